//! One corner under pressure: a spring and a damper that push and do not pull, and a spring and a damper against sliding.

use super::wall::{Bed, SPRINGS};

/// Corners that are alike at the ground and at the crack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corners {
    /// Stiffness of a corner, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping of a corner, N s/m.
    pub damping_n_s_per_m: f64,
}

/// What all corners are made of.
#[derive(Debug, Clone, Copy)]
pub struct Corner {
    /// Stiffness in both directions, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping in both directions, N s/m.
    pub damping_n_s_per_m: f64,
    /// Depth over which the dampers come in, so that forces do not jump, m.
    pub ramp_m: f64,
}

/// Place and velocity of one face of a corner relative to the other.
#[derive(Debug, Clone, Copy)]
pub struct Relative {
    /// Opening, m; negative: pressed in.
    pub gap_m: f64,
    /// Its rate, m/s.
    pub gap_rate_m_s: f64,
    /// Displacement along the joint, m.
    pub slip_m: f64,
    /// Its rate, m/s.
    pub slip_rate_m_s: f64,
}

impl Corner {
    /// How deep the corners at the ground are pressed in by a wall at rest, m.
    ///
    /// The joint turns by twice this over its width before it opens: 2e-6 rad, a fifth of the smallest noise of a case.
    const DEPTH_AT_REST_M: f64 = 2e-7;
    /// How much stiffer the crack is than the ground.
    ///
    /// An impact at the ground is then slow enough for a closed crack to carry it at both corners as one body would;
    /// equally stiff, the crack is struck open by it.
    const CRACK_OVER_GROUND: f64 = 30.0;
    /// Coefficient of friction: rocking needs about 0.2, so that nothing slides, and forces do not jump as a corner lifts.
    const FRICTION: f64 = 5.0;
    /// Damping ratios, so large that corners do not bounce.
    const DAMPING_RATIO: [f64; 2] = [3.0, 3.0];

    /// Corners at the ground and at the crack for a wall of this weight, N, whose impacts move this mass, kg.
    pub fn of_wall(weight_n: f64, moved_kg: f64) -> [Self; 2] {
        let ground_n_per_m = 0.5 * weight_n / Self::DEPTH_AT_REST_M;
        [0, 1].map(|joint| {
            let stiffness_n_per_m = ground_n_per_m * [1.0, Self::CRACK_OVER_GROUND][joint];
            let critical_n_s_per_m = 2.0 * (stiffness_n_per_m * moved_kg).sqrt();
            Self {
                stiffness_n_per_m,
                damping_n_s_per_m: Self::DAMPING_RATIO[joint] * critical_n_s_per_m,
                ramp_m: 0.1 * 0.5 * weight_n / stiffness_n_per_m,
            }
        })
    }

    /// One of corners that are alike, under this weight, N.
    pub fn alike(Corners { stiffness_n_per_m, damping_n_s_per_m }: Corners, weight_n: f64) -> Self {
        let ramp_m = 0.1 * 0.5 * weight_n / stiffness_n_per_m;
        Self { stiffness_n_per_m, damping_n_s_per_m, ramp_m }
    }

    /// One of the springs of a bed, which carries its share of a weight, N, at rest over a width, m.
    ///
    /// As stiff along the joint as across it.
    pub fn of_bed(bed: Bed, weight_n: f64, width_m: f64) -> Self {
        let stiffness_n_per_m = bed.stiffness_n_per_m2 * width_m / SPRINGS as f64;
        let depth_m = weight_n / (bed.stiffness_n_per_m2 * width_m);
        let damping_n_s_per_m = bed.damping_s * stiffness_n_per_m;
        Self { stiffness_n_per_m, damping_n_s_per_m, ramp_m: 0.01 * depth_m }
    }

    /// Time in which the corners take up an impact, s: that of the damper against the mass, c / k at the longest.
    pub fn impact_s(&self) -> f64 {
        self.damping_n_s_per_m / self.stiffness_n_per_m
    }

    /// Normal force, which pushes the faces apart, and tangential force against sliding, N.
    pub fn force_n(&self, at: Relative) -> [f64; 2] {
        let depth_m = -at.gap_m;
        if depth_m <= 0.0 {
            return [0.0; 2];
        }
        let damping = self.damping_n_s_per_m * (depth_m / self.ramp_m).min(1.0);
        let normal = self.stiffness_n_per_m * depth_m - damping * at.gap_rate_m_s;
        if normal <= 0.0 {
            return [0.0; 2];
        }
        let held = -self.stiffness_n_per_m * at.slip_m - damping * at.slip_rate_m_s;
        let most = Self::FRICTION * normal;
        [normal, held.clamp(-most, most)]
    }
}
