//! The forces on a wall beyond its weight and inertia, as smooth laws: a restraint with kinks gives one set a [`super::Regime`].

use wide::f64x2;

use super::effect::{EffectSums, Lanes};
use crate::fused::fused;

/// Everything that acts on the wall beyond its own masses, summed over the wall's spring and its effects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Laws {
    /// m_dp, kg.
    pub carriage_mass_kg: f64,
    /// Stiffness at the top, N/m: k_d and what else is elastic at the time.
    pub stiffness_n_per_m: f64,
    /// k_3, N/m³.
    pub cubic_n_per_m3: f64,
    /// Force of the springs at the top at no displacement, N.
    pub spring_offset_n: f64,
    /// Energy of the springs at the top at no displacement, J.
    pub stored_offset_j: f64,
    /// c at the top, N s/m.
    pub viscous_n_s_per_m: f64,
    /// Force at the top that takes energy whatever the velocity, N: friction and yielding.
    pub drag_n: f64,
    /// c at the ground and at the crack, N m s/rad.
    pub joint_damping_n_m_s: [f64; 2],
    /// What the lanes do of these laws, as the catalogue says of the effects they are made of.
    pub lanes: Lanes,
}

impl Laws {
    /// The wall's own spring and the smooth effects.
    pub fn new(carriage_mass_kg: f64, stiffness_n_per_m: f64, effects: &EffectSums) -> Self {
        Self {
            carriage_mass_kg: carriage_mass_kg + effects.carriage_mass_kg,
            stiffness_n_per_m,
            cubic_n_per_m3: effects.cubic_n_per_m3,
            spring_offset_n: 0.0,
            stored_offset_j: 0.0,
            viscous_n_s_per_m: effects.viscous_n_s_per_m,
            drag_n: 0.0,
            joint_damping_n_m_s: effects.joint_damping_n_m_s,
            lanes: effects.lanes,
        }
    }

    /// Whether the lanes do all sums of these laws.
    #[inline]
    pub fn known_to_lanes(&self) -> bool {
        match self.lanes {
            Lanes::Known => true,
            Lanes::WhileElastic => self.drag_n == 0.0,
            Lanes::Unknown => false,
        }
    }

    /// Horizontal force of the springs at the top, N, at a displacement in m.
    #[inline(always)]
    pub fn spring_force_n(&self, x_c_m: f64) -> f64 {
        // A linear spring need not wait for a square.
        if self.cubic_n_per_m3 == 0.0 {
            return fused(-self.stiffness_n_per_m, x_c_m, self.spring_offset_n);
        }
        let secant = fused(self.cubic_n_per_m3 * x_c_m, x_c_m, self.stiffness_n_per_m);
        fused(-secant, x_c_m, self.spring_offset_n)
    }

    /// Whether anything takes energy.
    pub fn is_damped(&self) -> bool {
        self.viscous_n_s_per_m != 0.0 || self.drag_n != 0.0 || self.joint_damping_n_m_s != [0.0; 2]
    }

    /// Energy stored in the springs at the top, J.
    pub fn spring_energy_j(&self, x_c_m: f64) -> f64 {
        let square = x_c_m * x_c_m;
        let elastic = 0.5 * self.stiffness_n_per_m * square + 0.25 * self.cubic_n_per_m3 * square * square;
        elastic - self.spring_offset_n * x_c_m + self.stored_offset_j
    }

    /// Horizontal force at the top against its velocity, N.
    #[inline(always)]
    pub fn damping_force_n(&self, v_c_m_s: f64) -> f64 {
        fused(-self.viscous_n_s_per_m, v_c_m_s, self.drag_n)
    }

    /// Generalised moments of the joint dampers on θ_1 and θ_2, N m.
    #[inline(always)]
    pub fn joint_moments_n_m(&self, omega: f64x2) -> f64x2 {
        let [c_ground, c_crack] = self.joint_damping_n_m_s;
        let [omega_1, omega_2] = omega.to_array();
        let at_crack = c_crack * (omega_2 - omega_1);
        f64x2::new([fused(-c_ground, omega_1, at_crack), -at_crack])
    }
}
