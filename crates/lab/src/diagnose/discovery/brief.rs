//! Joints that open too briefly for points.
//!
//! A wall that swings as a whole opens its crack for some hundredths of a second after impacts. No stretch between these is long enough for
//! a test function, so points have no row in which the crack turns; windows go through impacts, and said 130 natural logarithms more of another
//! damper there than of the catalogue's, and 214 more of a spring, where that damper was named. How a joint turns is known from windows alone.

use super::fitted::Start;
use super::kin::{Kin, Power};
use super::points::Points;
use crate::Progress;
use crate::diagnose::formula::{Atom, Law, Shape, Site};
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::{FittedHypothesis, Trials, against};
use crate::diagnose::verdict::leaves_noise;
use crate::limits::{BRIEF_LAWS, WORTH_A_LAW_IN_NOISE};
use mrbd_kernel::model::{EffectKind, G_M_S2};
use rayon::prelude::*;

/// Moment of the first law tried in the place of impacts, over what rights the wall: a few percent show there, and [`SIZES`] go about them.
const OF_RIGHTING: f64 = 0.03;
/// Sizes at which another law than a name's is tried, over the size of which its moments are as large.
const SIZES: [f64; 3] = [0.3, 1.0, 3.0];

impl<P: Progress> Trials<'_, P> {
    /// Points of the tests fitted under the wall, with how joints turn in windows under a hypothesis where no point shows it. `None` where
    /// no stretch is long enough for points.
    pub(super) fn points(&self, seen_by: &FittedHypothesis) -> Option<Points> {
        let wall = self.hypothesis(&self.experiment.nuisances, &[]);
        let points = Points::new(self.data.fit.tests, &wall)?;
        let is_silent = points.silent_joints().next().is_some();
        let motion = || self.data.fit.joint_motion(&seen_by.hypothesis, &seen_by.fit);
        Some(match is_silent.then(motion).flatten() {
            Some(motion) => points.with_brief(motion),
            None => points,
        })
    }

    /// A law of another shape in the place of a damper that is named at a joint which opens briefly, if it gains over the name what a name
    /// must: points, which would tell a moment that goes with rotation from one that goes with velocity, have no row of it.
    pub(super) fn other_at_brief_joint(
        &self,
        named: &FittedHypothesis,
        power: &Power,
        points: &Points,
    ) -> Option<Kin> {
        if !points.opens_briefly(power.site) {
            return None;
        }
        let own = power.atom(points.reach[power.site as usize]);
        self.best_in_place_of(named, power.index, &others_at(&own, points))
    }

    /// A law of the crack that opens briefly in the place of impacts that keep other shares, if these leave more than noise, and it gains over
    /// them what a law must that shows in few windows: both act at impacts, and of the crack's moment no point has a row.
    pub(super) fn crack_in_place_of_impacts(&self, named: &FittedHypothesis, points: &Points) -> Option<Kin> {
        if !acts_at_impacts_alone(named) || !points.opens_briefly(Site::Crack) || leaves_noise(named) {
            return None;
        }
        let p = self.experiment.wall.parameters();
        let size = OF_RIGHTING * p.mass_kg * G_M_S2 * p.thickness_m / 2.0;
        let reach = points.reach[Site::Crack as usize];
        let damper =
            Atom { site: Site::Crack, shape: Shape::Drag, numbers: [1.0, 0.0], size, reach, is_exact: false };
        let laws = [vec![Law::of(damper)], others_at(&damper, points)].concat();
        let gain = |kin: &Kin| against(&self.data, named) - against(&self.data, &kin.fitted);
        self.best_in_place_of(named, 0, &laws).filter(|kin| gain(kin) > WORTH_A_LAW_IN_NOISE)
    }

    /// The best of laws in the place of an effect of a name, if it gains over that what a name must.
    fn best_in_place_of(&self, named: &FittedHypothesis, index: usize, laws: &[Law]) -> Option<Kin> {
        self.progress.begin("other laws of a joint that opens briefly", laws.len());
        let look = |law: &Law| {
            let start = self.start_in_place_of(named, (index, law), None);
            self.progress.advance(1);
            start
        };
        let mut starts = laws.par_iter().filter_map(look).collect::<Vec<Start>>();
        starts.sort_by(|a, b| a.nats.total_cmp(&b.nats));
        starts.truncate(BRIEF_LAWS);
        let found = starts.into_par_iter().filter_map(|start| self.fitted_beside(named, start));
        let fitted = self.ordered(found.collect()).into_iter().next()?;
        let law = *fitted.hypothesis.laws(&fitted.fit.values).first()?;
        self.does_clearly_better(named, &fitted).then(|| Kin { laws: vec![law], fitted })
    }
}

/// Whether all that a name has is that impacts keep other shares.
pub(super) fn acts_at_impacts_alone(named: &FittedHypothesis) -> bool {
    let is_it = |addition: &Addition| addition.kind() == Some(EffectKind::ImpactDissipation);
    matches!(&named.hypothesis.additions[..], [only] if is_it(only))
}

/// Laws of other shapes at a joint, with moments about as large over what was excited as those of an atom there.
fn others_at(own: &Atom, points: &Points) -> Vec<Law> {
    let squares = |atom: &Atom| {
        points.forces(&Law::of(*atom), own.site).into_iter().map(|moment| moment * moment).sum::<f64>()
    };
    let of_own = squares(own);
    let numbers = |shape: Shape| match shape {
        Shape::Spring => &[1.0, 2.0][..],
        Shape::Saturation | Shape::DragSaturation => &[0.1, 0.4][..],
        _ => &[],
    };
    let atom = |(shape, number)| Atom { shape, numbers: [number, 0.0], size: 1.0, is_exact: false, ..*own };
    let shapes = Shape::AT_JOINTS.into_iter().filter(|shape| *shape != own.shape);
    let atoms = shapes.flat_map(|shape| numbers(shape).iter().map(move |n| (shape, *n))).map(atom);
    let sized = atoms.flat_map(|atom| {
        let as_large = (of_own / squares(&atom)).sqrt();
        SIZES.map(|share| Law::of(Atom { size: share * as_large, ..atom }))
    });
    sized.filter(|law| law.first.size.is_normal()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::twin::{Twin, wall_with};
    use super::*;
    use crate::diagnose::hypothesis::candidates;
    use crate::diagnose::trials::try_hypothesis;

    /// A law of the crack, with its coefficient in its unit.
    fn of_crack(moment: &str, k: f64, unit: &str) -> String {
        format!(
            "[[effects]]\nkind = \"formula\"\nplace = \"crack\"\nmoment_n_m = \"{moment}\"\n\
             [effects.parameters]\nk = {{ value = {k:?}, unit = \"{unit}\" }}\n"
        )
    }

    /// What is told instead of a damper of the crack, fitted to the windows of a wall with effects.
    fn instead_of_damper(effects: &str) -> Option<Law> {
        let damper = EffectKind::JointDamping.variant(Some("crack")).expect("a damper of the crack");
        instead_of(Addition::Effect(damper), effects)
    }

    /// The same instead of impacts that keep other shares.
    fn instead_of_impacts(effects: &str) -> Option<Law> {
        let name = |addition: &Addition| addition.name() == "impact_dissipation";
        let all = candidates(wall_with("").parameters());
        instead_of(all.into_iter().find(name).expect("of the catalogue"), effects)
    }

    fn instead_of(name: Addition, effects: &str) -> Option<Law> {
        let twin = Twin::opening_briefly(&wall_with(effects), 3e-5);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows").before;
        let h = trials.hypothesis(&trials.experiment.nuisances, &[name]);
        let named = try_hypothesis(&trials.data, h, &wall).expect("a wall");
        let points = trials.points(&named).expect("points");
        assert_eq!(Site::ALL.map(|site| points.opens_briefly(site)), [false, false, true]);
        let [[least, most], _] = points.range(Site::Crack);
        assert!(least < 0.0 && most > 0.0 && most.max(-least) < 1.1 * points.reach[Site::Crack as usize][0]);
        trials.relatives(&named).better.map(|kin| kin.laws[0])
    }

    #[test]
    fn analytic_a_damper_of_another_exponent_at_a_joint_that_opens_briefly_keeps_no_name_of_a_viscous_one() {
        let squared = instead_of_damper(&of_crack("-k*w*abs(w)", 3e4, "N*m*s**2")).expect("a law");
        assert_eq!((squared.first.site, squared.first.shape), (Site::Crack, Shape::Drag));
        // 1.99 by this noise.
        assert!((squared.first.numbers[0] - 2.0).abs() < 0.05, "{squared:?}");
        assert_eq!(instead_of_damper(&of_crack("-k*w", 500.0, "N*m*s")), None, "it is one");
    }

    #[test]
    fn analytic_a_spring_at_a_joint_that_opens_briefly_is_no_damper() {
        let spring = instead_of_damper(&of_crack("-k*phi", 2e4, "N*m")).expect("a law");
        assert_eq!((spring.first.site, spring.first.shape), (Site::Crack, Shape::Spring));
        assert!((spring.first.numbers[0] - 1.0).abs() < 0.01, "{spring:?}");
        let stiffness = spring.first.size / spring.first.reach[0];
        assert!((stiffness / 2e4 - 1.0).abs() < 0.02, "{stiffness} N m");
    }

    #[test]
    fn analytic_a_spring_at_a_joint_that_opens_briefly_is_none_of_impacts_that_keep_other_shares() {
        let spring = instead_of_impacts(&of_crack("-k*phi", 2e4, "N*m")).expect("a law");
        assert_eq!((spring.first.site, spring.first.shape), (Site::Crack, Shape::Spring));
        assert!((spring.first.numbers[0] - 1.0).abs() < 0.01, "{spring:?}");
        let impacts = "[[effects]]\nkind = \"impact_dissipation\"\nfactors = [0.9, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9]\n";
        assert_eq!(instead_of_impacts(impacts), None, "they are");
    }
}
