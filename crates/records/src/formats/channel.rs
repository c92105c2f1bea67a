//! The channels of a file: choosing one, converting it to m/s².

use super::source::{Source, quote};
use super::{Format, ReadOptions, Record};
use crate::{Accelerogram, Unit};
use mrbd_files::error::InputError;
use mrbd_kernel::model::G_M_S2;

/// Peaks that samples of no stated unit must have, g: below is hardly felt, above was hardly ever recorded.
const PLAUSIBLE_PEAK_G: std::ops::RangeInclusive<f64> = 0.01..=3.0;
/// Relative difference between the step of a file and the one it should have: headers round to this.
const STEP_TOLERANCE: f64 = 1e-3;

/// One channel of a file, in the unit of the file.
pub(super) struct Channel {
    /// Name in the file; empty where the format has no names.
    pub label: String,
    pub step_s: f64,
    /// What the file states; `None` where it states nothing.
    pub unit: Option<Unit>,
    pub samples: Vec<f64>,
}

/// The channel `wanted`; the only one there is where that is `None`.
pub(super) fn choose(
    source: &Source,
    mut channels: Vec<Channel>,
    wanted: Option<&str>,
) -> Result<Channel, InputError> {
    let count = channels.len();
    let index = match wanted {
        None if count == 1 => Some(0),
        None => None,
        Some(wanted) => find(&channels, wanted.trim()),
    };
    let found = || match wanted {
        None => format!("{count} channels and none chosen"),
        Some(wanted) => format!("channel {}", quote(wanted)),
    };
    match index {
        Some(index) => Ok(channels.swap_remove(index)),
        None => Err(source.fault_file(found(), format!("one of the channels {}", list(&channels)))),
    }
}

fn find(channels: &[Channel], wanted: &str) -> Option<usize> {
    if let Ok(number) = wanted.parse::<usize>() {
        return number.checked_sub(1).filter(|&index| index < channels.len());
    }
    let whole = channels.iter().position(|c| c.label.eq_ignore_ascii_case(wanted));
    whole.or_else(|| {
        let is_first =
            |c: &Channel| c.label.split_whitespace().next().is_some_and(|w| w.eq_ignore_ascii_case(wanted));
        channels.iter().position(is_first)
    })
}

fn list(channels: &[Channel]) -> String {
    let names: Vec<String> =
        channels.iter().enumerate().map(|(i, c)| format!("{} ({})", i + 1, c.label)).collect();
    names.join(", ")
}

impl Channel {
    /// The record, in m/s², once it agrees with what the caller knows.
    pub fn into_record(
        self,
        source: &Source,
        format: &'static Format,
        options: &ReadOptions,
    ) -> Result<Record, InputError> {
        self.check_step(source, options)?;
        let unit = self.check_unit(source, options)?;
        let samples: Vec<f64> = self.samples.iter().map(|a| a * unit.m_s2()).collect();
        let accelerogram = Accelerogram::new(self.step_s, samples)
            .map_err(|e| source.fault_file(e.to_string(), "an accelerogram"))?;
        if self.unit.is_none() && options.unit.is_none() {
            check_plausible(source, accelerogram.peak_m_s2() / G_M_S2)?;
        }
        let name = source.path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let channel = Some(self.label).filter(|label| !label.is_empty());
        Ok(Record { name, format, channel, unit, accelerogram })
    }

    fn check_step(&self, source: &Source, options: &ReadOptions) -> Result<(), InputError> {
        let Some(step) = options.step_s else { return Ok(()) };
        let agrees = (step - self.step_s).abs() <= STEP_TOLERANCE * self.step_s;
        if agrees {
            return Ok(());
        }
        let allowed = format!("the step of {step} s that was given for it");
        Err(source.fault_file(format!("a step of {} s", self.step_s), allowed))
    }

    fn check_unit(&self, source: &Source, options: &ReadOptions) -> Result<Unit, InputError> {
        match (self.unit, options.unit) {
            (Some(said), Some(given)) if said != given => {
                let allowed =
                    format!("the unit {given} that was given for it; leave it out to take the file's");
                Err(source.fault_file(format!("the unit {said}"), allowed))
            }
            (said, given) => Ok(said.or(given).unwrap_or(Unit::MetrePerSecond2)),
        }
    }
}

fn check_plausible(source: &Source, peak_g: f64) -> Result<(), InputError> {
    if PLAUSIBLE_PEAK_G.contains(&peak_g) {
        return Ok(());
    }
    let found = format!("a peak of {peak_g:.4} g when read as m/s2, and no unit given");
    let (low, high) = (PLAUSIBLE_PEAK_G.start(), PLAUSIBLE_PEAK_G.end());
    let allowed = format!(
        "{low} to {high} g; state the unit of the file if it is meant so: `--unit`, or `unit` in a suite"
    );
    Err(source.fault_file(found, allowed))
}
