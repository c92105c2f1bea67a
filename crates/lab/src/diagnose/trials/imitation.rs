//! Effects, or pairs of them, that may do what the best hypothesis does, and their fits from there.
//!
//! One effect can stand for another, and a fit of the other that started elsewhere may have ended too early. Two effects
//! together can stand for two others. A narrower joint read with a gain is an example. It moves much like the same wall
//! under a weaker record with a carriage at its top. No single effect points at such a pair, so a search from single
//! effects may miss it. How the windows change with a little of every effect is cheap to find. What any other can make of
//! the change that the best made is then a small least-squares problem.

use super::search::{refit, shared_states};
use super::{Data, FittedHypothesis, Trials, against, closes, kinds};
use crate::Progress;
use crate::diagnose::fit::{Fit, Loss};
use crate::diagnose::hypothesis::{Addition, Hypothesis, candidates};
use crate::limits::{IMITATING_PAIRS, IMITATING_SINGLES, NEAR_BEST, SHARING_STATES};
use mrbd_kernel::model::Role;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// As many effects as the best has, and the values at which they come nearest.
#[derive(Debug, Clone)]
pub struct Imitation {
    /// The effects.
    pub additions: Vec<Addition>,
    /// Values of their numbers.
    pub values: Vec<f64>,
    /// Squared residuals that they leave, in squared noise, as far as a linear look tells.
    pub left: f64,
}

/// Every one of `candidates`, or every pair where the best is a pair, each with one number. The nearest to the best
/// is first. `None` where its neighbourhood is no wall.
///
/// `hypothesis` makes one of additions.
fn imitations(
    data: &Data,
    best: &FittedHypothesis,
    candidates: &[Addition],
    hypothesis: impl Fn(&[Addition]) -> Hypothesis,
) -> Option<Vec<Imitation>> {
    let own = &best.hypothesis.additions;
    let others = candidates.iter().filter(|c| !own.contains(c));
    let (h, sums) = with_others(data, best, others, hypothesis)?;
    // Undoing the best is what another must make good.
    let values = best.fit.values.iter().enumerate().skip(h.nuisances);
    let undone = values.map(|(i, value)| (i, h.unknowns[i].start - value)).collect::<Vec<_>>();
    let numbers = single_numbers(&h);
    let sets: Vec<Vec<[usize; 2]>> = match own.len() {
        1 => numbers.iter().filter(|[index, _]| *index > 0).map(|one| vec![*one]).collect(),
        _ => {
            let pairs = numbers.iter().enumerate();
            pairs.flat_map(|(n, one)| numbers[n + 1..].iter().map(|two| vec![*one, *two])).collect()
        }
    };
    let mut found = sets.iter().filter_map(|set| imitation(&h, &sums, &undone, set)).collect::<Vec<_>>();
    found.sort_by(|a, b| a.left.total_cmp(&b.left));
    Some(found)
}

/// Every one of `candidates` of one number beside the best, with values of all added numbers. The one that takes away
/// most is first. `None` where its neighbourhood is no wall.
pub fn seconds(
    data: &Data,
    best: &FittedHypothesis,
    candidates: &[Addition],
    hypothesis: impl Fn(&[Addition]) -> Hypothesis,
) -> Option<Vec<Imitation>> {
    let own = &best.hypothesis.additions;
    let others = candidates.iter().filter(|c| own.iter().all(|own| own.stands_beside(c)));
    let (h, sums) = with_others(data, best, others, hypothesis)?;
    let beside = |[index, number]: &[usize; 2]| {
        let (left, steps) = sums.left(best.fit.values.len(), &[], &[*number])?;
        let unknown = &h.unknowns[*number];
        let value = unknown.start + steps[0];
        let additions = own.iter().copied().chain([h.additions[*index]]).collect();
        let values = best.fit.values[h.nuisances..].iter().copied().chain([value]).collect();
        let within = (unknown.lower..=unknown.upper).contains(&value);
        within.then_some(Imitation { additions, values, left })
    };
    let numbers = single_numbers(&h);
    let mut found =
        numbers.iter().filter(|[index, _]| *index >= own.len()).filter_map(beside).collect::<Vec<_>>();
    found.sort_by(|a, b| a.left.total_cmp(&b.left));
    Some(found)
}

/// What a number that does nothing where it stands takes away of what a fit leaves, in squared noise as far as a linear look tells, the
/// numbers before it free beside it; and where it goes. `None` where it leaves no trace.
pub fn taken_by(data: &Data, h: &Hypothesis, at: &Fit, number: usize) -> Option<(f64, f64)> {
    let sums = Sums::at(data, h, at.clone())?;
    // The numbers before it would be moved without it, too.
    let (without, _) = sums.left(number, &[], &[])?;
    let (left, steps) = sums.left(number, &[], &[number])?;
    Some((without - left, at.values[number] + steps[0]))
}

/// The best with a little of all the others, linear about it.
fn with_others<'a>(
    data: &Data,
    best: &'a FittedHypothesis,
    others: impl Iterator<Item = &'a Addition>,
    hypothesis: impl Fn(&[Addition]) -> Hypothesis,
) -> Option<(Hypothesis, Sums)> {
    let h = hypothesis(&best.hypothesis.additions.iter().chain(others).copied().collect::<Vec<_>>());
    let sums = Sums::about(data, &h, best)?;
    Some((h, sums))
}

/// Additions of one number, by their index, with the index of that number.
fn single_numbers(h: &Hypothesis) -> Vec<[usize; 2]> {
    let number = |index: usize| {
        let mut numbers = (0..h.unknowns.len()).filter(|i| h.unknowns[*i].belongs_to(index));
        let first = numbers.next()?;
        numbers.next().is_none().then_some([index, first])
    };
    (0..h.additions.len()).filter_map(number).collect()
}

/// What additions make of it; `None` for two of a kind at one place, for values outside their bounds, and where they leave
/// no trace.
fn imitation(h: &Hypothesis, sums: &Sums, undone: &[(usize, f64)], set: &[[usize; 2]]) -> Option<Imitation> {
    let additions = set.iter().map(|[index, _]| h.additions[*index]).collect::<Vec<_>>();
    let numbers = set.iter().map(|[_, number]| *number).collect::<Vec<_>>();
    if additions.len() == 2 && !additions[0].stands_beside(&additions[1]) {
        return None;
    }
    let (left, steps) = sums.left(h.nuisances, undone, &numbers)?;
    let unknowns = || numbers.iter().map(|number| &h.unknowns[*number]);
    let values = unknowns().zip(&steps).map(|(unknown, step)| unknown.start + step).collect::<Vec<_>>();
    let mut within = unknowns().zip(&values).map(|(unknown, v)| (unknown.lower..=unknown.upper).contains(v));
    within.all(|holds| holds).then_some(Imitation { additions, values, left })
}

/// Sums over windows, weighted as in the fit: rᵀr, Jᵀr and JᵀJ.
struct Sums {
    rr: f64,
    jr: DVector<f64>,
    jj: DMatrix<f64>,
}

impl Sums {
    /// Of a hypothesis that begins with the numbers of another, about where that is and with nothing more.
    fn about(data: &Data, h: &Hypothesis, best: &FittedHypothesis) -> Option<Self> {
        let values = h.values_from(&best.hypothesis, &best.fit.values);
        Self::at(data, h, Fit { values, windows: best.fit.windows.clone(), cost: 0.0, covariance: None })
    }

    /// Of a hypothesis about a fit.
    fn at(data: &Data, h: &Hypothesis, at: Fit) -> Option<Self> {
        let (slopes, _) = data.fit.slopes(h, &at, None)?;
        let count = h.unknowns.len();
        let mut sums = Self { rr: 0.0, jr: DVector::zeros(count), jj: DMatrix::zeros(count, count) };
        for (window, slopes) in at.windows.iter().zip(slopes) {
            let weight = Loss::Likelihood.weight(window);
            sums.rr += weight * slopes.residual.norm_squared();
            sums.jr += slopes.by_values.transpose() * &slopes.residual * weight;
            sums.jj += slopes.by_values.transpose() * &slopes.by_values * weight;
        }
        sums.rr += h.prior_penalty(&at.values);
        h.add_prior(&at.values, &mut sums.jj, &mut sums.jr);
        Some(sums)
    }

    /// What is left where some numbers are moved by given amounts and others are free, and where these go. Free are
    /// the first `own` numbers and some more. `None` where these leave no trace.
    fn left(&self, own: usize, moved: &[(usize, f64)], more: &[usize]) -> Option<(f64, Vec<f64>)> {
        let mut step = DVector::zeros(self.jr.len());
        moved.iter().for_each(|(i, by)| step[*i] = *by);
        let gradient = &self.jr + &self.jj * &step;
        let fixed = self.rr + 2.0 * self.jr.dot(&step) + step.dot(&(&self.jj * &step));
        let traced = |i: &usize| self.jj[(*i, *i)] > 0.0;
        if !more.iter().all(traced) {
            return None;
        }
        let own = (0..own).filter(traced).collect::<Vec<_>>();
        let free = own.iter().chain(more).copied().collect::<Vec<_>>();
        let scale = free.iter().map(|i| self.jj[(*i, *i)].sqrt()).collect::<Vec<_>>();
        let count = free.len();
        // Columns of length one: two that are each other's double must not stop the solution.
        let a = DMatrix::from_fn(count, count, |m, n| {
            self.jj[(free[m], free[n])] / (scale[m] * scale[n]) + if m == n { 1e-9 } else { 0.0 }
        });
        let g = DVector::from_fn(count, |m, _| gradient[free[m]] / scale[m]);
        let x = -a.cholesky()?.solve(&g);
        Some((fixed + g.dot(&x), (own.len()..count).map(|m| x[m] / scale[m]).collect()))
    }
}

impl<P: Progress> Trials<'_, P> {
    /// Single effects or pairs; where the best closes the gap, with the candidates that could imitate it.
    pub fn with_imitations(&self, tried: Vec<FittedHypothesis>, gap: f64) -> Vec<FittedHypothesis> {
        let Some(best) = tried.first().filter(|t| closes(t, gap) && kinds(t).is_some()) else { return tried };
        let nuisances = &self.experiment.nuisances;
        let candidates = candidates(self.experiment.wall.parameters());
        // Factors on the coefficients of impact would free these of what was known of them.
        let effect = |a: &Addition| a.role().is_some_and(|role| role != Role::Impact);
        let effects = candidates.into_iter().filter(effect).collect::<Vec<_>>();
        let hypothesis = |additions: &[Addition]| self.hypothesis(nuisances, additions);
        let Some(imitations) = imitations(&self.data, best, &effects, hypothesis) else { return tried };
        // A pair that was fitted set out from its better effect; of the others nothing is known.
        let one = best.hypothesis.additions.len() == 1;
        let fitted_before = |i: &Imitation| {
            tried.iter().any(|t| i.additions.iter().all(|a| t.hypothesis.additions.contains(a)))
        };
        let new = imitations.into_iter().filter(|i| one || !fitted_before(i));
        let new = new.take(if one { IMITATING_SINGLES } else { IMITATING_PAIRS }).collect::<Vec<_>>();
        self.progress.begin("candidates that could imitate the best", new.len());
        let fitted = new.par_iter().filter_map(|i| self.fit_from(i, best)).collect::<Vec<_>>();
        self.sharing(self.best_of_each([tried, fitted].concat()))
    }

    /// Fits additions from the values that a linear look about another hypothesis gave them.
    pub(super) fn fit_from(
        &self,
        imitation: &Imitation,
        about: &FittedHypothesis,
    ) -> Option<FittedHypothesis> {
        let h = self.hypothesis(&self.experiment.nuisances, &imitation.additions);
        let mut values = h.values_from(&about.hypothesis, &about.fit.values);
        values[h.nuisances..].copy_from_slice(&imitation.values);
        let tried = refit(&self.data, h, about, &values);
        self.progress.advance(1);
        tried
    }

    /// The hypotheses near the best with the states that each of them found. A window near an impact that the noise
    /// decides has several local minima. Which of them a fit found must not decide between hypotheses.
    fn sharing(&self, mut tried: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        let Some(best) = tried.first() else { return tried };
        let limit = against(&self.data, best) + NEAR_BEST;
        let near = tried.iter().take(SHARING_STATES).filter(|t| against(&self.data, t) < limit).count();
        let others = tried[..near].iter().collect::<Vec<_>>();
        let shared = others.par_iter().map(|t| shared_states(&self.data, t, &others)).collect::<Vec<_>>();
        tried.splice(..near, shared);
        self.ordered(tried)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn analytic_two_numbers_make_good_what_they_can_of_another() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut draw = |_, _| random.random_range(-1.0..1.0);
        let (j, r) = (DMatrix::from_fn(40, 4, &mut draw), DVector::from_fn(40, &mut draw));
        let sums = Sums { rr: r.norm_squared(), jr: j.transpose() * &r, jj: j.transpose() * &j };
        // The last is moved; the first is the wall's own.
        let (left, two) = sums.left(1, &[(3, 0.5)], &[1, 2]).expect("full rank");
        let moved = &r + j.column(3) * 0.5;
        let free = j.columns(0, 3).into_owned();
        let x = -free.clone().svd(true, true).solve(&moved, 0.0).expect("full rank");
        // The ridge of 1e-9 beside ones.
        assert!((left - (&moved + free * &x).norm_squared()).abs() < 1e-6, "{left}");
        assert!((two[0] - x[1]).abs() < 1e-6 && (two[1] - x[2]).abs() < 1e-6, "{two:?}, {x}");
    }
}
