//! The wall as bodies that are free in the plane, and all that acts on it.

use super::super::laws::atom::Atom;
use super::corner::Corners;
use super::top::TopLaw;

/// Left and right corner of a joint.
pub const CORNERS: [usize; 2] = [0, 1];

/// Springs of a bed: moments of the row and of a continuous bed differ by their inverse squared, 6e-4.
pub const SPRINGS: usize = 40;

/// Ground and crack; also the lower and the upper body.
pub const JOINTS: [usize; 2] = [0, 1];

/// A cracked wall. Pairs are of the lower and the upper body, or of the joints at the ground and at the crack.
#[derive(Debug, Clone)]
pub struct CompliantWall {
    /// Heights, m.
    pub height_m: [f64; 2],
    /// Masses, kg.
    pub mass_kg: [f64; 2],
    /// Polar moments about the centres of mass, kg m².
    pub inertia_kg_m2: [f64; 2],
    /// For each joint the distance of its left (negative) and right corner from the wall's axis, m.
    pub corner_x_m: [[f64; 2]; 2],
    /// Mass at the top that acts in both directions, m_d, kg.
    pub top_mass_kg: f64,
    /// Mass at the top that acts in x only, m_dp, kg.
    pub carriage_mass_kg: f64,
    /// Distance of the top mass from the wall's axis, e_C, m.
    pub eccentricity_m: f64,
    /// What pushes the top, the floor's spring among it.
    pub top: Vec<TopLaw>,
    /// Rotational dampers at the joints, N m s/rad.
    pub joint_damping_n_m_s: [f64; 2],
    /// Corners that are all alike; `None`: as near to sharp edges as may be.
    pub corners: Option<Corners>,
    /// Rotational dampers of each body against the ground, N m s/rad.
    pub body_damping_n_m_s: [f64; 2],
    /// Beds of springs in the place of corners.
    pub beds: [Option<Bed>; 2],
    /// Laws of the moments across the joints.
    pub joint_laws: [Vec<Atom>; 2],
    /// C_1 … C_8, applied by the law `contact`.
    pub coefficients: [f64; 8],
    /// b of the factor exp(-b u) on all of them at the speed u of an impact, s/m.
    pub fading_s_per_m: f64,
    /// A mass that lies loose on the top.
    pub loose: Option<LooseMass>,
}

/// A bed of springs without tension, with dampers beside them.
#[derive(Debug, Clone, Copy)]
pub struct Bed {
    /// Stiffness of a length of the joint, k L, N/m per m.
    pub stiffness_n_per_m2: f64,
    /// Damping time ζ, s.
    pub damping_s: f64,
}

/// A mass that slides freely between two stops on the top of the wall and rattles.
#[derive(Debug, Clone, Copy)]
pub struct LooseMass {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Distance to either stop from the middle, m.
    pub slack_m: f64,
    /// Stiffness of the stops, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping of the stops, N s/m.
    pub damping_n_s_per_m: f64,
}

impl LooseMass {
    /// Force on the loose mass, N, from its place and velocity relative to the top.
    pub fn force_n(&self, x_m: f64, v_m_s: f64) -> f64 {
        let beyond = x_m.abs() - self.slack_m;
        if beyond <= 0.0 {
            return 0.0;
        }
        let closing_m_s = v_m_s * x_m.signum();
        let push = self.stiffness_n_per_m * beyond + self.damping_n_s_per_m * closing_m_s;
        -push.max(0.0) * x_m.signum()
    }
}

impl CompliantWall {
    /// Masses at the top in x and in y, kg.
    pub fn top_masses_kg(&self) -> [f64; 2] {
        [self.top_mass_kg + self.carriage_mass_kg, self.top_mass_kg]
    }

    /// Weight above a joint, N.
    pub fn weight_above_n(&self, joint: usize) -> f64 {
        let bodies: f64 = self.mass_kg[joint..].iter().sum();
        (bodies + self.top_mass_kg) * super::G_M_S2
    }

    /// Width between the corners of a joint, m.
    pub fn width_m(&self, joint: usize) -> f64 {
        self.corner_x_m[joint][1] - self.corner_x_m[joint][0]
    }

    /// Where springs of a joint act, m from the wall's axis: its two corners, or all along its bed.
    pub fn contacts_m(&self, joint: usize) -> Vec<f64> {
        let [left, right] = self.corner_x_m[joint];
        let count = if self.beds[joint].is_some() { SPRINGS } else { 2 };
        // Corners lie at the ends, springs in the middle of their share of the width.
        let [first, apart] = match self.beds[joint] {
            Some(_) => [0.5 / count as f64, 1.0 / count as f64],
            None => [0.0, 1.0],
        };
        (0..count).map(move |i| left + (first + apart * i as f64) * (right - left)).collect()
    }
}
