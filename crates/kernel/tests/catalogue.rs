//! Every kind of effect in every variant: it acts as its entry says, in a run alone and in the lanes.
//!
//! Nothing here lists kinds. A new one is run by these tests as soon as it stands in the catalogue.

use std::collections::HashSet;

use fearless_simd::{Level, Simd};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{
    Effect, EffectEntry, EffectKind, EffectVariant, Place, Quantity, RockingWall, Role, Wall, WallParameters,
};
use mrbd_kernel::simulate::{
    Accuracy, History, Response, Shaking, Simulator, simulate_observed, simulate_side_by_side_at,
};

const ACCURACY: Accuracy = Accuracy { tolerance: 1e-6 };

/// The table wall of the paper's Table 1, its restitution of Table 2, with these effects.
fn table_wall(effects: &[Effect]) -> Wall {
    let parameters = WallParameters { effects: effects.to_vec(), ..WallParameters::table_wall() };
    Wall::new(parameters).expect("a wall that can exist")
}

/// Two sines that rock the table wall in all patterns.
fn shaking() -> Shaking {
    let a = |t: f64| 1.2 * ((9.0 * t).sin() + (23.0 * t).sin());
    let samples = (0..300).map(|k| a(0.01 * f64::from(k))).collect();
    Shaking {
        horizontal: Some(Accelerogram::new(0.01, samples).expect("a record")),
        vertical: None,
        tail_s: 1.0,
    }
}

fn variants() -> impl Iterator<Item = EffectVariant> {
    EffectKind::ALL.iter().flat_map(|kind| kind.variants())
}

/// The example of a variant, and half of what it changes: the sizes at which effects are run.
fn sizes(variant: EffectVariant) -> [Effect; 2] {
    let (example, neutral) = (variant.example(), variant.neutral());
    let middle = |(a, b): (f64, f64)| 0.5 * (a + b);
    let half: Vec<f64> = example.parameters().into_iter().zip(neutral.parameters()).map(middle).collect();
    [example, variant.with_parameters(&half).expect("between two values that are allowed")]
}

fn alone(effects: &[Effect]) -> (Response, History) {
    let mut history = History::new(0.01);
    let response = simulate_observed(&table_wall(effects), &shaking(), ACCURACY, &mut history);
    (response, history)
}

/// The runs of walls with these effects, beside each other.
fn side_by_side(walls: &[Vec<Effect>]) -> Vec<Response> {
    side_by_side_at(Level::new(), walls)
}

/// The same by given vector instructions.
fn side_by_side_at(level: Level, walls: &[Vec<Effect>]) -> Vec<Response> {
    let mut waiting = walls.iter().enumerate();
    let mut next = || {
        let (index, effects) = waiting.next()?;
        Some((index, Simulator::new(&table_wall(effects), &shaking(), ACCURACY).prepared()))
    };
    let mut responses = vec![None; walls.len()];
    simulate_side_by_side_at(level, &mut next, &mut |index, response| responses[index] = Some(response));
    responses.into_iter().map(|response| response.expect("every run ends")).collect()
}

/// Every number as the shortest text that gives its bits back, the sign of a zero too.
fn bits(of: &impl std::fmt::Debug) -> String {
    format!("{of:?}")
}

#[test]
fn analytic_the_wall_of_these_tests_goes_through_every_pattern() {
    let (response, _) = alone(&[]);
    assert!(response.impacts.table2.iter().filter(|count| **count > 0).count() > 4, "{:?}", response.impacts);
    for pair in [[1, 5], [2, 6], [3, 7]] {
        let time_s: f64 = pair.iter().map(|i| response.pattern_time_s[*i]).sum();
        assert!(time_s > 0.01, "{:?}", response.pattern_time_s);
    }
}

#[test]
fn analytic_every_effect_acts_where_its_role_says() {
    let plain = bits(&alone(&[]).0);
    for variant in variants() {
        let effect = variant.example();
        let moves = bits(&alone(&[effect]).0) != plain;
        let reads = !table_wall(&[effect]).reading().is_true();
        let expected = match effect.entry().role {
            Role::Sensor => (false, true),
            Role::Mass | Role::Damper | Role::Friction | Role::Spring | Role::Memory => (true, false),
            Role::Corners | Role::Bed | Role::JointLaw | Role::GroundMotion => (true, false),
            Role::Impact | Role::ImpactSpeed => (true, false),
        };
        assert_eq!((moves, reads), expected, "{effect:?}: (moves the wall, changes the reading)");
    }
}

/// Force that an effect adds at the top, N, at a displacement and a velocity, and mass that it adds there, kg.
fn added(effect: Effect, x_c_m: f64, v_c_m_s: f64) -> (f64, f64) {
    let [with, without] = [table_wall(&[effect]), table_wall(&[])].map(|wall| RockingWall::new(&wall));
    let force_n = |wall: &RockingWall| wall.top_force_n(x_c_m, v_c_m_s, 0.0);
    (force_n(&with) - force_n(&without), with.carriage_mass_kg() - without.carriage_mass_kg())
}

/// The same as the role of an effect and the quantities of its numbers mean it.
fn meant(variant: EffectVariant, numbers: &[f64], x_c_m: f64, v_c_m_s: f64) -> (f64, f64) {
    let entry = variant.entry();
    let side = match variant.choice {
        Some("negative") => f64::from(x_c_m < 0.0),
        Some("positive") => f64::from(x_c_m > 0.0),
        _ => 1.0,
    };
    let stiffness_n_per_m = table_wall(&[]).parameters().stiffness_n_per_m;
    let number = numbers[0];
    let force_n = match (entry.role, entry.parameters[0].quantity) {
        (Role::Damper, Quantity::TopDamping) => -number * v_c_m_s,
        (Role::Friction, Quantity::TopForce) => -number * v_c_m_s.signum(),
        (Role::Spring, Quantity::TopStiffness) => -number * x_c_m * side,
        (Role::Spring, Quantity::TopCubicStiffness) => -number * x_c_m.powi(3),
        (Role::Spring, Quantity::TopDisplacement) => {
            stiffness_n_per_m * x_c_m.abs().min(number) * x_c_m.signum()
        }
        (Role::Memory, Quantity::TopStiffness) => (-number * x_c_m).clamp(-numbers[1], numbers[1]),
        (Role::Mass, Quantity::TopMass) => return (0.0, number),
        (role, quantity) => panic!("{}: a {role:?} by a {quantity:?} has no law here", entry.name),
    };
    (force_n, 0.0)
}

#[test]
fn analytic_every_law_at_the_top_is_what_its_role_and_quantity_mean() {
    for variant in variants().filter(|variant| variant.entry().place == Place::Top) {
        for effect in sizes(variant) {
            // Both sides, inside the gap of the example and beyond it, on the way out and back.
            for x_c_m in [-0.05, -0.004, -5e-4, 5e-4, 0.004, 0.05] {
                for v_c_m_s in [-0.3, -0.01, 0.01, 0.3] {
                    let found = added(effect, x_c_m, v_c_m_s);
                    let expected = meant(variant, &effect.parameters(), x_c_m, v_c_m_s);
                    // Roundings of differences of forces of up to some kilonewtons.
                    let is_same = (found.0 - expected.0).abs() < 1e-9 && (found.1 - expected.1).abs() < 1e-9;
                    assert!(is_same, "{effect:?} at {x_c_m} m, {v_c_m_s} m/s: {found:?}, meant {expected:?}");
                }
            }
        }
    }
}

#[test]
fn analytic_every_effect_moves_the_wall_side_by_side_as_alone_to_the_bit() {
    let mut walls: Vec<Vec<Effect>> = variants().flat_map(sizes).map(|effect| vec![effect]).collect();
    walls.push(Vec::new());
    // One of each kind at once: their laws together. A joint has one law, of a bed or of one of its rivals.
    let is_joint_law = |kind: &&EffectKind| matches!(kind.entry().role, Role::Bed | Role::JointLaw);
    for law in EffectKind::ALL.iter().filter(is_joint_law) {
        let others = EffectKind::ALL.iter().filter(|kind| *kind == law || !is_joint_law(kind));
        walls.push(others.filter_map(|kind| kind.variants().next()).map(|v| v.example()).collect());
    }
    let alone: Vec<String> = walls.iter().map(|effects| bits(&alone(effects).0)).collect();
    for level in levels() {
        for ((effects, response), alone) in walls.iter().zip(side_by_side_at(level, &walls)).zip(&alone) {
            assert_eq!(&bits(&response), alone, "{effects:?}, {level:?}");
        }
    }
}

/// The best vector instructions of this processor, the least that every one of its kind has, and what lies between and is
/// compiled for.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let others = [best.as_sse2().map(Simd::level), best.as_avx2().map(Simd::level)];
    #[cfg(not(target_arch = "x86_64"))]
    let others = [Some(Level::baseline())];
    others.into_iter().flatten().chain([best]).collect()
}

#[test]
fn analytic_a_neutral_effect_changes_no_bit() {
    let (response, history) = alone(&[]);
    let neutral: Vec<Vec<Effect>> = variants().map(|variant| vec![variant.neutral()]).collect();
    for (effects, beside) in neutral.iter().zip(side_by_side(&neutral)) {
        let (found, seen) = alone(effects);
        assert!(effects[0].is_neutral(), "{effects:?}");
        assert_eq!(bits(&found), bits(&response), "{effects:?}");
        assert_eq!(bits(&seen.rows), bits(&history.rows), "{effects:?}");
        assert_eq!(bits(&beside), bits(&response), "{effects:?} side by side");
        assert!(table_wall(effects).reading().is_true(), "{effects:?}");
    }
}

#[test]
fn analytic_every_entry_agrees_with_itself() {
    let names: HashSet<&str> = EffectKind::ALL.iter().map(|kind| kind.name()).collect();
    assert_eq!(names.len(), EffectKind::ALL.len(), "a name twice");
    for kind in EffectKind::ALL {
        let entry = kind.entry();
        assert_eq!(EffectKind::named(entry.name), Ok(*kind));
        assert!(!entry.parameters.is_empty(), "{}: no number", entry.name);
        for p in entry.parameters {
            let allowed = p.least..=p.most;
            assert!(allowed.contains(&p.neutral) && allowed.contains(&p.example), "{} {}", entry.name, p.key);
            assert!(p.neutral != p.example, "{} {}: an example that does nothing", entry.name, p.key);
        }
        for variant in kind.variants() {
            assert_eq!(!variant.joints().is_empty(), entry.place == Place::Joint, "{variant:?}");
            assert!(!variant.example().is_neutral(), "{variant:?}");
        }
        assert_eq!(place(entry), entry.place, "{}: a role that acts elsewhere", entry.name);
    }
}

/// Where a role has its effects act; of forces and masses wherever the entry says.
fn place(entry: &EffectEntry) -> Place {
    match entry.role {
        Role::Mass | Role::Damper | Role::Friction | Role::Spring | Role::Memory => entry.place,
        Role::Corners | Role::Bed | Role::JointLaw => Place::Joint,
        Role::Impact | Role::ImpactSpeed => Place::Impacts,
        Role::GroundMotion => Place::GroundMotion,
        Role::Sensor => Place::Sensor,
    }
}

#[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct File {
    effects: Vec<Effect>,
}

#[test]
fn analytic_every_effect_survives_a_wall_file() {
    for variant in variants() {
        for effect in [variant.example(), variant.neutral()] {
            let file = File { effects: vec![effect] };
            let text = toml::to_string(&file).expect("a table");
            assert!(text.contains(&format!("kind = \"{}\"", variant.kind.name())), "{text}");
            assert_eq!(toml::from_str::<File>(&text).expect(&text), file);
        }
    }
}
