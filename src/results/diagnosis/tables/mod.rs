//! The data behind the figures of a diagnosis, in Parquet beside `diagnosis.json`.
//!
//! ```text
//! histories.parquet     every sample: measured, simulated before and after, patterns, errors over windows
//! windows.parquet       every window: its error under the wall as given, recalibrated and updated, and its impacts
//! force.parquet         the missing force at the top, stretch by stretch, and what the updated wall leaves of it
//! jumps.parquet         velocities after impacts over those of the model
//! laws.parquet          laws of the best hypotheses, to be drawn through the force
//! rivals.parquet        every hypothesis that was tried, a row a number
//! ```

mod force;
mod histories;
mod jumps;
mod laws;
mod rivals;
mod windows;

use std::path::Path;

use crate::error::Result;
use mrbd_lab::diagnose::answer::Tables;

/// Names of the tables.
pub const TABLES: [&str; 6] = [
    "histories.parquet",
    "windows.parquet",
    "force.parquet",
    "jumps.parquet",
    "laws.parquet",
    "rivals.parquet",
];

/// Writes all of them.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub fn write_tables(folder: &Path, tables: &Tables) -> Result<()> {
    let [samples, windows, force, jumps, laws, rivals] = TABLES.map(|name| folder.join(name));
    histories::write(&samples, &tables.samples)?;
    windows::write(&windows, &tables.windows)?;
    force::write(&force, &tables.force)?;
    jumps::write(&jumps, &tables.jumps)?;
    laws::write(&laws, &tables.laws)?;
    rivals::write(&rivals, &tables.rivals)
}
