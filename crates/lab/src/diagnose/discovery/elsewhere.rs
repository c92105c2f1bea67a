//! The best law of one atom of the top at the ground, or of the ground at the top.
//!
//! A wall that swings as a whole shows a force at the top and a moment at the ground alike. Where points say little, these or few windows
//! may have let one of the two go: a damper that grows with displacement was told at the ground, twice, that acts at the top and was never
//! fitted to windows there. A name of the top that the catalogue has nowhere else is asked so as well: a spring of the ground,
//! |φ|^2.45, was named a cubic one of the top, which left noise too and was 630 natural logarithms worse.

use super::asked::OpenGap;
use super::equals::law_of;
use super::fitted::{Fitted, Start};
use super::kin::{EXPONENTS, Kin, Power, as_large};
use super::points::Points;
use crate::Progress;
use crate::diagnose::fit::nats;
use crate::diagnose::formula::{Atom, Law, Shape, Site};
use crate::diagnose::trials::{Few, FittedHypothesis, Trials, against, all_but_closes};
use crate::limits::{NEAR_BEST, WORTH_A_LAW_IN_NOISE};
use rayon::prelude::*;

impl<P: Progress> Trials<'_, P> {
    /// Laws of one atom that were fitted to windows, and the best of them at the other place if it was not fitted there and all but closes
    /// the gap.
    pub(super) fn with_other_place(
        &self,
        gap: &OpenGap,
        points: &Points,
        singles: Vec<Fitted>,
    ) -> Vec<Fitted> {
        let near = |one: &&Fitted| one.means_something() && all_but_closes(&one.law, gap.error);
        let Some(best) = singles.iter().find(near) else { return singles };
        let Some(law) = law_of(&best.law) else { return singles };
        let known = singles.iter().filter_map(|one| law_of(&one.law)).collect::<Vec<_>>();
        let is_new = |there: &Law| !known.iter().any(|own| is_of_kind(&own.first, &there.first));
        let there = elsewhere(&law, points).filter(is_new);
        let few = Few::of_coarse(self.data.fit, &best.law.fit);
        let start = there.and_then(|there| self.start_elsewhere(few.as_ref(), &best.law, &there));
        let others =
            self.laws_in_windows(gap, start.into_iter().collect(), "the best law at its other place");
        self.in_order([singles, others].concat())
    }

    /// A spring of the ground in the place of one that is named at the top. `None` of another effect, and where nothing of either is excited.
    pub(super) fn spring_of_ground(
        &self,
        named: &FittedHypothesis,
        power: &Power,
        points: &Points,
    ) -> Option<FittedHypothesis> {
        let own = Law::of(power.atom(points.reach[power.site as usize]));
        let there = elsewhere(&own, points).filter(|_| own.first.shape == Shape::Spring)?;
        let of_exponent = |n: f64| Law::of(Atom { numbers: [n, 0.0], ..there.first });
        let exponents = EXPONENTS.into_iter().chain([own.first.numbers[0]]);
        let laws = exponents.filter_map(|n| as_large(of_exponent(n), &there, points)).collect::<Vec<_>>();
        self.progress.begin("a spring at its other place", laws.len());
        let look = |law: &Law| {
            let start = self.start_in_place_of(named, (power.index, law), None);
            self.progress.advance(1);
            start
        };
        let starts = laws.par_iter().filter_map(look);
        self.fitted_beside(named, starts.min_by(|a, b| a.nats.total_cmp(&b.nats))?)
    }

    /// The same as what does better than the name, if it gains over that what a law must where the gap is closed without it, and follows the
    /// tests held out no worse.
    pub(super) fn better_of_ground(
        &self,
        named: &FittedHypothesis,
        of_ground: &FittedHypothesis,
    ) -> Option<Kin> {
        let law = *of_ground.hypothesis.laws(&of_ground.fit.values).first()?;
        let gain = against(&self.data, named) - against(&self.data, of_ground);
        let holds = gain > WORTH_A_LAW_IN_NOISE && self.does_clearly_better(named, of_ground);
        holds.then(|| Kin { laws: vec![law], fitted: of_ground.clone() })
    }

    /// A law in the place of another, fitted coarsely to `few` windows where there are many; `None` where it comes nowhere near that one there.
    fn start_elsewhere(&self, few: Option<&Few>, best: &FittedHypothesis, there: &Law) -> Option<Start> {
        let (hypothesis, values) = self.law_beside(best, there);
        let Some(few) = few else {
            return Some(Start { nats: nats(&best.fit.windows), hypothesis, values });
        };
        let own = few.of(best);
        let fit = self.coarsely(&few.data(), there, &hypothesis, &values, &own)?;
        let nats = [&fit, &own.fit].map(|fit| nats(&fit.windows));
        (nats[0] < nats[1] + NEAR_BEST).then(|| Start { hypothesis, values: fit.values, nats: nats[0] })
    }
}

/// Whether two atoms are one shape at one place with as many numbers to move: one of the velocity's sign has no exponent of it.
fn is_of_kind(one: &Atom, other: &Atom) -> bool {
    let kind = |atom: &Atom| (atom.site, atom.shape, Atom { is_exact: false, ..*atom }.free().count());
    kind(one) == kind(other)
}

/// A law of one atom of the top at the ground, or the other way, in the same shares of what each reaches: it does the same work there.
/// `None` of a law of the crack, whose rotation is another.
fn elsewhere(law: &Law, points: &Points) -> Option<Law> {
    let first = law.first;
    let site = match first.site {
        Site::Top => Site::Ground,
        Site::Ground => Site::Top,
        Site::Crack => return None,
    };
    let reach = points.reach[site as usize];
    let size = first.size * first.reach[0] / reach[0];
    size.is_normal().then(|| Law::of(Atom { site, reach, size, is_exact: false, ..first }))
}

#[cfg(test)]
mod tests {
    use super::super::asked::Scope;
    use super::super::twin::{DRAG, DRAG_N, OPENING, Twin, drag, open_gap, wall_with};
    use super::*;
    use crate::diagnose::hypothesis::Addition;
    use crate::diagnose::trials::{refit, try_hypothesis};
    use crate::limits::COARSE_WINDOWS;
    use mrbd_kernel::model::EffectKind;

    #[test]
    fn analytic_a_law_of_the_top_that_is_fitted_at_the_ground_alone_is_found_at_the_top() {
        let twin = Twin::new(&wall_with(OPENING), 3e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[]);
        let points = Points::new(trials.data.fit.tests, &h).expect("points");
        let of = |site: Site, moment: f64| Atom {
            site,
            shape: Shape::Opening,
            numbers: [1.0, 1.0],
            size: moment / points.reach[site as usize][0],
            reach: points.reach[site as usize],
            is_exact: false,
        };
        let top = points.reach[Site::Top as usize];
        let ground = Law::of(of(Site::Ground, 3e4 * top[0].powi(2) * top[1]));
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Formula(ground)]);
        let own = wall.recalibrated.fit.values.iter().copied();
        let values = own.chain(ground.values()).collect::<Vec<_>>();
        let fitted = refit(&trials.data, h, &wall.recalibrated, &values).expect("a fit");
        let gap = open_gap(&wall, Scope::OneAtom);
        let all = trials.with_other_place(&gap, &points, vec![Fitted::new(fitted.clone())]);
        let best = law_of(&all[0].law).expect("a law").first;
        assert_eq!((best.site, best.shape), (Site::Top, Shape::Opening), "{best:?}");
        assert!(against(&trials.data, &all[0].law) < against(&trials.data, &fitted));
        // Those that are known already are not fitted again.
        let again = trials.with_other_place(&gap, &points, all.clone());
        assert_eq!(again.len(), all.len());
    }

    #[test]
    fn analytic_a_place_that_few_windows_speak_against_is_not_tried_in_all() {
        let twin = Twin::new(&wall_with(DRAG), 1e-5);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let law = drag(2.0, DRAG_N);
        let (h, values) = trials.law_beside(&wall.recalibrated, &law);
        let best = refit(&trials.data, h, &wall.recalibrated, &values).expect("a fit");
        let few = Few::new(trials.data.fit, COARSE_WINDOWS, 1.0);
        let h = trials.hypothesis(&trials.experiment.nuisances, &[]);
        let points = Points::new(trials.data.fit.tests, &h).expect("points");
        let there = elsewhere(&law, &points).expect("a law of the ground");
        let start = |law: &Law| trials.start_elsewhere(Some(&few), &best, law);
        // This twin swings as a whole: a drag of the ground comes as near as one of the top, and a spring nowhere.
        assert!(start(&law).is_some() && start(&there).is_some());
        let spring = Atom { shape: Shape::Spring, numbers: [3.0, 0.0], ..there.first };
        assert!(start(&Law::of(spring)).is_none());
    }

    /// What is told instead of a cubic spring of the top, fitted to the windows of a wall with effects.
    fn instead_of_cubic(effects: &str) -> Option<Law> {
        let twin = Twin::new(&wall_with(effects), 1e-5);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows").before;
        let cubic = EffectKind::CubicStiffness.variant(None).expect("a kind without variants");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Effect(cubic)]);
        let named = try_hypothesis(&trials.data, h, &wall).expect("a wall");
        trials.relatives(&named).better.map(|kin| kin.laws[0])
    }

    #[test]
    fn analytic_a_spring_of_the_ground_is_no_cubic_one_of_the_top() {
        let of_ground = "[[effects]]\nkind = \"formula\"\nplace = \"ground\"\n\
                         moment_n_m = \"-k*sign(phi)*abs(phi)**2.45\"\n[effects.parameters]\n\
                         k = { value = 4e7, unit = \"N*m\" }\n";
        let law = instead_of_cubic(of_ground).expect("a law");
        assert_eq!((law.first.site, law.first.shape), (Site::Ground, Shape::Spring), "{law:?}");
        // By its own interval some 0.01.
        assert!((law.first.numbers[0] - 2.45).abs() < 0.05, "{law:?}");
        let cubic = "[[effects]]\nkind = \"cubic_stiffness\"\ncoefficient_n_per_m3 = 2e6\n";
        assert_eq!(instead_of_cubic(cubic), None, "it is one");
    }
}
