//! The numbers that make a wall, as they are given: geometry, masses, restraint, impact law, further laws.

use mrbd_formula::Formula;
use serde::{Deserialize, Serialize};

use super::effect::{Effect, FurtherLaw};

/// How the coefficients C_l scale the velocities after an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ImpactLaw {
    /// Eq. 7 of the paper: C_l times both velocities.
    #[default]
    Whole,
    /// C_l times only the part of the motion that the impact can see.
    Contact,
}

impl ImpactLaw {
    /// Name in input and result files.
    pub fn name(self) -> &'static str {
        match self {
            ImpactLaw::Whole => "whole",
            ImpactLaw::Contact => "contact",
        }
    }
}

/// What happens to the velocities at impacts beyond plastic projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Restitution {
    /// C_1 … C_8 of Table 2.
    pub coefficients: [f64; 8],
    /// What the coefficients scale.
    pub law: ImpactLaw,
    /// Relative velocity below which a joint that would open stays closed, rad/s.
    pub capture_velocity_rad_s: f64,
}

impl Restitution {
    /// Default capture velocity, rad/s: corners that close slower than 0.3 mm/s do not count as impacts.
    pub const DEFAULT_CAPTURE_RAD_S: f64 = 1e-3;
}

impl Default for Restitution {
    fn default() -> Self {
        Self {
            coefficients: [1.0; 8],
            law: ImpactLaw::Whole,
            capture_velocity_rad_s: Self::DEFAULT_CAPTURE_RAD_S,
        }
    }
}

/// The numbers that make a wall, SI units, unchecked; [`Wall::new`](super::Wall::new) checks them.
#[derive(Debug, Clone, PartialEq)]
pub struct WallParameters {
    /// Thickness b, m.
    pub thickness_m: f64,
    /// Total height h, m.
    pub height_m: f64,
    /// Height of the crack h_1, m; `None`: uncracked, one block.
    pub crack_height_m: Option<f64>,
    /// Length L of the strip, m.
    pub length_m: f64,
    /// Mass of the whole wall m, kg.
    pub mass_kg: f64,
    /// Width b_1 between the rocking corners at the ground, m.
    pub lower_width_m: f64,
    /// Width b_2 between the rocking corners at the crack, m; ignored for an uncracked wall.
    pub upper_width_m: f64,
    /// Top mass m_d that acts horizontally and vertically, kg.
    pub diaphragm_mass_kg: f64,
    /// Top mass m_dp that acts only horizontally, kg.
    pub carriage_mass_kg: f64,
    /// Horizontal stiffness k_d at the top, N/m.
    pub stiffness_n_per_m: f64,
    /// Horizontal offset e_C of the point where top masses and spring act, m.
    pub eccentricity_m: f64,
    /// Coefficients and law of impacts.
    pub restitution: Restitution,
    /// Rotation over α_i at which the wall counts as collapsed.
    pub collapse_rotation_ratio: f64,
    /// Rotations from which the wall is released at rest, rad; both zero: at rest.
    pub initial_rotation_rad: [f64; 2],
    /// Further effects, in the order given.
    pub effects: Vec<Effect>,
    /// Further laws written as formulas, in the order given.
    pub formulas: Vec<Formula>,
}

impl WallParameters {
    /// Default collapse ratio: overturned well past the point of no return of a single block.
    pub const DEFAULT_COLLAPSE_RATIO: f64 = 2.0;

    /// A free strip of masonry 1 m long: uncracked, sharp corners, nothing on its top, at rest. What a wall
    /// has beside that is set over it.
    pub fn strip(thickness_m: f64, height_m: f64, density_kg_m3: f64) -> Self {
        Self {
            thickness_m,
            height_m,
            crack_height_m: None,
            length_m: 1.0,
            mass_kg: density_kg_m3 * thickness_m * height_m,
            lower_width_m: thickness_m,
            upper_width_m: thickness_m,
            diaphragm_mass_kg: 0.0,
            carriage_mass_kg: 0.0,
            stiffness_n_per_m: 0.0,
            eccentricity_m: 0.0,
            restitution: Restitution::default(),
            collapse_rotation_ratio: Self::DEFAULT_COLLAPSE_RATIO,
            initial_rotation_rad: [0.0; 2],
            effects: Vec::new(),
            formulas: Vec::new(),
        }
    }

    /// The wall of the paper's shaking-table tests: Table 1, with the coefficients of Table 2 under the law `whole`.
    pub fn table_wall() -> Self {
        Self {
            crack_height_m: Some(2.191),
            length_m: 1.5,
            mass_kg: 3614.0,
            lower_width_m: 0.271,
            upper_width_m: 0.281,
            diaphragm_mass_kg: 179.0,
            carriage_mass_kg: 663.0,
            stiffness_n_per_m: 37e3,
            restitution: Restitution {
                coefficients: [0.93, 1.03, 0.825, 0.985, 0.865, 0.76, 0.98, 0.94],
                ..Restitution::default()
            },
            ..Self::strip(0.291, 3.984, 1800.0)
        }
    }

    /// Effects and formulas, as they stand in wall files.
    pub fn further_laws(&self) -> Vec<FurtherLaw> {
        let effects = self.effects.iter().map(|effect| FurtherLaw::Effect(*effect));
        effects.chain(self.formulas.iter().cloned().map(FurtherLaw::Formula)).collect()
    }
}
