//! One hypothesis tried: where its fit starts, the fit, and tests that it has not seen.
//!
//! Fits are coarse at first; only some are worth fitting to the end.

use super::{Data, Few, FittedHypothesis};
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::hypothesis::Hypothesis;
use crate::limits::{BEGUN, FOLLOWING, LEAST_FINISHED, MOST_FINISHED, NEAR_BEST, STARTS_FROM};

/// Sizes tried for one added number, and for each of two, as shares of the size that matters.
pub struct Sizes {
    one: &'static [f64],
    each_of_two: &'static [f64],
}

/// Every size that may be the best start.
pub const SIZES: Sizes =
    Sizes { one: &[0.01, 0.03, 0.08, 0.2, 0.4, 0.8, 1.6], each_of_two: &[0.05, 0.1, 0.2, 0.4, 0.8, 1.6] };
/// Enough to see whether an addition would help.
const FEW_SIZES: Sizes = Sizes { one: &[0.05, 0.3], each_of_two: &[0.15, 0.6] };

/// Starts about `start`: itself, and the numbers from the `first` on, one, two, or more moved together, at several sizes; one,
/// or all together, of either sign.
pub fn ladder(h: &Hypothesis, start: &[f64], first: usize, sizes: &Sizes) -> Vec<Vec<f64>> {
    let moved = |values: &[f64], i: usize, by: f64| {
        let unknown = &h.unknowns[i];
        let mut values = values.to_vec();
        values[i] += by * unknown.scale;
        (unknown.lower..=unknown.upper).contains(&values[i]).then_some(values)
    };
    let mut starts = vec![start.to_vec()];
    match h.unknowns.len() - first {
        1 => {
            let shares = sizes.one.iter().flat_map(|share| [*share, -share]);
            starts.extend(shares.filter_map(|share| moved(start, first, share)));
        }
        2 => {
            let one = sizes.each_of_two.iter().filter_map(|share| moved(start, first, *share));
            let two = |values: Vec<f64>| {
                let of = |share: &f64| moved(&values, first + 1, *share);
                sizes.each_of_two.iter().filter_map(of).collect::<Vec<_>>()
            };
            starts.extend(one.flat_map(two));
        }
        0 => {}
        // Factors of impacts: all less, or more, than they were.
        _ => {
            let shares = sizes.one.iter().flat_map(|share| [*share, -share]);
            let all = |share: f64| {
                (first..h.unknowns.len()).try_fold(start.to_vec(), |values, i| moved(&values, i, share))
            };
            starts.extend(shares.filter_map(all));
        }
    }
    starts
}

/// Of two numbers or more, the best of several sizes of the last. A spring with too large a yield force does not feel
/// that force at all. Equal costs are one motion: it yields at neither force.
pub fn several(glances: Vec<Fit>) -> Vec<Fit> {
    let same = |a: &Fit, b: &Fit| a.values.last() == b.values.last() || a.cost == b.cost;
    let mut begun: Vec<Fit> = Vec::new();
    for glance in glances {
        if begun.len() < BEGUN && !begun.iter().any(|other| same(other, &glance)) {
            begun.push(glance);
        }
    }
    begun
}

/// Of one number, the best, and the best of those that do something. The states of windows were fitted without it.
/// They hold it where it does nothing, though it is there.
fn with_a_size(h: &Hypothesis, base: &[f64], number: usize, glances: Vec<Fit>) -> Vec<Fit> {
    let does = |glance: &Fit| {
        let size =
            glance.values.get(number).zip(base.get(number)).map_or(0.0, |(own, base)| (own - base).abs());
        h.unknowns.get(number).is_some_and(|unknown| size >= STARTS_FROM * unknown.scale)
    };
    let (doing, others): (Vec<_>, Vec<_>) = glances.into_iter().partition(does);
    let mut begun = others.into_iter().take(1).chain(doing.into_iter().take(1)).collect::<Vec<_>>();
    begun.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    begun
}

/// Most numbers of a second addition that a glance tells of.
const MOST_AT_A_GLANCE: usize = 2;

/// Fits a hypothesis coarsely from several starts: about its own values, and about those of each of `from`, where it
/// has them. `from` gives the states of the windows too.
///
/// `None` if no start makes a wall.
pub fn try_coarsely(
    data: &Data,
    hypothesis: Hypothesis,
    from: &[&FittedHypothesis],
) -> Option<FittedHypothesis> {
    let one = |from: &&FittedHypothesis| {
        let base = hypothesis.values_from(&from.hypothesis, &from.fit.values);
        let fit = best_coarse(data, &hypothesis, from, &base, hypothesis.nuisances)?;
        judged(data, hypothesis.clone(), fit, from, false)
    };
    let tried = from.iter().filter_map(one);
    tried.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost))
}

/// Fits to the end what was fitted coarsely.
pub fn finish(data: &Data, coarse: &FittedHypothesis) -> Option<FittedHypothesis> {
    let fit = data.fit.fit_finely(&coarse.hypothesis, coarse.fit.clone())?;
    judged(data, coarse.hypothesis.clone(), fit, coarse, true)
}

/// Fits a hypothesis from several starts to the end.
pub fn try_hypothesis(
    data: &Data,
    hypothesis: Hypothesis,
    from: &FittedHypothesis,
) -> Option<FittedHypothesis> {
    finish(data, &try_coarsely(data, hypothesis, &[from])?)
}

/// The best coarse fit from starts about `base` that move the numbers from the `first` on; to few windows where there are many, and the
/// states of all with its numbers.
fn best_coarse(
    data: &Data,
    h: &Hypothesis,
    from: &FittedHypothesis,
    base: &[f64],
    first: usize,
) -> Option<Fit> {
    let Some(few) = Few::of_coarse(data.fit, &from.fit) else {
        return best_coarse_in(data.fit, h, &from.hypothesis, &from.fit, base, first);
    };
    let found = best_coarse_in(few.problem(), h, &from.hypothesis, &few.of(from).fit, base, first)?;
    let all = data.fit.states_of_coarse(h, &found.values, &states_of(&from.fit))?;
    Some(Fit { covariance: found.covariance, ..all })
}

/// The same in windows as they are, which a fit of another hypothesis follows; starts are compared at a glance.
fn best_coarse_in(
    problem: Problem,
    h: &Hypothesis,
    other: &Hypothesis,
    from: &Fit,
    base: &[f64],
    first: usize,
) -> Option<Fit> {
    let mut glances = glances(problem, h, other, from, &ladder(h, base, first, &SIZES))?;
    glances.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let begun =
        if h.unknowns.len() - first >= 2 { several(glances) } else { with_a_size(h, base, first, glances) };
    let fits = begun.into_iter().filter_map(|start| problem.fit_coarsely(h, start));
    fits.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// The states of another hypothesis, looked at with values of this one.
fn glances(
    problem: Problem,
    h: &Hypothesis,
    other: &Hypothesis,
    from: &Fit,
    starts: &[Vec<f64>],
) -> Option<Vec<Fit>> {
    let chords = problem.chords(other, from)?;
    Some(starts.iter().filter_map(|values| problem.glance(h, values, from, &chords)).collect())
}

/// A fit with the tests held out beside it, of which the states alone are fitted. They start from those of another
/// hypothesis, which may be far from the truth. Where the fit is thorough they start from the measured ones too.
pub fn judged(
    data: &Data,
    hypothesis: Hypothesis,
    fit: Fit,
    from: &FittedHypothesis,
    thorough: bool,
) -> Option<FittedHypothesis> {
    let states = |x: &[Vec<f64>]| data.held_out.states(&hypothesis, &fit.values, x, 3, thorough);
    let mut held_out = states(&states_of(&from.held_out))?;
    if thorough {
        held_out.take_better(states(&data.held_out.measured_states())?);
    }
    Some(FittedHypothesis { hypothesis, fit, held_out })
}

/// A fit with the tests held out beside it, whose states start from the measured ones.
pub fn judged_from_measured(data: &Data, hypothesis: Hypothesis, fit: Fit) -> Option<FittedHypothesis> {
    from_measured(data, hypothesis, fit, false)
}

/// The same, with other valleys of windows held out that stay poor.
pub fn judged_thoroughly(data: &Data, hypothesis: Hypothesis, fit: Fit) -> Option<FittedHypothesis> {
    from_measured(data, hypothesis, fit, true)
}

fn from_measured(data: &Data, hypothesis: Hypothesis, fit: Fit, thorough: bool) -> Option<FittedHypothesis> {
    let measured = data.held_out.measured_states();
    let held_out = data.held_out.states(&hypothesis, &fit.values, &measured, 3, thorough)?;
    Some(FittedHypothesis { hypothesis, fit, held_out })
}

/// The model as it is, with nothing to find but the states.
pub fn untouched(data: &Data, hypothesis: Hypothesis) -> Option<FittedHypothesis> {
    let fit = data.fit.states(&hypothesis, &[], &data.fit.measured_states(), 4, true)?;
    let held_out = data.held_out.states(&hypothesis, &[], &data.held_out.measured_states(), 4, true)?;
    Some(FittedHypothesis { hypothesis, fit, held_out })
}

/// A hypothesis with given values: the states alone are fitted. `None` if they make no wall.
pub fn with_values(
    data: &Data,
    hypothesis: Hypothesis,
    from: &FittedHypothesis,
    values: &[f64],
) -> Option<FittedHypothesis> {
    let fit = data.fit.states(&hypothesis, values, &states_of(&from.fit), 3, true)?;
    judged(data, hypothesis, fit, from, true)
}

pub fn states_of(fit: &Fit) -> Vec<Vec<f64>> {
    fit.windows.iter().map(|w| w.x.clone()).collect()
}

/// Fits to the end from given values.
pub fn refit(
    data: &Data,
    hypothesis: Hypothesis,
    from: &FittedHypothesis,
    values: &[f64],
) -> Option<FittedHypothesis> {
    let start = data.fit.states_to_begin(&hypothesis, values, &states_of(&from.fit), 2)?;
    let fit = data.fit.fit_finely(&hypothesis, start)?;
    judged(data, hypothesis, fit, from, true)
}

/// A few steps from given values: enough to tell where such a fit would go.
pub fn first_steps(
    data: &Data,
    hypothesis: &Hypothesis,
    from: &FittedHypothesis,
    values: &[f64],
) -> Option<Fit> {
    let start = data.fit.states_to_begin(hypothesis, values, &states_of(&from.fit), 2)?;
    Some(data.fit.step_first(hypothesis, start))
}

/// A fit to the end from one that was begun.
pub fn finish_begun(
    data: &Data,
    hypothesis: Hypothesis,
    begun: Fit,
    from: &FittedHypothesis,
) -> Option<FittedHypothesis> {
    let fit = data.fit.fit_finely(&hypothesis, begun)?;
    judged(data, hypothesis, fit, from, true)
}

/// What a second addition beside one that was fitted promises at a glance, in the loss of starts; `None` where only a fit
/// would tell.
pub fn promise(data: &Data, hypothesis: &Hypothesis, first: &FittedHypothesis) -> Option<f64> {
    let (base, second) = beside(hypothesis, first);
    if hypothesis.unknowns.len() - second > MOST_AT_A_GLANCE {
        return None;
    }
    let starts = ladder(hypothesis, &base, second, &FEW_SIZES);
    glances(data.fit, hypothesis, &first.hypothesis, &first.fit, &starts)?
        .iter()
        .map(|fit| fit.cost)
        .min_by(f64::total_cmp)
}

/// Fits a second addition beside one that was fitted, coarsely, from its values.
pub fn try_second(
    data: &Data,
    hypothesis: Hypothesis,
    first: &FittedHypothesis,
    from: &FittedHypothesis,
) -> Option<FittedHypothesis> {
    let (base, second) = beside(&hypothesis, first);
    let fit = best_coarse(data, &hypothesis, first, &base, second)?;
    judged(data, hypothesis, fit, from, false)
}

/// Values of a pair at which the second addition does nothing, and where its numbers begin.
fn beside(hypothesis: &Hypothesis, first: &FittedHypothesis) -> (Vec<f64>, usize) {
    let mut base = hypothesis.start();
    // The first addition's numbers follow those of the wall; fewer of the wall's may have a prior beside the second.
    let added = &first.fit.values[first.hypothesis.nuisances..];
    let second = hypothesis.nuisances + added.len();
    base[hypothesis.nuisances..second].copy_from_slice(added);
    (base, second)
}

/// The same values with each window's state refitted from those that other hypotheses found, where that is better.
///
/// A window near an impact decided by less than the noise has several local minima. No hypothesis must win by having
/// found one that the others missed.
pub fn shared_states(
    data: &Data,
    tried: &FittedHypothesis,
    others: &[&FittedHypothesis],
) -> FittedHypothesis {
    let mut best = tried.clone();
    for other in others {
        data.fit.borrow_states(&tried.hypothesis, &mut best.fit, &other.fit);
        data.held_out.borrow_states(&tried.hypothesis, &mut best.held_out, &other.held_out);
    }
    best
}

/// A hypothesis fitted coarsely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coarse {
    /// What speaks against it, in natural logarithms of likelihood.
    pub against: f64,
    /// Its windowed error, in standard deviations of the noise.
    pub error: f64,
}

/// Which of coarse fits, in the order of what speaks against them, are worth finishing. These are the first, the two
/// that follow the windows best, and all that follow them as well.
pub fn worth_finishing(coarse: &[Coarse]) -> Vec<usize> {
    let Some(best) = coarse.first() else { return Vec::new() };
    let near = coarse.iter().filter(|c| c.against < best.against + NEAR_BEST).count();
    let near = near.clamp(LEAST_FINISHED, MOST_FINISHED).min(coarse.len());
    let mut errors = coarse.iter().map(|c| c.error).collect::<Vec<_>>();
    errors.sort_by(f64::total_cmp);
    let limit = errors[FOLLOWING.min(errors.len()) - 1];
    let others = (near..coarse.len()).filter(|i| coarse[*i].error <= limit);
    (0..near).chain(others).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypothesis::Unknown;

    fn glances(of: &[(f64, f64)]) -> Vec<Fit> {
        let one = |&(value, cost): &(f64, f64)| Fit {
            values: vec![value],
            windows: Vec::new(),
            cost,
            covariance: None,
        };
        of.iter().map(one).collect()
    }

    /// A wall with vertical motion, whose ratio of 1 matters.
    fn shaken_upwards() -> Hypothesis {
        crate::diagnose::hypothesis::example::starter_with(&["vertical_ground_motion"])
    }

    #[test]
    fn analytic_one_number_starts_where_it_does_something_too() {
        let h = shaken_upwards();
        let [Unknown { scale, .. }] = &h.unknowns[..] else { panic!("one number") };
        assert_eq!(*scale, 1.0);
        let values = |begun: &[Fit]| begun.iter().map(|fit| fit.values[0]).collect::<Vec<_>>();
        let near = glances(&[(0.0, 1.0), (-0.01, 2.0), (-0.08, 3.0), (0.2, 4.0)]);
        assert_eq!(values(&with_a_size(&h, &[0.0], 0, near)), [0.0, -0.08]);
        // The better of the two comes first; about another value the same shares count.
        let far = glances(&[(0.4, 1.0), (0.2, 2.0), (0.39, 3.0)]);
        assert_eq!(values(&with_a_size(&h, &[0.4], 0, far)), [0.4, 0.2]);
        assert_eq!(values(&with_a_size(&h, &[0.0], 0, glances(&[(0.4, 1.0), (0.0, 2.0)]))), [0.4, 0.0]);
        // Nothing is added: the only start.
        assert_eq!(values(&with_a_size(&h, &[0.0], 1, glances(&[(0.4, 1.0)]))), [0.4]);
    }

    #[test]
    fn analytic_of_two_numbers_several_sizes_of_the_last_are_begun() {
        let of = |(one, two, cost): (f64, f64, f64)| Fit {
            values: vec![one, two],
            windows: Vec::new(),
            cost,
            covariance: None,
        };
        let all = [
            (1.0, 1.0, 1.0),
            (2.0, 1.0, 2.0),
            (1.0, 2.0, 3.0),
            (1.0, 3.0, 3.0),
            (1.0, 4.0, 4.0),
            (1.0, 5.0, 5.0),
        ];
        let begun = several(all.map(of).to_vec());
        // The second has the size of the first, and the fourth moves as the third does.
        let sizes = begun.iter().map(|fit| fit.values[1]).collect::<Vec<_>>();
        assert_eq!(sizes, [1.0, 2.0, 4.0]);
    }

    /// Fits a number of logarithms apart, each followed worse than the one before.
    fn apart(step: f64) -> Vec<Coarse> {
        let fit = |i| Coarse { against: step * f64::from(i), error: 2.0 + 0.1 * f64::from(i) };
        (0..20).map(fit).collect()
    }

    #[test]
    fn analytic_the_best_are_finished_and_those_near_them() {
        assert!(worth_finishing(&[]).is_empty());
        assert_eq!(worth_finishing(&apart(1.0)[..3]), [0, 1, 2]);
        assert_eq!(worth_finishing(&apart(500.0)), (0..6).collect::<Vec<_>>());
        // 0, 12, ... 96 lie within 100 of the best.
        assert_eq!(worth_finishing(&apart(12.0)), (0..9).collect::<Vec<_>>());
        assert_eq!(worth_finishing(&apart(1.0)), (0..12).collect::<Vec<_>>());
    }

    #[test]
    fn analytic_what_follows_the_windows_best_is_finished_however_likely() {
        let mut coarse = apart(500.0);
        (coarse[11].error, coarse[17].error) = (1.9, 1.5);
        assert_eq!(worth_finishing(&coarse), [0, 1, 2, 3, 4, 5, 11, 17]);
        // Of three only two.
        coarse[8].error = 1.7;
        assert_eq!(worth_finishing(&coarse), [0, 1, 2, 3, 4, 5, 8, 17]);
    }
}
