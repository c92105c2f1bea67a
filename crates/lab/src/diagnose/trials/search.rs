//! Tries one hypothesis: where to start, the fit, and what it makes of tests it has not seen.

use super::starts::{FEW_SIZES, SIZES, ladder, several, with_a_size};
use super::{Data, Tried};
use crate::diagnose::fit::Fit;
use crate::diagnose::hypothesis::Hypothesis;

/// Most numbers of a second addition that a glance tells of.
const MOST_AT_A_GLANCE: usize = 2;

/// Fits a hypothesis coarsely from several starts about the values of each of `from`, where it has them, and its own; `from`
/// gives the states of the windows too.
///
/// `None` if no start makes a wall.
pub fn try_coarsely(data: &Data, hypothesis: Hypothesis, from: &[&Tried]) -> Option<Tried> {
    let one = |from: &&Tried| {
        let base = hypothesis.values_from(&from.hypothesis, &from.fit.values);
        let fit = best_coarse(data, &hypothesis, from, &base, hypothesis.nuisances)?;
        judged(data, hypothesis.clone(), fit, from, false)
    };
    let tried = from.iter().filter_map(one);
    tried.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost))
}

/// Fits to the end what was fitted coarsely.
pub fn finish(data: &Data, coarse: &Tried) -> Option<Tried> {
    let fit = data.fit.fit_finely(&coarse.hypothesis, coarse.fit.clone())?;
    judged(data, coarse.hypothesis.clone(), fit, coarse, true)
}

/// Fits a hypothesis from several starts to the end.
pub fn try_hypothesis(data: &Data, hypothesis: Hypothesis, from: &Tried) -> Option<Tried> {
    finish(data, &try_coarsely(data, hypothesis, &[from])?)
}

/// The best coarse fit from starts about `base` that move the numbers from the `first` on; starts are compared at a glance.
fn best_coarse(data: &Data, h: &Hypothesis, from: &Tried, base: &[f64], first: usize) -> Option<Fit> {
    let mut glances = glances(data, h, from, &ladder(h, base, first, &SIZES))?;
    glances.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let begun =
        if h.unknowns.len() - first >= 2 { several(glances) } else { with_a_size(h, base, first, glances) };
    let fits = begun.into_iter().filter_map(|start| data.fit.fit_coarsely(h, start));
    fits.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// The states of another hypothesis, looked at with values of this one.
fn glances(data: &Data, h: &Hypothesis, from: &Tried, starts: &[Vec<f64>]) -> Option<Vec<Fit>> {
    let chords = data.fit.chords(&from.hypothesis, &from.fit)?;
    Some(starts.iter().filter_map(|values| data.fit.glance(h, values, &from.fit, &chords)).collect())
}

/// A fit with the tests held out beside it, whose states alone are fitted: from those of another hypothesis, which may be far
/// from the truth, and where it is thorough from those measured too.
fn judged(data: &Data, hypothesis: Hypothesis, fit: Fit, from: &Tried, thorough: bool) -> Option<Tried> {
    let states = |x: &[Vec<f64>]| data.held_out.states(&hypothesis, &fit.values, x, 3, thorough);
    let mut held_out = states(&states_of(&from.held_out))?;
    if thorough {
        take_better(&mut held_out, states(&data.held_out.measured_states())?);
    }
    Some(Tried { hypothesis, fit, held_out })
}

/// Takes the states of another fit of the same values in the windows where they are better.
fn take_better(own: &mut Fit, other: Fit) {
    for (mine, new) in own.windows.iter_mut().zip(other.windows) {
        if new.squares < mine.squares {
            *mine = new;
        }
    }
}

/// The model as it is, with nothing to find but the states.
pub fn untouched(data: &Data, hypothesis: Hypothesis) -> Option<Tried> {
    let fit = data.fit.states(&hypothesis, &[], &data.fit.measured_states(), 4, true)?;
    let held_out = data.held_out.states(&hypothesis, &[], &data.held_out.measured_states(), 4, true)?;
    Some(Tried { hypothesis, fit, held_out })
}

fn states_of(fit: &Fit) -> Vec<Vec<f64>> {
    fit.windows.iter().map(|w| w.x.clone()).collect()
}

/// Fits to the end from given values.
pub fn refit(data: &Data, hypothesis: Hypothesis, from: &Tried, values: &[f64]) -> Option<Tried> {
    let start = data.fit.states(&hypothesis, values, &states_of(&from.fit), 2, false)?;
    let fit = data.fit.fit_finely(&hypothesis, start)?;
    judged(data, hypothesis, fit, from, true)
}

/// What a second addition beside one that was fitted promises at a glance, in the loss of starts; `None` where only a fit
/// would tell.
pub fn promise(data: &Data, hypothesis: &Hypothesis, first: &Tried) -> Option<f64> {
    let (base, second) = beside(hypothesis, first);
    if hypothesis.unknowns.len() - second > MOST_AT_A_GLANCE {
        return None;
    }
    let starts = ladder(hypothesis, &base, second, &FEW_SIZES);
    glances(data, hypothesis, first, &starts)?.iter().map(|fit| fit.cost).min_by(f64::total_cmp)
}

/// Fits a second addition beside one that was fitted, coarsely, from its values.
pub fn try_second(data: &Data, hypothesis: Hypothesis, first: &Tried, from: &Tried) -> Option<Tried> {
    let (base, second) = beside(&hypothesis, first);
    let fit = best_coarse(data, &hypothesis, first, &base, second)?;
    judged(data, hypothesis, fit, from, false)
}

/// Values of a pair at which the second addition does nothing, and where its numbers begin.
fn beside(hypothesis: &Hypothesis, first: &Tried) -> (Vec<f64>, usize) {
    let mut base = hypothesis.start();
    // The first addition's numbers follow those of the wall; fewer of the wall's may have a prior beside the second.
    let added = &first.fit.values[first.hypothesis.nuisances..];
    let second = hypothesis.nuisances + added.len();
    base[hypothesis.nuisances..second].copy_from_slice(added);
    (base, second)
}

/// The same values with each window's state refitted from those that other hypotheses found, where that is better.
///
/// A window near an impact decided by less than the noise has several valleys: no hypothesis shall win by having found
/// one that the others missed.
pub fn shared_states(data: &Data, tried: &Tried, others: &[&Tried]) -> Tried {
    let mut best = tried.clone();
    let (h, values) = (&tried.hypothesis, &tried.fit.values);
    for other in others {
        let sides =
            [(&data.fit, &mut best.fit, &other.fit), (&data.held_out, &mut best.held_out, &other.held_out)];
        for (problem, own, from) in sides {
            let Some(found) = problem.states(h, values, &states_of(from), 2, false) else { continue };
            take_better(own, found);
        }
    }
    best
}
