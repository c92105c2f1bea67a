//! Ill-conditioned runs: a sample of runs that are stored, run again at a tighter tolerance.
//!
//! Where two impacts nearly coincide a tiny change of step decides the later motion. Such a run is no error, but neither
//! is its answer the only one; what counts is how many there are, and whether medians depend on them.

use std::collections::BTreeMap;

use indicatif::ProgressBar;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::aggregate::{Answer, Compared, MOVED_SHARE, median};
use crate::study::batch::run_all;
use crate::study::plan::Plan;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Shaking, simulate};
use mrbd_statistics::normal::NINETY_FIVE_PERCENT;

/// One run as stored and as it came out again.
#[derive(Debug, Clone, PartialEq)]
pub struct Again {
    /// Set of assumptions.
    pub variant: String,
    /// How the floor runs.
    pub configuration: String,
    /// As stored.
    pub stored: Answer,
    /// At the tighter tolerance.
    pub tighter: Answer,
}

/// What a sample says of the runs of one variant and floor.
#[derive(Debug, Clone, PartialEq)]
pub struct Conditioning {
    /// Set of assumptions.
    pub variant: String,
    /// How the floor runs.
    pub configuration: String,
    /// Runs that were finished both times.
    pub runs: u64,
    /// Of these, those that ended otherwise.
    pub other_outcome: u64,
    /// Those, and those whose numbers differ by more than [`MOVED_SHARE`].
    pub ill_conditioned: u64,
    /// Medians of each number, stored and at the tighter tolerance; none where they lie above all numbers.
    pub medians: Vec<[Option<f64>; 2]>,
}

impl Conditioning {
    /// Share of ill-conditioned runs, and its 95 % interval by Wilson (1927); none of no runs.
    pub fn share(&self) -> Option<[f64; 3]> {
        if self.runs == 0 {
            return None;
        }
        let (n, z2) = (self.runs as f64, NINETY_FIVE_PERCENT * NINETY_FIVE_PERCENT);
        let p = self.ill_conditioned as f64 / n;
        let middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
        let half = NINETY_FIVE_PERCENT / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
        Some([p, middle - half, middle + half])
    }
}

/// Positions of a sample of `count` of `runs`: one in each of as many equal stretches of the plan, so that every record,
/// variant and floor has its share; all runs where there are no more.
pub fn sampled(runs: u64, count: u64, seed: u64) -> Vec<u64> {
    if count >= runs {
        return (0..runs).collect();
    }
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let start = |stretch: u64| (u128::from(stretch) * u128::from(runs) / u128::from(count)) as u64;
    (0..count).map(|stretch| rng.random_range(start(stretch)..start(stretch + 1))).collect()
}

/// What the runs of a sample say, by variant and floor in order of appearance.
pub fn conditioning(compared: &Compared, sample: &[Again]) -> Vec<Conditioning> {
    let mut groups: BTreeMap<(&str, &str), Vec<&Again>> = BTreeMap::new();
    let mut order = Vec::new();
    for again in sample {
        let key = (again.variant.as_str(), again.configuration.as_str());
        groups.entry(key).or_insert_with(|| {
            order.push(key);
            Vec::new()
        });
        // A run that could not be finished has no answer to compare.
        let finished = |answer: &Answer| [compared.usable, compared.beyond].contains(&&*answer.outcome);
        if finished(&again.stored)
            && finished(&again.tighter)
            && let Some(group) = groups.get_mut(&key)
        {
            group.push(again);
        }
    }
    order.into_iter().map(|key| of_group(compared, key, &groups[&key])).collect()
}

fn of_group(compared: &Compared, (variant, configuration): (&str, &str), group: &[&Again]) -> Conditioning {
    let count = |holds: &dyn Fn(&Again) -> bool| group.iter().filter(|again| holds(again)).count() as u64;
    let other = |again: &Again| again.stored.outcome != again.tighter.outcome;
    let median_of = |number: usize, of: &dyn Fn(&Again) -> Answer| {
        let answers: Vec<Answer> = group.iter().map(|again| of(again)).collect();
        let usable = answers.iter().filter(|answer| answer.outcome == compared.usable);
        let mut values: Vec<f64> = usable.filter_map(|answer| answer.numbers[number]).collect();
        values.sort_by(f64::total_cmp);
        median(&values, answers.len() - values.len())
    };
    let medians = (0..compared.numbers.len()).map(|number| {
        [median_of(number, &|again| again.stored.clone()), median_of(number, &|again| again.tighter.clone())]
    });
    Conditioning {
        variant: variant.to_owned(),
        configuration: configuration.to_owned(),
        runs: group.len() as u64,
        other_outcome: count(&other),
        ill_conditioned: count(&|again| other(again) || moved(compared, again)),
        medians: medians.collect(),
    }
}

fn moved(compared: &Compared, again: &Again) -> bool {
    let pairs = again.stored.numbers.iter().zip(&again.tighter.numbers);
    let far = |(a, b): (&Option<f64>, &Option<f64>)| {
        a.zip(*b).is_some_and(|(a, b)| (a - b).abs() > MOVED_SHARE * b.abs())
    };
    again.stored.outcome == compared.usable
        && again.tighter.outcome == compared.usable
        && pairs.into_iter().any(far)
}

/// The tolerance of the runs again, over that of the study, unless another is given.
const TIGHTER: f64 = 1e-2;

/// Runs that are stored, by position in the plan, and the same at another tolerance, on the threads of the current pool.
///
/// `None` for a hundredth of the tolerance of each run.
pub fn run_again(
    plan: &Plan,
    stored: &BTreeMap<u64, Answer>,
    tolerance: Option<f64>,
    progress: &ProgressBar,
) -> Vec<Again> {
    let tighter = |wall: &Wall, shaking: &Shaking, accuracy: Accuracy| {
        let tolerance = tolerance.unwrap_or(TIGHTER * accuracy.tolerance);
        simulate(wall, shaking, Accuracy { tolerance })
    };
    let compared = Compared::of(plan.kind());
    let runs = run_all(plan, stored.keys().copied().collect(), &tighter, progress).into_iter();
    let again = runs.zip(stored.values()).map(|(finished, stored)| Again {
        variant: finished.run.variant.name.clone(),
        configuration: finished.run.configuration.name().to_owned(),
        stored: stored.clone(),
        tighter: compared.answer(&finished),
    });
    again.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::pipeline::Kind;

    fn again(stored: (&str, f64), tighter: (&str, f64)) -> Again {
        let answer = |(outcome, x): (&str, f64)| Answer {
            outcome: outcome.to_owned(),
            numbers: vec![Some(x), Some(2.0 * x)],
        };
        Again {
            variant: "base".into(),
            configuration: "parallel".into(),
            stored: answer(stored),
            tighter: answer(tighter),
        }
    }

    #[test]
    fn analytic_a_sample_has_one_run_of_each_stretch() {
        assert_eq!(sampled(5, 9, 1), [0, 1, 2, 3, 4]);
        let sample = sampled(1003, 10, 7);
        for (stretch, position) in sample.iter().enumerate() {
            let stretch = stretch as u64;
            assert!((stretch * 1003 / 10..(stretch + 1) * 1003 / 10).contains(position), "{sample:?}");
        }
        assert_ne!(sample, sampled(1003, 10, 8));
    }

    #[test]
    fn published_interval_of_wilson() {
        // Newcombe (1998), "Two-sided confidence intervals for the single proportion", Statist. Med. 17, Table I, method 3.
        let of = |ill_conditioned, runs| Conditioning {
            variant: String::new(),
            configuration: String::new(),
            runs,
            other_outcome: 0,
            ill_conditioned,
            medians: Vec::new(),
        };
        let [p, low, high] = of(81, 263).share().expect("runs");
        // The source prints four digits.
        assert!((p - 0.3080).abs() < 5e-5 && (low - 0.2553).abs() < 5e-5 && (high - 0.3662).abs() < 5e-5);
        assert_eq!(of(0, 0).share(), None);
    }

    #[test]
    fn regress_only_what_moves_is_ill_conditioned() {
        let compared = Compared::of(Kind::MonteCarlo);
        let sample = [
            again(("stood", 0.1), ("stood", 0.1)),
            again(("stood", 0.1), ("stood", 0.1005)),
            again(("stood", 0.1), ("stood", 0.2)),
            again(("stood", 0.1), ("collapsed", 2.0)),
            again(("collapsed", 2.0), ("collapsed", 2.1)),
            again(("failed", 0.0), ("failed", 0.0)),
        ];
        let found = conditioning(&compared, &sample).remove(0);
        assert_eq!((found.runs, found.other_outcome, found.ill_conditioned), (5, 1, 2));
        assert_eq!(found.medians[0], [Some(0.1), Some(0.2)]);
    }
}
