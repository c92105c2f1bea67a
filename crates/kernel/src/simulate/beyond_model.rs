//! Where a run leaves what the model describes: rigid bodies that never slide nor fly, on a floor that the
//! record can move.

use std::f64::consts::TAU;
use std::fmt;

use super::Response;
use crate::model::Wall;

/// Friction coefficient that no masonry has. EN 1996-1-1, 3.6.2, counts on 0.4. Bed joints in shear tests have
/// 0.64 to 0.75 (Atkinson, Amadei, Saeb and Sture 1989, J. Struct. Eng. 115).
const MOST_FRICTION: f64 = 1.0;

/// Tensions of a joint that may be the jerk of an impact. Each is a moment at which the wall would have flown.
const MOST_TENSIONS: u64 = 3;

/// Energy not accounted for, over what passed through. At the default tolerance the shipped wall leaves 1e-9,
/// and stiff floors that still converge leave 4e-6.
const MOST_RESIDUAL: f64 = 1e-5;

/// Steps of the record in the shortest period that it has (Nyquist). Between samples it is a straight line.
const STEPS_A_PERIOD: f64 = 2.0;

/// Why the model does not apply to a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BeyondModel {
    /// The joint would have slid.
    Sliding {
        /// `ground` or `crack`.
        joint: &'static str,
        /// Friction coefficient that it needed.
        friction: f64,
    },
    /// The joint would have flown.
    Flying {
        /// `ground` or `crack`.
        joint: &'static str,
        /// How often it came under tension.
        tensions: u64,
    },
    /// Energy is lost or made by the numbers.
    Energy {
        /// What is not accounted for, over what passed through.
        residual: f64,
    },
    /// The floor moves faster than the record can tell.
    Stiffness {
        /// Period of the floor's spring under top masses and wall, s.
        period_s: f64,
        /// Step of the record, s.
        step_s: f64,
    },
}

impl fmt::Display for BeyondModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sliding { joint, friction } => {
                write!(
                    f,
                    "a friction of {friction:.3} at the {joint}, where masonry has less than {MOST_FRICTION}"
                )
            }
            Self::Flying { joint, tensions } => {
                write!(
                    f,
                    "{tensions} tensions at the {joint}, each a moment at which the wall would have flown"
                )
            }
            Self::Energy { residual } => {
                write!(f, "an energy residual of {residual:.1e}, where at most {MOST_RESIDUAL:e} is rounding")
            }
            Self::Stiffness { period_s, step_s } => write!(
                f,
                "a floor with a period of {period_s:.2e} s, where a record at a step of {step_s} s has none below {} s",
                STEPS_A_PERIOD * step_s
            ),
        }
    }
}

/// Period of the floor's spring k_d, s: the wall turns about its foot with the masses at its top.
///
/// T = 2π √((m_d + m_dp + m/3) / k_d); a slender wall has the moment m h²/3 about its foot. `None` without a
/// spring.
pub fn floor_period_s(wall: &Wall) -> Option<f64> {
    let p = wall.parameters();
    let mass_kg = p.diaphragm_mass_kg + p.carriage_mass_kg + p.mass_kg / 3.0;
    (p.stiffness_n_per_m > 0.0).then(|| TAU * (mass_kg / p.stiffness_n_per_m).sqrt())
}

/// Every reason why the model does not apply to a run; `step_s` is that of the record, if there is one.
pub fn beyond_model(wall: &Wall, step_s: Option<f64>, response: &Response) -> Vec<BeyondModel> {
    let joints = ["ground", "crack"].into_iter().zip(response.demand);
    let mut reasons = Vec::new();
    for (joint, demand) in joints.take(if wall.is_cracked() { 2 } else { 1 }) {
        let (friction, tensions) = (demand.friction, demand.tensions);
        reasons.extend((friction > MOST_FRICTION).then_some(BeyondModel::Sliding { joint, friction }));
        reasons.extend((tensions > MOST_TENSIONS).then_some(BeyondModel::Flying { joint, tensions }));
    }
    let residual = response.energy.residual();
    reasons.extend((residual > MOST_RESIDUAL).then_some(BeyondModel::Energy { residual }));
    let floor = floor_period_s(wall).zip(step_s);
    let too_fast = floor.filter(|(period_s, step_s)| *period_s < STEPS_A_PERIOD * step_s);
    reasons.extend(too_fast.map(|(period_s, step_s)| BeyondModel::Stiffness { period_s, step_s }));
    reasons
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::WallParameters;
    use crate::simulate::{Accuracy, Shaking, simulate};

    fn released(stiffness_n_per_m: f64) -> (Wall, Response) {
        let strip = WallParameters::strip(0.3, 4.0, 1800.0);
        let initial_rotation_rad = [0.01, 0.01];
        let wall =
            Wall::new(WallParameters { stiffness_n_per_m, initial_rotation_rad, ..strip }).expect("a wall");
        let shaking = Shaking { tail_s: 2.0, ..Shaking::default() };
        let response = simulate(&wall, &shaking, Accuracy::default());
        (wall, response)
    }

    #[test]
    fn analytic_each_limit_has_its_reason() {
        let (wall, mut response) = released(40e3);
        assert_eq!(beyond_model(&wall, Some(0.005), &response), []);
        response.demand[0].friction = 1.5;
        response.demand[0].tensions = 4;
        // A wall without a crack has no joint there.
        response.demand[1].friction = 9.0;
        let found = beyond_model(&wall, Some(0.005), &response);
        let sliding = BeyondModel::Sliding { joint: "ground", friction: 1.5 };
        assert_eq!(found, [sliding, BeyondModel::Flying { joint: "ground", tensions: 4 }]);
    }

    #[test]
    fn analytic_a_floor_faster_than_the_record_is_beyond_it() {
        let (wall, response) = released(40e3);
        // m/3 = 720 kg on 40 kN/m.
        let period_s = floor_period_s(&wall).expect("a spring");
        assert!((period_s - TAU * (720.0_f64 / 40e3).sqrt()).abs() < 1e-12, "{period_s}");
        assert!(beyond_model(&wall, Some(0.49 * period_s), &response).is_empty());
        assert_eq!(beyond_model(&wall, Some(0.51 * period_s), &response).len(), 1);
        assert!(beyond_model(&wall, None, &response).is_empty());
    }
}
