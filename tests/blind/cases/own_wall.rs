//! The true wall of a case as a wall file for the library's own simulator.

use toml::Table;

use super::draw::Case;
use super::hidden::{Hidden, Joints, side_name};

/// The wall file.
pub fn true_wall(case: &Case) -> String {
    let mut numbers = case.actual.clone();
    let mut effects = Vec::new();
    for effect in &case.hidden {
        match *effect {
            Hidden::CarriageMass { mass_kg } => effects.push(table("carriage_mass", &[("mass_kg", mass_kg)])),
            Hidden::ViscousDamping { coefficient_n_s_per_m: c } => {
                effects.push(table("viscous_damping", &[("coefficient_n_s_per_m", c)]));
            }
            Hidden::CoulombFriction { force_n } => {
                effects.push(table("coulomb_friction", &[("force_n", force_n)]));
            }
            Hidden::CubicStiffness { coefficient_n_per_m3: k_3 } => {
                effects.push(table("cubic_stiffness", &[("coefficient_n_per_m3", k_3)]));
            }
            Hidden::Gap { slack_m } => effects.push(table("gap", &[("half_width_m", slack_m)])),
            Hidden::OneSidedSpring { side, stiffness_n_per_m: k } => {
                let mut spring = table("one_sided_spring", &[("stiffness_n_per_m", k)]);
                spring.insert("side".into(), side_name(side).into());
                effects.push(spring);
            }
            Hidden::YieldingSpring { stiffness_n_per_m: k, force_n } => {
                let numbers = [("stiffness_n_per_m", k), ("yield_force_n", force_n)];
                effects.push(table("yielding_spring", &numbers));
            }
            Hidden::JointDamping { joint, coefficient_n_m_s_per_rad: c } => {
                let mut damping = table("joint_damping", &[("coefficient_n_m_s_per_rad", c)]);
                damping.insert("joint".into(), joint.name().into());
                effects.push(damping);
            }
            Hidden::CompliantJoint { joints, stiffness_pa_per_m: k, damping_s } => {
                effects.push(bed(joints, k, damping_s));
            }
            // Both corners move inwards: the joint is narrower.
            Hidden::CornerIndentation { joint, depth_m } => {
                numbers.widths_m[joint as usize] -= depth_m;
            }
            Hidden::ImpactDissipation { factors } => {
                numbers.coefficients.iter_mut().zip(factors).for_each(|(c, factor)| *c *= factor);
            }
            Hidden::ImpactFading { fading_s_per_m: b } => {
                effects.push(table("impact_fading", &[("fading_s_per_m", b)]));
            }
            // These act on the ground motion and on what is read.
            Hidden::VerticalGroundMotion { .. }
            | Hidden::RecordGain { .. }
            | Hidden::RecordLag { .. }
            | Hidden::SensorGain { .. }
            | Hidden::SensorOffset { .. } => {}
            Hidden::Law(atom) => effects.push(atom.effect()),
            Hidden::Outside { .. } => unreachable!("drawn for the other simulator"),
        }
    }
    numbers.to_toml(&effects)
}

/// A bed as wall files have it.
pub fn bed(joints: Joints, stiffness_pa_per_m: f64, damping_s: f64) -> Table {
    let numbers = [("stiffness_pa_per_m", stiffness_pa_per_m), ("damping_s", damping_s)];
    let mut bed = table("compliant_joint", &numbers);
    bed.insert("joint".into(), joints.name().into());
    bed
}

fn table(kind: &str, numbers: &[(&str, f64)]) -> Table {
    let mut table = Table::new();
    table.insert("kind".into(), kind.into());
    for (key, value) in numbers {
        table.insert((*key).into(), (*value).into());
    }
    table
}
