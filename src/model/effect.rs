//! Further effects: named additions to the model, each with its place, parameters, units and bounds.
//!
//! The wall is the model of the paper; an effect adds one physical law to it without touching the rest.
//! The carriage mass is the paper's own example of an effect that the first model lacked.

use serde::{Deserialize, Serialize};

use super::contact::Joint;

/// One further effect, as written in the `[[effects]]` of a wall file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Effect {
    /// A mass at the top that acts only horizontally.
    CarriageMass {
        /// Added to m_dp, kg.
        mass_kg: f64,
    },
    /// A force at the top against its velocity, F = -c ẋ_C.
    ViscousDamping {
        /// c, N s/m.
        coefficient_n_s_per_m: f64,
    },
    /// A force at the top that hardens or softens with displacement, F = -k_3 x_C³.
    CubicStiffness {
        /// k_3, N/m³; negative softens.
        coefficient_n_per_m3: f64,
    },
    /// A moment against the opening and closing velocity of a joint, M = -c φ̇.
    JointDamping {
        /// Where it acts.
        joint: Joint,
        /// c, N m s/rad.
        coefficient_n_m_s_per_rad: f64,
    },
}

impl Effect {
    /// The `kind` of the wall file.
    pub fn kind(&self) -> &'static str {
        match self {
            Effect::CarriageMass { .. } => "carriage_mass",
            Effect::ViscousDamping { .. } => "viscous_damping",
            Effect::CubicStiffness { .. } => "cubic_stiffness",
            Effect::JointDamping { .. } => "joint_damping",
        }
    }
}

/// Everything that acts on the wall beyond its own masses, summed over the wall's spring and its effects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Laws {
    /// m_dp, kg.
    pub carriage_mass_kg: f64,
    /// k_d, N/m.
    pub stiffness_n_per_m: f64,
    /// k_3, N/m³.
    pub cubic_n_per_m3: f64,
    /// c at the top, N s/m.
    pub viscous_n_s_per_m: f64,
    /// c at the ground and at the crack, N m s/rad.
    pub joint_damping_n_m_s: [f64; 2],
}

impl Laws {
    pub fn new(carriage_mass_kg: f64, stiffness_n_per_m: f64, effects: &[Effect]) -> Self {
        let mut laws = Self {
            carriage_mass_kg,
            stiffness_n_per_m,
            cubic_n_per_m3: 0.0,
            viscous_n_s_per_m: 0.0,
            joint_damping_n_m_s: [0.0; 2],
        };
        effects.iter().for_each(|effect| laws.add(effect));
        laws
    }

    fn add(&mut self, effect: &Effect) {
        match *effect {
            Effect::CarriageMass { mass_kg } => self.carriage_mass_kg += mass_kg,
            Effect::ViscousDamping { coefficient_n_s_per_m: c } => self.viscous_n_s_per_m += c,
            Effect::CubicStiffness { coefficient_n_per_m3: k_3 } => self.cubic_n_per_m3 += k_3,
            Effect::JointDamping { joint, coefficient_n_m_s_per_rad: c } => {
                self.joint_damping_n_m_s[joint as usize] += c;
            }
        }
    }

    /// Horizontal force of the springs at the top, N, at a displacement in m.
    #[inline]
    pub fn spring_force_n(&self, x_c_m: f64) -> f64 {
        -(self.stiffness_n_per_m + self.cubic_n_per_m3 * x_c_m * x_c_m) * x_c_m
    }

    /// Energy stored in the springs at the top, J.
    pub fn spring_energy_j(&self, x_c_m: f64) -> f64 {
        let square = x_c_m * x_c_m;
        0.5 * self.stiffness_n_per_m * square + 0.25 * self.cubic_n_per_m3 * square * square
    }

    /// Horizontal force at the top against its velocity, N.
    #[inline]
    pub fn damping_force_n(&self, v_c_m_s: f64) -> f64 {
        -self.viscous_n_s_per_m * v_c_m_s
    }

    /// Generalised moments of the joint dampers on θ_1 and θ_2, N m.
    #[inline]
    pub fn joint_moments_n_m(&self, omega: [f64; 2]) -> [f64; 2] {
        let [c_ground, c_crack] = self.joint_damping_n_m_s;
        let at_crack = c_crack * (omega[1] - omega[0]);
        [at_crack - c_ground * omega[0], -at_crack]
    }
}
