//! Shares of variances as tables: for people, as CSV and as Parquet.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

use super::outputs::Output;
use super::{OfFloor, OfOutput, Share, Shares};
use crate::error::Result;
use crate::store::{Column, Read};
use crate::survey::Configuration;
use crate::text::{TERMINAL, aligned, wrapped};

/// The indices of an input, with what they are of.
struct Row {
    configuration: Configuration,
    points: usize,
    left_out: usize,
    output: Output,
    mean: f64,
    variance: f64,
    share: Share,
}

macro_rules! text {
    (|$r:ident| $value:expr) => {
        Read::Text(|$r| Some(Cow::Borrowed($value)))
    };
}

macro_rules! number {
    (|$r:ident| $value:expr) => {
        Read::Number(|$r| Some($value))
    };
}

/// Every column of the table of indices, in order.
#[rustfmt::skip] // One column a line, so that the table reads as a table.
const COLUMNS: &[Column<Row>] = &[
    Column::input("configuration", "", "how the floor runs", text!(|r| r.configuration.name())),
    Column::input("output", "", "what varies: theta1_rank, theta2_rank (rank of θ_i/α_i among all runs, collapses highest), collapse (1 or 0), theta1_clipped, theta2_clipped (θ_i/α_i, at most 1)", text!(|r| r.output.name())),
    Column::input("input", "", "input or group of inputs, as the matrices of the runs are named; record", text!(|r| &r.share.input)),
    Column::input("is_group", "", "whether it is a group of others", Read::Flag(|r| Some(r.share.is_group))),
    Column::result("first", "", "first-order index: share of the variance that would go if it were known", number!(|r| r.share.first)),
    Column::result("first_low", "", "5 % quantile of it over draws of the points", number!(|r| r.share.first_interval[0])),
    Column::result("first_high", "", "95 % quantile", number!(|r| r.share.first_interval[1])),
    Column::result("total", "", "total index: share of the variance that would be left if all others were known", number!(|r| r.share.total)),
    Column::result("total_low", "", "5 % quantile of it over draws of the points", number!(|r| r.share.total_interval[0])),
    Column::result("total_high", "", "95 % quantile", number!(|r| r.share.total_interval[1])),
    Column::result("mean", "", "mean of the output", number!(|r| r.mean)),
    Column::result("variance", "", "its variance", number!(|r| r.variance)),
    Column::result("points", "", "points that are told of", Read::Count(|r| Some(r.points as u64))),
    Column::result("left_out", "", "points left out, as one of their runs failed", Read::Count(|r| Some(r.left_out as u64))),
];

fn rows(shares: &Shares) -> Vec<Row> {
    let of_output = |floor: &OfFloor, of: &OfOutput| -> Vec<Row> {
        let row = |share: &Share| Row {
            configuration: floor.configuration,
            points: floor.points,
            left_out: floor.left_out,
            output: of.output,
            mean: of.mean,
            variance: of.variance,
            share: share.clone(),
        };
        of.shares.iter().map(row).collect()
    };
    let of_floor =
        |floor: &OfFloor| -> Vec<Row> { floor.outputs.iter().flat_map(|of| of_output(floor, of)).collect() };
    shares.floors.iter().flat_map(of_floor).collect()
}

/// Writes a row for each floor, output and input to a Parquet file.
///
/// # Errors
/// [`mrbd_files::Error::Io`] or [`crate::Error::Table`] if the disk refuses.
pub fn write_table(path: &Path, shares: &Shares) -> Result<()> {
    crate::store::write_table(path, COLUMNS, &[], &rows(shares))
}

/// Writes the same rows as CSV.
///
/// # Errors
/// What the stream says.
pub fn print_csv(mut out: impl Write, shares: &Shares) -> io::Result<()> {
    crate::store::print_csv(&mut out, COLUMNS.iter(), rows(shares))
}

/// Prints a table a floor: the inputs, and their indices for ranks of the rotations and for collapse.
///
/// # Errors
/// What the stream says.
pub fn print_tables(out: &mut dyn Write, shares: &Shares) -> io::Result<()> {
    writeln!(
        out,
        "{} runs of {:?} under {} records of {:?}",
        shares.runs, shares.study, shares.records, shares.suite
    )?;
    for floor in &shares.floors {
        print_floor(out, floor)?;
    }
    let notes = "Sobol' indices with their 90 % intervals over draws of the points. first: share of the variance that would \
                 go if the input were known; total: share that would be left if all others were. Rotations by their \
                 ranks, collapses highest. chaos: what no input decides; the record is one of the suite's, each as \
                 likely as another.";
    writeln!(out, "{}", wrapped(notes, 0, TERMINAL))
}

/// Outputs of the printed table.
const SHOWN: [(Output, &str); 3] =
    [(Output::Theta1Rank, "θ1/α1"), (Output::Theta2Rank, "θ2/α2"), (Output::Collapse, "collapse")];

fn print_floor(out: &mut dyn Write, floor: &OfFloor) -> io::Result<()> {
    let OfFloor { configuration, points, left_out, .. } = floor;
    let left_out =
        if *left_out > 0 { format!(", {left_out} left out for a failed run") } else { String::new() };
    let fallen = 100.0 * floor.fallen();
    writeln!(
        out,
        "\n{} floor: {points} points{left_out}; {fallen:.1} % of the walls fall",
        configuration.name()
    )?;
    let shown: Vec<(&OfOutput, &str)> = SHOWN
        .iter()
        .filter_map(|(output, symbol)| Some((floor.outputs.iter().find(|of| of.output == *output)?, *symbol)))
        .collect();
    let mut head = vec!["input".to_owned()];
    head.extend(
        shown.iter().flat_map(|(_, symbol)| ["first", "total"].map(|index| format!("{symbol} {index}"))),
    );
    let mut rows = vec![head];
    for input in inputs(floor) {
        let cells = shown.iter().flat_map(|(of, _)| cells(of.share(input)));
        rows.push(std::iter::once(input.to_owned()).chain(cells).collect());
    }
    writeln!(out, "{}", aligned(&rows))
}

/// The inputs of the first output that varies.
fn inputs(floor: &OfFloor) -> Vec<&str> {
    let varies = floor.outputs.iter().find(|of| !of.shares.is_empty());
    varies.map_or(Vec::new(), |of| of.shares.iter().map(|share| share.input.as_str()).collect())
}

/// Both indices; dashes for an output that does not vary.
fn cells(share: Option<&Share>) -> [String; 2] {
    share.map_or(["-".to_owned(), "-".to_owned()], Share::told)
}
