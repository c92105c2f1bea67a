//! Laws of the horizontal force between the top of the wall and the floor.

use super::super::laws::atom::Atom;

/// One law; forces in N on the top, from its displacement in m and velocity in m/s relative to the ground.
#[derive(Debug, Clone, PartialEq)]
pub enum TopLaw {
    /// F = -k x, without force inside ± slack.
    Spring { stiffness_n_per_m: f64, slack_m: f64 },
    /// F = -k x where x has the sign of `side`.
    OneSided { stiffness_n_per_m: f64, side: f64 },
    /// F = -k (x - x_p), its size limited; x_p follows.
    Yielding { stiffness_n_per_m: f64, limit_n: f64, plastic_m: f64 },
    /// F = -k_3 x³.
    Cubic { coefficient_n_per_m3: f64 },
    /// F = -c ẋ.
    Viscous { coefficient_n_s_per_m: f64 },
    /// F = -c ẋ |ẋ|.
    QuadraticDrag { coefficient_n_s2_per_m2: f64 },
    /// F = -k (x - at) beyond `at`, on its side only.
    Stop { stiffness_n_per_m: f64, at_m: f64 },
    /// F = -k x_s tanh(x / x_s): ever softer, without memory.
    Saturating { stiffness_n_per_m: f64, scale_m: f64 },
    /// F = -k x / (1 + largest |x| so far / scale): softer for good.
    Degrading { stiffness_n_per_m: f64, scale_m: f64, largest_m: f64 },
    /// F = -c |x| ẋ: damping that grows with displacement.
    DisplacementDamping { coefficient_n_s_per_m2: f64 },
    /// A law drawn as a formula.
    Drawn { atom: Atom, largest_m: f64 },
    /// One that carries a state along: its value at the start of the step, where the top was there, and half of what is left of it
    /// after a step as the one before.
    Carried { atom: Atom, z: f64, from_m: f64, left: f64 },
}

impl TopLaw {
    /// Dry friction: a spring so stiff that it yields within some hundredths of a millimetre.
    pub fn friction(force_n: f64) -> Self {
        const TRAVEL_M: f64 = 1e-5;
        Self::Yielding { stiffness_n_per_m: force_n / TRAVEL_M, limit_n: force_n, plastic_m: 0.0 }
    }

    /// Force on the top, N.
    pub fn force_n(&self, x_m: f64, v_m_s: f64) -> f64 {
        match *self {
            Self::Spring { stiffness_n_per_m: k, slack_m } => {
                -k * (x_m.abs() - slack_m).max(0.0) * x_m.signum()
            }
            Self::OneSided { stiffness_n_per_m: k, side } => -k * (x_m * side).max(0.0) * side,
            Self::Yielding { stiffness_n_per_m: k, limit_n, plastic_m } => {
                -(k * (x_m - plastic_m)).clamp(-limit_n, limit_n)
            }
            Self::Cubic { coefficient_n_per_m3: k_3 } => -k_3 * x_m * x_m * x_m,
            Self::Viscous { coefficient_n_s_per_m: c } => -c * v_m_s,
            Self::QuadraticDrag { coefficient_n_s2_per_m2: c } => -c * v_m_s * v_m_s.abs(),
            Self::Stop { stiffness_n_per_m: k, at_m } => {
                -k * (x_m * at_m.signum() - at_m.abs()).max(0.0) * at_m.signum()
            }
            Self::Saturating { stiffness_n_per_m: k, scale_m } => -k * scale_m * (x_m / scale_m).tanh(),
            Self::Degrading { stiffness_n_per_m: k, scale_m, largest_m } => {
                -k * x_m / (1.0 + largest_m.max(x_m.abs()) / scale_m)
            }
            Self::DisplacementDamping { coefficient_n_s_per_m2: c } => -c * x_m.abs() * v_m_s,
            Self::Drawn { atom, largest_m } => atom.force([x_m, v_m_s, largest_m.max(x_m.abs())]),
            // What decays over a step is taken at its middle.
            Self::Carried { atom, z, from_m, left } => {
                let z = atom.carried(z * left, x_m - from_m, 0.0);
                atom.force([x_m, v_m_s, z * atom.reach[0]])
            }
        }
    }

    /// Takes note of where the top has come, at the end of a step of this length.
    pub fn remember(&mut self, x_m: f64, step_s: f64) {
        match self {
            Self::Yielding { stiffness_n_per_m, limit_n, plastic_m } => {
                let travel = *limit_n / *stiffness_n_per_m;
                *plastic_m = plastic_m.clamp(x_m - travel, x_m + travel);
            }
            Self::Degrading { largest_m, .. } | Self::Drawn { largest_m, .. } => {
                *largest_m = largest_m.max(x_m.abs());
            }
            Self::Carried { atom, z, from_m, left } => {
                *z = atom.carried(*z, x_m - *from_m, step_s);
                (*from_m, *left) = (x_m, atom.left_after(0.5 * step_s));
            }
            _ => {}
        }
    }
}
