//! The blind cases: their second simulator against the library's own, and a case as a reader meets it.

#[allow(dead_code)]
#[path = "../blind/cases/mod.rs"]
mod cases;
#[allow(dead_code)]
#[path = "../blind/compliant/mod.rs"]
mod compliant;
#[allow(dead_code)]
#[path = "../blind/diagnose.rs"]
mod diagnose;
#[allow(dead_code)]
#[path = "../blind/laws/mod.rs"]
pub(crate) mod laws;
pub(crate) mod recorded;
mod said;
#[allow(dead_code)]
#[path = "../blind/score/mod.rs"]
pub(crate) mod score;
#[allow(dead_code)]
#[path = "../blind/twins/mod.rs"]
mod twins;

use std::collections::BTreeMap;
use std::path::Path;

use cases::draw::{Case, Simulator, of_kind};
use cases::hidden::{Hidden, Joint};
use cases::kind::Kind;
use cases::walls::WallNumbers;
use compliant::GroundMotion;
use laws::atom::{Atom, Form, Site};
use laws::found::{is_spelled_as, number_errors, round_exponents_hold};
use mrbd_files::load_wall;
use mrbd_formula::{Formula, Parameter, Place};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};
use mrbd_lab::calibrate::Experiment;
use mrbd_lab::diagnose::answer::{FoundEffect, RoundExponents};

const STEP_S: f64 = 0.005;
const TAIL_S: f64 = 1.0;

/// One strong sine, so that the wall opens at once: trembling about rest is where tiny differences grow.
fn sine(amplitude_m_s2: f64, period_s: f64) -> Vec<f64> {
    let samples = (period_s / STEP_S).round() as usize;
    let phase = |k: usize| 2.0 * std::f64::consts::PI * k as f64 / samples as f64;
    (0..=samples).map(|k| amplitude_m_s2 * phase(k).sin()).collect()
}

fn own(wall: &str, x: &[f64], y: &[f64]) -> Vec<[f64; 2]> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("wall.toml");
    std::fs::write(&path, wall).expect("written");
    let record = |samples: &[f64]| Accelerogram::new(STEP_S, samples.to_vec()).expect("a valid record");
    let shaking = Shaking { horizontal: Some(record(x)), vertical: Some(record(y)), tail_s: TAIL_S };
    let mut history = History::new(STEP_S);
    simulate_observed(
        &load_wall(&path).expect("a wall"),
        &shaking,
        Accuracy { tolerance: 1e-9 },
        &mut history,
    );
    history.rows.iter().map(|row| row.theta_rad).collect()
}

/// Both simulators on a case's true wall: the largest difference over the largest rotation.
fn difference(case: &Case, x: &[f64], vertical: f64) -> f64 {
    let y: Vec<f64> = x.iter().map(|a| a * vertical).collect();
    let own = own(&cases::own_wall::true_wall(case), x, &y);
    let ground = GroundMotion { step_s: STEP_S, x_m_s2: x.to_vec(), y_m_s2: y };
    let compliant = compliant::run(cases::compliant_wall::true_wall(case), &ground, TAIL_S).theta_rad;
    assert_eq!(own.len(), compliant.len());
    let largest = own.iter().flatten().fold(0.0, |l: f64, t| l.max(t.abs()));
    assert!((0.01..0.06).contains(&largest), "the wall hardly rocks, or nearly falls: {largest} rad");
    let pairs = own.iter().flatten().zip(compliant.iter().flatten());
    pairs.fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs())) / largest
}

fn case(actual: WallNumbers, hidden: Vec<Hidden>) -> Case {
    Case { actual, hidden, ..of_kind("test", 0, Kind::Nothing, 0) }
}

/// What may differ: corners give, and impacts take time. Found: 0.0003 to 0.004 of the largest rotation.
const AGREE: f64 = 0.01;

fn plastic(wall: WallNumbers) -> WallNumbers {
    WallNumbers { coefficients: [1.0; 8], ..wall }
}

/// Amplitudes at which no crack opens by less than corners give in the milliseconds before it strikes the ground: there
/// Table 2 jumps from one coefficient to another, and the two part.
#[test]
fn analytic_compliant_corners_rock_as_the_library_does() {
    let stiff = WallNumbers { stiffness_n_per_m: 1.2e5, ..WallNumbers::table() };
    let walls = [
        ("plastic", plastic(WallNumbers::table()), [1.4, -1.8]),
        ("plastic, stiff floor", plastic(stiff), [1.4, -1.6]),
        ("Table 2", WallNumbers::table(), [1.4, -1.9]),
    ];
    for (name, wall, amplitudes_m_s2) in walls {
        for amplitude_m_s2 in amplitudes_m_s2 {
            let found = difference(&case(wall.clone(), vec![]), &sine(amplitude_m_s2, 0.8), 0.3);
            eprintln!("{name}, {amplitude_m_s2} m/s²: {found:.4}");
            assert!(found < AGREE, "{name}, {amplitude_m_s2} m/s²: {found}");
        }
    }
}

#[test]
fn analytic_effects_mean_the_same_in_both_simulators() {
    // Under a stiff floor the crack opens, so that effects at the crack show.
    let [soft, stiff] = [37_000.0, 150_000.0];
    let effects = [
        (soft, Hidden::CarriageMass { mass_kg: 400.0 }),
        (soft, Hidden::ViscousDamping { coefficient_n_s_per_m: 2000.0 }),
        (soft, Hidden::CoulombFriction { force_n: 300.0 }),
        (soft, Hidden::Gap { slack_m: 0.003 }),
        (soft, Hidden::OneSidedSpring { side: -1.0, stiffness_n_per_m: 8000.0 }),
        (soft, Hidden::YieldingSpring { stiffness_n_per_m: 20_000.0, force_n: 200.0 }),
        (soft, Hidden::CubicStiffness { coefficient_n_per_m3: 4e6 }),
        (soft, Hidden::CornerIndentation { joint: Joint::Ground, depth_m: 0.02 }),
        (stiff, Hidden::CornerIndentation { joint: Joint::Crack, depth_m: 0.02 }),
        (soft, Hidden::JointDamping { joint: Joint::Ground, coefficient_n_m_s_per_rad: 2000.0 }),
        (stiff, Hidden::JointDamping { joint: Joint::Crack, coefficient_n_m_s_per_rad: 2000.0 }),
        (soft, Hidden::ImpactDissipation { factors: [0.9, 0.9, 0.85, 0.9, 0.9, 0.9, 1.0, 1.0] }),
        (soft, Hidden::ImpactFading { fading_s_per_m: 2.0 }),
    ];
    let record = sine(1.4, 0.8);
    let still = vec![0.0; record.len()];
    for (stiffness_n_per_m, effect) in effects {
        let told = format!("{effect:?}");
        let wall = plastic(WallNumbers { stiffness_n_per_m, ..WallNumbers::table() });
        let without = own(&wall.to_toml(&[]), &record, &still);
        let case = case(wall, vec![effect]);
        let found = difference(&case, &record, 0.0);
        let with = own(&cases::own_wall::true_wall(&case), &record, &still);
        let pairs = with.iter().flatten().zip(without.iter().flatten());
        let shows = pairs.fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
        eprintln!("{told}: {found:.4}, shows {shows:.4} rad");
        assert!(found < AGREE, "{told}: {found}");
        // Otherwise agreement would say nothing about the effect.
        assert!(shows > 5e-4, "{told}: shows only {shows} rad");
    }
}

/// What the cases do to records themselves, against the library's own effects of that name.
#[test]
fn analytic_effects_of_the_ground_mean_what_the_cases_do() {
    let record = sine(1.4, 0.8);
    let still = vec![0.0; record.len()];
    let with = |kind: &str, numbers: &str| {
        let effect = format!("kind = \"{kind}\"\n{numbers}").parse().expect("a table");
        own(&WallNumbers::table().to_toml(&[effect]), &record, &still)
    };
    let plain = |x: &[f64], y: &[f64]| own(&WallNumbers::table().to_toml(&[]), x, y);
    let times = |factor: f64| record.iter().map(|a| a * factor).collect::<Vec<_>>();
    let late = [vec![0.0; 2], record.clone()].concat();
    let pairs = [
        ("gain", with("record_gain", "gain = 1.05"), plain(&times(1.05), &still)),
        ("vertical", with("vertical_ground_motion", "ratio = 0.3"), plain(&record, &times(0.3))),
        ("lag", with("record_lag", "lag_s = 0.01"), plain(&late, &[0.0, 0.0])),
    ];
    for (name, effect, by_hand) in pairs {
        let both = effect.iter().flatten().zip(by_hand.iter().flatten());
        let worst = both.fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
        // The same run to rounding, but for steps that end elsewhere: a hundredth of the smallest noise.
        assert!(worst < 1e-7, "{name}: {worst} rad");
    }
}

fn files(folder: &Path) -> Vec<(String, String)> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder")
        .map(|entry| {
            let entry = entry.expect("an entry");
            let text = std::fs::read_to_string(entry.path()).expect("a text file");
            (entry.file_name().into_string().expect("a name"), text)
        })
        .collect();
    files.sort();
    files
}

#[test]
fn regress_a_case_depends_on_its_number_alone_and_can_be_read() {
    let motions = cases::tests::motions("test").expect("the motions");
    let folders = [tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder")];
    let kind = Kind::One("viscous_damping");
    let own = (0..).map(|n| of_kind("test", 0, kind, n)).find(|case| case.simulator == Simulator::Own);
    let case = own.expect("every other combination");
    for folder in &folders {
        cases::folder::write(&case, &motions, folder.path()).expect("a case");
    }
    assert_eq!(files(folders[0].path()), files(folders[1].path()));
    let experiment =
        Experiment::load(&folders[0].path().join("experiment.toml"), None).expect("an experiment");
    assert_eq!(experiment.tests.len(), case.fit_tests + case.hold_out_tests);
    assert_eq!(experiment.fit_tests().len(), case.fit_tests);
    let answer = std::fs::read_to_string(folders[0].path().join("answer.json")).expect("the answer");
    let answer: serde_json::Value = serde_json::from_str(&answer).expect("the answer");
    assert_eq!(answer["verdict"], "named");
    assert_eq!(answer["effect"], "viscous_damping");
}

#[test]
fn analytic_a_set_holds_the_promised_shares() {
    let kinds: Vec<Kind> = (0..840).map(|n| cases::draw::draw("report", n).kind).collect();
    let nothing = kinds.iter().filter(|kind| **kind == Kind::Nothing).count();
    assert!(nothing >= 200, "{nothing} cases hide nothing");
    for effect in cases::kind::CATALOGUE {
        let count = kinds.iter().filter(|kind| **kind == Kind::One(effect)).count();
        assert!(count >= 30, "{effect} in {count} cases");
    }
}

/// Both simulators on a law that no catalogue has.
#[test]
fn analytic_drawn_laws_mean_the_same_in_both_simulators() {
    let record = sine(1.4, 0.8);
    let still = vec![0.0; record.len()];
    let reach = [0.05, 0.16];
    let [soft, stiff] = [37_000.0, 150_000.0];
    let top = |form| Atom { site: Site::Top, form, size: 600.0, reach };
    let joint = |site, form| Atom { site, form, size: 900.0, reach: [0.0125, 0.04] };
    let laws = [
        (soft, top(Form::Spring { n: 1.7 })),
        (soft, top(Form::Stop { side: -1.0, g: 0.3, n: 1.4 })),
        (soft, top(Form::DeadZone { g: 0.3, n: 1.0 })),
        (soft, top(Form::Saturation { d: 0.2 })),
        (soft, top(Form::Drag { n: 0.5 })),
        (soft, top(Form::Opening { p: 1.3, n: 0.8 })),
        (soft, top(Form::DragSaturation { s: 0.3 })),
        (soft, top(Form::OneWay { side: 1.0, n: 2.0 })),
        (soft, top(Form::Snapping { d: 0.3 })),
        (soft, top(Form::Hardening { d: 1.0 })),
        (soft, top(Form::NearRest { d: 0.4 })),
        (soft, top(Form::Slipping { s: 0.3 })),
        (soft, top(Form::Weakening { g: 1.0 })),
        (soft, top(Form::Secant { g: 0.3 })),
        (soft, top(Form::Slack { a: 0.4 })),
        (soft, joint(Site::Ground, Form::Drag { n: 2.0 })),
        (soft, joint(Site::Ground, Form::Spring { n: 2.0 })),
        // On the stiffer floor the crack does open. Springs keep it rattling, and without any law both part by 4 % of it.
        (stiff, joint(Site::Crack, Form::Drag { n: 2.0 })),
    ];
    for (stiffness_n_per_m, law) in laws {
        let wall = plastic(WallNumbers { stiffness_n_per_m, ..WallNumbers::table() });
        let without = own(&wall.to_toml(&[]), &record, &still);
        let case = case(wall, vec![Hidden::Law(law)]);
        let found = difference(&case, &record, 0.0);
        let with = own(&cases::own_wall::true_wall(&case), &record, &still);
        let pairs = with.iter().flatten().zip(without.iter().flatten());
        let shows = pairs.fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
        eprintln!("{law:?}: {found:.4}, shows {shows:.4} rad");
        assert!(found < AGREE, "{law:?}: {found}");
        assert!(shows > 5e-4, "{law:?}: shows only {shows} rad");
    }
}

/// An answer of one formula at the top.
fn answered(formula: &str, parameters: &[(&str, f64, &str)]) -> FoundEffect {
    let numbers =
        parameters.iter().map(|(name, value, _)| ((*name).to_owned(), *value)).collect::<BTreeMap<_, _>>();
    let units = parameters.iter().map(|(name, _, unit)| (*name, *unit)).collect::<BTreeMap<_, _>>();
    let interval = numbers.iter().map(|(name, x)| (name, [0.9 * x, 1.02 * x])).collect::<BTreeMap<_, _>>();
    serde_json::from_value(serde_json::json!({
        "kind": "formula", "name": "formula", "formula": formula, "place": "top",
        "parameters": numbers, "interval": interval, "units": units,
    }))
    .expect("an effect")
}

#[test]
fn analytic_a_formula_is_known_by_its_spelling_and_its_numbers_are_held_against_the_truth() {
    let reach = [0.05, 0.2];
    let drag = Atom { site: Site::Top, form: Form::Drag { n: 2.0 }, size: 400.0, reach };
    let stop = Atom { site: Site::Top, form: Form::Stop { side: -1.0, g: 0.4, n: 1.0 }, size: 300.0, reach };
    let truth =
        |atoms: &[Atom]| serde_json::json!({ "effects": atoms.iter().map(Atom::told).collect::<Vec<_>>() });
    // 400 N at 0.2 m/s.
    let exact = answered("-c*v*abs(v)", &[("c", 10_100.0, "N*(s/m)**2")]);
    let fitted = answered("-c*sign(v)*abs(v)**n", &[("c", 9000.0, "N*(s/m)**n"), ("n", 1.93, "")]);
    let line = answered("-c*v", &[("c", 2000.0, "N*s/m")]);
    for found in [&exact, &fitted] {
        assert!(is_spelled_as(&truth(&[drag]), std::slice::from_ref(found)), "{found:?}");
    }
    assert!(!is_spelled_as(&truth(&[drag]), std::slice::from_ref(&line)));
    assert!(!is_spelled_as(&truth(&[drag, stop]), std::slice::from_ref(&exact)));
    let both = answered(
        "-c_1*v*abs(v) + k_2*max(-x-g_2,0)",
        &[("c_1", 1.0, ""), ("k_2", 1.0, ""), ("g_2", 1.0, "")],
    );
    assert!(is_spelled_as(&truth(&[stop, drag]), &[both]));
    let numbers = number_errors(&truth(&[drag]), &[exact]);
    // 1 % off, in an interval from 10 % below to 2 % above what was found.
    assert!(matches!(numbers[..], [(error, true)] if (error - 0.01).abs() < 1e-12), "{numbers:?}");
}

#[test]
fn analytic_a_round_exponent_holds_the_true_one_where_its_interval_does() {
    let reach = [0.05, 0.2];
    let drag = |n: f64| Atom { site: Site::Top, form: Form::Drag { n }, size: 400.0, reach };
    let stop = |n: f64| Atom { form: Form::Stop { side: -1.0, g: 0.4, n }, ..drag(0.0) };
    let truth =
        |atoms: &[Atom]| serde_json::json!({ "effects": atoms.iter().map(Atom::told).collect::<Vec<_>>() });
    let round = |formula: &str, free: &str, intervals: &[(&str, [f64; 2])]| {
        let told = intervals.iter().map(|(name, _)| ((*name).to_owned(), 2.0)).collect();
        let interval = intervals.iter().map(|(name, ends)| ((*name).to_owned(), *ends)).collect();
        let found = RoundExponents { formula: free.to_owned(), told, interval, beside: BTreeMap::new() };
        FoundEffect { round_exponents: Some(found), ..answered(formula, &[]) }
    };
    let one = round("-c*v*abs(v)", "-c*sign(v)*abs(v)**n", &[("n", [1.9, 2.04])]);
    let held = |atoms: &[Atom], found: &FoundEffect| {
        round_exponents_hold(&truth(atoms), std::slice::from_ref(found))
    };
    assert_eq!([1.93, 2.0, 2.1].map(|n| held(&[drag(n)], &one)), [Some(true), Some(true), Some(false)]);
    assert_eq!(held(&[stop(1.93)], &one), None, "another law");
    assert_eq!(held(&[drag(1.93)], &answered("-c*v*abs(v)", &[])), None, "nothing is told of it");
    // The atoms of an answer stand in an order of its own.
    let both = round(
        "-c_1*v*abs(v) + k_2*max(-x-g_2,0)**2",
        "-c_1*sign(v)*abs(v)**n_1 + k_2*max(-x-g_2,0)**n_2",
        &[("n_1", [1.9, 2.0]), ("n_2", [1.4, 2.0])],
    );
    assert_eq!(held(&[stop(1.5), drag(1.95)], &both), Some(true));
    assert_eq!(held(&[stop(1.95), drag(1.5)], &both), Some(false));
}

#[test]
fn analytic_every_drawn_law_is_a_formula_of_its_own_force() {
    let forms = [
        Form::Spring { n: 1.7 },
        Form::Stop { side: 1.0, g: 0.3, n: 1.4 },
        Form::DeadZone { g: 0.3, n: 1.4 },
        Form::Saturation { d: 0.2 },
        Form::Drag { n: 0.5 },
        Form::Opening { p: 1.3, n: 0.8 },
        Form::DragSaturation { s: 0.3 },
        Form::OneWay { side: -1.0, n: 2.0 },
        Form::Snapping { d: 0.3 },
        Form::Hardening { d: 0.6 },
        Form::NearRest { d: 0.4 },
        Form::Slipping { s: 0.3 },
        Form::Weakening { g: 1.3 },
        Form::Secant { g: 0.3 },
        Form::Slack { a: 0.4 },
    ];
    let places = [(Site::Top, Place::Top), (Site::Ground, Place::Ground), (Site::Crack, Place::Crack)];
    let remembers =
        |form: &Form| matches!(form, Form::Weakening { .. } | Form::Secant { .. } | Form::Slack { .. });
    let all = forms.iter().flat_map(|form| places.map(|place| (*form, place)));
    for (form, (site, place)) in all.filter(|(form, (site, _))| *site == Site::Top || !remembers(form)) {
        let atom = Atom { site, form, size: 400.0, reach: [0.05, 0.2] };
        let parameters =
            atom.parameters().into_iter().map(|(name, value, unit)| Parameter::new(name, value, &unit));
        let formula = Formula::parse(&atom.formula(), place, &parameters.collect::<Vec<_>>());
        let formula = formula.unwrap_or_else(|e| panic!("{atom:?}: {e}"));
        for motion in [[0.03, -0.1], [-0.02, 0.15], [0.01, 0.02], [-0.045, -0.19]] {
            let motion = [motion[0], motion[1], 0.047];
            let [own, written] = [atom.force(motion), formula.value(motion)];
            // Two ways to the same number, of a few roundings each.
            assert!((own - written).abs() < 1e-9, "{formula} at {motion:?}: {written} for {own}");
        }
    }
}
