//! Laws chosen by few windows, where points are too noisy to choose among them.
//!
//! A missing force is a second derivative: at 3e-4 rad its points may say nothing where windows, whose states follow the motion itself,
//! say a thousand natural logarithms. The shapes that points put first then start from what points give them, however little speaks for
//! that, and are fitted coarsely to few windows; the best go on to all of them, which alone judge.

use super::asked::OpenGap;
use super::equals::law_of;
use super::fitted::{Fitted, LOOK_STEPS, Start};
use super::guards::holds_in_each_test;
use super::kin::power;
use super::points::Points;
use super::search::Searched;
use crate::Progress;
use crate::diagnose::fit::{Fit, nats};
use crate::diagnose::formula::{Atom, Law};
use crate::diagnose::hypothesis::Hypothesis;
use crate::diagnose::trials::{Data, Few, FittedHypothesis, Trials, against};
use crate::limits::{LAWS_FITTED_BY_FEW, LAWS_IN_WINDOWS, SILENT_POINTS, WORTH_WINDOWS};
use rayon::prelude::*;

/// Where a number that points put at the end of its range starts, as a share of the range from there.
const OFF_THE_END: f64 = 0.1;
/// Exponent of velocity at which a law starts that points read as one of its sign alone.
const OFF_FRICTION: f64 = 1.0;

impl Searched<'_> {
    /// Whether points say so much less than windows that they cannot choose among laws.
    pub(super) fn is_silent_beside(&self, windows_nats: f64) -> bool {
        self.most_evidence().max(WORTH_WINDOWS) < SILENT_POINTS * windows_nats
    }

    /// Laws of one atom as points put them first, whatever they say for them, with numbers that a fit may move.
    pub(super) fn singles_to_move(&self) -> Vec<Law> {
        let holds = |law: &Law| holds_in_each_test(&self.equations, law);
        self.singles
            .iter()
            .map(|c| c.law)
            .filter(holds)
            .flat_map(|law| [Some(inside(law)), freed(law)])
            .flatten()
            .collect()
    }

    /// Laws of two atoms: those of which points say most, and the best one of windows with other shapes at its place.
    pub(super) fn pairs_to_move(&self, best: Option<&Law>) -> Vec<Law> {
        let of_points = self.pairs.iter().map(|c| c.law).take(LAWS_IN_WINDOWS);
        let with = |best: &Law| {
            let first = best.first;
            let others = self.singles.iter().map(|c| c.law.first);
            let others = others.filter(move |atom| atom.site == first.site && atom.shape != first.shape);
            others.take(LAWS_IN_WINDOWS).map(move |second| Law { first, second: Some(second) })
        };
        of_points.chain(best.into_iter().flat_map(with)).map(inside).collect()
    }
}

/// A law with numbers that a fit may move either way.
fn inside(law: Law) -> Law {
    law.map(|_, mut atom| {
        for i in atom.free() {
            let [least, most] = atom.bounds(i);
            let margin = OFF_THE_END * (most - least);
            atom.numbers[i] = atom.numbers[i].clamp(least + margin, most - margin);
        }
        atom
    })
}

/// The same of a law that points read as one of the velocity's sign: as friction it has no exponent of velocity that a fit could move.
fn freed(law: Law) -> Option<Law> {
    let first = law.first;
    let number = first.shape.powers(first.numbers)[1].filter(|power| power.value == 0.0)?.number?;
    let mut numbers = first.numbers;
    numbers[number] = OFF_FRICTION;
    Some(inside(Law::of(Atom { numbers, ..first })))
}

/// The powers among the effects of a name, with the sizes that windows gave them: noisy points read a drag as one of the velocity's sign,
/// of an eighth of its largest force, from which no fit came to it.
pub(super) fn powers_of(named: &FittedHypothesis, points: &Points) -> Vec<Law> {
    let all = (0..named.hypothesis.additions.len()).filter_map(|index| power(named, index));
    all.map(|power| Law::of(power.atom(points.reach[power.site as usize]))).collect()
}

impl<P: Progress> Trials<'_, P> {
    /// Laws from where points put them, fitted coarsely to few windows, in the order of what these say against them: the best.
    pub(super) fn starts_in_few(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        laws: &[Law],
        what: &str,
    ) -> Vec<Start> {
        let few = Few::of_coarse(self.data.fit, &gap.nearest.fit);
        let (nearest, data) = match &few {
            Some(few) => (few.of(gap.nearest), few.data()),
            None => (gap.nearest.clone(), self.data),
        };
        self.progress.begin(&format!("{what}, in few windows"), laws.len());
        let start = |law: &Law| {
            let (hypothesis, values) = self.of_points(searched, law)?;
            let fit = self.coarsely(&data, law, &hypothesis, &values, &nearest);
            self.progress.advance(1);
            let fit = fit?;
            Some(Start {
                nats: nats(&fit.windows) + 0.5 * hypothesis.prior_penalty(&fit.values),
                hypothesis,
                values: fit.values,
            })
        };
        let mut starts = laws.par_iter().filter_map(start).collect::<Vec<_>>();
        starts.sort_by(|a, b| a.nats.total_cmp(&b.nats));
        starts.truncate(LAWS_FITTED_BY_FEW);
        starts
    }

    /// A law fitted coarsely to windows from given values, the states of these from those of another hypothesis.
    pub(super) fn coarsely(
        &self,
        data: &Data,
        law: &Law,
        hypothesis: &Hypothesis,
        values: &[f64],
        from: &FittedHypothesis,
    ) -> Option<Fit> {
        self.within_budget_of(data, &law.name(), values.len(), |data| {
            let begun = data.fit.states_to_begin(hypothesis, values, &from.states(), LOOK_STEPS)?;
            data.fit.fit_coarsely(hypothesis, begun)
        })
    }

    /// Whether windows say so much more than points that they choose among laws.
    pub(super) fn windows_choose(&self, gap: &OpenGap, searched: &Searched) -> bool {
        searched.is_silent_beside(against(&self.data, gap.recalibrated))
    }
}

/// The best law of those fitted to windows, in order, whose numbers mean something.
pub(super) fn best_law(fitted: &[Fitted]) -> Option<Law> {
    fitted.iter().find(|fitted| fitted.means_something()).and_then(|fitted| law_of(&fitted.law))
}

#[cfg(test)]
mod tests {
    use super::super::asked::Scope;
    use super::super::search::search;
    use super::super::twin::{OPENING, Twin, drag, open_gap, points_of, points_with, tests_of, wall_with};
    use super::*;
    use crate::diagnose::formula::{Shape, Site};
    use crate::diagnose::hypothesis::Addition;
    use crate::diagnose::trials::try_hypothesis;
    use mrbd_kernel::model::EffectKind;

    #[test]
    fn analytic_few_windows_choose_the_law_where_points_say_too_little_of_it() {
        let twin = Twin::new(&wall_with(OPENING), 3e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let gap = OpenGap { error: 2.0, ..open_gap(&wall, Scope::OneAtom) };
        let h = trials.hypothesis(&trials.experiment.nuisances, &[]);
        let points = Points::new(trials.data.fit.tests, &h).expect("points");
        let found = search(&points).expect("laws");
        let by_points = found.singles[0].law.first;
        assert_ne!(by_points.shape, Shape::Opening, "points choose rightly: {found:?}");
        let said = against(&trials.data, &wall.recalibrated);
        assert!(trials.windows_choose(&gap, &found), "{said} and {}", found.singles[0].evidence);
        let starts = trials.starts_in_few(&gap, &found, &found.singles_to_move(), "laws");
        let best = starts[0].hypothesis.laws(&starts[0].values)[0].first;
        assert_eq!(best.shape, Shape::Opening, "{best:?}");
        // Coarsely: exact exponents are told from a fit to all windows.
        assert!(best.numbers.iter().all(|n| (n - 1.0).abs() < 0.4), "{best:?}");
    }

    #[test]
    fn analytic_a_damper_that_is_named_starts_a_drag_of_its_size() {
        let twin = Twin::new(&wall_with(OPENING), 3e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows").recalibrated;
        let damper = EffectKind::ViscousDamping.variant(None).expect("a kind without variants");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Effect(damper)]);
        let named = try_hypothesis(&trials.data, h, &wall).expect("a wall");
        let points = trials.points(&named).expect("points");
        let [law] = powers_of(&named, &points)[..] else { panic!("one law") };
        assert_eq!((law.first.site, law.first.shape, law.first.numbers[0]), (Site::Top, Shape::Drag, 1.0));
        let [_, largest_m_s] = points.reach[Site::Top as usize];
        let coefficient = named.fit.values[named.hypothesis.nuisances];
        assert!(coefficient > 0.0 && (law.first.size / largest_m_s / coefficient - 1.0).abs() < 1e-12);
        assert_eq!(powers_of(&wall, &points), [], "a wall has no effects");
    }

    #[test]
    fn analytic_clear_points_choose_for_themselves() {
        let points = points_with(&drag(2.0, 300.0), |_| 1.0);
        let found = search(&points).expect("laws");
        let said = found.singles[0].evidence;
        assert!(!found.is_silent_beside(9.0 * said) && found.is_silent_beside(11.0 * said));
        // Of a small gap nothing can be chosen by windows either.
        let nothing = points_of(&tests_of(&wall_with(""), 3e-5));
        let nothing = search(&nothing).expect("laws");
        assert!(!nothing.is_silent_beside(90.0));
    }

    #[test]
    fn analytic_numbers_start_where_a_fit_may_move_them_either_way() {
        let law =
            |shape: Shape, numbers: [f64; 2]| Law::of(Atom { shape, numbers, ..drag(0.0, 300.0).first });
        // From 0.2 to 5 a tenth of the range is 0.48.
        assert_eq!(inside(law(Shape::Drag, [5.0, 0.0])).first.numbers[0], 5.0 - 0.48);
        assert_eq!(inside(law(Shape::Drag, [2.0, 0.0])).first.numbers[0], 2.0);
        assert!(freed(law(Shape::Drag, [2.0, 0.0])).is_none());
        let freed = freed(law(Shape::Opening, [1.5, 0.0])).expect("a law of the sign alone");
        assert_eq!(freed.first.numbers, [1.5, 1.0]);
        assert_eq!(freed.first.free().count(), 2);
    }

    #[test]
    fn analytic_a_second_atom_stands_at_the_place_of_the_first() {
        let points = points_of(&tests_of(&wall_with(OPENING), 3e-4));
        let found = search(&points).expect("laws");
        let best = drag(1.0, 300.0);
        let alone = found.pairs_to_move(None).len();
        let pairs = found.pairs_to_move(Some(&best));
        assert!(pairs.len() > alone);
        for pair in &pairs[alone..] {
            let second = pair.second.expect("two atoms");
            assert!(second.site == Site::Top && second.shape != best.first.shape, "{pair:?}");
        }
    }
}
