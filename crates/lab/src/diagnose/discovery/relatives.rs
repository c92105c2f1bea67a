//! Laws that stand in the place of the effects of a name, and do better or as well.

use super::brief::acts_at_impacts_alone;
use super::kin::{Kin, power};
use crate::Progress;
use crate::diagnose::trials::{FittedHypothesis, Trials, against};

/// What laws do in the place of the effects of a name.
#[derive(Debug, Default)]
pub struct Relatives {
    /// What does better: the name does not stand.
    pub better: Option<Kin>,
    /// The name with a spring of the ground in the place of one of the top, as it is fitted.
    pub of_ground: Option<FittedHypothesis>,
}

impl<P: Progress> Trials<'_, P> {
    /// Laws beside a name of which an effect is clearly a wrong case: its exponent set free, in the windows, gains what a
    /// name must and makes another force, and the tests held out are followed no worse; or one in the place of two effects, of
    /// another shape at a joint that opens briefly, or at the ground.
    pub fn relatives(&self, named: &FittedHypothesis) -> Relatives {
        let all = 0..named.hypothesis.additions.len();
        let powers = all.filter_map(|index| power(named, index)).collect::<Vec<_>>();
        let may_be_none = !powers.is_empty() || acts_at_impacts_alone(named);
        let points = if may_be_none { self.points(named) } else { None };
        let Some(points) = points else { return Relatives::default() };
        self.progress.begin("the name with its exponent free", powers.len());
        let freed = powers.iter().map(|power| self.freed(named, power, &points));
        let one = freed.inspect(|_| self.progress.advance(1)).find_map(|kin| kin);
        let one = one.or_else(|| self.one_for_friction_and_damper(named, &points));
        // A damper with its exponent free may do better than a name in the place of a spring, and the spring better still.
        let other = powers.iter().find_map(|power| self.other_at_brief_joint(named, power, &points));
        let other = other.or_else(|| self.crack_in_place_of_impacts(named, &points));
        let of_ground = powers.iter().find_map(|power| self.spring_of_ground(named, power, &points));
        let there = of_ground.as_ref().and_then(|of_ground| self.better_of_ground(named, of_ground));
        let nats = |kin: &Kin| against(&self.data, &kin.fitted);
        let better = [one, other, there].into_iter().flatten().min_by(|a, b| nats(a).total_cmp(&nats(b)));
        Relatives { better, of_ground }
    }
}
