//! The height of the crack at which a wall held at its top bears least.

use serde::{Deserialize, Serialize};

use crate::chain::Chain;
use crate::joint::Joint;
use crate::mechanism::Mechanism;

/// Shares of the height between which the crack is looked for: nearer to an end it is no crack of a wall.
const SHARES: [f64; 2] = [0.02, 0.98];
/// Trials of the first look.
const TRIALS: u32 = 96;
/// Narrowings by the golden section: 0.618⁴⁵ of a trial's width is 4e-10.
const NARROWINGS: u32 = 45;

/// The crack with the least multiplier of vertical bending.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LeastCrack {
    /// Height above the foot, m.
    pub height_m: f64,
    /// α_0 with the crack there.
    pub alpha_0: f64,
    /// Whether it is an end of the range that was looked at: without a load on its top a wall breaks ever higher.
    pub at_end: bool,
}

/// The crack of least α_0 in vertical bending, between 2 % and 98 % of the height, the widths of the joints as they are.
pub fn least_crack_height(chain: &Chain) -> LeastCrack {
    let at = |share: f64| alpha_0(chain, share);
    let width = (SHARES[1] - SHARES[0]) / f64::from(TRIALS);
    let shares = (0..=TRIALS).map(|i| SHARES[0] + width * f64::from(i));
    let first = shares.fold(SHARES[0], |best, share| if at(share) < at(best) { share } else { best });
    let [mut low, mut high] = [first - width, first + width].map(|share| share.clamp(SHARES[0], SHARES[1]));
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..NARROWINGS {
        let [left, right] = [high - golden * (high - low), low + golden * (high - low)];
        if at(left) < at(right) { high = right } else { low = left }
    }
    let share = 0.5 * (low + high);
    let at_end = SHARES.iter().any(|end| (share - end).abs() < 1e-6);
    LeastCrack { height_m: share * chain.whole_height_m(), alpha_0: at(share), at_end }
}

/// α_0 of vertical bending with the crack at a share of the height.
fn alpha_0(chain: &Chain, share: f64) -> f64 {
    let (height_m, mass_kg) = (chain.whole_height_m(), chain.mass_kg[0] + chain.mass_kg[1]);
    let width_m = if chain.cracked { chain.joints[1].width_m } else { chain.joints[0].width_m };
    let moved = Chain {
        height_m: [share * height_m, (1.0 - share) * height_m],
        mass_kg: [share * mass_kg, (1.0 - share) * mass_kg],
        // Loads of joints are none of virtual work's: weights are lifted.
        joints: [chain.joints[0], Joint::sharp(width_m, 0.0)],
        cracked: true,
        ..*chain
    };
    Mechanism::VerticalBending.work(&moved).map_or(f64::NAN, |work| work.alpha_0())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Edges, Side};
    use mrbd_kernel::model::{Wall, WallParameters};

    fn chain(diaphragm_mass_kg: f64) -> Chain {
        let strip = WallParameters::strip(0.3, 4.0, 1800.0);
        let wall = Wall::new(WallParameters { diaphragm_mass_kg, ..strip }).expect("a wall");
        Chain::of(&wall, Edges::Full, Side::Right)
    }

    #[test]
    fn analytic_the_least_crack_is_where_the_derivative_vanishes() {
        // α_0 = [1 + ν (2 - ξ)/(2 (1 - ξ))] 2b/(ξ h), ν = m_d/m, ξ = h_1/h. The derivative is zero where
        // 2 (1 - ξ)² + ν (2 - ξ)(1 - ξ) = ν ξ: a quadratic equation, (2 + ν) ξ² - (4 + 4ν) ξ + 2 + 2ν = 0.
        for nu in [0.05, 0.3, 1.0, 4.0_f64] {
            let (a, b, c) = (2.0 + nu, -(4.0 + 4.0 * nu), 2.0 + 2.0 * nu);
            let xi = (-b - (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
            let found = least_crack_height(&chain(nu * 2160.0));
            let alpha = (1.0 + nu * (2.0 - xi) / (2.0 * (1.0 - xi))) * 0.6 / (xi * 4.0);
            // A minimum is flat: its place is known to the root of a rounding.
            assert!((found.height_m / 4.0 - xi).abs() < 1e-7, "{nu}: {} {xi}", found.height_m / 4.0);
            assert!((found.alpha_0 - alpha).abs() < 1e-14 && !found.at_end);
        }
    }

    #[test]
    fn analytic_without_a_load_the_wall_breaks_ever_higher() {
        // α_0 = 2b/(ξ h) falls all the way up.
        let found = least_crack_height(&chain(0.0));
        assert!(found.at_end && (found.alpha_0 - 0.6 / (0.98 * 4.0)).abs() < 1e-8, "{found:?}");
    }
}
