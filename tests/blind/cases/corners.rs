//! Cases of free bodies on stiff damped corners that are alike at the ground and at the crack, with what was once missed there.

use super::super::compliant::corner::Corners;
use super::draw::{Case, Contacts, Simulator, of_kind, plastic};
use super::hidden::{Hidden, Scale, hidden};
use super::kind::Kind;
use super::nulls::{CORNERS_N_PER_M, DAMPING_S, corners, even};
use super::{draw::generator, hidden::Joint};

/// What is hidden, in turn.
const KINDS: [Kind; 8] = [
    Kind::One("cubic_stiffness"),
    Kind::Nothing,
    Kind::One("one_sided_spring"),
    Kind::Pair("corner_indentation", "corner_indentation"),
    Kind::One("sensor_gain"),
    Kind::Pair("joint_damping", "joint_damping"),
    Kind::One("viscous_damping"),
    Kind::Outside("body_damping"),
];
/// Corners of every other case: 1e10 N/m and 4e6 N s/m.
const OFTEN: Corners = Corners { stiffness_n_per_m: 1e10, damping_n_s_per_m: 4e6 };

/// The case of this number.
pub fn draw(set: &str, number: u64) -> Case {
    let count = KINDS.len() as u64;
    let (kind, turn) = (KINDS[(number % count) as usize], number / count);
    let mut rng = generator(set, number, 61);
    let drawn = of_kind(set, number, kind, turn as usize);
    let (described, actual) = (plastic(drawn.described.clone()), plastic(drawn.actual.clone()));
    let mut hidden_here = drawn.hidden.clone();
    if let Kind::Pair(name, other) = kind
        && name == other
    {
        // One at either joint, each of a size of its own.
        let scale = Scale { wall: &actual, rotation_rad: drawn.target_rad, size: drawn.size };
        let at = |joint, effect| match effect {
            Hidden::CornerIndentation { depth_m, .. } => Hidden::CornerIndentation { joint, depth_m },
            Hidden::JointDamping { coefficient_n_m_s_per_rad, .. } => {
                Hidden::JointDamping { joint, coefficient_n_m_s_per_rad }
            }
            other => other,
        };
        hidden_here =
            [Joint::Ground, Joint::Crack].map(|joint| at(joint, hidden(name, &scale, &mut rng))).into();
    }
    let damping_s = even(DAMPING_S, &mut rng);
    let drawn_corners = corners(even(CORNERS_N_PER_M, &mut rng), damping_s);
    let contacts = Contacts::Corners(if number.is_multiple_of(2) { OFTEN } else { drawn_corners });
    Case { simulator: Simulator::Compliant, contacts, described, actual, hidden: hidden_here, ..drawn }
}
