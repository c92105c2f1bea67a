//! Laws that the tests cannot tell apart, and which of them are one law by two names.

use super::fitted::Fitted;
use super::points::Points;
use crate::diagnose::formula::{Law, Site};
use crate::diagnose::trials::{Data, FittedHypothesis, against};
use crate::limits::{EQUIVALENT, SAME_FORCE};

/// Of laws in order, best first, those that are as good as the best: the better of those that are alike but for exact
/// exponents, the simplest of those that are one force over what was excited.
pub(super) fn simplest_of_equals(data: &Data, points: &Points, closing: Vec<Fitted>) -> Vec<Fitted> {
    let of = |one: &Fitted| against(data, one.judged());
    let Some(best) = closing.first().map(of) else { return Vec::new() };
    let equals = closing.into_iter().filter(|one| of(one) < best + EQUIVALENT);
    let mut equals = equals.fold(Vec::new(), |kept, one| with_shape(points, kept, one));
    // Stable: of as many numbers and the same place, the better comes first.
    equals.sort_by_key(|t| (t.law.hypothesis.unknowns.len(), law_of(t.judged()).map(|law| law.first.site)));
    let mut kept: Vec<Fitted> = Vec::new();
    for one in equals {
        let known = |other: &Fitted| {
            let pair = law_of(one.judged()).zip(law_of(other.judged()));
            pair.is_some_and(|(a, b)| difference(points, &a, &b) < SAME_FORCE)
        };
        if !kept.iter().any(known) {
            kept.push(one);
        }
    }
    kept
}

/// Laws of different shapes, best first, with one more: of two alike but for exact exponents the better, or that with exact
/// ones where both are one force. An exponent of 1.997 that tests cannot tell from 2 is 2.
fn with_shape(points: &Points, mut kept: Vec<Fitted>, one: Fitted) -> Vec<Fitted> {
    let of = |one: &Fitted| law_of(one.judged());
    let Some(law) = of(&one) else { return kept };
    match kept.iter_mut().find(|better| of(better).is_some_and(|better| better.is_like(&law))) {
        Some(better) => {
            let is_one = of(better).is_some_and(|better| difference(points, &better, &law) < SAME_FORCE);
            if is_one && one.law.hypothesis.unknowns.len() < better.law.hypothesis.unknowns.len() {
                *better = one;
            }
        }
        None => kept.push(one),
    }
    kept
}

/// The law of a fitted hypothesis.
pub fn law_of(tried: &FittedHypothesis) -> Option<Law> {
    tried.hypothesis.laws(&tried.fit.values).into_iter().next()
}

/// Largest difference of the forces of two laws over what was excited, over the largest force of the first at its place.
pub fn difference(points: &Points, one: &Law, other: &Law) -> f64 {
    let at = |site: Site| {
        let [one, other] = [one, other].map(|law| points.forces(law, site));
        let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
        for (one, other) in one.into_iter().zip(other) {
            apart = apart.max((one - other).abs());
            largest = largest.max(one.abs()).max(other.abs());
        }
        if largest > 0.0 { apart / largest } else { 0.0 }
    };
    Site::ALL.map(at).into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::twin::{drag, points_with};
    use super::*;

    #[test]
    fn analytic_laws_are_one_where_their_forces_are_over_what_was_excited() {
        let law = drag(2.0, 300.0);
        let points = points_with(&law, |_| 1.0);
        // |v|^2 and |v|^2.02 part by 0.4 % of the largest force, |v| and |v|^2 by a quarter of it.
        assert!(difference(&points, &law, &drag(2.02, 300.0)) < SAME_FORCE);
        let apart = difference(&points, &law, &drag(1.0, 300.0));
        assert!((0.15..0.35).contains(&apart), "{apart}");
        let joint = Law::of(crate::diagnose::formula::Atom { site: Site::Ground, ..law.first });
        assert!((difference(&points, &law, &joint) - 1.0).abs() < 1e-12);
    }
}
