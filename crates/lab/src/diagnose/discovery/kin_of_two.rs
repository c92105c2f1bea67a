//! One power of velocity in the place of friction and a damper: together these stand for any power between them. So does a spring that yields
//! at once, which is friction.

use super::kin::{Kin, as_large};
use super::points::Points;
use crate::Progress;
use crate::diagnose::formula::{Atom, Law, Shape, Site};
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::{FittedHypothesis, Trials};
use mrbd_kernel::model::EffectKind;
use rayon::prelude::*;

/// Exponents of velocity at which it is looked for.
const BETWEEN: [f64; 3] = [0.3, 0.5, 0.7];

impl<P: Progress> Trials<'_, P> {
    /// The power of the floor's velocity that does better than friction and a damper of a name, by what a name must gain, and follows the
    /// tests held out no worse. `None` where these stand, or a name has not both.
    pub(super) fn one_for_friction_and_damper(
        &self,
        named: &FittedHypothesis,
        points: &Points,
    ) -> Option<Kin> {
        const FRICTION: [EffectKind; 2] = [EffectKind::CoulombFriction, EffectKind::YieldingSpring];
        let (friction, force_n) = coefficient(named, &FRICTION, "force_n")?;
        let (damper, n_s_m) = coefficient(named, &[EffectKind::ViscousDamping], "n_s_per_m")?;
        let reach = points.reach[Site::Top as usize];
        let drag = |n: f64, size: f64| Atom {
            site: Site::Top,
            shape: Shape::Drag,
            numbers: [n, 0.0],
            size,
            reach,
            is_exact: false,
        };
        let law = Law { second: Some(drag(1.0, n_s_m * reach[1])), ..Law::of(drag(0.0, force_n)) };
        let others = named.hypothesis.additions.iter().enumerate();
        let others = others.filter(|(index, _)| ![friction, damper].contains(index)).map(|(_, one)| *one);
        let others = others.collect::<Vec<_>>();
        let starts = BETWEEN.par_iter().filter_map(|n| {
            let one = as_large(Law::of(drag(*n, 1.0)), &law, points)?;
            let additions = [&others[..], &[Addition::Formula(one)]].concat();
            self.start_beside(named, &additions, (others.len(), &one), None)
        });
        let start = starts.min_by(|a, b| a.nats.total_cmp(&b.nats))?;
        let found = self.fitted_beside(named, start)?;
        let laws = found.hypothesis.laws(&found.fit.values).into_iter().take(1).collect::<Vec<_>>();
        (!laws.is_empty() && self.does_clearly_better(named, &found)).then_some(Kin { laws, fitted: found })
    }
}

/// Which addition of a fitted hypothesis is an effect of these kinds, and its number whose key ends so, in its unit.
fn coefficient(named: &FittedHypothesis, kinds: &[EffectKind], key: &str) -> Option<(usize, f64)> {
    let h = &named.hypothesis;
    let is_it =
        |addition: &Addition| matches!(addition, Addition::Effect(variant) if kinds.contains(&variant.kind));
    let index = h.additions.iter().position(is_it)?;
    let is_asked = |i: &usize| h.unknowns[*i].belongs_to(index) && h.unknowns[*i].key.ends_with(key);
    let number = (0..h.unknowns.len()).find(is_asked)?;
    Some((index, h.unknowns[number].number(named.fit.values[number])))
}

#[cfg(test)]
mod tests {
    use super::super::twin::{Twin, wall_with};
    use super::*;
    use crate::diagnose::trials::try_hypothesis;

    /// The power that does better than friction, or a spring that yields, and a damper fitted to the windows of a wall with effects.
    fn one_for_both(friction: EffectKind, effects: &str) -> Option<Law> {
        let twin = Twin::new(&wall_with(effects), 3e-5);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows").before;
        let effect =
            |kind: EffectKind| Addition::Effect(kind.variant(None).expect("a kind without variants"));
        let both = [friction, EffectKind::ViscousDamping].map(effect);
        let h = trials.hypothesis(&trials.experiment.nuisances, &both);
        let named = try_hypothesis(&trials.data, h, &wall).expect("a wall");
        let wall = trials.hypothesis(&trials.experiment.nuisances, &[]);
        let points = Points::new(trials.data.fit.tests, &wall).expect("points");
        trials.one_for_friction_and_damper(&named, &points).map(|kin| kin.laws[0])
    }

    #[test]
    fn analytic_a_power_between_friction_and_a_damper_is_told_in_the_place_of_both() {
        let root = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-c*sign(v)*abs(v)**0.4\"\n\
                    [effects.parameters]\nc = { value = 900.0, unit = \"N*(s/m)**0.4\" }\n";
        for friction in [EffectKind::CoulombFriction, EffectKind::YieldingSpring] {
            let one = one_for_both(friction, root).expect("a power");
            assert!((one.first.numbers[0] - 0.4).abs() < 0.05 && one.second.is_none(), "{one:?}");
        }
        let both = "[[effects]]\nkind = \"coulomb_friction\"\nforce_n = 300.0\n\
                    [[effects]]\nkind = \"viscous_damping\"\ncoefficient_n_s_per_m = 1500.0\n";
        assert_eq!(one_for_both(EffectKind::CoulombFriction, both), None);
    }
}
