//! Writing a record as two columns, the format that tells everything itself.

use std::fmt::Write;
use std::path::Path;

use super::Accelerogram;
use mrbd_files::error::{Error, Result};

/// Most decimals of a written time, s.
const MOST_DECIMALS: usize = 9;

/// Writes a record as CSV with the header `time_s,acceleration_m_s2`; read back, its samples are the same to the bit.
///
/// # Errors
/// Where the file cannot be written.
pub fn write_two_columns(path: &Path, record: &Accelerogram) -> Result<()> {
    std::fs::write(path, two_columns(record)).map_err(|e| Error::io("write the record", path, e))
}

fn two_columns(record: &Accelerogram) -> String {
    let step = record.step_s();
    let decimals = decimals(step);
    let mut text = String::from("time_s,acceleration_m_s2\n");
    for (i, a) in record.acceleration_m_s2().iter().enumerate() {
        // Adding zero takes the sign off a negative zero; writing to a string does not fail.
        let _written = writeln!(text, "{:.decimals$},{}", i as f64 * step, a + 0.0);
    }
    text
}

/// Decimals that write every multiple of the step; for steps that no few decimals write, the most.
fn decimals(step_s: f64) -> usize {
    let writes = |decimals: &usize| {
        let scaled = step_s * 10_f64.powi(*decimals as i32);
        scaled >= 1.0 && (scaled - scaled.round()).abs() < 1e-6
    };
    (2..MOST_DECIMALS).find(writes).unwrap_or(MOST_DECIMALS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_times_are_written_with_the_decimals_they_need() {
        for (step, expected) in [(0.01, 2), (0.005, 3), (0.0078125, 7), (0.1, 2), (1.0 / 3.0, 9)] {
            assert_eq!(decimals(step), expected, "{step}");
        }
        let record = Accelerogram::new(0.005, vec![0.0, -0.0, 0.1 + 0.2]).expect("valid");
        let expected = "time_s,acceleration_m_s2\n0.000,0\n0.005,0\n0.010,0.30000000000000004\n";
        assert_eq!(two_columns(&record), expected);
    }
}
