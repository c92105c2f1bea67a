//! How sure a quantile over drawn façades is: façades and records drawn anew many times.
//!
//! A draw takes as many façades and as many records as the study has, with replacement; a run counts as often as its façade
//! was drawn times as often as its record (Owen 2007, "The pigeonhole bootstrap", Ann. Appl. Stat. 1(2)). Of one
//! record the façades alone are drawn. A draw depends on its number alone, so that threads and machines change nothing.

use std::cmp::Ordering;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::draws::{DRAWS, FEWEST_RECORDS, interval, rng_of};
use super::quantile::LEVELS;
use super::resampled::Interval;

/// Runs that are looked at for the intervals of a group at most: a study has dozens of groups, and a million runs are not
/// to wait longer for intervals than for themselves.
const MOST_LOOKS: usize = 10_000_000;

/// Draws that go through the runs together, in vector lanes.
const TOGETHER: usize = 8;

/// Draws are kept for the next group of runs up to this: two hundred of a record's part of a million runs.
const MOST_KEPT_BYTES: usize = 16_000_000;

/// How many runs are before one is noted of so many of them at most: of each of a million would take more memory than the runs do.
const MOST_MARKS: usize = 1 << 16;

/// The quantiles of a quantity in each of the draws that go together; `None` where all weigh nothing.
type Quantiles = [Option<[Option<f64>; 7]>; TOGETHER];

/// How often a record or a façade is drawn in each of these draws. As many are drawn as there are: that one of more than 255 comes more
/// than 255 times has a chance of 10⁻⁵⁰⁰.
type Times = [u8; TOGETHER];

/// A count of runs in each of these draws. All of a draw are about as many as its runs, of which no memory holds four thousand million.
type Counts = [u32; TOGETHER];

/// Of a million runs fewer draws are made, but never fewer than these: the quantile at 5 % is then the tenth of them.
const FEWEST_DRAWS: u64 = 200;

/// A run: its value, infinite where it lies above all numbers; its record and its façade by number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawn {
    pub value: f64,
    pub record: u32,
    pub facade: u32,
}

/// How often records and façades count in draws that go together.
struct Together {
    of_records: Vec<Times>,
    of_facades: Vec<Times>,
}

impl Together {
    /// The `k`-th of them, of so many records and façades.
    fn drawn([records, facades]: [usize; 2], k: usize) -> Self {
        let first = (k * TOGETHER) as u64;
        let mut rngs: [ChaCha8Rng; TOGETHER] = std::array::from_fn(|i| rng_of(first + i as u64));
        let of_records = times_together(records, &mut rngs);
        Self { of_records, of_facades: times_together(facades, &mut rngs) }
    }
}

/// Draws of so many records and façades, for one group of runs after another that has as many.
#[derive(Default)]
pub(super) struct Kept {
    of: [usize; 2],
    together: Vec<Together>,
}

impl Kept {
    /// Keeps so many draws of these, where there is room for them.
    fn keep(&mut self, of: [usize; 2], draws: usize) {
        let fit = draws * of.iter().sum::<usize>() * size_of::<Times>() / TOGETHER <= MOST_KEPT_BYTES;
        if self.of != of || !fit {
            *self = Self { of, together: Vec::new() };
        }
        if fit {
            let more = self.together.len()..draws.div_ceil(TOGETHER);
            self.together.par_extend(more.into_par_iter().map(|k| Together::drawn(of, k)));
        }
    }
}

/// Intervals of the quantiles at [`LEVELS`] of several quantities of the same runs, under so many records.
///
/// A draw takes the same façades and records for all quantities.
pub(super) fn intervals(
    mut quantities: Vec<Vec<Drawn>>,
    records: usize,
    kept: &mut Kept,
) -> Vec<[Option<Interval>; 7]> {
    // What is no number stands at the end.
    quantities.par_iter_mut().for_each(|runs| runs.sort_unstable_by(|a, b| a.value.total_cmp(&b.value)));
    let facades = quantities.iter().flatten().map(|run| run.facade as usize + 1).max().unwrap_or(0);
    let few_records = records > 1 && records < FEWEST_RECORDS;
    if facades < FEWEST_RECORDS || few_records {
        return vec![[None; 7]; quantities.len()];
    }
    let most = quantities.iter().map(Vec::len).max().unwrap_or(0);
    let draws = ((MOST_LOOKS / most) as u64).clamp(FEWEST_DRAWS, DRAWS) as usize;
    let of = [records, facades];
    kept.keep(of, draws);
    let quantiles = |up_to: &mut Vec<Counts>, k: usize| match kept.together.get(k) {
        Some(together) => together.quantiles(&quantities, up_to),
        None => Together::drawn(of, k).quantiles(&quantities, up_to),
    };
    let drawn: Vec<_> = (0..draws.div_ceil(TOGETHER)).into_par_iter().map_init(Vec::new, quantiles).collect();
    let of = |quantity: usize| {
        let all = drawn.iter().flat_map(|together| together[quantity]).take(draws);
        let at = |level: usize| all.clone().filter_map(move |one| Some(one?[level]));
        std::array::from_fn(|level| interval(at(level), by_size))
    };
    (0..quantities.len()).into_par_iter().map(of).collect()
}

impl Together {
    /// The quantiles of every quantity in every draw. `up_to` is room for them.
    fn quantiles(&self, quantities: &[Vec<Drawn>], up_to: &mut Vec<Counts>) -> Vec<Quantiles> {
        // A plain loop goes in vector lanes; an array made by a function of its index did not.
        let weigh = |run: &Drawn, all: &mut Counts| {
            let (record, facade) =
                (&self.of_records[run.record as usize], &self.of_facades[run.facade as usize]);
            for i in 0..TOGETHER {
                all[i] += u32::from(record[i]) * u32::from(facade[i]);
            }
        };
        quantities.iter().map(|runs| weighted(runs, weigh, up_to)).collect()
    }
}

/// How often each of some is drawn in as many draws.
pub(super) fn counts(of: usize, rng: &mut ChaCha8Rng) -> Vec<u64> {
    let mut counts = vec![0; of];
    (0..of).for_each(|_| counts[rng.random_range(0..of)] += 1);
    counts
}

/// The same in draws that go together.
fn times_together(of: usize, rngs: &mut [ChaCha8Rng; TOGETHER]) -> Vec<Times> {
    let mut times = vec![Times::default(); of];
    for (i, rng) in rngs.iter_mut().enumerate() {
        for _ in 0..of {
            let drawn = &mut times[rng.random_range(0..of)][i];
            *drawn = drawn.saturating_add(1);
        }
    }
    times
}

/// The quantiles of runs in increasing order, each as often as `weigh` adds it to what all are so far, in every draw; `None` where all weigh
/// nothing.
/// `up_to` is room for how many they are before some of the runs.
///
/// They are those of [`super::quantiles`] of the runs repeated.
fn weighted(runs: &[Drawn], weigh: impl Fn(&Drawn, &mut Counts), up_to: &mut Vec<Counts>) -> Quantiles {
    let each = runs.len().div_ceil(MOST_MARKS).max(1);
    up_to.clear();
    let mut all = [0; TOGETHER];
    up_to.extend(runs.chunks(each).map(|some| {
        let before = all;
        some.iter().for_each(|run| weigh(run, &mut all));
        before
    }));
    let value = |draw: usize, rank: u32| {
        let mark = up_to.partition_point(|before| before[draw] <= rank) - 1;
        let mut counts = up_to[mark];
        let reached = |run: &&Drawn| {
            weigh(run, &mut counts);
            counts[draw] > rank
        };
        let run = runs[mark * each..].iter().find(reached);
        run.map(|run| run.value).filter(|value| value.is_finite())
    };
    std::array::from_fn(|draw| Some(levels(|rank| value(draw, rank), all[draw].checked_sub(1)?)))
}

/// The quantiles of one draw by the values at its ranks, of which this is the last.
fn levels(statistic: impl Fn(u32) -> Option<f64>, last: u32) -> [Option<f64>; 7] {
    LEVELS.map(|level| {
        let rank = level * f64::from(last);
        let (lower, beyond) = (rank as u32, rank.fract());
        // Without a share of it the next value need not be a number.
        if beyond == 0.0 {
            return statistic(lower);
        }
        let (a, b) = (statistic(lower)?, statistic(lower + 1)?);
        Some(a + beyond * (b - a))
    })
}

/// What is no number lies above all.
fn by_size(a: &Option<f64>, b: &Option<f64>) -> Ordering {
    match (a, b) {
        (Some(a), Some(b)) => a.total_cmp(b),
        (a, b) => a.is_none().cmp(&b.is_none()),
    }
}

#[cfg(test)]
mod tests {
    use rand_distr::{Distribution, StandardNormal};

    use super::super::quantile::{MEDIAN, quantiles};
    use rand::SeedableRng;

    use super::*;

    /// Façades × records of values.
    fn runs(facades: u32, records: u32, value: impl Fn(u32, u32) -> Option<f64>) -> Vec<Drawn> {
        let of = |facade| (0..records).map(move |record| (facade, record));
        let above = f64::INFINITY;
        let run = |(facade, record)| Drawn { value: value(facade, record).unwrap_or(above), record, facade };
        (0..facades).flat_map(of).map(run).collect()
    }

    #[test]
    fn analytic_weights_are_repetitions() {
        for beyond in [0, 2, 5] {
            let runs: Vec<Drawn> =
                runs(9, 1, |facade, _| (facade < 9 - beyond).then(|| f64::from(facade * facade)));
            let weights: [u32; 9] = [2, 0, 1, 3, 0, 1, 2, 4, 1];
            let repeated = runs.iter().flat_map(|run| {
                vec![Some(run.value).filter(|x| x.is_finite()); weights[run.facade as usize] as usize]
            });
            let repeated: Vec<Option<f64>> = repeated.collect();
            let standing: Vec<f64> = repeated.iter().flatten().copied().collect();
            let expected = quantiles(&standing, repeated.len() - standing.len());
            // The second draw of those that go together; the others weigh nothing.
            let weigh = |run: &Drawn, all: &mut Counts| all[1] += weights[run.facade as usize];
            let all = weighted(&runs, weigh, &mut Vec::new());
            let found = all[1].expect("weights");
            for (found, expected) in found.iter().zip(expected) {
                // A sum and a product of numbers up to 100 may round otherwise.
                let near = found.zip(expected).is_some_and(|(a, b)| (a - b).abs() < 1e-12);
                assert!(near || (found.is_none() && expected.is_none()), "{found:?} for {expected:?}");
            }
        }
        let nothing = weighted(&runs(3, 1, |_, _| Some(1.0)), |_, _| (), &mut Vec::new());
        assert_eq!(nothing, [None; TOGETHER]);
    }

    #[test]
    fn analytic_marks_that_are_far_apart_lead_to_the_same_runs() {
        let facades = 3 * MOST_MARKS as u32;
        let runs = runs(facades, 1, |facade, _| Some(f64::from(facade)));
        let times = |run: &Drawn| run.facade * 7 % 5;
        let repeated: Vec<f64> = runs.iter().flat_map(|run| vec![run.value; times(run) as usize]).collect();
        let weigh = |run: &Drawn, all: &mut Counts| all[3] += times(run);
        let found = weighted(&runs, weigh, &mut Vec::new())[3].expect("weights");
        assert_eq!(found, quantiles(&repeated, 0));
    }

    fn of_one(runs: Vec<Drawn>, records: usize) -> [Option<Interval>; 7] {
        intervals(vec![runs], records, &mut Kept::default())[0]
    }

    #[test]
    fn analytic_quantities_side_by_side_are_as_alone() {
        let root = |facade: u32, record: u32| Some(f64::from(facade * record).sqrt());
        let fall = |facade: u32, record: u32| (facade + record < 12).then(|| f64::from(facade));
        let both = [runs(8, 7, root), runs(8, 7, fall)];
        let alone = both.clone().map(|runs| of_one(runs, 7));
        assert_eq!(intervals(both.to_vec(), 7, &mut Kept::default()), alone);
    }

    #[test]
    fn analytic_draws_that_are_kept_are_those_drawn_anew() {
        let square = |facade: u32, record: u32| Some(f64::from(facade).powi(2) + f64::from(record));
        let mut kept = Kept::default();
        // Of few runs all draws are made, of many fewer.
        for (facades, records) in [(8, 7), (8, 7), (9, 7), (9, 1), (3000, 7), (3000, 7), (100_000, 1)] {
            let runs = vec![runs(facades, records, square)];
            let anew = intervals(runs.clone(), records as usize, &mut Kept::default());
            assert_eq!(intervals(runs, records as usize, &mut kept), anew, "{facades} under {records}");
            assert_eq!(kept.together.is_empty(), facades > 80_000, "{facades} under {records}");
        }
    }

    #[test]
    fn analytic_runs_that_agree_leave_no_doubt_and_collapses_no_number() {
        assert_eq!(of_one(runs(8, 7, |_, _| Some(0.2)), 7), [Some([Some(0.2); 2]); 7]);
        assert_eq!(of_one(runs(8, 7, |_, _| None), 7), [Some([None; 2]); 7]);
        let half = of_one(runs(8, 7, |facade, _| (facade % 2 == 0).then_some(0.2)), 7);
        assert_eq!(half[MEDIAN], Some([Some(0.2), None]), "four of eight façades fall");
        assert_eq!(of_one(runs(8, 4, |_, _| Some(0.2)), 4), [None; 7], "four records are too few");
        assert_eq!(of_one(runs(4, 7, |_, _| Some(0.2)), 7), [None; 7], "so are four façades");
        assert_eq!(of_one(runs(8, 1, |_, _| Some(0.2)), 1)[0], Some([Some(0.2); 2]), "one is all there is");
    }

    #[test]
    fn analytic_intervals_hold_the_median_of_a_sum_of_facades_and_records() {
        let (mut hold, studies) = (0, 100);
        for seed in 0..studies {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut normal =
                |count: u32| -> Vec<f64> { (0..count).map(|_| StandardNormal.sample(&mut rng)).collect() };
            let (of_facades, of_records) = (normal(30), normal(12));
            let runs = runs(30, 12, |facade, record| {
                Some(of_facades[facade as usize] + of_records[record as usize])
            });
            let [low, high] = of_one(runs, 12)[MEDIAN].expect("enough").map(|end| end.expect("a number"));
            hold += u32::from(low <= 0.0 && 0.0 <= high);
        }
        // 90 of 100, and three standard deviations of 3; a median of twelve records is held a little too seldom or often.
        assert!((81..=99).contains(&hold), "{hold} of {studies}");
    }
}
