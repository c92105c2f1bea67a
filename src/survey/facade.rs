//! From a façade of the survey, and what the survey leaves open, to a wall that can be simulated.
//!
//! The source's section 4.1: slenderness and mass ratios give size and masses, and masonry that crushes
//! at the corners moves them inwards. Left open are strip, density, impact law and accuracy.

use std::path::Path;

use crate::error::{InputError, Result};
use mrbd_kernel::model::{
    Effect, ImpactLaw, ImpossibleWall, Restitution, Wall, WallParameters, crushed_widths_m,
};
use mrbd_kernel::simulate::Accuracy;
use serde::{Deserialize, Serialize};

/// What a study assumes where the survey is silent.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Assumptions {
    /// Length L of the strip, m.
    pub length_m: f64,
    /// Density ρ of the masonry, kg/m³.
    pub density_kg_m3: f64,
    /// What the C_l scale.
    pub law: ImpactLaw,
    /// Relative velocity below which a joint that would open stays closed, rad/s.
    pub capture_velocity_rad_s: f64,
    /// Rotation over α_i at which the wall counts as collapsed.
    pub collapse_rotation_ratio: f64,
    /// Error allowed in rotations relative to α_i.
    pub tolerance: f64,
    /// Free motion after the record, s.
    pub tail_s: f64,
    /// Whether the records' vertical components act too.
    pub vertical: bool,
}

/// Assumptions that differ from those they build on.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Changes {
    length_m: Option<f64>,
    density_kg_m3: Option<f64>,
    law: Option<ImpactLaw>,
    capture_velocity_rad_s: Option<f64>,
    collapse_rotation_ratio: Option<f64>,
    tolerance: Option<f64>,
    tail_s: Option<f64>,
    vertical: Option<bool>,
}

impl Default for Assumptions {
    /// Strip of 1 m of solid brick and lime mortar, 18 kN/m³ (commentary to the Italian code); Eq. 7.
    fn default() -> Self {
        Self {
            length_m: 1.0,
            density_kg_m3: 1800.0,
            law: ImpactLaw::Whole,
            capture_velocity_rad_s: Restitution::DEFAULT_CAPTURE_RAD_S,
            collapse_rotation_ratio: WallParameters::DEFAULT_COLLAPSE_RATIO,
            tolerance: Accuracy::default().tolerance,
            tail_s: 5.0,
            vertical: false,
        }
    }
}

impl Changes {
    pub(crate) fn onto(&self, base: &Assumptions) -> Assumptions {
        Assumptions {
            length_m: self.length_m.unwrap_or(base.length_m),
            density_kg_m3: self.density_kg_m3.unwrap_or(base.density_kg_m3),
            law: self.law.unwrap_or(base.law),
            capture_velocity_rad_s: self.capture_velocity_rad_s.unwrap_or(base.capture_velocity_rad_s),
            collapse_rotation_ratio: self.collapse_rotation_ratio.unwrap_or(base.collapse_rotation_ratio),
            tolerance: self.tolerance.unwrap_or(base.tolerance),
            tail_s: self.tail_s.unwrap_or(base.tail_s),
            vertical: self.vertical.unwrap_or(base.vertical),
        }
    }
}

impl Assumptions {
    /// Checks every value; `table` is where the keys stand in `path`.
    pub(crate) fn check(&self, path: &Path, table: &str) -> Result<()> {
        let rule = |key: &str, value: f64, holds: bool, allowed: &str| match value.is_finite() && holds {
            true => Ok(()),
            false => Err(InputError::key(path, format!("{table}.{key}"), value.to_string(), allowed)),
        };
        let above_0 = "a finite number above 0";
        let not_below_0 = "a finite number, 0 or more";
        rule("length_m", self.length_m, self.length_m > 0.0, above_0)?;
        rule("density_kg_m3", self.density_kg_m3, self.density_kg_m3 > 0.0, above_0)?;
        let capture = self.capture_velocity_rad_s;
        rule("capture_velocity_rad_s", capture, capture >= 0.0, not_below_0)?;
        let ratio = self.collapse_rotation_ratio;
        rule("collapse_rotation_ratio", ratio, ratio > 0.0, above_0)?;
        let within = Accuracy::TOLERANCES.contains(&self.tolerance);
        rule("tolerance", self.tolerance, within, Accuracy::ALLOWED)?;
        rule("tail_s", self.tail_s, self.tail_s >= 0.0, not_below_0)?;
        Ok(())
    }
}

/// A strip of façade and the floor it carries, in the quantities of the survey.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facade {
    /// Thickness b, m.
    pub thickness_m: f64,
    /// Slenderness h_tot / b.
    pub slenderness: f64,
    /// Height of the crack h_1 / h_tot.
    pub crack_height_ratio: f64,
    /// Compressive strength f, Pa.
    pub compressive_strength_pa: f64,
    /// Stiffness of the floor k_d, N/m.
    pub stiffness_n_per_m: f64,
    /// Floor mass m_d / m_tot that acts in both directions; m_tot = m + m_d + m_dp.
    pub diaphragm_mass_ratio: f64,
    /// Floor mass m_dp / m_tot that acts horizontally only.
    pub carriage_mass_ratio: f64,
    /// Length L of the strip, m.
    pub length_m: f64,
    /// Density ρ of the masonry, kg/m³.
    pub density_kg_m3: f64,
}

/// Why a façade is not a wall.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImpossibleFacade {
    /// The floor leaves no mass to the wall.
    #[error("floor masses of {0} of the total; allowed: below 1, the wall has mass too")]
    NoWallMass(f64),
    /// A parameter is out of its bounds.
    #[error(transparent)]
    Wall(#[from] ImpossibleWall),
}

impl Facade {
    /// The wall, at rest, with these coefficients and this rotation ratio of collapse.
    ///
    /// # Errors
    /// [`ImpossibleFacade`] where a corner crushes away or a parameter is out of its bounds.
    pub fn wall(
        &self,
        restitution: Restitution,
        collapse_rotation_ratio: f64,
    ) -> Result<Wall, ImpossibleFacade> {
        self.wall_with(restitution, collapse_rotation_ratio, None)
    }

    /// The same with a further effect.
    ///
    /// # Errors
    /// As [`Facade::wall`], and for a wall that cannot have the effect.
    pub fn wall_with(
        &self,
        restitution: Restitution,
        collapse_rotation_ratio: f64,
        effect: Option<Effect>,
    ) -> Result<Wall, ImpossibleFacade> {
        let masses = self.masses()?;
        let height_m = self.slenderness * self.thickness_m;
        let [lower_width_m, upper_width_m] = crushed_widths_m(
            self.thickness_m,
            self.length_m,
            masses.above_kg(self.crack_height_ratio),
            self.compressive_strength_pa,
        )?;
        Ok(Wall::new(WallParameters {
            thickness_m: self.thickness_m,
            height_m,
            crack_height_m: Some(self.crack_height_ratio * height_m),
            length_m: self.length_m,
            mass_kg: masses.wall_kg,
            lower_width_m,
            upper_width_m,
            diaphragm_mass_kg: masses.diaphragm_kg,
            carriage_mass_kg: masses.carriage_kg,
            stiffness_n_per_m: self.stiffness_n_per_m,
            eccentricity_m: 0.0,
            restitution,
            collapse_rotation_ratio,
            initial_rotation_rad: [0.0; 2],
            effects: effect.into_iter().collect(),
            formulas: Vec::new(),
        })?)
    }

    fn masses(&self) -> Result<Masses, ImpossibleFacade> {
        let floor_ratio = self.diaphragm_mass_ratio + self.carriage_mass_ratio;
        if floor_ratio >= 1.0 {
            return Err(ImpossibleFacade::NoWallMass(floor_ratio));
        }
        let wall_kg =
            self.density_kg_m3 * self.thickness_m * self.slenderness * self.thickness_m * self.length_m;
        let total_kg = wall_kg / (1.0 - floor_ratio);
        Ok(Masses {
            wall_kg,
            diaphragm_kg: self.diaphragm_mass_ratio * total_kg,
            carriage_kg: self.carriage_mass_ratio * total_kg,
        })
    }
}

struct Masses {
    wall_kg: f64,
    diaphragm_kg: f64,
    carriage_kg: f64,
}

impl Masses {
    /// Masses whose weight the corners at the ground and at the crack carry; the carriage has none.
    fn above_kg(&self, crack_height_ratio: f64) -> [f64; 2] {
        let upper_kg = self.wall_kg * (1.0 - crack_height_ratio);
        [self.wall_kg + self.diaphragm_kg, upper_kg + self.diaphragm_kg]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean façade whose floor rests on it, 9 m high.
    const MEAN: Facade = Facade {
        thickness_m: 0.5,
        slenderness: 18.0,
        crack_height_ratio: 0.62,
        compressive_strength_pa: 3.45e6,
        stiffness_n_per_m: 1.4e6,
        diaphragm_mass_ratio: 0.09,
        carriage_mass_ratio: 0.0,
        length_m: 1.0,
        density_kg_m3: 1800.0,
    };

    fn wall(facade: Facade) -> Result<Wall, ImpossibleFacade> {
        facade.wall(Restitution::default(), 2.0)
    }

    #[test]
    fn analytic_mass_ratios_are_to_the_total_mass() {
        let wall = wall(Facade { carriage_mass_ratio: 0.14, ..MEAN }).expect("a façade that stands");
        let p = wall.parameters();
        let total_kg = p.mass_kg + p.diaphragm_mass_kg + p.carriage_mass_kg;
        // A few roundings of sums and quotients: 1e-15 each.
        assert!((p.diaphragm_mass_kg / total_kg - 0.09).abs() < 1e-14);
        assert!((p.carriage_mass_kg / total_kg - 0.14).abs() < 1e-14);
        assert_eq!(p.mass_kg, 1800.0 * 0.5 * 9.0);
    }

    #[test]
    fn analytic_corners_crush_under_the_weight_above_them() {
        let wall = wall(MEAN).expect("a façade that stands");
        let p = wall.parameters();
        let weight = |mass_kg: f64| mass_kg * 9.81 / (0.85 * 3.45e6);
        let (m, m_d) = (8100.0, 8100.0 / 0.91 * 0.09);
        // Rounding of lengths near 0.5 m.
        assert!((p.lower_width_m - (0.5 - weight(m + m_d))).abs() < 1e-15);
        assert!((p.upper_width_m - (0.5 - weight(0.38 * m + m_d))).abs() < 1e-15);
    }

    #[test]
    fn rejects_facades_that_cannot_stand() {
        let crushed = wall(Facade { compressive_strength_pa: 2e5, ..MEAN }).expect_err("crushes");
        assert!(crushed.to_string().contains("crushes through"), "{crushed}");
        let no_wall = wall(Facade { carriage_mass_ratio: 0.95, ..MEAN }).expect_err("no mass left");
        assert!(matches!(no_wall, ImpossibleFacade::NoWallMass(_)), "{no_wall}");
        let no_crack = wall(Facade { crack_height_ratio: 1.0, ..MEAN }).expect_err("crack at the top");
        assert!(no_crack.to_string().contains("wall.crack_height_m"), "{no_crack}");
    }
}
