//! What holds the top of a wall sideways: nothing, a rigid support, or the springs of its wall file.

use mrbd_kernel::model::{RockingWall, Wall};

use crate::chain::{Chain, Side};

/// Stiffness of a rigid support over W/b. It gives by 1e-7 of the thickness, which changes no force by more than that share;
/// a stiffer one would lose the digits of the top's position (1e-16 of the height).
const RIGID: f64 = 1e7;

/// What holds the top.
#[derive(Debug, Clone)]
pub enum Restraint {
    /// Nothing.
    Free,
    /// A support that does not give.
    Held,
    /// k_d and the springs among the effects.
    Springs(Box<Springs>),
}

/// The springs at the top of a wall.
#[derive(Debug, Clone)]
pub struct Springs {
    wall: Wall,
    rocking: RockingWall,
    side: Side,
}

/// How far apart the forces of two displacements are looked at to tell whether anything holds the top, shares of b.
const PROBES: [f64; 4] = [0.01, 0.1, 0.5, 1.0];

impl Restraint {
    /// Of the wall file, for a wall that moves to a side: k_d, and effects whose force depends on the displacement.
    ///
    /// Dampers and friction do not count: a static check may not rely on them.
    pub fn of(wall: &Wall, side: Side) -> Self {
        let springs = Springs { wall: wall.clone(), rocking: RockingWall::new(wall), side };
        let thickness_m = wall.parameters().thickness_m;
        let holds = PROBES.iter().any(|share| springs.force_n(share * thickness_m, 0.0) != 0.0);
        if holds { Self::Springs(Box::new(springs)) } else { Self::Free }
    }

    /// Whether the top is free.
    pub fn is_free(&self) -> bool {
        matches!(self, Self::Free)
    }

    /// Force on the wall at a displacement of the top towards the side of the fall, N; negative where it holds back.
    pub fn force_n(&self, chain: &Chain, top_m: f64, plastic_m: f64) -> f64 {
        match self {
            Self::Free => 0.0,
            Self::Held => -RIGID * chain.weight_n() / chain.joints[0].width_m * top_m,
            Self::Springs(springs) => springs.force_n(top_m, plastic_m),
        }
    }

    /// Plastic displacement once the top has been displaced so far, m.
    pub fn plastic_m(&self, before_m: f64, top_m: f64) -> f64 {
        match self {
            Self::Springs(springs) => {
                let sign = springs.side.sign();
                sign * springs.wall.plastic_displacement_m(sign * before_m, sign * top_m)
            }
            _ => 0.0,
        }
    }
}

impl Springs {
    fn force_n(&self, top_m: f64, plastic_m: f64) -> f64 {
        let sign = self.side.sign();
        sign * self.rocking.top_force_n(sign * top_m, 0.0, sign * plastic_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::{Effect, WallParameters};

    fn wall(stiffness_n_per_m: f64, effects: &[(&str, &[f64])]) -> Wall {
        let effects =
            effects.iter().map(|(name, values)| Effect::with_parameters(name, values).expect("an effect"));
        let strip = WallParameters::strip(0.3, 4.0, 1800.0);
        Wall::new(WallParameters { stiffness_n_per_m, effects: effects.collect(), ..strip }).expect("a wall")
    }

    #[test]
    fn analytic_springs_hold_and_dampers_do_not() {
        let force = |wall: &Wall, side, top_m| {
            let chain = Chain::of(wall, crate::chain::Edges::Crushed, side);
            Restraint::of(wall, side).force_n(&chain, top_m, 0.0)
        };
        let spring = wall(40e3, &[]);
        assert_eq!([Side::Right, Side::Left].map(|side| force(&spring, side, 0.02)), [-800.0; 2]);
        assert!(Restraint::of(&wall(0.0, &[]), Side::Right).is_free());
        let damped = wall(0.0, &[("viscous_damping", &[1500.0]), ("coulomb_friction", &[800.0])]);
        assert!(Restraint::of(&damped, Side::Right).is_free());
    }
}
