//! The one motion of a cracked strip that is held sideways at foot and top and free to rise.
//!
//! With r = h_1/h_2 the upper body turns by θ_2 = -r θ_1 and the crack opens by φ = (1 + r) θ_1. A joint that turns
//! lifts what stands on it by its arm a_j a unit of rotation; a_j = τ b_j/2 where it carries the share τ of the
//! moment of its sharp edges. To the square of the rotations
//!
//! M θ'' + ½ dM/dθ θ'² + τ G sign θ - P θ = 0
//!
//! | | |
//! | --- | --- |
//! | G = N_1 b_1/2 + (1 + r) N_2 b_2/2 | moment of sharp edges at ground and crack, N the weights above them |
//! | P = g h_1 (m_1/2 + m_2 (1 + r/2) + m_d (1 + r)) | what leaning takes of it |
//! | M = m_1 (h_1²/4 + a_1²) + I_1 + m_2 (h_1²/4 + (a_1 + (1 + r) a_2)²) + r² I_2 + m_d (a_1 + (1 + r) a_2)² | inertia |
//!
//! For h_1 = h_2 and a point force at the crack, τ - P θ/G is the force over that of the rigid line at rest.

use mrbd_kernel::model::{Bed, G_M_S2, Wall};

/// A strip held at foot and top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldStrip {
    thickness_m: f64,
    length_m: f64,
    height_1_m: f64,
    /// r = h_1/h_2.
    ratio: f64,
    width_m: [f64; 2],
    mass_kg: [f64; 2],
    inertia_kg_m2: [f64; 2],
    diaphragm_kg: f64,
}

impl HeldStrip {
    /// The strip of a wall; `None` of a wall without a crack, or with a top that is loaded off its middle.
    pub fn of(wall: &Wall) -> Option<Self> {
        let p = wall.parameters();
        let height_1_m = p.crack_height_m.filter(|_| p.eccentricity_m == 0.0)?;
        let height_m = [height_1_m, p.height_m - height_1_m];
        let mass_kg = height_m.map(|h| p.mass_kg * h / p.height_m);
        let inertia = |i: usize| mass_kg[i] * (p.thickness_m.powi(2) + height_m[i].powi(2)) / 12.0;
        Some(Self {
            thickness_m: p.thickness_m,
            length_m: p.length_m,
            height_1_m,
            ratio: height_m[0] / height_m[1],
            width_m: wall.width_m(),
            mass_kg,
            inertia_kg_m2: [inertia(0), inertia(1)],
            diaphragm_kg: p.diaphragm_mass_kg,
        })
    }

    /// Displacement of the crack over the thickness at a rotation of the lower body, rad.
    pub fn displacement_over_thickness(&self, theta_1_rad: f64) -> f64 {
        theta_1_rad * self.height_1_m / self.thickness_m
    }

    /// Rotations across ground and crack at a displacement of the crack over the thickness, rad.
    pub fn rotations_rad(&self, displacement: f64) -> [f64; 2] {
        let theta_1 = displacement * self.thickness_m / self.height_1_m;
        [theta_1, (1.0 + self.ratio) * theta_1]
    }

    /// Weights above ground and crack, N.
    fn loads_n(&self) -> [f64; 2] {
        let above_crack_kg = self.mass_kg[1] + self.diaphragm_kg;
        [self.mass_kg[0] + above_crack_kg, above_crack_kg].map(|mass_kg| mass_kg * G_M_S2)
    }

    /// G: the moment of sharp edges on θ_1, N m.
    pub fn sharp_moment_n_m(&self) -> f64 {
        let edges = self.loads_n();
        self.on_lower([0, 1].map(|j| edges[j] * self.width_m[j] / 2.0))
    }

    /// What moments across ground and crack are on θ_1, N m.
    fn on_lower(&self, [ground, crack]: [f64; 2]) -> f64 {
        ground + (1.0 + self.ratio) * crack
    }

    /// P: the moment that leaning takes, N m a unit of θ_1.
    pub fn lean_n_m(&self) -> f64 {
        let [m1, m2] = self.mass_kg;
        let r = self.ratio;
        G_M_S2 * self.height_1_m * (m1 / 2.0 + m2 * (1.0 + r / 2.0) + self.diaphragm_kg * (1.0 + r))
    }

    /// What leaning takes at a displacement of the crack over the thickness, as a share of the moment of sharp edges.
    pub fn leaning(&self, displacement: f64) -> f64 {
        self.lean_n_m() * self.rotations_rad(displacement)[0] / self.sharp_moment_n_m()
    }

    /// Largest force at the crack on the rigid line over the weight: G/(h_1 W).
    pub fn rigid_force_over_weight(&self) -> f64 {
        self.sharp_moment_n_m() / (self.height_1_m * self.loads_n()[0])
    }

    /// M, kg m², where the joints carry this share of the moment of their sharp edges.
    pub fn inertia_kg_m2(&self, share: f64) -> f64 {
        let [a1, a2] = self.width_m.map(|b| share * b / 2.0);
        let ([m1, m2], [i1, i2]) = (self.mass_kg, self.inertia_kg_m2);
        let (half, rises) = (self.height_1_m.powi(2) / 4.0, self.on_lower([a1, a2]).powi(2));
        let upper = m2 * (half + rises) + self.ratio.powi(2) * i2 + self.diaphragm_kg * rises;
        m1 * (half + a1 * a1) + i1 + upper
    }

    /// Share of the moment of sharp edges that a law of each joint carries at a displacement over the thickness: moments
    /// against rotations, N m, by joint.
    pub fn share(&self, displacement: f64, moment_n_m: impl Fn(usize, f64) -> f64) -> f64 {
        let rotations = self.rotations_rad(displacement);
        self.on_lower([0, 1].map(|j| moment_n_m(j, rotations[j]))) / self.sharp_moment_n_m()
    }

    /// The bed of each joint at a stiffness, Pa/m.
    pub fn beds(&self, stiffness_pa_per_m: f64) -> [Bed; 2] {
        let loads = self.loads_n();
        [0, 1].map(|j| Bed {
            stiffness_pa_per_m,
            damping_s: 0.0,
            width_m: self.width_m[j],
            length_m: self.length_m,
            load_n: loads[j],
        })
    }

    /// The moment of a joint whose load acts at this share of half its width, N m.
    pub fn at_share(&self, joint: usize, share: f64) -> f64 {
        self.loads_n()[joint] * self.width_m[joint] / 2.0 * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::{Contact, RockingWall, State, WallParameters};

    /// One brick, cracked off its middle, with a mass on its top.
    fn wall() -> Wall {
        let strip = WallParameters::strip(0.11, 1.5, 1800.0);
        Wall::new(WallParameters { crack_height_m: Some(0.9), diaphragm_mass_kg: 40.0, ..strip })
            .expect("a wall")
    }

    #[test]
    fn analytic_the_equation_is_that_of_the_energies_of_the_rigid_bodies() {
        let (wall, strip) = (wall(), HeldStrip::of(&wall()).expect("held"));
        let rocking = RockingWall::new(&wall);
        let contact = Contact::of_rotations([0.01, -0.015]);
        // θ_2 at which the top stays, by Newton on its displacement.
        let held = |theta_1: f64| {
            let mut theta_2 = -1.5 * theta_1;
            for _ in 0..20 {
                let theta = [theta_1, theta_2];
                theta_2 -= rocking.top_displacement_m(contact, theta) / rocking.top_arms_m(contact, theta)[1];
            }
            theta_2
        };
        let energy_j = |theta_1: f64, omega_1: f64| {
            let theta = [theta_1, held(theta_1)];
            let arms = rocking.top_arms_m(contact, theta);
            let omega = [omega_1, -omega_1 * arms[0] / arms[1]];
            rocking.energy_j(contact, &State { theta, omega })
        };
        // At 1e-4 rad the edges are where they were, to a share of 1e-4 of the terms that are left out.
        let at = 1e-4;
        let inertia = 2.0 * (energy_j(at, 1.0) - energy_j(at, 0.0));
        assert!((strip.inertia_kg_m2(1.0) / inertia - 1.0).abs() < 5e-4, "{inertia}");
        // Leaning takes its part of the moment half-way between both.
        let moment = (energy_j(2.0 * at, 0.0) - energy_j(at, 0.0)) / at;
        let leaning = strip.sharp_moment_n_m() - 1.5 * at * strip.lean_n_m();
        assert!((leaning / moment - 1.0).abs() < 1e-4, "{moment}");
        let bent = (energy_j(3.0 * at, 0.0) - 2.0 * energy_j(2.0 * at, 0.0) + energy_j(at, 0.0)) / (at * at);
        // The widths add a share of (b/h)² to what the heights take: below 3 %.
        assert!((strip.lean_n_m() / -bent - 1.0).abs() < 0.05, "{bent}");
    }
}
