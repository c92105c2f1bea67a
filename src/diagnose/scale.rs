//! How large an effect would have to be to matter in these tests, by the unit of its number.

use super::test_data::TestData;
use crate::model::{RockingWall, Wall};

/// Sizes of the measured motion of the top and of the forces there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Largest displacement of the top, m.
    pub displacement_m: f64,
    /// Largest rotation, rad.
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
        let largest = tests.iter().flat_map(|test| test.theta_rad.iter().flatten());
        let rotation_rad = largest.filter(|t| t.is_finite()).fold(0.0, |most, t| f64::max(most, t.abs()));
        let displacement_m = rotation_rad * p.height_m;
        let weight_n = p.mass_kg * crate::model::G_M_S2;
        Self {
            displacement_m,
            rotation_rad,
            frequency_rad_s: 1.0 / RockingWall::new(wall).response_time_s(),
            force_n: (p.stiffness_n_per_m * displacement_m).max(0.1 * weight_n),
            moment_n_m: 0.5 * weight_n * p.lower_width_m,
            width_m: p.lower_width_m,
        }
    }

    /// A size that would matter, of a number with this unit.
    pub fn of_unit(&self, unit: &str, key: &str) -> f64 {
        let velocity_m_s = self.displacement_m * self.frequency_rad_s;
        match unit {
            "N" => self.force_n,
            "N/m" => self.force_n / self.displacement_m,
            "N/m³" => self.force_n / self.displacement_m.powi(3),
            "N s/m" => self.force_n / velocity_m_s,
            "kg" => self.force_n / (velocity_m_s * self.frequency_rad_s),
            // A quarter of the moment that opens a joint: beside it a damper there is as large as the others at the top.
            "N m s/rad" => 0.25 * self.moment_n_m / (self.rotation_rad * self.frequency_rad_s),
            // A depth is one of corners, any other length one of the top's displacement.
            "m" if key.contains("depth") || key.contains("width_m") && !key.contains("half") => {
                0.1 * self.width_m
            }
            "m" => self.displacement_m,
            "rad" => 0.1 * self.rotation_rad,
            "s" => 0.05 / self.frequency_rad_s,
            // Gains, factors and ratios.
            _ => 1.0,
        }
    }
}
