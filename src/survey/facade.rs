//! From a façade of the survey, and what the survey leaves open, to a wall that can be simulated.
//!
//! The source's section 4.1: slenderness and mass ratios give size and masses, and masonry that crushes
//! at the corners moves them inwards. Left open are strip, density, impact law and accuracy.

use std::path::Path;

use super::Bed;
use crate::error::{InputError, Result};
use mrbd_kernel::model::{
    Effect, EffectError, G_M_S2, ImpactLaw, ImpossibleWall, Restitution, Wall, WallParameters,
    crushed_widths_m,
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
    /// Displacement of the top at which the floor's spring yields and keeps what it has yielded, m; none: it never does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub floor_yield_m: Option<f64>,
    /// Whether a record of a sequence leaves corners crushed as deep as the largest compression in it asks for.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub crushing_stays: bool,
    /// What lies in both joints; none: sharp edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bed: Option<Bed>,
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
    floor_yield_m: Option<f64>,
    crushing_stays: Option<bool>,
    bed: Option<Bed>,
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
            floor_yield_m: None,
            crushing_stays: false,
            bed: None,
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
            floor_yield_m: self.floor_yield_m.or(base.floor_yield_m),
            crushing_stays: self.crushing_stays.unwrap_or(base.crushing_stays),
            bed: self.bed.or(base.bed),
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
        if let Some(yield_m) = self.floor_yield_m {
            rule("floor_yield_m", yield_m, yield_m > 0.0, above_0)?;
        }
        self.bed.map_or(Ok(()), |bed| bed.check(path, &format!("{table}.bed")))
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
    /// A floor that yields is out of its bounds.
    #[error(transparent)]
    Floor(#[from] EffectError),
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

    /// The wall as a study assumes it: with what lies in its joints, and a floor that yields, where it may.
    ///
    /// # Errors
    /// As [`Facade::wall_with`], and for a floor that yields at a force out of its bounds.
    pub fn wall_under(
        &self,
        restitution: Restitution,
        assumptions: &Assumptions,
        bed: Option<Effect>,
    ) -> Result<Wall, ImpossibleFacade> {
        let wall = self.wall_with(restitution, assumptions.collapse_rotation_ratio, bed)?;
        let Some(yield_m) = assumptions.floor_yield_m else { return Ok(wall) };
        let k_d = self.stiffness_n_per_m;
        // The spring that yields takes the place of k_d: the same up to F_y = k_d x_y.
        let floor = Effect::with_parameters("yielding_spring", &[k_d, k_d * yield_m])?;
        let elastic = wall.parameters().clone();
        let effects = bed.into_iter().chain([floor]).collect();
        Ok(Wall::new(WallParameters { stiffness_n_per_m: 0.0, effects, ..elastic })?)
    }

    /// The wall with corners crushed as deep as these compressions at the ground and at the crack ask for, N. A corner
    /// that was crushed deeper before stays so.
    ///
    /// # Errors
    /// [`ImpossibleFacade`] where a corner crushes away.
    pub fn crushed(&self, wall: &Wall, compression_n: [f64; 2]) -> Result<Wall, ImpossibleFacade> {
        let pressing_kg = compression_n.map(|force_n| force_n / G_M_S2);
        let strength_pa = self.compressive_strength_pa;
        let [ground_m, crack_m] =
            crushed_widths_m(self.thickness_m, self.length_m, pressing_kg, strength_pa)?;
        let before = wall.parameters().clone();
        let lower_width_m = before.lower_width_m.min(ground_m);
        let upper_width_m = before.upper_width_m.min(crack_m);
        Ok(Wall::new(WallParameters { lower_width_m, upper_width_m, ..before })?)
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
    fn analytic_corners_stay_crushed_as_deep_as_the_largest_compression() {
        let built = wall(MEAN).expect("a façade that stands");
        let (m, m_d) = (8100.0, 8100.0 / 0.91 * 0.09);
        let weight_n = [m + m_d, 0.38 * m + m_d].map(|kg: f64| kg * G_M_S2);
        // The stress block of a force half as much again is half as deep again: b - 1.5 a.
        let crushed = MEAN.crushed(&built, weight_n.map(|n| 1.5 * n)).expect("it stands");
        let depth_m = 0.5 - built.parameters().lower_width_m;
        // Rounding of lengths near 0.5 m.
        assert!((crushed.parameters().lower_width_m - (0.5 - 1.5 * depth_m)).abs() < 1e-15);
        // A wall that did not move bears no less than its weight, and corners do not grow again.
        let still = MEAN.crushed(&crushed, [0.0; 2]).expect("it stands");
        assert_eq!(still.parameters(), crushed.parameters());
        let through = MEAN.crushed(&built, weight_n.map(|n| 100.0 * n)).expect_err("nothing is left");
        assert!(through.to_string().contains("crushes through"), "{through}");
    }

    #[test]
    fn regress_a_floor_that_yields_takes_the_place_of_its_spring() {
        let assumed = |floor_yield_m| Assumptions { floor_yield_m, ..Assumptions::default() };
        let of =
            |yield_m| MEAN.wall_under(Restitution::default(), &assumed(yield_m), None).expect("it stands");
        assert_eq!(of(None).parameters(), wall(MEAN).expect("it stands").parameters());
        let yields = of(Some(5e-3));
        assert_eq!(yields.parameters().stiffness_n_per_m, 0.0);
        let effects = serde_json::to_value(&yields.parameters().effects).expect("effects");
        assert_eq!(effects[0]["kind"], "yielding_spring");
        assert_eq!(effects[0]["yield_force_n"], 1.4e6 * 5e-3);
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
