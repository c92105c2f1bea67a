//! Second atoms beside the best law of one, as windows ask for them.
//!
//! Points weigh every stretch by its noise and see little of what a law of one atom leaves in few windows: at 3e-4 rad a damper with a stop was
//! not among the pairs of which they said most, and windows said 190 natural logarithms of the stop. How windows change with a little of any
//! other shape is cheap to find.

use super::asked::OpenGap;
use super::equals::law_of;
use super::fitted::{Fitted, Start};
use crate::Progress;
use crate::diagnose::fit::{Fit, WindowFit};
use crate::diagnose::formula::{Atom, Law, Shape, Site};
use crate::diagnose::trials::{Data, Few, FittedHypothesis, Trials, against, all_but_closes, taken_by};
use crate::limits::{COARSE_WINDOWS, SECONDS_FITTED, WORTH_WINDOWS};
use rayon::prelude::*;

/// Exponents at which second atoms are looked at.
const EXPONENTS: [f64; 4] = [0.5, 1.0, 2.0, 3.0];
/// Thresholds, as shares of the largest displacement.
const THRESHOLDS: [f64; 6] = [0.13, 0.28, 0.45, 0.63, 0.8, 0.87];
/// Displacements or velocities over which an atom saturates, as shares of the largest.
const WIDTHS: [f64; 3] = [0.1, 0.25, 0.63];
/// Exponent of what lies beyond a threshold: between a line and a square, of which a fit finds either.
const BEYOND: f64 = 1.5;
/// One of so many atoms is looked at where it is only asked whether any shows: neighbours take away nearly the same.
const LOOKED_AT: usize = 3;
/// Size for which the look is taken, as a share of the first atom's: where it starts is zero.
const LITTLE: f64 = 0.1;

impl<P: Progress> Trials<'_, P> {
    /// Laws of two atoms fitted to windows: the best of one, where it all but closes the gap, with those shapes at its place of which a little
    /// takes away most of what it leaves.
    pub(super) fn seconds_in_windows(&self, gap: &OpenGap, singles: &[Fitted]) -> Vec<Fitted> {
        let near = |one: &&Fitted| one.means_something() && all_but_closes(&one.law, gap.error);
        let Some(best) = singles.iter().find(near) else { return Vec::new() };
        let starts = self.seconds(&best.law, 1);
        let beside = OpenGap { nearest: &best.law, ..*gap };
        self.laws_in_windows(&beside, starts, "second atoms beside the best law")
    }

    /// Whether the best of laws that leave no more than noise leaves what a second atom would take away: how large a noise is, is known to a
    /// few hundredths, and a law may imitate another within that. Of 33 right laws all leave 8 natural logarithms of likelihood at most, half 1.
    pub(super) fn second_shows(&self, gap: &OpenGap, closing: &[Fitted]) -> bool {
        if let Some(before) = gap.before.filter(|before| !before.is_open()) {
            return before.second_shows;
        }
        let of = |one: &&Fitted| against(&self.data, one.judged());
        let best = closing.iter().min_by(|a, b| of(a).total_cmp(&of(b)));
        // The states of laws that carry one along make a look dear, and second atoms hard to tell from them.
        let best = best.filter(|one| !law_of(one.judged()).is_some_and(|law| law.first.shape.carries()));
        best.is_some_and(|one| !self.seconds(one.judged(), LOOKED_AT).is_empty())
    }

    /// The law of a fitted hypothesis of one atom with second ones, one of a shape, of which a little takes away most of what it leaves: of
    /// all, or `every` so many of them.
    fn seconds(&self, best: &FittedHypothesis, every: usize) -> Vec<Start> {
        let Some(law) = law_of(best).filter(|law| law.second.is_none()) else { return Vec::new() };
        let few = Few::followed_worst(self.data.fit, COARSE_WINDOWS, &best.fit);
        let data = few.data();
        let left = few.of(best).fit.windows;
        let seconds = seconds_of(&law.first, law.first.reach);
        let seconds = seconds.into_iter().step_by(every).collect::<Vec<_>>();
        self.progress.begin("second atoms beside the best law, a first look", seconds.len());
        let look = |second: &Atom| {
            let taken = self.taken_by_second(&data, best, &left, Law { second: Some(*second), ..law });
            self.progress.advance(1);
            taken
        };
        let mut found = seconds.par_iter().filter_map(look).collect::<Vec<_>>();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut starts: Vec<(Law, Start)> = Vec::new();
        for (gain, pair) in found {
            if gain > WORTH_WINDOWS && !starts.iter().any(|(known, _)| known.is_like(&pair)) {
                let (hypothesis, values) = self.law_beside(best, &pair);
                starts.push((pair, Start { hypothesis, values, nats: -gain }));
            }
        }
        starts.into_iter().map(|(_, start)| start).take(SECONDS_FITTED).collect()
    }

    /// What a second atom takes away of what a law of one leaves in windows, in natural logarithms of likelihood as far as a linear look
    /// tells, and both with the size at which it does. `None` where it may not have that, or shows nowhere.
    pub(super) fn taken_by_second(
        &self,
        data: &Data,
        best: &FittedHypothesis,
        left: &[WindowFit],
        pair: Law,
    ) -> Option<(f64, Law)> {
        let (hypothesis, mut values) = self.law_beside(best, &pair);
        let number = hypothesis.nuisances + Law { second: None, ..pair }.values().len();
        values[number] = 0.0;
        let at = Fit { values, windows: left.to_vec(), cost: 0.0, covariance: None };
        let (taken, size) = taken_by(data, &hypothesis, &at, number)?;
        let second = pair.second.filter(|second| second.may_be(size))?;
        Some((0.5 * taken, Law { second: Some(Atom { size, ..second }), ..pair }))
    }
}

/// Atoms of the shapes that walls have often, other than that of a first one and at its place, which reaches so far.
pub(super) fn seconds_of(first: &Atom, reach: [f64; 2]) -> Vec<Atom> {
    let numbers = |shape: Shape| -> Vec<[f64; 2]> {
        match shape {
            Shape::Spring | Shape::Drag => EXPONENTS.map(|n| [n, 0.0]).to_vec(),
            Shape::OneSidedSpring(_) => vec![[1.0, 0.0], [2.0, 0.0]],
            Shape::Stop(_) | Shape::DeadZone => THRESHOLDS.map(|g| [g, BEYOND]).to_vec(),
            Shape::Saturation | Shape::DragSaturation => WIDTHS.map(|d| [d, 0.0]).to_vec(),
            Shape::Opening => vec![[1.0, 1.0], [2.0, 1.0], [1.0, 2.0], [2.0, 2.0]],
            _ => Vec::new(),
        }
    };
    let shapes = if first.site == Site::Top { &Shape::ALL[..] } else { &Shape::AT_JOINTS };
    let others = shapes.iter().filter(|shape| shape.is_common() && **shape != first.shape);
    let size = LITTLE * first.size.abs();
    let atoms = |shape: &Shape| {
        let atom = |numbers| Atom { shape: *shape, numbers, size, reach, is_exact: false, ..*first };
        numbers(*shape).into_iter().map(atom).collect::<Vec<_>>()
    };
    others.flat_map(atoms).collect()
}

#[cfg(test)]
mod tests {
    use super::super::asked::Scope;
    use super::super::points::Points;
    use super::super::twin::{DRAG, SPRING, Twin, drag_and_spring, open_gap, wall_with};
    use super::*;
    use crate::diagnose::formula::Side;
    use crate::diagnose::hypothesis::Addition;
    use crate::diagnose::trials::refit;

    /// The shapes that are looked at beside a drag fitted to the windows of a wall with effects.
    fn beside_a_drag(effects: &str) -> Vec<Shape> {
        let twin = Twin::new(&wall_with(effects), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[]);
        let points = Points::new(trials.data.fit.tests, &h).expect("points");
        let alone = Law { second: None, ..drag_and_spring(&points) };
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Formula(alone)]);
        let values = wall.recalibrated.fit.values.iter().copied().chain(alone.values()).collect::<Vec<_>>();
        let one = refit(&trials.data, h, &wall.recalibrated, &values).expect("a fit");
        let starts = trials.seconds(&one, 1);
        let laws = starts.iter().flat_map(|start| start.hypothesis.laws(&start.values));
        let shapes = laws.filter_map(|law| law.second).map(|second| second.shape).collect();
        let gap = OpenGap { error: 10.0, ..open_gap(&wall, Scope::TwoAtoms) };
        let one = [Fitted::new(one)];
        let fitted = trials.seconds_in_windows(&gap, &one);
        assert_eq!(fitted.is_empty(), starts.is_empty());
        assert_eq!(trials.second_shows(&gap, &one), !starts.is_empty());
        shapes
    }

    #[test]
    fn analytic_what_takes_away_most_of_what_a_law_leaves_is_looked_at_first_and_nothing_where_it_leaves_nothing()
     {
        let shapes = beside_a_drag(&[DRAG, SPRING].concat());
        assert_eq!(shapes.first(), Some(&Shape::OneSidedSpring(Side::Negative)), "{shapes:?}");
        assert_eq!(beside_a_drag(DRAG), []);
    }

    #[test]
    fn analytic_second_atoms_are_of_every_other_shape_that_walls_have_often_and_at_the_place_of_the_first() {
        let first = super::super::twin::drag(2.0, 300.0).first;
        for (site, shapes) in [(Site::Top, &Shape::ALL[..]), (Site::Ground, &Shape::AT_JOINTS)] {
            let all = seconds_of(&Atom { site, ..first }, first.reach);
            assert!(all.iter().all(|atom| atom.site == site));
            let looked_at = |shape: &Shape| all.iter().any(|atom| atom.shape == *shape);
            let asked = |shape: &&Shape| shape.is_common() && **shape != first.shape;
            assert!(shapes.iter().filter(asked).all(looked_at) && !looked_at(&first.shape), "{all:?}");
        }
    }
}
