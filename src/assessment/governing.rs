//! The run with the largest displacement, sample by sample.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{Error, InputError, Result};
use mrbd_assessment::{Capacity, Control, TAIL_S};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{RockingWall, Wall};
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};

/// A sample of the governing run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GoverningRow {
    /// Time, s.
    pub time_s: f64,
    /// Acceleration of the ground or floor, m/s².
    pub ground_m_s2: f64,
    /// θ_1, rad.
    pub theta1_rad: f64,
    /// θ_2, rad.
    pub theta2_rad: f64,
    /// d: displacement as that of the equivalent oscillator, m.
    pub d_m: f64,
}

/// Runs a wall under a motion once more and keeps every sample.
pub fn governing_run(wall: &Wall, capacity: &Capacity, motion: &Accelerogram) -> Vec<GoverningRow> {
    let mut history = History::new(motion.step_s());
    let shaking = Shaking { horizontal: Some(motion.clone()), vertical: None, tail_s: TAIL_S };
    simulate_observed(wall, &shaking, Accuracy::default(), &mut history);
    let rocking = RockingWall::new(wall);
    let ground = motion.acceleration_m_s2();
    let row = |(k, row): (usize, &mrbd_kernel::simulate::HistoryRow)| GoverningRow {
        time_s: k as f64 * motion.step_s(),
        ground_m_s2: ground.get(k).copied().unwrap_or(0.0),
        theta1_rad: row.theta_rad[0],
        theta2_rad: row.theta_rad[1],
        d_m: {
            let control_m = match capacity.control {
                Control::Top => rocking.top_displacement_m(row.contact, row.theta_rad),
                Control::Crack => rocking.crack_displacement_m(row.theta_rad[0]),
            };
            capacity.d_of_control_m(control_m.abs()).copysign(control_m)
        },
    };
    history.rows.iter().enumerate().map(row).collect()
}

/// Rows as CSV.
///
/// # Errors
/// [`Error::Table`], a defect.
pub fn csv_bytes(rows: &[GoverningRow]) -> Result<Vec<u8>> {
    let fault = |e: csv::Error| Error::table(Path::new("governing_run.csv"), e);
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| writer.serialize(row)).map_err(fault)?;
    writer.into_inner().map_err(|e| fault(e.into_error().into()))
}

/// Reads them back; none where there is no such file.
///
/// # Errors
/// An input error for a file that is damaged.
pub fn read_governing(path: &Path) -> Result<Vec<GoverningRow>> {
    if !path.is_file() {
        return Ok(Vec::new());
    }
    let refuse = |e: csv::Error| InputError::file(path, e.to_string(), "a run as `mrbd assess` writes it");
    let mut reader = csv::Reader::from_path(path).map_err(refuse)?;
    Ok(reader.deserialize().collect::<Result<Vec<GoverningRow>, _>>().map_err(refuse)?)
}
