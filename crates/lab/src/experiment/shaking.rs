//! The ground motion of a test: read from its records, and cut where nothing counts any more.

use std::path::Path;

use mrbd_files::error::{InputError, Result};
use mrbd_kernel::model::WallParameters;
use mrbd_kernel::simulate::Shaking;
use mrbd_records::{Accelerogram, ReadOptions, read};

use super::file::TestTable;

/// Steps this near each other, as a share, are equal: files round them.
const SAME_STEP: f64 = 1e-9;

/// What is kept of a record beyond its last use, s, for walls whose effects bring it earlier: by no more than this.
const SPARE_S: f64 = 1.0;

/// What a record may be off the lines between every other sample, as a share of the noise of rotations: by so much a wall would have
/// turned after a second, if all samples between were off by the same. Roundings of a file are not.
const LITTLE_OF_NOISE: f64 = 0.1;

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

/// The same ground motion in as few samples as tell it, up to a time: every other is left out while those between lie on the lines.
///
/// A simulation takes a step for each sample. Records that were brought to a finer step for the sake of what was measured, or that their
/// makers interpolated, cost twice what they tell. Up to `until_s` nothing moves by more than a share of a noise in rad.
pub(super) fn straightened(shaking: Shaking, wall: &WallParameters, noise_rad: f64, until_s: f64) -> Shaking {
    let crack_m = wall.crack_height_m.unwrap_or(wall.height_m);
    let shortest_m = if crack_m < wall.height_m { crack_m.min(wall.height_m - crack_m) } else { crack_m };
    // A slender body of height H begins to turn by 3 a / (2 H), and has turned by half as much after a second.
    let most_off_m_s2 = LITTLE_OF_NOISE * noise_rad * shortest_m / 0.75;
    let mut shaking = shaking;
    let halved = |of: &Accelerogram| halved(of, most_off_m_s2, until_s + SPARE_S);
    while let Some(horizontal) = shaking.horizontal.as_ref().and_then(halved) {
        let vertical = match &shaking.vertical {
            None => None,
            Some(vertical) => match halved(vertical) {
                None => break,
                halved => halved,
            },
        };
        shaking = Shaking { horizontal: Some(horizontal), vertical, tail_s: shaking.tail_s };
    }
    shaking
}

/// Every other sample of a record, where those between lie on the lines up to a time; `None` where they do not.
fn halved(record: &Accelerogram, most_off_m_s2: f64, until_s: f64) -> Option<Accelerogram> {
    let samples = record.acceleration_m_s2();
    let ends_before = record.duration_s() <= until_s;
    if ends_before && samples.len().is_multiple_of(2) {
        // Without its last sample a record is another one when it runs backwards.
        return None;
    }
    let at = |k: usize| samples.get(k).copied().unwrap_or(0.0);
    let counted = (1..=samples.len()).step_by(2).take_while(|k| (k - 1) as f64 * record.step_s() < until_s);
    for k in counted {
        if (at(k) - 0.5 * (at(k - 1) + at(k + 1))).abs() > most_off_m_s2 {
            return None;
        }
    }
    Accelerogram::new(2.0 * record.step_s(), samples.iter().copied().step_by(2).collect()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Horizontal and vertical samples at steps of 0.005 s.
    fn shaken(horizontal: &[f64], vertical: Option<&[f64]>) -> Shaking {
        let of = |samples: &[f64]| Accelerogram::new(0.005, samples.to_vec()).expect("a record");
        Shaking { horizontal: Some(of(horizontal)), vertical: vertical.map(of), tail_s: 1.0 }
    }

    fn straight(shaking: Shaking, until_s: f64) -> (f64, Vec<f64>) {
        let wall = WallParameters::strip(0.25, 4.0, 1800.0);
        let shaking = straightened(shaking, &wall, 1e-5, until_s);
        let horizontal = shaking.horizontal.expect("a record");
        assert_eq!(shaking.vertical.map_or(horizontal.step_s(), |v| v.step_s()), horizontal.step_s());
        (horizontal.step_s(), horizontal.acceleration_m_s2().to_vec())
    }

    #[test]
    fn analytic_a_record_brought_to_a_finer_step_comes_back_to_its_own() {
        let own = [0.0, 1.0, -2.0, 0.5, 0.0];
        let finer = |parts: usize| {
            let between = |k: usize| {
                let (j, share) = (k / parts, (k % parts) as f64 / parts as f64);
                // As a file has it.
                let exact = own[j] + share * (own.get(j + 1).copied().unwrap_or(0.0) - own[j]);
                (exact * 1e6).round() / 1e6
            };
            (0..=(own.len() - 1) * parts).map(between).collect::<Vec<_>>()
        };
        assert_eq!(straight(shaken(&finer(2), None), 9.0), (0.01, own.to_vec()));
        assert_eq!(straight(shaken(&finer(4), None), 9.0), (0.02, own.to_vec()));
        // Three parts are no halves, and a vertical record of its own step holds the horizontal one.
        assert_eq!(straight(shaken(&finer(3), None), 9.0).0, 0.005);
        let vertical = [0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0];
        assert_eq!(straight(shaken(&finer(2), Some(&vertical)), 9.0).0, 0.005);
        assert_eq!(straight(shaken(&finer(2), Some(&finer(2))), 9.0).0, 0.01);
    }

    #[test]
    fn analytic_a_record_is_as_fine_as_it_tells() {
        // What is off by more than its bound, 5.3e-6 m/s², counts …
        let off = |a: f64| [0.0, 0.5 + a, 1.0, 0.5, 0.0];
        assert_eq!(straight(shaken(&off(5.2e-6), None), 9.0).0, 0.01);
        assert_eq!(straight(shaken(&off(5.4e-6), None), 9.0).0, 0.005);
        // … so do its end, which falls to zero within a step, and its last sample …
        assert_eq!(straight(shaken(&[0.0, 0.5, 1.0], None), 9.0).0, 0.005);
        assert_eq!(straight(shaken(&[0.0, 0.5, 1.0, 0.5], None), 9.0).0, 0.005);
        // … but not what comes a second after the last time that counts.
        let quiet = |then: f64| {
            let mut samples = vec![0.0; 300];
            samples[290] = then;
            samples
        };
        assert_eq!(straight(shaken(&quiet(1.0), None), 0.5).0, 0.005);
        assert!(straight(shaken(&quiet(1.0), None), 0.4).0 > 0.005);
    }
}
