//! How sure the form of a law is: over swings drawn again, and over amplitudes that it was not fitted to.
//!
//! Both are asked of points, with the shapes as they were found and their sizes and the wall's numbers fitted anew.

use super::guards::unseen_gain;
use super::search::{Candidate, Equations, Searched};
use crate::diagnose::formula::{Law, Site};
use crate::limits::{EQUIVALENT, SMALL_SWING};
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Sets of swings that are drawn.
const DRAWS: usize = 40;
const SEED: u64 = 24;
/// Fewest rows of points on either side of an amplitude.
const LEAST_ROWS: usize = 8;

/// What speaks for the form of a law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// Sets of swings drawn again, with replacement, within each test.
    pub draws: usize,
    /// Share of them in which the law, or one of its class, is within [`EQUIVALENT`] of the best of all laws that were refined.
    pub stable: f64,
    /// Swings below [`SMALL_SWING`] of the reach predicted by those above.
    pub small_by_large: Option<UnseenGain>,
    /// Those above predicted by those below.
    pub large_by_small: Option<UnseenGain>,
}

/// What a law gains over the wall alone, in natural logarithms of likelihood.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UnseenGain {
    /// In swings that it was not fitted to.
    pub unseen: f64,
    /// In the same, where it was.
    pub seen: f64,
}

impl Stability {
    /// Of the laws of a class, the told one first.
    pub fn of(searched: &Searched, class: &[Law]) -> Option<Self> {
        let told = class.first()?;
        let is_small = small(&searched.equations, told.first.site);
        let [small_by_large, large_by_small] =
            [true, false].map(|judged| across(&searched.equations, told, &is_small, judged));
        Some(Self { draws: DRAWS, stable: stable(searched, class), small_by_large, large_by_small })
    }
}

/// Whether each row is of a small swing.
fn small(equations: &Equations, site: Site) -> Vec<bool> {
    let points = equations.points();
    points.amplitude(site).iter().map(|share| *share < SMALL_SWING).collect()
}

/// What a law gains in swings of one kind, fitted to those of the other.
fn across(equations: &Equations, law: &Law, is_small: &[bool], judged: bool) -> Option<UnseenGain> {
    let (own, others): (Vec<usize>, Vec<usize>) =
        (0..is_small.len()).partition(|row| is_small[*row] == judged);
    let enough = own.len() >= LEAST_ROWS && others.len() >= LEAST_ROWS;
    let all = (0..is_small.len()).collect::<Vec<_>>();
    let gain = |fitted: &[usize]| unseen_gain(equations, law, fitted, &own);
    enough.then(|| Some(UnseenGain { unseen: gain(&others)?, seen: gain(&all)? })).flatten()
}

/// Share of drawn sets of swings in which a law of the class is as good as the best.
fn stable(searched: &Searched, class: &[Law]) -> f64 {
    let found = searched.singles.iter().chain(&searched.pairs).map(|c| c.law);
    let laws = class.iter().copied().chain(found).collect::<Vec<_>>();
    let points = searched.equations.points();
    let columns = laws.iter().map(|law| law.atoms().map(|atom| points.column(&atom)).collect::<Vec<_>>());
    let columns = columns.collect::<Vec<_>>();
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let draws = (0..DRAWS).map(|_| drawn(&points.swings(), &mut random)).collect::<Vec<_>>();
    let holds = |times: &DVector<f64>| {
        let equations = searched.equations.repeated(times);
        let all = laws.iter().zip(&columns);
        let found = all.map(|(law, columns)| equations.fitted_to(law, columns)).collect::<Vec<_>>();
        let evidence = |c: &Option<Candidate>| c.as_ref().map_or(f64::NEG_INFINITY, |c| c.evidence);
        let best = |of: &[Option<Candidate>]| of.iter().map(evidence).fold(f64::NEG_INFINITY, f64::max);
        best(&found[..class.len()]) > best(&found) - EQUIVALENT
    };
    let held = draws.par_iter().filter(|times| holds(times)).count();
    held as f64 / DRAWS as f64
}

/// How often each row comes where the swings of each test are drawn with replacement.
fn drawn(swings: &[(usize, std::ops::Range<usize>)], random: &mut ChaCha8Rng) -> DVector<f64> {
    let rows = swings.last().map_or(0, |(_, rows)| rows.end);
    let mut times = DVector::zeros(rows);
    for (test, _) in swings {
        let own = swings.iter().filter(|(other, _)| other == test).map(|(_, rows)| rows).collect::<Vec<_>>();
        let rows = own[random.random_range(0..own.len())];
        rows.clone().for_each(|row| times[row] += 1.0);
    }
    times
}

#[cfg(test)]
mod tests {
    use super::super::search::search;
    use super::super::twin::{drag, points_with};
    use super::*;

    #[test]
    fn analytic_a_clear_law_is_stable_and_holds_at_amplitudes_it_has_not_seen() {
        let law = drag(2.0, 300.0);
        let points = points_with(&law, |_| 1.0);
        let found = search(&points).expect("laws");
        let checked = Stability::of(&found, &[law]).expect("a law");
        assert_eq!(checked.stable, 1.0);
        let small = points.amplitude(Site::Top).iter().filter(|share| **share < SMALL_SWING).count();
        let counts = format!("{small} of {} rows are of small swings", points.missing.len());
        let gain = checked.large_by_small.expect(&counts);
        assert!(gain.unseen > 0.5 * gain.seen && gain.seen > 0.0, "{gain:?}, {counts}");
    }

    #[test]
    fn analytic_another_law_is_not_stable() {
        let points = points_with(&drag(2.0, 300.0), |_| 1.0);
        let found = search(&points).expect("laws");
        let other = Stability::of(&found, &[drag(0.0, 100.0)]).expect("a law");
        // Of few swings friction is as good now and then: 15 % of the sets.
        assert!(other.stable < 0.5, "{other:?}");
    }

    #[test]
    fn analytic_drawn_swings_are_as_many_as_there_are() {
        let swings = [(0, 0..4), (0, 4..6), (2, 6..9)];
        let times = drawn(&swings, &mut ChaCha8Rng::seed_from_u64(1));
        // The only swing of the last test comes once; those of the first are two in all.
        assert_eq!(times.rows(6, 3).as_slice(), [1.0; 3]);
        assert_eq!(times[0] + times[4], 2.0);
        assert!(times.rows(0, 4).iter().all(|t| *t == times[0]));
    }
}
