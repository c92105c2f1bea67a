//! Records one after another on one wall: `--then`, `--rest`, `--then-scale`.

use std::path::PathBuf;

use clap::Args;

use crate::error::{InputError, Result};
use crate::report::Watch;
use crate::results::{PartPeaks, PartResults, joined, part_results};
use mrbd_kernel::model::{Contact, Pair, Wall};
use mrbd_kernel::simulate::{Accuracy, Observer, Response, Shaking, simulate};
use mrbd_kernel::solver::Quintic;
use mrbd_records::{Accelerogram, ReadOptions};

use super::{load, number, record_name};

/// Options of sequences.
#[derive(Debug, Clone, Args)]
pub struct ThenArgs {
    /// A record that follows, at the same step; several in order.
    #[arg(long, value_name = "FILE", requires = "record", conflicts_with = "vertical")]
    pub then: Vec<PathBuf>,
    /// Rest from the last sample of a record to the first of the next, up to a whole step.
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0, requires = "then")]
    rest: f64,
    /// Factor on the records that follow.
    #[arg(long, value_name = "X", default_value_t = 1.0, requires = "then", allow_negative_numbers = true)]
    then_scale: f64,
}

/// The records of a sequence, and when each begins.
pub struct Sequence {
    names: Vec<String>,
    later: Vec<Accelerogram>,
    peaks: PartPeaks,
}

impl ThenArgs {
    /// Makes the records one after another of a shaking by the first; `None` where none follows.
    ///
    /// # Errors
    /// Input errors for records that cannot be read or have another step, and for a rest shorter than two steps.
    pub fn follow(
        &self,
        shaking: &mut Shaking,
        first_name: Option<&str>,
        options: &ReadOptions,
    ) -> Result<Option<Sequence>> {
        let (Some(first), Some(first_name)) = (&shaking.horizontal, first_name) else { return Ok(None) };
        if self.then.is_empty() {
            return Ok(None);
        }
        let step_s = first.step_s();
        let rest_s = self.rest_s(step_s)?;
        let scale = number("--then-scale", self.then_scale, true, "a finite number")?;
        let (mut records, mut names) = (vec![first.clone()], vec![first_name.to_owned()]);
        for path in &self.then {
            let Some(record) = load(Some(path), options, scale)? else { continue };
            if record.step_s() != step_s {
                let allowed = format!("the step of the first record, {step_s} s");
                let found = format!("a step of {} s", record.step_s());
                return Err(InputError::file(path, found, allowed).into());
            }
            records.push(record);
            names.push(record_name(path, scale));
        }
        let fault = |e: mrbd_records::InvalidAccelerogram| {
            InputError::option("--then", e.to_string(), "records that make a record together")
        };
        if let Some((samples, starts_s)) = joined(&records, rest_s) {
            shaking.horizontal = Some(Accelerogram::new(step_s, samples).map_err(fault)?);
            let peaks = PartPeaks::new(&starts_s);
            return Ok(Some(Sequence { names, later: records.split_off(1), peaks }));
        }
        Ok(None)
    }

    /// Within two steps the motion falls to zero and rises again; a day is no rest between records.
    fn rest_s(&self, step_s: f64) -> Result<f64, InputError> {
        let (least_s, most_s) = (2.0 * step_s, 3600.0);
        let allowed = format!("{least_s} to {most_s} s: two steps of the record to an hour");
        number("--rest", self.rest, (least_s..=most_s).contains(&self.rest), &allowed)
    }
}

impl Sequence {
    /// Name of all records, for titles.
    pub fn name(&self) -> String {
        self.names.join(", then ")
    }

    /// What watches the run part by part.
    pub fn peaks(&mut self) -> &mut PartPeaks {
        &mut self.peaks
    }

    /// What each part did in the run that was watched, beside what the later records do to the wall as it was built.
    pub fn results(&self, wall: &Wall, accuracy: Accuracy, run: &Response, tail_s: f64) -> Vec<PartResults> {
        let alone = |record: &Accelerogram| {
            let shaking = Shaking { horizontal: Some(record.clone()), vertical: None, tail_s };
            simulate(wall, &shaking, accuracy)
        };
        let alone: Vec<Response> = self.later.iter().map(alone).collect();
        part_results(wall, run, &self.peaks, &self.names, &alone)
    }
}

/// Watches a run for its pictures, where there are any, and part by part.
pub struct WatchedParts<'a> {
    /// For pictures and histories.
    pub watch: Option<&'a mut Watch>,
    /// Part by part, of a sequence.
    pub peaks: Option<&'a mut PartPeaks>,
}

impl WatchedParts<'_> {
    fn each(&mut self, tell: impl Fn(&mut dyn Observer)) {
        self.watch.iter_mut().for_each(|watch| tell(*watch));
        self.peaks.iter_mut().for_each(|peaks| tell(*peaks));
    }
}

impl Observer for WatchedParts<'_> {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        self.each(|observer| observer.moved(start_s, contact, motion));
    }

    fn stood(&mut self, from_s: f64, to_s: f64) {
        self.each(|observer| observer.stood(from_s, to_s));
    }

    fn ended(&mut self, time_s: f64, contact: Contact, theta: Pair) {
        self.each(|observer| observer.ended(time_s, contact, theta));
    }
}
