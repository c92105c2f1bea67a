//! The true wall of a case for the simulator with compliant corners.

use super::super::compliant::wall::{Bed, LooseMass, SPRINGS};
use super::super::compliant::{CompliantWall, TopLaw};
use super::super::laws::atom::Site;
use super::draw::{Case, Contacts};
use super::hidden::Hidden;
use super::walls::WallNumbers;

/// The wall with everything hidden that acts on the wall itself.
pub fn true_wall(case: &Case) -> CompliantWall {
    let mut wall = wall(&case.actual);
    match case.contacts {
        Contacts::SharpEdges => {}
        Contacts::Corners(corners) => wall.corners = Some(corners),
        Contacts::Springs { stiffness_pa_per_m, damping_s } => {
            let stiffness_n_per_m2 = stiffness_pa_per_m * case.actual.length_m;
            wall.beds = [Some(Bed { stiffness_n_per_m2, damping_s }); 2];
            // Stiff rows stand on their outermost springs: these lie where the edges are.
            let wider = SPRINGS as f64 / (SPRINGS as f64 - 1.0);
            wall.corner_x_m = wall.corner_x_m.map(|corners| corners.map(|x| wider * x));
        }
    }
    case.hidden.iter().for_each(|effect| add(&mut wall, effect, &case.actual));
    wall
}

/// A wall file's wall.
pub fn wall(numbers: &WallNumbers) -> CompliantWall {
    let height_m = [numbers.crack_height_m, numbers.height_m - numbers.crack_height_m];
    let mass_kg = height_m.map(|h| numbers.mass_kg * h / numbers.height_m);
    let b = numbers.thickness_m;
    CompliantWall {
        height_m,
        mass_kg,
        inertia_kg_m2: [0, 1].map(|i| mass_kg[i] * (b * b + height_m[i] * height_m[i]) / 12.0),
        corner_x_m: numbers.widths_m.map(|width| [-0.5 * width, 0.5 * width]),
        top_mass_kg: numbers.diaphragm_mass_kg,
        carriage_mass_kg: numbers.carriage_mass_kg,
        eccentricity_m: 0.0,
        top: vec![TopLaw::Spring { stiffness_n_per_m: numbers.stiffness_n_per_m, slack_m: 0.0 }],
        joint_damping_n_m_s: [0.0; 2],
        corners: None,
        body_damping_n_m_s: [0.0; 2],
        beds: [None; 2],
        joint_laws: [Vec::new(), Vec::new()],
        coefficients: numbers.coefficients,
        fading_s_per_m: 0.0,
        loose: None,
    }
}

fn add(wall: &mut CompliantWall, effect: &Hidden, numbers: &WallNumbers) {
    let k_d = numbers.stiffness_n_per_m;
    match *effect {
        Hidden::CarriageMass { mass_kg } => wall.carriage_mass_kg += mass_kg,
        Hidden::ViscousDamping { coefficient_n_s_per_m } => {
            wall.top.push(TopLaw::Viscous { coefficient_n_s_per_m });
        }
        Hidden::CoulombFriction { force_n } => wall.top.push(TopLaw::friction(force_n)),
        Hidden::CubicStiffness { coefficient_n_per_m3 } => {
            wall.top.push(TopLaw::Cubic { coefficient_n_per_m3 });
        }
        // The floor's own spring is the first law.
        Hidden::Gap { slack_m } => wall.top[0] = TopLaw::Spring { stiffness_n_per_m: k_d, slack_m },
        Hidden::OneSidedSpring { side, stiffness_n_per_m } => {
            wall.top.push(TopLaw::OneSided { stiffness_n_per_m, side });
        }
        Hidden::YieldingSpring { stiffness_n_per_m, force_n } => {
            wall.top.push(TopLaw::Yielding { stiffness_n_per_m, limit_n: force_n, plastic_m: 0.0 });
        }
        Hidden::CornerIndentation { joint, depth_m } => {
            let [left, right] = &mut wall.corner_x_m[joint as usize];
            *left += 0.5 * depth_m;
            *right -= 0.5 * depth_m;
        }
        Hidden::ImpactDissipation { factors } => {
            wall.coefficients.iter_mut().zip(factors).for_each(|(c, factor)| *c *= factor);
        }
        Hidden::ImpactFading { fading_s_per_m } => wall.fading_s_per_m += fading_s_per_m,
        Hidden::CompliantJoint { joints, stiffness_pa_per_m, damping_s } => {
            for joint in joints.indices() {
                let stiffness_n_per_m2 = stiffness_pa_per_m * numbers.length_m;
                wall.beds[*joint] = Some(Bed { stiffness_n_per_m2, damping_s });
            }
        }
        Hidden::JointDamping { joint, coefficient_n_m_s_per_rad } => {
            wall.joint_damping_n_m_s[joint as usize] += coefficient_n_m_s_per_rad;
        }
        Hidden::Outside { law, rotation_rad, size } => {
            outside(wall, law, numbers, rotation_rad * numbers.height_m, size);
        }
        Hidden::Law(atom) => match atom.site {
            Site::Top if atom.carries() => {
                wall.top.push(TopLaw::Carried { atom, z: 0.0, from_m: 0.0, left: 1.0 })
            }
            Site::Top => wall.top.push(TopLaw::Drawn { atom, largest_m: 0.0 }),
            Site::Ground => wall.joint_laws[0].push(atom),
            Site::Crack => wall.joint_laws[1].push(atom),
        },
        // These act on the ground motion and on what is read.
        Hidden::VerticalGroundMotion { .. }
        | Hidden::RecordGain { .. }
        | Hidden::RecordLag { .. }
        | Hidden::SensorGain { .. }
        | Hidden::SensorOffset { .. } => {}
    }
}

/// Laws that no entry of the catalogue describes; `reach_m` is the largest displacement of the top in the tests.
fn outside(wall: &mut CompliantWall, law: &str, numbers: &WallNumbers, reach_m: f64, size: f64) {
    let k_d = numbers.stiffness_n_per_m;
    let impedance = (k_d * numbers.mass_kg).sqrt();
    match law {
        "one_sided_stop" => {
            wall.top.push(TopLaw::Stop { stiffness_n_per_m: 2.0 * size * k_d, at_m: 0.4 * reach_m });
        }
        "quadratic_drag" => {
            // The velocity of the top is about its reach times √(k/m).
            let velocity_m_s = reach_m * (k_d / numbers.mass_kg).sqrt();
            let c = 0.3 * size * impedance / velocity_m_s;
            wall.top.push(TopLaw::QuadraticDrag { coefficient_n_s2_per_m2: c });
        }
        "saturating_spring" => {
            wall.top[0] = TopLaw::Saturating { stiffness_n_per_m: k_d, scale_m: reach_m / size.sqrt() };
        }
        "loose_mass" => {
            let mass_kg = 0.1 * size * numbers.mass_kg;
            let stiffness_n_per_m = 20.0 * k_d;
            wall.loose = Some(LooseMass {
                mass_kg,
                slack_m: 0.1 * reach_m,
                stiffness_n_per_m,
                damping_n_s_per_m: 0.6 * (stiffness_n_per_m * mass_kg).sqrt(),
            });
        }
        "degrading_spring" => {
            wall.top[0] =
                TopLaw::Degrading { stiffness_n_per_m: k_d, scale_m: 3.0 * reach_m / size, largest_m: 0.0 };
        }
        // c θ' of each body against the ground, as large at both.
        "body_damping" => {
            let c = 0.1 * size * wall.weight_above_n(0) * 0.5 * numbers.widths_m[0];
            wall.body_damping_n_m_s = [c; 2];
        }
        "displacement_damping" => {
            let c = 0.4 * size * impedance / reach_m;
            wall.top.push(TopLaw::DisplacementDamping { coefficient_n_s_per_m2: c });
        }
        unknown => unreachable!("no law is called {unknown}"),
    }
}
