//! The true wall of a case as a wall file for the library's own simulator.

use toml::Table;

use super::draw::Case;
use super::hidden::Hidden;

/// Kinds that the library cannot simulate: their cases are made by the other simulator.
pub const UNKNOWN_TO_THE_LIBRARY: [&str; 4] =
    ["coulomb_friction", "gap", "one_sided_spring", "yielding_spring"];

/// The wall file.
pub fn true_wall(case: &Case) -> String {
    let mut numbers = case.actual.clone();
    let mut effects = Vec::new();
    for effect in &case.hidden {
        match *effect {
            Hidden::CarriageMass { mass_kg } => effects.push(table("carriage_mass", "mass_kg", mass_kg)),
            Hidden::ViscousDamping { coefficient_n_s_per_m: c } => {
                effects.push(table("viscous_damping", "coefficient_n_s_per_m", c));
            }
            Hidden::CubicStiffness { coefficient_n_per_m3: k_3 } => {
                effects.push(table("cubic_stiffness", "coefficient_n_per_m3", k_3));
            }
            Hidden::JointDamping { joint, coefficient_n_m_s_per_rad: c } => {
                let mut damping = table("joint_damping", "coefficient_n_m_s_per_rad", c);
                damping.insert("joint".into(), joint.name().into());
                effects.push(damping);
            }
            // Both corners move inwards: the joint is narrower.
            Hidden::CornerIndentation { joint, depth_m } => {
                numbers.widths_m[joint as usize] -= depth_m;
            }
            Hidden::ImpactDissipation { factors } => {
                numbers.coefficients.iter_mut().zip(factors).for_each(|(c, factor)| *c *= factor);
            }
            // These act on the ground motion and on what is read.
            Hidden::VerticalGroundMotion { .. }
            | Hidden::RecordGain { .. }
            | Hidden::RecordLag { .. }
            | Hidden::SensorGain { .. }
            | Hidden::SensorOffset { .. } => {}
            Hidden::CoulombFriction { .. }
            | Hidden::Gap { .. }
            | Hidden::OneSidedSpring { .. }
            | Hidden::YieldingSpring { .. }
            | Hidden::Outside { .. } => unreachable!("drawn for the other simulator"),
        }
    }
    numbers.to_toml(&effects)
}

fn table(kind: &str, key: &str, value: f64) -> Table {
    let mut table = Table::new();
    table.insert("kind".into(), kind.into());
    table.insert(key.into(), value.into());
    table
}
