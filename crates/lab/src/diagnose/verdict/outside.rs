//! Laws outside the catalogue: where no effect follows, where one only nearly does, and the place or the curve where none is found.

use super::at_impacts::{leaves_only_impacts, misses_held_out_between, worth_two_between};
use super::found::Found;
use super::judge::{Answer, Gap};
use super::worth_naming::{held_out_ask_for, leaves_noise, leaves_noise_or_little_more, place, worth_two};
use super::{OtherLaw, Verdict};
use crate::Progress;
use crate::diagnose::discovery::{AskedOfLaws, Discovered, Guard, Kin, OpenGap, Refused, Scope};
use crate::diagnose::force::{ForcePoint, acts_at_top, force_points, lie_along_top};
use crate::diagnose::formula::Law;
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::{FittedHypothesis, against, closes, closes_held_out, joint_error};
use crate::limits::{BEDS_GAP, EQUIVALENT, NOISE, TREND_SHARE_ON_BEDS, WORTH_A_NAME};
use mrbd_kernel::model::Role;

/// The place of a missing force with the curve that it is, where one holds.
fn with_curve(placed: Found) -> Found {
    let curve = placed.discovered.as_ref().and_then(|discovered| discovered.curve.clone());
    match curve.filter(|_| placed.place == Some("top")) {
        Some(after) => Found { verdict: Verdict::Curve, after, ..placed },
        None => placed,
    }
}

impl<P: Progress> AskedOfLaws for Gap<'_, P> {
    fn is_worth_two(&self, one: &FittedHypothesis, two: &FittedHypothesis) -> bool {
        // Windows that another formulation of a contact misses speak against both laws, and say nothing of the second atom.
        worth_two(&self.trials.data, one, two)
            || held_out_ask_for(&self.trials.data, one, two)
            || leaves_only_impacts(self.trials, two) && worth_two_between(self.trials, one, two)
    }

    fn follows_held_out(&self, law: &FittedHypothesis) -> bool {
        let follows = closes_held_out(law) || leaves_only_impacts(self.trials, law);
        follows && !misses_held_out_between(self.trials, law)
    }

    fn leaves_nothing(&self, law: &FittedHypothesis) -> bool {
        leaves_noise(law) || leaves_only_impacts(self.trials, law)
    }

    fn other_law(&self, law: &FittedHypothesis) -> Vec<Guard> {
        let guards = OtherLaw::beside(&self.trials.data, law).guards();
        // Of a wall of another formulation, at 1e-5 rad, points leave a curve at the top beside the right law, with which windows leave noise.
        if guards == [Guard::Bend] && self.leaves_nothing(law) { Vec::new() } else { guards }
    }
}

impl<P: Progress> Gap<'_, P> {
    /// A law outside the catalogue that leaves noise, but for what another formulation of a contact leaves, and acts at the top, or is one
    /// atom at a joint beside which points say no more of two, as they would beside a bed: no effect needs to be fitted once more, nor do
    /// joints that give beside one. Looked for once.
    pub(super) fn told_early(&self, singles: &[FittedHypothesis]) -> Option<Discovered> {
        if self.early.get().is_some() {
            return None;
        }
        let of_one = self.looked_for(singles, &[], Scope::OneAtom, None)?;
        let may_act_at_top = self.may_act_at_top();
        let asks_for_two = of_one.is_open() || of_one.asks_for_a_second();
        let found = if asks_for_two && may_act_at_top {
            self.looked_for(singles, &[], Scope::TwoAtoms, Some(&of_one)).unwrap_or(of_one)
        } else {
            of_one
        };
        let found = self.early.get_or_init(|| found).clone();
        let best = found.equals.first()?;
        let is_told = match best.hypothesis.additions[0].place() {
            "top" => may_act_at_top,
            _ => found.is_all_of_one_atom() && !found.asks_for_a_second(),
        };
        (found.is_outside_catalogue() && is_told && self.leaves_nothing(best)).then_some(found)
    }

    /// Whether a law outside the catalogue that was looked for closes the gap at the top, told early or not: of 35 walls of a blind set on
    /// beds, most with an effect beside them, none came to be asked with such a law.
    pub(super) fn closes_by_law_at_top(&self) -> bool {
        let best = self.early.get().and_then(|early| early.equals.first());
        best.is_some_and(|law| law.hypothesis.additions[0].place() == "top")
    }

    /// Laws outside the catalogue of up to two atoms.
    pub(super) fn of_up_to_two_atoms(&self, singles: &[FittedHypothesis]) -> Option<Discovered> {
        self.looked_for(singles, &[], Scope::TwoAtoms, self.early.get())
    }

    /// Whether what the wall as given lacks may be a force at the top, and nothing that joints do which give: it lies along the direction
    /// of the top, or has no direction and left so much that joints that give were asked for before any effect.
    pub(super) fn may_act_at_top(&self) -> bool {
        let wide = || joint_error(&self.wall.recalibrated).is_some_and(|error| error > BEDS_GAP);
        lie_along_top(&self.missing()).unwrap_or_else(wide)
    }

    /// Whether the best law found leaves noise and acts at the top, and the measured force lies along that direction.
    pub(super) fn is_told_at_top(&self, discovered: &Discovered) -> bool {
        let Some(best) = discovered.equals.first() else { return false };
        best.hypothesis.additions[0].place() == "top" && leaves_noise(best) && self.acts_at_top()
    }

    /// Whether what the wall as given lacks lies along the direction of the top.
    fn acts_at_top(&self) -> bool {
        acts_at_top(&self.missing())
    }

    /// Whether what the wall as given lacks at the top are its own numbers: with these fitted the tests fitted leave noise, and what is missing
    /// in all does not lie along the top. A floor that was half as stiff again stood for a damper of a crack that opens in the test held out.
    fn own_numbers_act_there(&self) -> bool {
        let recalibrated = &self.wall.recalibrated;
        recalibrated.fit_error() < NOISE && !acts_at_top(&self.missing_of(recalibrated))
    }

    /// What the wall as given lacks.
    fn missing(&self) -> Vec<ForcePoint> {
        self.missing_of(&self.wall.before)
    }

    fn missing_of(&self, wall: &FittedHypothesis) -> Vec<ForcePoint> {
        let physics = wall.hypothesis.physics(&wall.fit.values);
        physics.map_or_else(Vec::new, |physics| force_points(self.trials.data.fit.tests, &physics))
    }

    /// A name whose exponent set free does clearly better is none: a law outside the catalogue that does as much better, or the
    /// place.
    pub(super) fn beyond_a_wrong_name(
        self,
        named: &FittedHypothesis,
        Kin { laws, fitted }: Kin,
        other_law: OtherLaw,
        mut tried: Vec<FittedHypothesis>,
    ) -> Found {
        // The states of windows with which its exponent does better are those to begin from.
        tried.push(fitted);
        let mut discovered = self.discovered(&tried, &laws);
        tried.pop();
        if let Some(discovered) = &mut discovered {
            let (better, others) =
                discovered.equals.drain(..).partition(|law| self.gain(named, law) > WORTH_A_NAME);
            discovered.equals = better;
            let others: Vec<FittedHypothesis> = others;
            let by_name = others.iter().map(|law| Refused::in_windows(law, vec![Guard::Name]));
            discovered.refused.extend(by_name);
            discovered.refused.push(Refused::in_windows(named, vec![Guard::FreedExponent]));
        }
        self.placed_by(discovered, Some(other_law), tried)
    }

    /// Whether a law outside the catalogue leaves noise, or little more, where a name leaves more, and is worth as much beside it as a second
    /// effect must be: the name only imitates it.
    pub(super) fn outdoes(&self, law: &FittedHypothesis, named: &FittedHypothesis) -> bool {
        !leaves_noise(named) && leaves_noise_or_little_more(law) && worth_two(&self.trials.data, named, law)
    }

    /// A law outside the catalogue that outdoes a name.
    pub(super) fn better_formula(
        &self,
        named: &FittedHypothesis,
        tried: &[FittedHypothesis],
    ) -> Option<(Discovered, Answer)> {
        if leaves_noise(named) {
            return None;
        }
        let discovered = self.discovered(tried, &[])?;
        let formula = self.formula(&discovered)?;
        self.outdoes(&formula.after, named).then_some((discovered, formula))
    }

    /// Joints that give named with an effect and a remainder, unless a size of theirs is quite another in large motion: they stand for
    /// another law then, that outside the catalogue or the place, if joints that give are not named `alone`.
    pub(super) fn or_another_law(self, on_beds: Found, alone: impl FnOnce() -> Option<Found>) -> Found {
        let is_on_edges = |a: &Addition| !matches!(a.role(), Some(Role::Bed | Role::JointLaw));
        let has_effect = on_beds.after.hypothesis.additions.iter().any(is_on_edges);
        if on_beds.remainder.is_none() || !has_effect {
            return on_beds;
        }
        let other_law = OtherLaw::beside(&self.trials.data, &on_beds.after);
        if !other_law.differs_in_large_motion_by(TREND_SHARE_ON_BEDS) {
            return on_beds;
        }
        alone().unwrap_or_else(|| {
            let on_edges = |t: &&FittedHypothesis| t.hypothesis.additions.iter().all(is_on_edges);
            let tried = on_beds.tried.iter().filter(on_edges).cloned().collect();
            self.placed_without(&on_beds.after, other_law, tried)
        })
    }

    /// A name that another law is behind is none: a law outside the catalogue, or the place.
    pub(super) fn placed_without(
        self,
        named: &FittedHypothesis,
        other_law: OtherLaw,
        tried: Vec<FittedHypothesis>,
    ) -> Found {
        let mut discovered = self.discovered(&tried, &[]);
        if let Some(discovered) = &mut discovered {
            discovered.refused.push(Refused::in_windows(named, other_law.guards()));
        }
        self.placed_by(discovered, Some(other_law), tried)
    }

    /// No law of the catalogue follows: one outside it that does, or where the force is missing.
    pub(super) fn placed(self, other_law: Option<OtherLaw>, tried: Vec<FittedHypothesis>) -> Found {
        let discovered = self.discovered(&tried, &[]);
        self.placed_by(discovered, other_law, tried)
    }

    /// The same where laws outside the catalogue were looked for.
    pub(super) fn placed_by(
        self,
        discovered: Option<Discovered>,
        other_law: Option<OtherLaw>,
        tried: Vec<FittedHypothesis>,
    ) -> Found {
        match discovered.as_ref().and_then(|discovered| self.formula(discovered)) {
            Some(answer) => {
                let tried = self.trials.ordered(tried);
                Found { discovered, other_law, ..self.found(answer, tried) }
            }
            None => {
                let laws = discovered.as_ref().map_or(Vec::new(), |discovered| discovered.tried.clone());
                with_curve(Found { discovered, ..self.only_placed(other_law, tried, &laws) })
            }
        }
    }

    /// Laws outside the catalogue, some of which windows speak of already.
    pub(super) fn discovered(&self, tried: &[FittedHypothesis], kin: &[Law]) -> Option<Discovered> {
        self.looked_for(tried, kin, Scope::Curves, self.early.get())
    }

    /// The same as far as asked for, where some may have been looked for `before`.
    pub(super) fn looked_for(
        &self,
        tried: &[FittedHypothesis],
        kin: &[Law],
        scope: Scope,
        before: Option<&Discovered>,
    ) -> Option<Discovered> {
        self.trials.discover(&self.open_gap(tried, kin, scope, before)?, self)
    }

    /// What laws outside the catalogue are to close.
    pub(super) fn open_gap<'g>(
        &'g self,
        tried: &'g [FittedHypothesis],
        kin: &'g [Law],
        scope: Scope,
        before: Option<&'g Discovered>,
    ) -> Option<OpenGap<'g>> {
        let (trials, recalibrated) = (self.trials, &self.wall.recalibrated);
        let nearest = tried.iter().chain([recalibrated]);
        let nearest = nearest.min_by(|a, b| against(&trials.data, a).total_cmp(&against(&trials.data, b)));
        Some(OpenGap { recalibrated, nearest: nearest?, error: self.error, scope, kin, before })
    }

    /// The answer that laws outside the catalogue make, if one holds.
    fn formula(&self, discovered: &Discovered) -> Option<Answer> {
        let after = self.trials.refined(discovered.equals.first()?.clone());
        let verdict = if discovered.equals.len() == 1 { Verdict::Formula } else { Verdict::FormulaClass };
        let others = discovered.equals.iter().filter(|_| verdict == Verdict::FormulaClass);
        let equivalent =
            others.flat_map(|t| t.hypothesis.laws(&t.fit.values)).map(|law| law.name()).collect();
        Some(Answer { equivalent, ..Answer::of(verdict, after) })
    }

    /// Where the force is missing, if that shows.
    ///
    /// A law that follows the tests to their noise tells it, though something else refuses its form.
    fn only_placed(
        self,
        other_law: Option<OtherLaw>,
        tried: Vec<FittedHypothesis>,
        laws: &[FittedHypothesis],
    ) -> Found {
        // What no law follows may still be measured; it tells a damper at the top from one at a joint that follows as well.
        let place = match self.acts_at_top() && !self.own_numbers_act_there() {
            true => Some("top"),
            // Laws that follow at two places as well leave it open, whatever an effect says that follows less.
            false => match self.places_of_laws(laws)[..] {
                [] => place(&self.trials.data, &self.wall.recalibrated, &tried),
                [one] => Some(one),
                _ => None,
            },
        };
        let verdict = if place.is_some() { Verdict::PlaceOnly } else { Verdict::Unknown };
        let tried = self.trials.ordered(tried);
        let after = self.wall.recalibrated.clone();
        Found { place, other_law, ..self.found(Answer::of(verdict, after), tried) }
    }

    /// Where the laws act that close the gap and are as good as the best; nowhere where none does.
    fn places_of_laws(&self, laws: &[FittedHypothesis]) -> Vec<&'static str> {
        let closing = laws.iter().filter(|law| closes(law, self.error));
        let best = closing.clone().map(|law| against(&self.trials.data, law)).fold(f64::INFINITY, f64::min);
        if against(&self.trials.data, &self.wall.recalibrated) - best < WORTH_A_NAME {
            return Vec::new();
        }
        let equals = closing.filter(|law| against(&self.trials.data, law) < best + EQUIVALENT);
        let atoms = equals.flat_map(|law| law.hypothesis.laws(&law.fit.values)).flat_map(|law| law.atoms());
        let mut places = atoms.map(|atom| atom.site.name()).collect::<Vec<_>>();
        places.sort_unstable();
        places.dedup();
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{DRAG, DRAG_N, Twin, drag, wall_with};
    use crate::diagnose::fit::Fit;
    use crate::diagnose::formula::{Atom, Site};
    use crate::diagnose::trials::refit;
    use mrbd_kernel::model::Wall;

    #[test]
    fn analytic_laws_that_follow_at_two_places_as_well_leave_the_place_open() {
        let twin = Twin::new(&wall_with(DRAG), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let error = joint_error(&wall.before).expect("windows");
        let recalibrated = wall.recalibrated.clone();
        let gap = Gap::new(&trials, wall, error);
        let (h, values) = trials.law_beside(&recalibrated, &drag(2.0, DRAG_N));
        let top = refit(&trials.data, h, &recalibrated, &values).expect("a fit");
        let there = Law::of(Atom { site: Site::Ground, ..drag(2.0, DRAG_N).first });
        // As if it followed as well from there.
        let (h, values) = trials.law_beside(&top, &there);
        let ground =
            FittedHypothesis { hypothesis: h, fit: Fit { values, ..top.fit.clone() }, ..top.clone() };
        let places = |laws: &[&FittedHypothesis]| {
            gap.places_of_laws(&laws.iter().map(|law| (*law).clone()).collect::<Vec<_>>())
        };
        assert_eq!(places(&[&top]), ["top"]);
        assert_eq!(places(&[&top, &ground]), ["ground", "top"]);
        assert_eq!(places(&[&recalibrated]), Vec::<&str>::new(), "it closes no gap");
    }

    #[test]
    fn analytic_own_numbers_that_close_the_gap_where_tests_were_fitted_are_no_force_at_the_top() {
        let own_numbers = |hidden: &Wall| {
            let twin = Twin::new(hidden, 3e-5);
            let trials = twin.trials();
            let wall = trials.wall_fits(None).expect("windows");
            let error = joint_error(&wall.before).expect("windows");
            assert!(error > NOISE, "{error}");
            Gap::new(&trials, wall, error).own_numbers_act_there()
        };
        let mut stiff = wall_with("").parameters().clone();
        stiff.stiffness_n_per_m *= 1.05;
        assert!(own_numbers(&Wall::new(stiff).expect("a wall")));
        assert!(!own_numbers(&wall_with(DRAG)), "they do not stand for a drag");
    }
}
