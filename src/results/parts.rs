//! A sequence of records on one wall, as one joined record: its largest rotations part by part.

use serde_json::{Value, json};

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, Pair, Wall};
use mrbd_kernel::simulate::{Observer, Outcome, Peak, Response};
use mrbd_kernel::solver::Quintic;

/// Records as one, and when each begins, s; at the step of the first.
///
/// Between two lie `rest_s` from the last sample of one to the first of the next, rounded up to a whole step: zeros, so
/// that the motion falls to zero within a step and rises from it within one.
pub fn joined(records: &[Accelerogram], rest_s: f64) -> Option<(Vec<f64>, Vec<f64>)> {
    let step_s = records.first()?.step_s();
    // A quotient has roundings.
    let rest = ((rest_s / step_s - 1e-9).ceil() as usize).max(1);
    let (mut samples, mut starts_s) = (Vec::new(), Vec::new());
    for (index, record) in records.iter().enumerate() {
        if index > 0 {
            samples.resize(samples.len() + rest - 1, 0.0);
        }
        starts_s.push(samples.len() as f64 * step_s);
        samples.extend_from_slice(record.acceleration_m_s2());
    }
    Some((samples, starts_s))
}

/// Largest rotations of a run, by the parts in which they are reached.
#[derive(Debug, Clone, PartialEq)]
pub struct PartPeaks {
    starts_s: Vec<f64>,
    /// Largest rotations θ_1, θ_2 of each part, rad.
    pub largest: Vec<[Peak; 2]>,
}

impl PartPeaks {
    /// None yet, of parts that begin at these times, s.
    pub fn new(starts_s: &[f64]) -> Self {
        Self { starts_s: starts_s.to_vec(), largest: vec![<[Peak; 2]>::default(); starts_s.len()] }
    }
}

impl Observer for PartPeaks {
    fn moved(&mut self, start_s: f64, _: Contact, motion: &Quintic) {
        // Samples end steps, so that the middle of one lies in its part whatever the roundings of times.
        let middle_s = start_s + 0.5 * motion.h();
        let part = self.starts_s.partition_point(|&start_s| start_s <= middle_s).max(1) - 1;
        for (i, peak) in self.largest[part].iter_mut().enumerate() {
            for sign in [1.0, -1.0] {
                let (value, share) = motion.coordinate(i).times(sign).maximum();
                if value > peak.value.abs() {
                    *peak = Peak { value: sign * value, time_s: start_s + share * motion.h() };
                }
            }
        }
    }

    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}
}

/// A record of a sequence, and what it did.
#[derive(Debug, Clone, PartialEq)]
pub struct PartResults {
    /// Name of the record.
    pub record: String,
    /// When it begins, s.
    pub start_s: f64,
    /// Largest rotations over slenderness angles, without sign; none where the wall had fallen before.
    pub over_alpha_i: Option<[f64; 2]>,
    /// Whether the wall fell in it.
    pub collapsed: bool,
    /// The same record on the wall as it was built; none of the first, which is just that.
    pub alone: Option<Response>,
}

/// What each part did; `alone` are the later records by themselves.
pub fn part_results(
    wall: &Wall,
    run: &Response,
    peaks: &PartPeaks,
    records: &[String],
    alone: &[Response],
) -> Vec<PartResults> {
    let alpha_rad = wall.alpha_i_rad();
    let part = |index: usize| {
        let start_s = peaks.starts_s[index];
        let end_s = peaks.starts_s.get(index + 1).copied().unwrap_or(f64::INFINITY);
        let fell_s = match run.outcome {
            Outcome::Stood => f64::INFINITY,
            Outcome::Collapsed { time_s } | Outcome::Failed { time_s, .. } => time_s,
        };
        let over_alpha_i = [0, 1].map(|i| peaks.largest[index][i].value.abs() / alpha_rad[i]);
        PartResults {
            record: records[index].clone(),
            start_s,
            over_alpha_i: (fell_s > start_s).then_some(over_alpha_i),
            collapsed: run.collapsed() && (start_s..end_s).contains(&fell_s),
            alone: index.checked_sub(1).and_then(|later| alone.get(later).cloned()),
        }
    };
    (0..records.len()).map(part).collect()
}

impl PartResults {
    /// The results for scripts.
    pub fn json(&self) -> Value {
        let ratios = |of: Option<[f64; 2]>| match of {
            Some([lower, upper]) => {
                json!({ "theta1_max_over_alpha1": lower, "theta2_max_over_alpha2": upper })
            }
            None => json!({ "theta1_max_over_alpha1": null, "theta2_max_over_alpha2": null }),
        };
        let mut part = ratios(self.over_alpha_i);
        part["record"] = self.record.as_str().into();
        part["start_s"] = self.start_s.into();
        part["collapsed"] = self.over_alpha_i.map(|_| self.collapsed).into();
        if let Some(alone) = &self.alone {
            part["alone"] = ratios(Some(alone.theta_max_over_alpha_i()));
            part["alone"]["collapsed"] = alone.collapsed().into();
        }
        part
    }

    /// What the part did, for people.
    pub fn told(&self) -> String {
        let rotated = |ratios| rotated(ratios, self.collapsed);
        self.over_alpha_i.map_or("the wall had fallen".to_owned(), rotated)
    }

    /// What the record does to the wall as it was built, for people; none of the first.
    pub fn told_alone(&self) -> Option<String> {
        let alone = self.alone.as_ref()?;
        Some(rotated(alone.theta_max_over_alpha_i(), alone.collapsed()))
    }

    /// A line of the results.
    pub fn text(&self, number: usize) -> String {
        let alone = self.told_alone().map_or(String::new(), |alone| format!("; alone {alone}"));
        format!("part {number:<7}{} from {:.3} s: {}{alone}", self.record, self.start_s, self.told())
    }
}

fn rotated([lower, upper]: [f64; 2], fell: bool) -> String {
    let fell = if fell { ", and fell" } else { "" };
    format!("{lower:.4} and {upper:.4} of α{fell}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_joined_record_is_its_records_with_rest_between() {
        let record = |samples: &[f64]| Accelerogram::new(0.1, samples.to_vec()).expect("a record");
        let records = [record(&[1.0, 2.0]), record(&[3.0, 4.0])];
        // From the last sample at 0.1 s rest lasts to the first one of the next at 0.4 s.
        let (samples, starts_s) = joined(&records, 0.3).expect("records");
        assert_eq!(samples, [1.0, 2.0, 0.0, 0.0, 3.0, 4.0]);
        assert_eq!(starts_s, [0.0, 4.0 * 0.1]);
        assert_eq!(joined(&records, 0.21).expect("records").0.len(), 6, "up to a whole step");
    }
}
