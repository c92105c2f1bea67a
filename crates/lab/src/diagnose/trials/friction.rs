//! A spring that yields almost at once is friction.
//!
//! No dry friction acts at once: what the top slides on gives a little first, some micrometres. Where the tests are quiet
//! enough to tell, the spring of the catalogue that yields follows them better than friction that jumps. It is called by what
//! it is: friction, of the force at which it yields. Its wall keeps the spring.
//!
//! The search for springs begins with those as stiff as the floor and does not reach such stiff ones. So where
//! friction is the best and leaves more than noise, the spring is fitted from there.

use rayon::prelude::*;

use super::FittedHypothesis;
use super::search::refit;
use super::{Trials, is_noise, kinds};
use crate::Progress;
use crate::diagnose::hypothesis::{Addition, Hypothesis, candidates};
use crate::limits::FRICTION_WITHIN;
use mrbd_kernel::model::EffectKind;

/// The spring that yields.
const SPRING: EffectKind = EffectKind::YieldingSpring;
/// Friction.
pub const FRICTION: EffectKind = EffectKind::CoulombFriction;
/// Shares of the largest displacement of the top over which friction may set in, from which a spring in its place is fitted.
const ONSETS: [f64; 4] = [3e-4, 1e-3, 3e-3, 1e-2];

/// Friction that is an addition by the name of a spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GivingFriction {
    /// Which of the numbers of its hypothesis are its force, and the stiffness with which it sets in.
    pub force: usize,
    pub stiffness: usize,
    /// Displacement over which it sets in, m.
    pub onset_m: f64,
}

/// The friction that an addition of a fitted hypothesis is, if it is a spring that yields almost at once.
pub fn giving_friction(h: &Hypothesis, values: &[f64], index: usize) -> Option<GivingFriction> {
    if h.additions[index].kind() != Some(SPRING) {
        return None;
    }
    let (stiffness, force) = (number(h, index, "stiffness_n_per_m")?, number(h, index, "yield_force_n")?);
    let onset_m = values[force] / values[stiffness];
    // The size of a force that matters over that of a stiffness is the largest displacement.
    let largest_m = h.unknowns[force].scale / h.unknowns[stiffness].scale;
    (onset_m > 0.0 && onset_m < FRICTION_WITHIN * largest_m).then_some(GivingFriction {
        force,
        stiffness,
        onset_m,
    })
}

/// Friction that is fitted in two parts: which addition of its hypothesis gives first, and which of the numbers are its force and that of
/// the other.
pub fn friction_in_two_parts(h: &Hypothesis, values: &[f64]) -> Option<(usize, [usize; 2])> {
    let gives = |index: usize| Some((index, giving_friction(h, values, index)?.force));
    let (index, force) = (0..h.additions.len()).find_map(gives)?;
    Some((index, [force, number(h, position(&h.additions, FRICTION)?, "force_n")?]))
}

/// Which of the numbers of a hypothesis an addition has by this key.
fn number(h: &Hypothesis, index: usize, key: &str) -> Option<usize> {
    h.unknowns.iter().position(|u| u.belongs_to(index) && u.key == key)
}

/// Which addition of a hypothesis is of a kind.
fn position(additions: &[Addition], kind: EffectKind) -> Option<usize> {
    additions.iter().position(|a| a.kind() == Some(kind))
}

/// Kind that an addition of a fitted hypothesis goes by in answers; `None` for what is no answer.
pub fn kind_of(h: &Hypothesis, values: &[f64], index: usize) -> Option<EffectKind> {
    let friction = giving_friction(h, values, index).map(|_| FRICTION);
    friction.or_else(|| h.additions[index].kind())
}

impl<P: Progress> Trials<'_, P> {
    /// Hypotheses in order, and where friction that jumps is part of the best and leaves a gap, the same with friction that
    /// gives first.
    pub(super) fn with_giving(&self, tried: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        let best = tried.iter().find(|t| kinds(t).is_some()).filter(|t| !is_noise(t));
        let Some((h, from)) = best.and_then(|best| Some((self.giving_instead(best)?, best))) else {
            return tried;
        };
        self.progress.begin("friction with a soft onset", ONSETS.len());
        let fit = |onset: &f64| {
            let found = giving_values(&h, from, *onset)
                .and_then(|values| refit(&self.data, h.clone(), from, &values));
            self.progress.advance(1);
            found
        };
        let found = ONSETS.par_iter().filter_map(fit).collect();
        self.best_of_each([tried, found].concat())
    }

    /// The hypothesis with a spring that yields in the place of friction; `None` if it has no friction, or a spring already.
    fn giving_instead(&self, tried: &FittedHypothesis) -> Option<Hypothesis> {
        let mut additions = tried.hypothesis.additions.clone();
        let (friction, None) = (position(&additions, FRICTION)?, position(&additions, SPRING)) else {
            return None;
        };
        let all = candidates(self.experiment.wall.parameters());
        additions[friction] = *all.iter().find(|a| a.kind() == Some(SPRING))?;
        Some(self.hypothesis(&self.experiment.nuisances, &additions))
    }
}

/// The values of a hypothesis with friction for the one with a spring in its place. The spring yields at the same
/// force, after a share of the largest displacement. `None` if either is missing.
fn giving_values(h: &Hypothesis, from: &FittedHypothesis, onset: f64) -> Option<Vec<f64>> {
    let number_of = |h: &Hypothesis, kind, key| number(h, position(&h.additions, kind)?, key);
    let stiffness = number_of(h, SPRING, "stiffness_n_per_m")?;
    let yields = number_of(h, SPRING, "yield_force_n")?;
    let force_n = from.fit.values[number_of(&from.hypothesis, FRICTION, "force_n")?];
    let largest_m = h.unknowns[yields].scale / h.unknowns[stiffness].scale;
    let mut values = h.values_from(&from.hypothesis, &from.fit.values);
    values[yields] = force_n;
    values[stiffness] = (force_n / (onset * largest_m)).min(h.unknowns[stiffness].upper);
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypothesis::example::starter_with;

    /// An effect of this name among others.
    fn with(name: &str) -> Hypothesis {
        starter_with(&["viscous_damping", name])
    }

    #[test]
    fn analytic_a_spring_that_yields_within_a_hundredth_of_the_motion_is_friction() {
        let h = with("yielding_spring");
        // 300 N over 0.4 mm of 50 mm, and over 0.6 mm.
        let values = |onset_m: f64| [0.0, 300.0 / onset_m, 300.0];
        let found = giving_friction(&h, &values(4e-4), 1).expect("friction");
        assert_eq!((found.stiffness, found.force), (1, 2));
        assert!((found.onset_m - 4e-4).abs() < 1e-18, "{found:?}");
        assert_eq!(kind_of(&h, &values(4e-4), 1), Some(FRICTION));
        assert_eq!(kind_of(&h, &values(6e-4), 1), Some(SPRING));
        assert_eq!(kind_of(&h, &values(4e-4), 0), Some(EffectKind::ViscousDamping));
        // A spring that holds nothing, or is none.
        assert_eq!(kind_of(&h, &[0.0, 1e6, 0.0], 1), Some(SPRING));
        assert_eq!(kind_of(&h, &[0.0, 0.0, 0.0], 1), Some(SPRING));
    }

    #[test]
    fn analytic_friction_beside_a_spring_that_yields_at_once_is_a_part_of_it() {
        let h = starter_with(&["coulomb_friction", "yielding_spring"]);
        // 4 N of friction, and a spring that yields at 396 N after 0.1 mm or 1 mm.
        let values = |onset_m: f64| [4.0, 396.0 / onset_m, 396.0];
        assert_eq!(friction_in_two_parts(&h, &values(1e-4)), Some((1, [2, 0])));
        assert_eq!(friction_in_two_parts(&h, &values(1e-3)), None, "it is a spring");
        assert_eq!(friction_in_two_parts(&with("yielding_spring"), &[0.0, 396e4, 396.0]), None);
    }

    #[test]
    fn analytic_other_effects_keep_their_names() {
        assert_eq!(kind_of(&with("gap"), &[0.0, 1e-6], 1), Some(EffectKind::Gap));
    }
}
