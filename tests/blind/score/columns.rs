//! The columns of the table of cases.

use mrbd::store::{Column, Read};

use super::row::Row;

/// One row a case.
pub static COLUMNS: [Column<Row>; 21] = [
    Column::input("case", "", "number of the case in its set", Read::Count(|r| Some(r.number))),
    Column::input("kind", "", "what is hidden", Read::Text(|r| Some(r.kind.as_str().into()))),
    Column::input(
        "simulator",
        "",
        "which simulator made it",
        Read::Text(|r| Some(r.simulator.as_str().into())),
    ),
    Column::input("prior", "", "what is said to be known", Read::Text(|r| Some(r.prior.as_str().into()))),
    Column::input("noise_rad", "rad", "white noise on the rotations", Read::Number(|r| Some(r.noise_rad))),
    Column::input("size", "", "size of the effect over its nominal one", Read::Number(|r| Some(r.size))),
    Column::input("fit_tests", "", "tests to fit", Read::Count(|r| Some(r.tests))),
    Column::input("place", "", "where it acts", Read::Text(|r| Some(r.hidden_places.join(" + ").into()))),
    Column::result("verdict", "", "the verdict", Read::Text(|r| Some(r.verdict.as_str().into()))),
    Column::result("named", "", "effects named", Read::Text(|r| Some(r.named.join(" + ").into()))),
    Column::result("equivalent", "", "the class", Read::Text(|r| Some(r.equivalent.join(" ").into()))),
    Column::result(
        "place_said",
        "",
        "where it was said to act",
        Read::Text(|r| Some(r.place.as_str().into())),
    ),
    Column::result("exact", "", "exactly what is hidden was named", Read::Flag(|r| Some(r.exact()))),
    Column::result("right", "", "named, or in the class", Read::Flag(|r| Some(r.right()))),
    Column::result("wrong", "", "another name was given", Read::Flag(|r| Some(r.wrong()))),
    Column::result(
        "over_detectable",
        "",
        "size over the smallest that the diagnosis says it could detect",
        Read::Number(|r| r.first_over_detectable()),
    ),
    Column::result(
        "parameter_error",
        "",
        "|found - true| over the deviation from doing nothing",
        Read::Number(|r| r.parameter_error),
    ),
    Column::result("covered", "", "the interval holds the truth", Read::Flag(|r| r.covered)),
    Column::result("held_out_before", "", "windowed error over noise, before", Read::Number(|r| r.before)),
    Column::result("held_out_after", "", "windowed error over noise, after", Read::Number(|r| r.after)),
    Column::result("seconds", "s", "time of the diagnosis", Read::Number(|r| Some(r.seconds))),
];
