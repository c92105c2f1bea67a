//! From a set and a number to a case with a law that no catalogue has, or with none.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::super::cases::draw::{
    Case, Contacts, Prior, Simulator, combination, generator, plastic, scatter, seed,
};
use super::super::cases::hidden::{Hidden, Scale, hidden};
use super::super::cases::kind::Kind;
use super::super::cases::walls::WallNumbers;
use super::atom::{Atom, Form, Site};

/// Groups of cases, and how many of fifty.
pub const GROUPS: [(&str, f64); 8] = [
    ("nothing", 6.0),
    ("a name", 6.0),
    ("one atom", 20.0),
    ("two atoms", 6.0),
    ("joint", 5.0),
    ("outside the grammar", 4.0),
    ("memory", 2.0),
    ("a hidden body", 1.0),
];

/// Effects of the catalogue that are drawn as names.
const NAMES: [&str; 8] = [
    "viscous_damping",
    "coulomb_friction",
    "cubic_stiffness",
    "one_sided_spring",
    "carriage_mass",
    "yielding_spring",
    "corner_indentation",
    "joint_damping",
];

/// Forms of one atom, in turn: powers come more often.
const FORMS: [&str; 10] = [
    "drag",
    "spring",
    "opening",
    "saturation",
    "stop",
    "drag",
    "dead zone",
    "opening",
    "drag saturation",
    "one way",
];
/// Two forms at once.
const TWO: [[&str; 2]; 5] = [
    ["drag", "stop"],
    ["drag", "saturation"],
    ["spring", "opening"],
    ["dead zone", "drag"],
    ["drag saturation", "spring"],
];
/// Teeth come last: cases of sets before them are the same.
const OUTSIDE: [&str; 5] = ["snapping", "hardening", "near rest", "slipping", "teeth"];
const WITH_MEMORY: [&str; 3] = ["weakening", "secant", "slack"];
/// Those that carry a state along. Sets whose number is less have none of them: their cases are the same.
const WITH_STATES: [&str; 2] = ["relaxing", "yielding"];
const FIRST_WITH_STATES: u32 = 5;

/// The case of this number.
pub fn draw(set: &str, number: u64) -> Case {
    let group = group_of(set, number);
    let before = (0..number).filter(|earlier| group_of(set, *earlier) == group).count();
    of_group(set, number, group, before)
}

/// The group of a case: the golden ratio's multiples make the first cases of a set a fair share of it.
fn group_of(set: &str, number: u64) -> &'static str {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let start = (seed(set) >> 11) as f64 / (1u64 << 53) as f64;
    let all = GROUPS.iter().map(|(_, cases)| cases).sum::<f64>();
    let mut place = (start + number as f64 * golden).fract() * all;
    for (group, cases) in GROUPS {
        if place < cases {
            return group;
        }
        place -= cases;
    }
    GROUPS[0].0
}

/// The case of this number in a group, with so many of the group before it.
pub fn of_group(set: &str, number: u64, group: &'static str, before: usize) -> Case {
    let (noise_rad, size, simulator) = combination(set, group, before);
    let mut rng = generator(set, number, 0);
    let simulator = if is_foreign(group, before) { Simulator::Compliant } else { simulator };
    let size = if group == "nothing" { 1.0 } else { size };
    let table = rng.random_range(0.0..1.0) < 0.5;
    let described = if table { WallNumbers::table() } else { WallNumbers::facade(&mut rng) };
    let described = if simulator == Simulator::Compliant { plastic(described) } else { described };
    let known = rng.random_range(0.0..1.0) < 0.75;
    let prior = if known { Prior::Known } else { Prior::StiffnessFree };
    let fit_tests = [3, 3, 2, 4][rng.random_range(0..4)];
    // The test held out goes twice as far, and stands.
    let target_rad = rng.random_range(0.10..0.18) * described.widths_m[0] / described.height_m * 2.0;
    let scattered = rng.random_range(0.0..1.0) < 0.5;
    let actual = if scattered { scatter(&described, prior, &mut rng) } else { described.clone() };
    let scale = Scale { wall: &actual, rotation_rad: target_rad, size };
    let hidden = hidden_of(set, group, before, &scale, &mut rng);
    let held_out_amplitude = rng.random_range(1.5..2.0);
    Case {
        set: set.to_owned(),
        number,
        kind: Kind::Law(group),
        simulator,
        prior,
        noise_rad,
        size,
        described,
        actual,
        hidden,
        fit_tests,
        hold_out_tests: 1,
        target_rad,
        held_out_amplitude,
        contacts: Contacts::SharpEdges,
    }
}

/// Whether only the second simulator can have the law. The library has no hidden bodies, and refuses an exponential that
/// grows beyond any force where a wall has long fallen.
fn is_foreign(group: &str, before: usize) -> bool {
    match group {
        "a hidden body" => true,
        "outside the grammar" => outside(before) == "hardening",
        _ => false,
    }
}

fn outside(before: usize) -> &'static str {
    OUTSIDE[before % OUTSIDE.len()]
}

/// Forms with a memory, those that carry a state first.
fn with_memory(set: &str) -> Vec<&'static str> {
    let number = set.trim_start_matches(|c: char| !c.is_ascii_digit()).parse::<u32>();
    let states = if number.is_ok_and(|number| number >= FIRST_WITH_STATES) { &WITH_STATES[..] } else { &[] };
    [states, &WITH_MEMORY[..]].concat()
}

fn hidden_of(set: &str, group: &str, before: usize, scale: &Scale, rng: &mut ChaCha8Rng) -> Vec<Hidden> {
    let law = |form: &str, rng: &mut ChaCha8Rng| Hidden::Law(at_top(form, scale, rng));
    match group {
        "nothing" => vec![],
        "a name" => vec![hidden(NAMES[before % NAMES.len()], scale, rng)],
        "one atom" => vec![law(FORMS[before % FORMS.len()], rng)],
        "two atoms" => TWO[before % TWO.len()].map(|form| law(form, rng)).to_vec(),
        "joint" => vec![Hidden::Law(at_joint(before, scale, rng))],
        "outside the grammar" => vec![law(outside(before), rng)],
        "memory" => {
            let forms = with_memory(set);
            vec![law(forms[before % forms.len()], rng)]
        }
        _ => vec![hidden("loose_mass", scale, rng)],
    }
}

/// An exponent: off every grid in a third of the cases, else one of those that laws of physics have.
fn exponent(exact: &[f64], [low, high]: [f64; 2], rng: &mut ChaCha8Rng) -> f64 {
    if rng.random_range(0.0..1.0) < 1.0 / 3.0 {
        rng.random_range(low..high)
    } else {
        exact[rng.random_range(0..exact.len())]
    }
}

/// Largest velocity of the top by the floor's spring and the wall's mass, m/s.
fn velocity_m_s(scale: &Scale) -> f64 {
    scale.displacement_m() * (scale.wall.stiffness_n_per_m / scale.wall.mass_kg).sqrt()
}

/// A law at the top: at its reach about a quarter of the force of the floor's spring, of nominal size.
fn at_top(form: &str, scale: &Scale, rng: &mut ChaCha8Rng) -> Atom {
    let reach = [scale.displacement_m(), velocity_m_s(scale)];
    let size = scale.size * rng.random_range(0.8..1.2);
    let side = if rng.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 };
    let (form, share) = match form {
        "drag" => {
            let low = rng.random_range(0.0..1.0) < 0.3;
            let n = if low {
                exponent(&[0.5], [0.3, 0.75], rng)
            } else {
                exponent(&[1.5, 2.0, 3.0], [1.3, 2.7], rng)
            };
            (Form::Drag { n }, 0.3)
        }
        "spring" => (Form::Spring { n: exponent(&[1.5, 2.0, 5.0], [1.4, 2.6], rng) }, 0.3),
        "opening" => {
            let p = exponent(&[1.0, 2.0], [0.6, 2.4], rng);
            (Form::Opening { p, n: exponent(&[1.0, 2.0], [0.6, 1.8], rng) }, 0.4)
        }
        "saturation" => (Form::Saturation { d: rng.random_range(0.1..0.4) }, 0.25),
        "stop" => {
            let (g, n) = (rng.random_range(0.2..0.5), exponent(&[1.0, 1.5], [1.1, 1.9], rng));
            (Form::Stop { side, g, n }, 0.8)
        }
        "dead zone" => {
            let (g, n) = (rng.random_range(0.15..0.45), exponent(&[1.0, 1.5], [1.1, 1.9], rng));
            (Form::DeadZone { g, n }, 0.6)
        }
        "drag saturation" => (Form::DragSaturation { s: rng.random_range(0.1..0.4) }, 0.2),
        "one way" => (Form::OneWay { side, n: exponent(&[1.0, 2.0], [1.2, 2.5], rng) }, 0.4),
        "snapping" => (Form::Snapping { d: rng.random_range(0.2..0.4) }, 0.6),
        // At the reach (exp(1/d) − 1) of its size.
        "hardening" => {
            let d = rng.random_range(0.3..0.6);
            (Form::Hardening { d }, 0.3 / ((1.0 / d).exp() - 1.0))
        }
        "teeth" => (Form::Teeth { d: rng.random_range(0.15..0.22) }, 0.25),
        // Of size 1 a half of the floor's spring at the reach is lost.
        "weakening" => (Form::Weakening { g: rng.random_range(0.8..3.0) }, 0.8),
        "secant" => (Form::Secant { g: rng.random_range(0.1..0.5) }, 0.3),
        "slack" => (Form::Slack { a: rng.random_range(0.25..0.75) }, 0.6),
        // Times from a sixth of a swing to half of one.
        "relaxing" => (Form::Relaxing { tau: rng.random_range(0.3..3.0) }, 0.5),
        "yielding" => {
            let n = exponent(&[1.0, 2.0], [0.8, 3.0], rng);
            (Form::Yielding { d: rng.random_range(0.1..0.4), n }, 0.3)
        }
        "near rest" => (Form::NearRest { d: rng.random_range(0.2..0.5) }, 0.3),
        _ => (Form::Slipping { s: rng.random_range(0.15..0.35) }, 0.6),
    };
    Atom { site: Site::Top, form, size: share * size * scale.spring_n(), reach }
}

/// A law of the moment across a joint.
fn at_joint(before: usize, scale: &Scale, rng: &mut ChaCha8Rng) -> Atom {
    let share = scale.size * rng.random_range(0.8..1.2);
    let site = [Site::Ground, Site::Crack][before % 2];
    let wall = scale.wall;
    let turning = (wall.stiffness_n_per_m / wall.mass_kg).sqrt();
    let reach = [scale.rotation_rad, scale.rotation_rad * turning];
    // Of the moment of the floor's spring about the joint.
    let arm_m = [wall.height_m, wall.height_m - wall.crack_height_m][before % 2];
    let form = match before % 3 {
        0 => Form::Drag { n: exponent(&[0.5, 2.0], [1.3, 2.2], rng) },
        1 => Form::Spring { n: exponent(&[2.0, 3.0], [1.4, 2.6], rng) },
        _ => Form::Saturation { d: rng.random_range(0.15..0.4) },
    };
    Atom { site, form, size: 0.3 * share * scale.spring_n() * arm_m, reach }
}
