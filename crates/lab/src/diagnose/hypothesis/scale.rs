//! How large an effect would have to be to matter in these tests, by the quantity of its number.

use crate::diagnose::measured::TestData;
use mrbd_kernel::model::{Quantity, RockingWall, Wall};

/// Sizes of the measured motion of the top and of the forces there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Largest displacement of the top while the wall stands, m.
    pub displacement_m: f64,
    /// Largest rotation while the wall stands, rad.
    pub rotation_rad: f64,
    /// Frequency of the wall on its floor, rad/s.
    pub frequency_rad_s: f64,
    /// Force of the floor at the largest displacement, or a tenth of the weight, N.
    pub force_n: f64,
    /// Moment that a joint takes to open, m g b/2, N m.
    pub moment_n_m: f64,
    /// Width between corners, m.
    pub width_m: f64,
}

impl Scales {
    /// Of a wall in its tests.
    pub fn of(wall: &Wall, tests: &[TestData]) -> Self {
        let p = wall.parameters();
        let largest = |test: &TestData| {
            let theta = |i: usize| test.theta_rad.iter().map(|pair| pair[i]).collect::<Vec<_>>();
            [0, 1].map(|i| largest_rad(&theta(i), wall.alpha_i_rad()[i]))
        };
        let rotation_rad = tests.iter().flat_map(largest).fold(0.0, f64::max);
        let displacement_m = rotation_rad * p.height_m;
        let weight_n = p.mass_kg * mrbd_kernel::model::G_M_S2;
        Self {
            displacement_m,
            rotation_rad,
            frequency_rad_s: 1.0 / RockingWall::new(wall).response_time_s(),
            force_n: (p.stiffness_n_per_m * displacement_m).max(0.1 * weight_n),
            moment_n_m: 0.5 * weight_n * p.lower_width_m,
            width_m: p.lower_width_m,
        }
    }

    /// A size of this quantity that would matter.
    pub fn size(&self, quantity: Quantity) -> f64 {
        let velocity_m_s = self.displacement_m * self.frequency_rad_s;
        match quantity {
            Quantity::TopForce => self.force_n,
            Quantity::TopStiffness => self.force_n / self.displacement_m,
            Quantity::TopCubicStiffness => self.force_n / self.displacement_m.powi(3),
            Quantity::TopDamping => self.force_n / velocity_m_s,
            Quantity::TopMass => self.force_n / (velocity_m_s * self.frequency_rad_s),
            Quantity::TopDisplacement => self.displacement_m,
            // A quarter of the moment that opens a joint: beside it a damper there is as large as the others at the top.
            Quantity::JointDamping => 0.25 * self.moment_n_m / (self.rotation_rad * self.frequency_rad_s),
            Quantity::CornerWidth => 0.1 * self.width_m,
            Quantity::Rotation => 0.1 * self.rotation_rad,
            Quantity::Time => 0.05 / self.frequency_rad_s,
            Quantity::Ratio | Quantity::ImpactFactor => 1.0,
        }
    }
}

/// Largest rotation of a body that it comes back from, rad: a swing that ends the test beyond where its own weight turns it
/// over (alpha, rad) is its fall, and tells no size, unless it is the only one.
fn largest_rad(theta_rad: &[f64], alpha_rad: f64) -> f64 {
    let theta = theta_rad.iter().copied().filter(|t| t.is_finite()).collect::<Vec<_>>();
    let largest = |part: &[f64]| part.iter().fold(0.0, |most, t| f64::max(most, t.abs()));
    let Some(last) = theta.last().filter(|t| t.abs() > alpha_rad) else { return largest(&theta) };
    let came_back = theta.iter().rposition(|t| t * last <= 0.0);
    came_back.map_or(alpha_rad, |k| largest(&theta[..=k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypothesis::example::SCALES;
    use mrbd_kernel::model::EffectKind;

    #[test]
    fn analytic_every_number_of_the_catalogue_has_a_size_that_matters() {
        for kind in EffectKind::ALL {
            for parameter in kind.entry().parameters {
                let size = SCALES.size(parameter.quantity);
                assert!(size.is_finite() && size > 0.0, "{} {}: {size}", kind.name(), parameter.key);
            }
        }
    }

    #[test]
    fn analytic_the_swing_in_which_a_wall_falls_tells_no_size() {
        let alpha_rad = 0.12;
        let returns = [0.0, 0.03, -0.01, -0.13, f64::NAN, 0.05, 0.02];
        assert_eq!(largest_rad(&returns, alpha_rad), 0.13);
        let falls = [0.0, 0.03, 0.01, -0.04, 0.02, 0.09, f64::NAN, 0.15, 0.3];
        assert_eq!(largest_rad(&falls, alpha_rad), 0.04);
        // Nothing before the fall.
        assert_eq!(largest_rad(&[0.01, 0.2, 0.31], alpha_rad), alpha_rad);
        assert_eq!(largest_rad(&[], alpha_rad), 0.0);
    }
}
