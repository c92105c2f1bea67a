//! Laws of which an effect of the catalogue is the case of one exponent: a name must not stand where another exponent does
//! clearly better.

use super::equals::difference;
use super::fitted::{LOOK_STEPS, Start, beside};
use super::points::Points;
use super::search::Equations;
use crate::Progress;
use crate::diagnose::fit::nats;
use crate::diagnose::formula::{Atom, Law, Shape, Side, Site};
use crate::diagnose::hypothesis::{Addition, Hypothesis};
use crate::diagnose::trials::{FittedHypothesis, Trials, against, refit, shared_states};
use crate::limits::{OTHER_FORCE, WORTH_A_NAME};
use mrbd_kernel::model::{EffectKind, Joint};
use nalgebra::DVector;
use rayon::prelude::*;

/// Exponents of displacement and of velocity at which damping that grows with displacement is looked at.
const OPENINGS: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, 2.0], [2.0, 1.0], [2.0, 2.0]];
/// Exponents from which that of a name is looked for: near impacts that the noise decides a fit from that of the name may
/// stay in its valley.
pub(super) const EXPONENTS: [f64; 4] = [0.5, 1.5, 2.0, 4.0];

/// Steps of an exponent about that of a law, from which it is fitted again.
const ABOUT: [f64; 4] = [-0.5, -0.25, 0.25, 0.5];

/// What does better than a name.
#[derive(Debug, Clone)]
pub struct Kin {
    /// The law, and others that may be behind it.
    pub laws: Vec<Law>,
    /// The name with it in the place of one effect, or two.
    pub fitted: FittedHypothesis,
}

impl<P: Progress> Trials<'_, P> {
    /// The laws that do better than one effect of a name, if its exponent set free does.
    pub(super) fn freed(&self, named: &FittedHypothesis, power: &Power, points: &Points) -> Option<Kin> {
        let law = Law::of(power.atom(points.reach[power.site as usize]));
        let equations = Equations::even(points);
        let of_name = exponents(law).filter_map(|other| Some((as_large(other, &law, points)?, None)));
        let of_points = exponents(law).filter_map(|other| equations.fitted(&other)).filter_map(|found| {
            let steps = equations.wall_steps(&found.law)?;
            Some((found.law, Some(steps)))
        });
        let all = of_name.chain(of_points).collect::<Vec<_>>();
        let look = |(start, steps): &(Law, Option<DVector<f64>>)| {
            self.start_in_place_of(named, (power.index, start), steps.as_ref())
        };
        let found = all.par_iter().filter_map(|one| Some((one.0.first.numbers[0], look(one)?)));
        let found = found.collect::<Vec<_>>();
        // Where a joint opens briefly a first look tells little of an exponent, and a fit ends in a valley of the windows near where it began.
        let opens_briefly = points.opens_briefly(power.site);
        let starts = match opens_briefly {
            true => found.into_iter().map(|(_, start)| start).collect(),
            false => nearest_on_either_side(power.exponent, found),
        };
        let fit = |start: Start| self.fitted_beside(named, start);
        let found = starts.into_par_iter().filter_map(fit).collect::<Vec<_>>();
        let mut found = self.ordered(found).into_iter().next()?;
        if opens_briefly {
            found = self.again_about(found, power.index, points);
        }
        let free = *found.hypothesis.laws(&found.fit.values).first()?;
        let better = self.does_clearly_better(named, &found) && difference(points, &law, &free) > OTHER_FORCE;
        better.then(|| Kin { laws: with_openings(free, points), fitted: found })
    }

    /// A law in the place of an effect fitted once more from exponents about its own, about as large: the best.
    fn again_about(&self, found: FittedHypothesis, index: usize, points: &Points) -> FittedHypothesis {
        let Some(law) = found.hypothesis.laws(&found.fit.values).first().copied() else { return found };
        let from = |step: &f64| {
            let [least, most] = law.first.bounds(0);
            let n = (law.first.numbers[0] + step).clamp(least, most);
            let start = as_large(Law::of(Atom { numbers: [n, 0.0], ..law.first }), &law, points)?;
            let start = self.start_beside(&found, &found.hypothesis.additions, (index, &start), None)?;
            self.fitted_beside(&found, start)
        };
        let others = ABOUT.par_iter().filter_map(from).collect::<Vec<_>>();
        self.ordered(others.into_iter().chain([found]).collect()).swap_remove(0)
    }

    /// Fitted from where it starts; with the states of the windows of a name where these are better.
    pub(super) fn fitted_beside(&self, named: &FittedHypothesis, start: Start) -> Option<FittedHypothesis> {
        let name = start.hypothesis.name();
        self.within_budget(&name, start.values.len(), |data| {
            let found = refit(data, start.hypothesis, named, &start.values)?;
            Some(shared_states(data, &found, &[named]))
        })
    }

    /// Whether it gains over a name what a name must, and follows the tests held out no worse.
    pub(super) fn does_clearly_better(&self, named: &FittedHypothesis, found: &FittedHypothesis) -> bool {
        let [before, after] = [named, found].map(|tried| tried.against(&self.data)[1]);
        against(&self.data, named) - against(&self.data, found) > WORTH_A_NAME && after <= before
    }

    /// A name fitted on with the exponent of one of its effects free; `None` of one that is no power, and where such a fit takes more work
    /// than it may.
    pub fn with_exponent_of_name_free(
        &self,
        named: &FittedHypothesis,
        index: usize,
    ) -> Option<FittedHypothesis> {
        let power = power(named, index)?;
        let points = self.points(named)?;
        let law = Law::of(power.atom(points.reach[power.site as usize]));
        let mut additions = named.hypothesis.additions.clone();
        additions[index] = Addition::Formula(law);
        let hypothesis = self.hypothesis(&self.experiment.nuisances, &additions);
        let values = values_beside(&hypothesis, named, index, &law);
        let name = hypothesis.name();
        self.within_budget(&name, values.len(), |data| refit(data, hypothesis, named, &values))
    }

    /// A law in the place of one effect of a name, as [`Trials::start_beside`] has it.
    pub(super) fn start_in_place_of(
        &self,
        named: &FittedHypothesis,
        (index, law): (usize, &Law),
        steps: Option<&DVector<f64>>,
    ) -> Option<Start> {
        let mut additions = named.hypothesis.additions.clone();
        additions[index] = Addition::Formula(*law);
        self.start_beside(named, &additions, (index, law), steps)
    }

    /// Additions in the place of those of a name, one of which is a law, with steps of the wall's numbers where points tell them, and how well
    /// windows follow them so, their states fitted.
    pub(super) fn start_beside(
        &self,
        named: &FittedHypothesis,
        additions: &[Addition],
        (index, law): (usize, &Law),
        steps: Option<&DVector<f64>>,
    ) -> Option<Start> {
        let hypothesis = self.hypothesis(&self.experiment.nuisances, additions);
        let mut values = values_beside(&hypothesis, named, index, law);
        if let Some(steps) = steps.filter(|steps| steps.len() == hypothesis.nuisances) {
            let wall = beside(&hypothesis, steps).collect::<Vec<_>>();
            values[..wall.len()].copy_from_slice(&wall);
        }
        let fit = self.data.fit.states(&hypothesis, &values, &named.states(), LOOK_STEPS, false)?;
        Some(Start { nats: nats(&fit.windows), hypothesis, values })
    }
}

/// A law with other exponents.
fn exponents(law: Law) -> impl Iterator<Item = Law> {
    let grid = law.first.shape.numbers()[0].grid;
    let others = EXPONENTS.into_iter().filter(move |n| grid[0] <= *n && *n <= grid[grid.len() - 1]);
    others.map(move |n| Law::of(Atom { numbers: [n, 0.0], ..law.first }))
}

/// Of starts with their exponents the best with less than the own and the best with more.
fn nearest_on_either_side(own: f64, found: Vec<(f64, Start)>) -> Vec<Start> {
    let (less, more): (Vec<_>, Vec<_>) = found.into_iter().partition(|(n, _)| *n < own);
    let best = |side: Vec<(f64, Start)>| {
        side.into_iter().map(|(_, start)| start).min_by(|a, b| a.nats.total_cmp(&b.nats))
    };
    [less, more].into_iter().filter_map(best).collect()
}

/// A law of one atom, of the size that brings its force nearest to that of another over what was excited. `None` where nothing of either
/// was, or no size does.
pub(super) fn as_large(law: Law, other: &Law, points: &Points) -> Option<Law> {
    let unit = Atom { size: 1.0, ..law.first };
    let [own, others] = [Law::of(unit), *other].map(|law| points.forces(&law, unit.site));
    let sum = |[own, with]: [f64; 2], [one, other]: [f64; 2]| [own + one * one, with + one * other];
    let both = own.into_iter().zip(others).map(|(own, other)| [own, other]);
    let [own, with] = both.fold([0.0; 2], sum);
    let size = with / own;
    size.is_normal().then(|| Law::of(Atom { size, ..unit }))
}

/// Exponents of the catalogue nearer than this are its own.
const NEAR_EXPONENT: f64 = 0.15;

/// Whether every atom of a law is a power that the catalogue has, or nearly.
pub fn is_of_catalogue(law: &Law) -> bool {
    let own = |atom: &Atom| -> &[f64] {
        match atom.shape {
            Shape::Drag => &[0.0, 1.0],
            Shape::Spring => &[3.0],
            Shape::OneSidedSpring(_) => &[1.0],
            _ => &[],
        }
    };
    law.atoms().all(|atom| own(&atom).iter().any(|n| (atom.numbers[0] - n).abs() < NEAR_EXPONENT))
}

/// Values of a hypothesis in which a law stands for an effect of another.
fn values_beside(h: &Hypothesis, named: &FittedHypothesis, index: usize, law: &Law) -> Vec<f64> {
    let mut values = h.values_from(&named.hypothesis, &named.fit.values);
    let own = (0..values.len()).filter(|i| h.unknowns[*i].belongs_to(index));
    for (i, value) in own.zip(law.values()) {
        values[i] = h.unknowns[i].within(value);
    }
    values
}

/// A law, and beside a damper those that grow with displacement, of about its force.
fn with_openings(free: Law, points: &Points) -> Vec<Law> {
    let opening = |numbers: [f64; 2]| {
        as_large(Law::of(Atom { shape: Shape::Opening, numbers, ..free.first }), &free, points)
    };
    let openings = OPENINGS.into_iter().filter(|_| free.first.shape == Shape::Drag).filter_map(opening);
    std::iter::once(free).chain(openings).collect()
}

/// An effect that is a power of displacement or of velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Power {
    /// Which addition it is.
    pub index: usize,
    /// Where it acts.
    pub site: Site,
    shape: Shape,
    /// Its exponent in the catalogue.
    exponent: f64,
    /// N/m^n, N (s/m)^n, or the same of moments and rotations.
    coefficient: f64,
}

impl Power {
    /// The law that it is, of what is excited so far.
    pub fn atom(&self, reach: [f64; 2]) -> Atom {
        let of = reach[usize::from(self.shape == Shape::Drag)];
        Atom {
            site: self.site,
            shape: self.shape,
            numbers: [self.exponent, 0.0],
            size: self.coefficient * of.powf(self.exponent),
            reach,
            is_exact: false,
        }
    }
}

/// The exponent of an effect of a name that is a power of displacement or of velocity.
pub fn exponent_of(named: &FittedHypothesis, index: usize) -> Option<f64> {
    power(named, index).map(|power| power.exponent)
}

/// What power an addition of a fitted hypothesis is; `None` for another effect. Friction is a power of velocity at its end:
/// nothing lies beyond, and what nearly jumps is not fitted.
pub(super) fn power(named: &FittedHypothesis, index: usize) -> Option<Power> {
    let h = &named.hypothesis;
    let addition = &h.additions[index];
    let Addition::Effect(variant) = addition else { return None };
    let (site, shape, exponent) = match (variant.kind, variant.choice) {
        (EffectKind::CubicStiffness, _) => (Site::Top, Shape::Spring, 3.0),
        (EffectKind::ViscousDamping, _) => (Site::Top, Shape::Drag, 1.0),
        (EffectKind::OneSidedSpring, Some("positive")) => {
            (Site::Top, Shape::OneSidedSpring(Side::Positive), 1.0)
        }
        (EffectKind::OneSidedSpring, Some("negative")) => {
            (Site::Top, Shape::OneSidedSpring(Side::Negative), 1.0)
        }
        (EffectKind::JointDamping, _) => match addition.joint()? {
            Joint::Ground => (Site::Ground, Shape::Drag, 1.0),
            Joint::Crack => (Site::Crack, Shape::Drag, 1.0),
        },
        _ => return None,
    };
    let number = (0..h.unknowns.len()).find(|i| h.unknowns[*i].belongs_to(index))?;
    let coefficient = h.unknowns[number].number(named.fit.values[number]);
    Some(Power { index, site, shape, exponent, coefficient })
}

#[cfg(test)]
mod tests {
    use super::super::twin::{Twin, drag, points_with, wall_with};
    use super::*;
    use crate::diagnose::certainty::intervals;
    use crate::diagnose::fit::Fit;
    use crate::diagnose::hypothesis::example::starter_with;
    use crate::diagnose::trials::try_hypothesis;

    const CUBIC: &str = "[[effects]]\nkind = \"cubic_stiffness\"\ncoefficient_n_per_m3 = 2e6\n";

    /// An effect of the starter's wall with this first number.
    fn named(name: &str, value: f64) -> FittedHypothesis {
        let of = |values| Fit { values, windows: Vec::new(), cost: 0.0, covariance: None };
        FittedHypothesis { hypothesis: starter_with(&[name]), fit: of(vec![value]), held_out: of(vec![]) }
    }

    #[test]
    fn analytic_a_power_of_the_catalogue_is_its_law_with_that_exponent() {
        let motion = [0.03, -0.2, 0.05];
        let force = |name: &str, value: f64| {
            let power = power(&named(name, value), 0).expect("a power");
            power.atom([0.05, 0.3]).force(motion)
        };
        // A few roundings of some tens of newtons.
        let same = |one: f64, other: f64| assert!((one - other).abs() < 1e-10, "{one} {other}");
        same(force("cubic_stiffness", 2e6), -2e6 * 0.03_f64.powi(3));
        same(force("viscous_damping", 700.0), 700.0 * 0.2);
        same(force("one_sided_spring.positive", 900.0), -900.0 * 0.03);
        same(force("one_sided_spring.negative", 900.0), 0.0);
        same(force("joint_damping.ground", 50.0), 50.0 * 0.2);
        assert_eq!(power(&named("gap", 0.01), 0), None);
    }

    /// A cubic spring fitted to the windows of a wall.
    fn as_cubic<P: Progress>(trials: &Trials<P>) -> FittedHypothesis {
        let wall = trials.wall_fits(None).expect("windows").before;
        let cubic = EffectKind::CubicStiffness.variant(None).expect("a kind without variants");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Effect(cubic)]);
        try_hypothesis(&trials.data, h, &wall).expect("a wall")
    }

    /// Laws that do better than a cubic spring fitted to the windows of a wall with an effect.
    fn kin_of_cubic(effect: &str) -> Vec<Law> {
        let twin = Twin::new(&wall_with(effect), 1e-5);
        let trials = twin.trials();
        trials.relatives(&as_cubic(&trials)).better.map_or(Vec::new(), |kin| kin.laws)
    }

    #[test]
    fn analytic_the_exponent_of_a_name_is_told_as_well_as_noise_lets_it() {
        let width = |noise_rad: f64| {
            let twin = Twin::new(&wall_with(CUBIC), noise_rad);
            let trials = twin.trials();
            let named = as_cubic(&trials);
            assert_eq!(exponent_of(&named, 0), Some(3.0));
            let free = trials.with_exponent_of_name_free(&named, 0).expect("a power");
            let [.., [low, high]] = intervals(&trials.data, &free)[..] else { panic!("no numbers") };
            assert!(low < 3.0 && 3.0 < high, "{low} to {high} at {noise_rad} rad");
            high - low
        };
        let [quiet, loud] = [1e-5, 1e-4].map(width);
        assert!(loud > 3.0 * quiet, "{quiet} and {loud}");
        let twin = Twin::new(&wall_with(CUBIC), 1e-4);
        let trials = twin.trials();
        let gap = EffectKind::Gap.variant(None).expect("a kind without variants");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Effect(gap)]);
        let gap = FittedHypothesis { hypothesis: h, ..as_cubic(&trials) };
        assert!(trials.with_exponent_of_name_free(&gap, 0).is_none(), "no power");
    }

    #[test]
    fn analytic_a_spring_of_another_exponent_keeps_no_name_of_a_cubic_one() {
        let squared = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-k*x*abs(x)\"\n\
                       [effects.parameters]\nk = { value = 60000.0, unit = \"N/m**2\" }\n";
        let kin = kin_of_cubic(squared);
        let [free] = &kin[..] else { panic!("one law beside the name: {kin:?}") };
        assert_eq!(free.first.shape, Shape::Spring);
        // Noise leaves an exponent of a force that is seen so well open to far less.
        assert!((free.first.numbers[0] - 2.0).abs() < 0.1, "{free:?}");
        assert_eq!(kin_of_cubic(CUBIC), []);
    }

    #[test]
    fn analytic_powers_near_those_of_the_catalogue_are_its_own() {
        assert!(is_of_catalogue(&drag(0.0, 300.0)) && is_of_catalogue(&drag(1.1, 300.0)));
        assert!(!is_of_catalogue(&drag(0.5, 300.0)) && !is_of_catalogue(&drag(2.0, 300.0)));
        let spring = |n: f64| Law::of(Atom { shape: Shape::Spring, ..drag(n, 300.0).first });
        assert!(is_of_catalogue(&spring(2.9)) && !is_of_catalogue(&spring(1.0)));
        // Of two atoms both must be.
        let both = |one: Law, two: Law| Law { second: Some(two.first), ..one };
        assert!(is_of_catalogue(&both(drag(1.0, 300.0), spring(3.0))));
        assert!(!is_of_catalogue(&both(drag(1.0, 300.0), spring(2.0))));
    }

    #[test]
    fn analytic_damping_that_grows_with_displacement_is_looked_at_with_the_force_of_the_damper() {
        let law = drag(1.0, 300.0);
        let points = points_with(&law, |_| 1.0);
        let kin = with_openings(law, &points);
        assert_eq!(kin.len(), 1 + OPENINGS.len());
        for one in &kin[1..] {
            let dot = |f: &dyn Fn([f64; 3]) -> f64| points.excited(Site::Top).map(f).sum::<f64>();
            let own = dot(&|m| one.first.force(m).powi(2));
            let with = dot(&|m| one.first.force(m) * law.first.force(m));
            // The nearest force of that shape: what it leaves is square to it.
            assert!((with / own - 1.0).abs() < 1e-9 && one.first.size > 0.0, "{one:?}");
        }
        // Nor has a damper of a joint that does not turn: its force is none of a size.
        let still = Law::of(Atom { reach: [f64::MIN_POSITIVE; 2], size: 0.0, ..law.first });
        assert_eq!(with_openings(still, &points), [still]);
        // A spring has none.
        let spring = Law::of(Atom { shape: Shape::Spring, ..law.first });
        assert_eq!(with_openings(spring, &points), [spring]);
    }
}
