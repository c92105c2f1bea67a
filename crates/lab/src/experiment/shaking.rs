//! The ground motion of a test: read from its records, and cut where nothing counts any more.

use std::path::Path;

use mrbd_files::error::{InputError, Result};
use mrbd_kernel::simulate::Shaking;
use mrbd_records::{Accelerogram, ReadOptions, read};

use super::file::TestTable;

/// Steps this near each other, as a share, are equal: files round them.
const SAME_STEP: f64 = 1e-9;

/// What is kept of a record beyond its last use, s, for walls whose effects bring it earlier: by no more than this.
const SPARE_S: f64 = 1.0;

/// Reads the records of a test; paths are relative to `folder`.
///
/// # Errors
/// Input errors of the records, or if their steps differ.
pub(super) fn read_shaking(folder: &Path, table: &TestTable) -> Result<Shaking> {
    let options = ReadOptions { step_s: table.record_step_s, ..ReadOptions::default() };
    let Some(record) = &table.record else { return Ok(Shaking::default()) };
    let horizontal = read(&folder.join(record), &options)?.accelerogram.scaled(table.scale);
    let vertical = match &table.vertical {
        None => None,
        Some(name) => {
            let path = folder.join(name);
            let record = read(&path, &options)?.accelerogram;
            let (step_s, needed) = (record.step_s(), horizontal.step_s());
            if (step_s / needed - 1.0).abs() > SAME_STEP {
                let allowed = format!("the step of the horizontal record, {needed} s");
                return Err(InputError::file(&path, format!("a step of {step_s} s"), allowed).into());
            }
            Some(record.scaled(table.vertical_scale.unwrap_or(table.scale)))
        }
    };
    Ok(Shaking { horizontal: Some(horizontal), vertical, tail_s: 0.0 })
}

/// The records cut where nothing counts any more, or free motion added until there.
///
/// What comes after a time does not change what came before it, so the cut changes no result.
pub(super) fn until(shaking: &Shaking, end_s: f64) -> Shaking {
    let horizontal = shaking.horizontal.as_ref().map(|record| cut(record, end_s));
    let vertical = shaking.vertical.as_ref().map(|record| cut(record, end_s));
    let duration_s = horizontal.as_ref().map_or(0.0, Accelerogram::duration_s);
    Shaking { horizontal, vertical, tail_s: (end_s - duration_s).max(0.0) }
}

fn cut(record: &Accelerogram, end_s: f64) -> Accelerogram {
    let samples = record.acceleration_m_s2();
    let needed = ((end_s + SPARE_S) / record.step_s()).ceil() as usize + 2;
    if needed >= samples.len() {
        return record.clone();
    }
    // A part of a valid record, two samples at least, is valid.
    Accelerogram::new(record.step_s(), samples[..needed].to_vec()).unwrap_or_else(|_| record.clone())
}
