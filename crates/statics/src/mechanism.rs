//! Mechanisms of collapse and their multipliers by virtual work (limit analysis, Circolare 2019, C8.7.1.2.1).

use mrbd_kernel::model::G_M_S2;
use serde::{Deserialize, Serialize};

use crate::chain::Chain;

/// How a wall may begin to fall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mechanism {
    /// The whole wall turns about its foot, the top free (pattern 3).
    OneBlock,
    /// What is above the crack turns about the crack, the top free (pattern 4).
    UpperBody,
    /// Both bodies turn towards the same side, the top free (pattern 1).
    Both,
    /// The bodies turn about foot, crack and top, the top held sideways (pattern 2): vertical bending.
    VerticalBending,
}

impl Mechanism {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::OneBlock, Self::UpperBody, Self::Both, Self::VerticalBending];

    /// Name in result files.
    pub fn name(self) -> &'static str {
        match self {
            Self::OneBlock => "one_block",
            Self::UpperBody => "upper_body",
            Self::Both => "both",
            Self::VerticalBending => "vertical_bending",
        }
    }

    /// Whether a wall can do it: all but the first need a crack.
    pub fn exists(self, chain: &Chain) -> bool {
        self == Self::OneBlock || chain.cracked
    }

    /// Virtual rotations, and the corners (+1 right) that ground and crack turn about.
    ///
    /// Of both bodies the ratio is free: α_0 lies between those of one block and of the upper body alone, and
    /// what is given is the middle, δθ_2 = 2 δθ_1.
    fn rotations(self, chain: &Chain) -> ([f64; 2], [f64; 2]) {
        let [h_1, h_2] = chain.height_m;
        match self {
            Self::OneBlock | Self::UpperBody => ([1.0, 1.0], [1.0, 1.0]),
            Self::Both => ([1.0, 2.0], [1.0, 1.0]),
            Self::VerticalBending => ([1.0, -h_1 / h_2], [1.0, -1.0]),
        }
    }

    /// The virtual work of a wall in this mechanism; `None` where it has no crack for it.
    pub fn work(self, chain: &Chain) -> Option<VirtualWork> {
        if !self.exists(chain) {
            return None;
        }
        let (rotations, sides) = self.rotations(chain);
        Some(match self {
            // Weights that take no part are none of its sums: what is below it, and what the support holds.
            Self::UpperBody => VirtualWork::of(&chain.above_crack(), [1.0; 2], [1.0; 2]),
            Self::VerticalBending => {
                VirtualWork { pushing_n: chain.weight_n(), ..VirtualWork::of(chain, rotations, sides) }
            }
            _ => VirtualWork::of(chain, rotations, sides),
        })
    }
}

/// Virtual work of a wall that begins to turn: what the code sums over k, one weight after the other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct VirtualWork {
    /// Σ P_k δ_Py,k: weights lifted, J for a unit rotation.
    pub lifting_j: f64,
    /// Σ (P_k + Q_k) δ_PQx,k, J.
    pub pushing_j: f64,
    /// Σ (P_k + Q_k) δ_PQx,k², N m².
    pub squares_n_m2: f64,
    /// Σ (P_k + Q_k), N.
    pub pushing_n: f64,
    /// δ of the middle of the crack, m.
    pub crack_m: f64,
    /// δ of the top, m.
    pub top_m: f64,
}

impl VirtualWork {
    /// Of a chain at rest that begins to turn about these corners.
    pub fn of(chain: &Chain, rotations: [f64; 2], sides: [f64; 2]) -> Self {
        let moves = chain.moves([0.0; 2], sides);
        let along = |slopes: [f64; 2]| slopes[0] * rotations[0] + slopes[1] * rotations[1];
        let body = |i: usize| {
            // Masses spread over the height: that of the centre, and h_i²/12 of the rotation.
            let sideways = along(moves.bodies[i][0].slope_m);
            let spread = (rotations[i] * chain.height_m[i]).powi(2) / 12.0;
            chain.mass_kg[i] * G_M_S2 * (sideways * sideways + spread)
        };
        let top_m = along(moves.top[0].slope_m);
        let top_n = (chain.carried_kg + chain.pushing_kg) * G_M_S2;
        Self {
            lifting_j: along(chain.lifted(&moves).slope_m),
            pushing_j: along(chain.pushed(&moves).slope_m),
            squares_n_m2: body(0) + body(1) + top_n * top_m * top_m,
            pushing_n: chain.pushing_n(),
            crack_m: along(moves.crack[0].slope_m),
            top_m,
        }
    }

    /// α_0 (C8.7.1.1) without external forces or internal work: the restraint has no force before it moves.
    pub fn alpha_0(&self) -> f64 {
        self.lifting_j / self.pushing_j
    }

    /// e* (C8.7.1.5): the share of the mass that takes part.
    pub fn e_star(&self) -> f64 {
        self.pushing_j * self.pushing_j / (self.pushing_n * self.squares_n_m2)
    }

    /// M* = e* Σ (P_k + Q_k)/g, kg.
    pub fn m_star_kg(&self) -> f64 {
        self.e_star() * self.pushing_n / G_M_S2
    }

    /// d/d_C (C8.7.1.4): the displacement of the equivalent oscillator over that of a point with virtual δ_C, m.
    pub fn spectral_over(&self, control_m: f64) -> f64 {
        self.squares_n_m2 / (control_m * self.pushing_j)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Edges, Side};
    use mrbd_kernel::model::{Wall, WallParameters};

    fn chain(change: impl Fn(&mut WallParameters)) -> Chain {
        let mut parameters = WallParameters::strip(0.3, 4.0, 1800.0);
        change(&mut parameters);
        Chain::of(&Wall::new(parameters).expect("a wall"), Edges::AsTheyAre, Side::Right)
    }

    fn work(mechanism: Mechanism, chain: &Chain) -> VirtualWork {
        mechanism.work(chain).expect("it has this mechanism")
    }

    #[test]
    fn analytic_a_free_block_has_its_slenderness_and_three_quarters() {
        let block = work(Mechanism::OneBlock, &chain(|_| {}));
        // Roundings of a dozen products, here and below.
        assert!((block.alpha_0() - 0.3 / 4.0).abs() < 1e-15 && (block.e_star() - 0.75).abs() < 1e-15);
        assert!((block.spectral_over(block.top_m) - 2.0 / 3.0).abs() < 1e-15);
        assert!(Mechanism::VerticalBending.work(&chain(|_| {})).is_none());
    }

    #[test]
    fn analytic_a_wall_held_at_its_top_and_cracked_half_way_bears_four_times_as_much() {
        let cracked = chain(|p| p.crack_height_m = Some(2.0));
        let bending = work(Mechanism::VerticalBending, &cracked);
        assert!((bending.alpha_0() - 4.0 * 0.3 / 4.0).abs() < 1e-15);
        assert!((bending.e_star() - 0.75).abs() < 1e-15 && bending.top_m.abs() < 1e-15);
        // The upper body alone: a block half as high.
        let upper = work(Mechanism::UpperBody, &cracked);
        assert!((upper.alpha_0() - 0.15).abs() < 1e-15 && (upper.e_star() - 0.75).abs() < 1e-15);
    }

    #[test]
    fn analytic_weights_and_masses_at_the_top_enter_as_by_hand() {
        let held = chain(|p| {
            p.crack_height_m = Some(2.0);
            p.diaphragm_mass_kg = 500.0;
            p.carriage_mass_kg = 900.0;
            p.eccentricity_m = 0.05;
        });
        let (wall_kg, p_kg, q_kg) = (2160.0, 500.0, 900.0);
        // One block: [m b/2 + m_d (b/2 - e)] / [m h/2 + (m_d + m_dp) h].
        let block = (wall_kg * 0.15 + p_kg * 0.10) / (wall_kg * 2.0 + (p_kg + q_kg) * 4.0);
        assert!((work(Mechanism::OneBlock, &held).alpha_0() - block).abs() < 1e-15);
        // Held: masses at C do not move sideways; m_d rises by b + b/2 + e over a unit of θ, the wall on average by b.
        let bending = (wall_kg * 0.30 + p_kg * (0.30 + 0.15 + 0.05)) / (wall_kg * 1.0);
        let found = work(Mechanism::VerticalBending, &held).alpha_0();
        assert!((found - bending).abs() < 1e-14, "{found} {bending}");
        let without_q = chain(|p| {
            p.crack_height_m = Some(2.0);
            p.diaphragm_mass_kg = 500.0;
            p.eccentricity_m = 0.05;
        });
        assert!((work(Mechanism::VerticalBending, &without_q).alpha_0() - found).abs() < 1e-15);
    }

    #[test]
    fn analytic_both_bodies_lie_between_one_block_and_the_upper_one() {
        let cracked = chain(|p| {
            p.crack_height_m = Some(1.0);
            p.carriage_mass_kg = 300.0;
        });
        let [block, upper, both] = [Mechanism::OneBlock, Mechanism::UpperBody, Mechanism::Both]
            .map(|mechanism| work(mechanism, &cracked).alpha_0());
        assert!(block.min(upper) < both && both < block.max(upper), "{block} {upper} {both}");
    }
}
