//! Effects with their sizes.
//!
//! The nominal size of an effect shows about as much as the effects of the paper's tests would: a tenth or so of the
//! force or the mass that is there anyway.

use std::path::Path;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use super::super::laws::atom::Atom;
use super::own_wall;
use super::walls::{WallNumbers, rounded};

/// A joint, as wall files name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Joint {
    Ground,
    Crack,
}

/// Joints that give, as wall files name them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Joints {
    Ground,
    Crack,
    Both,
}

impl Joints {
    /// Name in wall files.
    pub fn name(self) -> &'static str {
        match self {
            Joints::Ground => "ground",
            Joints::Crack => "crack",
            Joints::Both => "both",
        }
    }

    /// The joints by their numbers, from 0 at the ground.
    pub fn indices(self) -> &'static [usize] {
        match self {
            Joints::Ground => &[0],
            Joints::Crack => &[1],
            Joints::Both => &[0, 1],
        }
    }
}

/// One effect.
#[derive(Debug, Clone, PartialEq)]
pub enum Hidden {
    CarriageMass {
        mass_kg: f64,
    },
    ViscousDamping {
        coefficient_n_s_per_m: f64,
    },
    CoulombFriction {
        force_n: f64,
    },
    CubicStiffness {
        coefficient_n_per_m3: f64,
    },
    Gap {
        slack_m: f64,
    },
    /// A further spring on one side only.
    OneSidedSpring {
        side: f64,
        stiffness_n_per_m: f64,
    },
    /// A further spring that yields.
    YieldingSpring {
        stiffness_n_per_m: f64,
        force_n: f64,
    },
    /// The width between the corners is smaller by the depth, half at each.
    CornerIndentation {
        joint: Joint,
        depth_m: f64,
    },
    /// Factors on C_1 … C_8.
    ImpactDissipation {
        factors: [f64; 8],
    },
    /// C_l exp(-b u) at the speed u of an impact.
    ImpactFading {
        fading_s_per_m: f64,
    },
    /// A bed of springs in place of sharp edges.
    CompliantJoint {
        joints: Joints,
        stiffness_pa_per_m: f64,
        damping_s: f64,
    },
    JointDamping {
        joint: Joint,
        coefficient_n_m_s_per_rad: f64,
    },
    VerticalGroundMotion {
        ratio: f64,
    },
    RecordGain {
        gain: f64,
    },
    RecordLag {
        lag_s: f64,
    },
    SensorGain {
        body: usize,
        gain: f64,
    },
    SensorOffset {
        body: usize,
        offset_rad: f64,
    },
    Outside {
        law: &'static str,
        rotation_rad: f64,
        size: f64,
    },
    /// A law that is told as a formula.
    Law(Atom),
}

/// What sizes are measured by.
#[derive(Debug, Clone, Copy)]
pub struct Scale<'a> {
    pub wall: &'a WallNumbers,
    /// Largest rotation of the tests, rad.
    pub rotation_rad: f64,
    /// Size over the nominal one.
    pub size: f64,
}

impl Scale<'_> {
    /// Largest displacement of the top, m.
    pub fn displacement_m(&self) -> f64 {
        self.rotation_rad * self.wall.height_m
    }

    /// Largest force of the floor's spring, N.
    pub fn spring_n(&self) -> f64 {
        self.wall.stiffness_n_per_m * self.displacement_m()
    }

    /// √(k_d m), N s/m.
    pub fn impedance_n_s_per_m(&self) -> f64 {
        (self.wall.stiffness_n_per_m * self.wall.mass_kg).sqrt()
    }
}

/// An effect of this kind or a law of this name, its size drawn within ± 20 %.
pub fn hidden(name: &'static str, scale: &Scale, rng: &mut ChaCha8Rng) -> Hidden {
    let size = scale.size * rng.random_range(0.8..1.2);
    let sign = if rng.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 };
    let joint = if rng.random_range(0.0..1.0) < 0.5 { Joint::Ground } else { Joint::Crack };
    let body = rng.random_range(0..2);
    let wall = scale.wall;
    match name {
        "carriage_mass" => Hidden::CarriageMass { mass_kg: 0.08 * size * wall.mass_kg },
        "viscous_damping" => {
            Hidden::ViscousDamping { coefficient_n_s_per_m: 0.1 * size * scale.impedance_n_s_per_m() }
        }
        "coulomb_friction" => Hidden::CoulombFriction { force_n: 0.08 * size * scale.spring_n() },
        "cubic_stiffness" => {
            let k_3 = 0.3 * size * wall.stiffness_n_per_m / scale.displacement_m().powi(2);
            Hidden::CubicStiffness { coefficient_n_per_m3: k_3 }
        }
        "gap" => Hidden::Gap { slack_m: 0.06 * size * scale.displacement_m() },
        "one_sided_spring" => {
            Hidden::OneSidedSpring { side: sign, stiffness_n_per_m: 0.15 * size * wall.stiffness_n_per_m }
        }
        // Yields at a fifth of the reach or so.
        "yielding_spring" => Hidden::YieldingSpring {
            stiffness_n_per_m: 0.6 * wall.stiffness_n_per_m,
            force_n: 0.1 * size * scale.spring_n(),
        },
        "corner_indentation" => Hidden::CornerIndentation { joint, depth_m: 0.04 * size * wall.thickness_m },
        "impact_dissipation" => {
            // Each transition loses a tenth or so of what the impact can see, one more than another.
            let factors = [0; 8].map(|_| 1.0 - 0.1 * size * rng.random_range(0.5..1.5));
            Hidden::ImpactDissipation { factors }
        }
        // At the speed of the largest swing a fifth less is kept.
        "impact_fading" => {
            let frequency_rad_s = (wall.stiffness_n_per_m / wall.mass_kg).sqrt();
            let speed_m_s = wall.widths_m[0] * scale.rotation_rad * frequency_rad_s;
            Hidden::ImpactFading { fading_s_per_m: 0.2 * size / speed_m_s }
        }
        "joint_damping" => {
            let arm_m = 0.5 * wall.widths_m[joint as usize];
            let coefficient = 0.2 * size * wall.weight_n() * arm_m;
            Hidden::JointDamping { joint, coefficient_n_m_s_per_rad: coefficient }
        }
        "compliant_joint" => compliant_joint(wall, rng),
        "vertical_ground_motion" => Hidden::VerticalGroundMotion { ratio: sign * 0.3 * size },
        "record_gain" => Hidden::RecordGain { gain: 1.0 + sign * 0.05 * size },
        // Whole samples, so that the wall's own record can be shifted.
        "record_lag" => Hidden::RecordLag { lag_s: (2.0 * size).round().max(1.0) * super::tests::STEP_S },
        "sensor_gain" => Hidden::SensorGain { body, gain: 1.0 + sign * 0.04 * size },
        "sensor_offset" => Hidden::SensorOffset { body, offset_rad: sign * 0.02 * size * scale.rotation_rad },
        law => Hidden::Outside { law, rotation_rad: scale.rotation_rad, size },
    }
}

/// Stiffness of beds that are drawn, Pa/m, and their damping times, s.
const BED_STIFFNESS: [f64; 2] = [5e7, 5e10];
const BED_DAMPING_S: [f64; 2] = [2e-4, 2e-3];

/// A bed that the wall stands on: drawn again where it would fall by its own weight.
fn compliant_joint(wall: &WallNumbers, rng: &mut ChaCha8Rng) -> Hidden {
    let joints = [Joints::Both, Joints::Both, Joints::Crack, Joints::Ground][rng.random_range(0..4)];
    let mut even = |[low, high]: [f64; 2]| low * f64::powf(high / low, rng.random_range(0.0..1.0));
    loop {
        let [k, damping_s] = [even(BED_STIFFNESS), even(BED_DAMPING_S)].map(three_digits);
        let text = wall.to_toml(&[own_wall::bed(joints, k, damping_s)]);
        if mrbd_files::parse_wall(Path::new("wall.toml"), &text).is_ok() {
            return Hidden::CompliantJoint { joints, stiffness_pa_per_m: k, damping_s };
        }
    }
}

fn three_digits(value: f64) -> f64 {
    let unit = 10f64.powi(value.log10().floor() as i32 - 2);
    rounded(value / unit, 1.0) * unit
}

impl Hidden {
    /// Where it acts, in the words of a diagnosis.
    pub fn place(&self) -> &'static str {
        match self {
            Hidden::CornerIndentation { joint, .. } | Hidden::JointDamping { joint, .. } => joint.name(),
            Hidden::CompliantJoint { joints: Joints::Both, .. } => "joint",
            Hidden::CompliantJoint { joints, .. } => joints.name(),
            Hidden::ImpactDissipation { .. } | Hidden::ImpactFading { .. } => "impacts",
            Hidden::VerticalGroundMotion { .. } | Hidden::RecordGain { .. } | Hidden::RecordLag { .. } => {
                "ground motion"
            }
            Hidden::SensorGain { .. } | Hidden::SensorOffset { .. } => "sensor",
            Hidden::Law(atom) => atom.site.name(),
            _ => "top",
        }
    }

    /// Kind, and the number a refit should find with its key in wall files, where it is one number.
    pub fn kind_and_value(&self) -> (&'static str, Option<(&'static str, f64)>) {
        match *self {
            Hidden::CarriageMass { mass_kg } => ("carriage_mass", Some(("mass_kg", mass_kg))),
            Hidden::ViscousDamping { coefficient_n_s_per_m: c } => {
                ("viscous_damping", Some(("coefficient_n_s_per_m", c)))
            }
            Hidden::CoulombFriction { force_n } => ("coulomb_friction", Some(("force_n", force_n))),
            Hidden::CubicStiffness { coefficient_n_per_m3: k_3 } => {
                ("cubic_stiffness", Some(("coefficient_n_per_m3", k_3)))
            }
            Hidden::Gap { slack_m } => ("gap", Some(("half_width_m", slack_m))),
            Hidden::OneSidedSpring { stiffness_n_per_m: k, .. } => {
                ("one_sided_spring", Some(("stiffness_n_per_m", k)))
            }
            Hidden::YieldingSpring { force_n, .. } => ("yielding_spring", Some(("yield_force_n", force_n))),
            Hidden::CornerIndentation { depth_m, .. } => ("corner_indentation", Some(("depth_m", depth_m))),
            Hidden::ImpactDissipation { .. } => ("impact_dissipation", None),
            Hidden::ImpactFading { fading_s_per_m: b } => ("impact_fading", Some(("fading_s_per_m", b))),
            Hidden::JointDamping { coefficient_n_m_s_per_rad: c, .. } => {
                ("joint_damping", Some(("coefficient_n_m_s_per_rad", c)))
            }
            Hidden::CompliantJoint { stiffness_pa_per_m: k, .. } => {
                ("compliant_joint", Some(("stiffness_pa_per_m", k)))
            }
            Hidden::VerticalGroundMotion { ratio } => ("vertical_ground_motion", Some(("ratio", ratio))),
            Hidden::RecordGain { gain } => ("record_gain", Some(("gain", gain))),
            Hidden::RecordLag { lag_s } => ("record_lag", Some(("lag_s", lag_s))),
            Hidden::SensorGain { gain, .. } => ("sensor_gain", Some(("gain", gain))),
            Hidden::SensorOffset { offset_rad, .. } => ("sensor_offset", Some(("offset_rad", offset_rad))),
            Hidden::Outside { law, .. } => (law, None),
            Hidden::Law(_) => ("formula", None),
        }
    }

    /// The word that a kind takes in wall files.
    fn choice(&self) -> Option<&'static str> {
        match *self {
            Hidden::SensorGain { body, .. } | Hidden::SensorOffset { body, .. } => {
                Some(["lower", "upper"][body])
            }
            Hidden::CornerIndentation { joint, .. } | Hidden::JointDamping { joint, .. } => {
                Some(joint.name())
            }
            Hidden::CompliantJoint { joints, .. } => Some(joints.name()),
            Hidden::OneSidedSpring { side, .. } => Some(side_name(side)),
            _ => None,
        }
    }

    /// As the answer tells it.
    pub fn told(&self) -> Value {
        if let Hidden::Law(atom) = self {
            return atom.told();
        }
        let (kind, number) = self.kind_and_value();
        let name = self.choice().map_or(kind.to_owned(), |choice| format!("{kind}.{choice}"));
        let (parameter, value) = number.unzip();
        // What it is where nothing is hidden.
        let neutral = if parameter == Some("gain") { 1.0 } else { 0.0 };
        let mut told = json!({
            "kind": kind,
            "name": name,
            "place": self.place(),
            "parameter": parameter,
            "value": value,
            "deviation": value.map(|value: f64| (value - neutral).abs()),
        });
        if let Hidden::ImpactDissipation { factors } = self {
            told["factors"] = json!(factors);
        }
        told
    }
}

/// A side by its sign, as wall files name it.
pub fn side_name(side: f64) -> &'static str {
    if side > 0.0 { "positive" } else { "negative" }
}

impl Joint {
    /// Name in wall files.
    pub fn name(self) -> &'static str {
        match self {
            Joint::Ground => "ground",
            Joint::Crack => "crack",
        }
    }
}
