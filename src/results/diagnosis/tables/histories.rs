//! `histories.parquet`: measured against simulated, sample by sample.

use std::borrow::Cow;
use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::answer::rows::Sample;

fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

fn theta(sample: &Sample, when: usize, body: usize) -> Option<f64> {
    sample.simulated[when].map(|(theta, _)| theta[body])
}

fn pattern(sample: &Sample, when: usize) -> Option<Cow<'_, str>> {
    sample.simulated[when].map(|(_, contact)| contact.name().into())
}

fn error(sample: &Sample, when: usize, body: usize) -> Option<f64> {
    sample.residual[when].map(|r| r[body])
}

static COLUMNS: [Column<Sample>; 16] = [
    Column::input("test", "", "test", Read::Text(|s| Some(s.test.as_str().into()))),
    Column::input("use", "", "fit or hold-out", Read::Text(|s| Some(s.purpose.name().into()))),
    Column::input("time_s", "s", "time in the record", Read::Number(|s: &Sample| Some(s.time_s))).distinct(),
    Column::result(
        "theta1_measured_rad",
        "rad",
        "rotation of the lower body, measured",
        Read::Number(|s| finite(s.measured_rad[0])),
    ),
    Column::result(
        "theta2_measured_rad",
        "rad",
        "rotation of the upper body, measured",
        Read::Number(|s| finite(s.measured_rad[1])),
    ),
    Column::result(
        "pattern_measured",
        "",
        "pattern, where the measurement leaves no doubt",
        Read::Text(|s| s.measured_contact.map(|c| c.name().into())),
    ),
    Column::result(
        "theta1_before_rad",
        "rad",
        "θ_1 of a whole run of the wall as given",
        Read::Number(|s| theta(s, 0, 0)),
    ),
    Column::result("theta2_before_rad", "rad", "θ_2 of the same", Read::Number(|s| theta(s, 0, 1))),
    Column::result("pattern_before", "", "its pattern", Read::Text(|s| pattern(s, 0))),
    Column::result(
        "theta1_after_rad",
        "rad",
        "θ_1 of a whole run of the updated wall",
        Read::Number(|s| theta(s, 1, 0)),
    ),
    Column::result("theta2_after_rad", "rad", "θ_2 of the same", Read::Number(|s| theta(s, 1, 1))),
    Column::result("pattern_after", "", "its pattern", Read::Text(|s| pattern(s, 1))),
    Column::result(
        "error1_before",
        "",
        "measured less simulated θ_1 over its noise, in windows, wall as given",
        Read::Number(|s| error(s, 0, 0)),
    ),
    Column::result("error2_before", "", "the same of θ_2", Read::Number(|s| error(s, 0, 1))),
    Column::result("error1_after", "", "the same of θ_1, updated wall", Read::Number(|s| error(s, 1, 0))),
    Column::result("error2_after", "", "the same of θ_2, updated wall", Read::Number(|s| error(s, 1, 1))),
];

/// Writes the table.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn write(path: &Path, rows: &[Sample]) -> Result<()> {
    write_table(path, &COLUMNS, &[], rows)
}
