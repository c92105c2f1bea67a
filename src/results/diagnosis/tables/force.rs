//! `force.parquet`: the missing force at the top.

use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::answer::rows::ForceRow;

static COLUMNS: [Column<ForceRow>; 13] = [
    Column::input("test", "", "test", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::input("use", "", "fit or hold-out", Read::Text(|r| Some(r.purpose.name().into()))),
    Column::input("time_s", "s", "middle of the stretch", Read::Number(|r: &ForceRow| Some(r.point.time_s)))
        .distinct(),
    Column::input("pattern", "", "pattern", Read::Text(|r| Some(r.point.contact.name().into()))),
    Column::result(
        "displacement_m",
        "m",
        "displacement of the top, relative to the ground",
        Read::Number(|r| Some(r.point.displacement_m)),
    ),
    Column::result("velocity_m_s", "m/s", "its velocity", Read::Number(|r| Some(r.point.velocity_m_s))),
    Column::result(
        "acceleration_m_s2",
        "m/s²",
        "its absolute acceleration",
        Read::Number(|r| Some(r.point.acceleration_m_s2)),
    ),
    Column::result(
        "moment1_n_m",
        "N m",
        "missing moment on θ_1; on both bodies together in pattern 3",
        Read::Number(|r| r.point.moment_n_m[0]),
    ),
    Column::result("moment2_n_m", "N m", "missing moment on θ_2", Read::Number(|r| r.point.moment_n_m[1])),
    Column::result(
        "force_n",
        "N",
        "horizontal force at the top that comes nearest to them",
        Read::Number(|r| Some(r.point.force_n)),
    ),
    Column::result(
        "force_sd_n",
        "N",
        "its standard deviation by the noise",
        Read::Number(|r| Some(r.point.force_sd_n)),
    ),
    Column::result(
        "share_off_top",
        "",
        "share of the squared moments off the direction of such a force; null where noise, or one moment, has none",
        Read::Number(|r| r.point.share_off_top),
    ),
    Column::result(
        "force_after_n",
        "N",
        "the same force as the updated wall leaves it",
        Read::Number(|r| r.after_n),
    ),
];

/// Writes the table.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn write(path: &Path, rows: &[ForceRow]) -> Result<()> {
    write_table(path, &COLUMNS, &[], rows)
}
