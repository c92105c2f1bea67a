//! Limits in which the wall of two bodies becomes something simpler.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, G_M_S2, ImpactLaw, Pivot, WallParameters};
use mrbd_kernel::simulate::{
    Accuracy, FREE_RELEASE_STEP_S, History, Outcome, Response, Shaking, simulate_observed,
};

use crate::walls::{bare_wall, made, table_wall};

const TIGHT: Accuracy = Accuracy { tolerance: 1e-10 };

fn run(wall: &WallParameters, shaking: &Shaking) -> (Response, History) {
    let step_s = shaking.horizontal.as_ref().map_or(FREE_RELEASE_STEP_S, Accelerogram::step_s);
    let mut history = History::new(step_s);
    let response = simulate_observed(&made(wall), shaking, TIGHT, &mut history);
    (response, history)
}

/// A sine that fades in and out over three seconds.
fn shaken(peak_m_s2: f64) -> Shaking {
    let a = |t: f64| peak_m_s2 * (6.0 * t).sin() * (std::f64::consts::PI * t / 3.0).sin();
    let samples = (0..=600).map(|k| a(f64::from(k) * 0.005)).collect();
    Shaking {
        horizontal: Some(Accelerogram::new(0.005, samples).expect("a record")),
        vertical: None,
        tail_s: 3.0,
    }
}

fn largest(history: &History, body: usize) -> f64 {
    history.rows.iter().map(|row| row.theta_rad[body].abs()).fold(0.0, f64::max)
}

/// Largest difference of the rotation of one body, relative to the largest rotation.
fn apart(a: &History, b: &History, body: usize) -> f64 {
    assert_eq!(a.rows.len(), b.rows.len());
    let rows = a.rows.iter().zip(&b.rows);
    rows.map(|(a, b)| (a.theta_rad[body] - b.theta_rad[body]).abs()).fold(0.0, f64::max) / largest(b, body)
}

#[test]
fn analytic_a_vanishing_upper_body_leaves_a_block() {
    let (_, block) = run(&bare_wall(0.3, 3.0, None), &shaken(2.0));
    assert!(largest(&block, 0) > 0.01);
    for share in [1e-3, 1e-5, 1e-7] {
        // The crack runs just below the top, so the wall as a whole stays the same.
        let (response, cracked) = run(&bare_wall(0.3, 3.0, Some(3.0 * (1.0 - share))), &shaken(2.0));
        assert_eq!(response.openings.crack, 0, "a flat plate stays on the block");
        let difference = apart(&cracked, &block, 0);
        // As long as the plate sticks the two are one block, whatever its share.
        assert!(difference < 1e-9, "share {share}: {difference:e}");
    }
}

#[test]
fn analytic_a_vanishing_lower_body_leaves_a_block() {
    // Narrower at the crack than at the ground: the upper body rocks alone.
    let narrow = WallParameters { lower_width_m: 0.25, ..bare_wall(0.3, 3.0, None) };
    let (_, block) = run(&narrow, &shaken(2.0));
    let mut last = f64::INFINITY;
    for share in [1e-3, 1e-5, 1e-7] {
        let mut wall = bare_wall(0.3, 3.0, Some(3.0 * share));
        wall.upper_width_m = 0.25;
        let (response, cracked) = run(&wall, &shaken(2.0));
        for contact in Contact::ALL.into_iter().filter(|contact| contact.ground.is_open()) {
            assert_eq!(response.pattern_time_s[contact.index()], 0.0, "share {share}: {}", contact.name());
        }
        let difference = apart(&cracked, &block, 1);
        // The upper body is lower by the share; the motion follows in proportion, magnified by its impacts.
        assert!(difference < 300.0 * share && difference < last, "share {share}: {difference:e}");
        eprintln!("lower body {share:e}: {difference:e}");
        last = difference;
    }
}

#[test]
fn analytic_a_crack_that_never_opens_changes_nothing() {
    // Low top masses and a crack high up: the wall rocks as one.
    let mut cracked = table_wall(ImpactLaw::Whole);
    cracked.crack_height_m = Some(3.7);
    let whole = WallParameters { crack_height_m: None, ..cracked.clone() };
    let (response, cracked) = run(&cracked, &shaken(1.2));
    assert_eq!(response.openings.crack + response.openings.ground + response.openings.rest_to_4, 0);
    assert!(response.impacts.table2[5] > 3, "{:?}", response.impacts);
    let (_, whole) = run(&whole, &shaken(1.2));
    let difference = apart(&cracked, &whole, 0);
    eprintln!("locked crack: {difference:e}");
    // Other sums in another order, at a step error of 1e-13: the steps differ because α_2 does.
    assert!(difference < 1e-10, "{difference:e}");
}

#[test]
fn analytic_a_weak_spring_is_no_spring() {
    let free = WallParameters { stiffness_n_per_m: 0.0, ..table_wall(ImpactLaw::Contact) };
    let (_, without) = run(&free, &shaken(1.0));
    assert!(largest(&without, 0) > 1e-3);
    let difference = |stiffness_n_per_m: f64| {
        let (_, with) = run(&WallParameters { stiffness_n_per_m, ..free.clone() }, &shaken(1.0));
        apart(&with, &without, 0)
    };
    let [weak, weaker] = [1e-1, 1e-3].map(difference);
    eprintln!("weak springs: {weak:e} {weaker:e}");
    // In proportion to the spring over the weight per height, 1e4 N/m, with a margin for what impacts magnify.
    assert!(weak < 100.0 * 1e-5, "{weak:e}");
    assert!(weaker < 2e-2 * weak + 1e-9, "{weaker:e} against {weak:e}");
}

#[test]
fn analytic_a_held_top_leaves_bending_only() {
    // One pulse that opens the hinge mechanism, watched while the pulse lasts.
    let pulse = |peak: f64| {
        let samples = (0..=40).map(|k| peak * (std::f64::consts::PI * f64::from(k) / 40.0).sin()).collect();
        Shaking {
            horizontal: Some(Accelerogram::new(0.005, samples).expect("a record")),
            vertical: None,
            tail_s: 0.0,
        }
    };
    let of = |stiffness_n_per_m: f64| {
        let wall =
            WallParameters { stiffness_n_per_m, carriage_mass_kg: 0.0, ..table_wall(ImpactLaw::Contact) };
        let (response, history) = run(&wall, &pulse(12.0));
        assert_eq!(response.outcome, Outcome::Stood);
        let as_one = history.rows.iter().filter(|row| row.contact.crack.is_closed());
        let rigid_rad = as_one.map(|row| row.theta_rad[0].abs()).fold(0.0, f64::max);
        for row in history.rows.iter().filter(|row| row.contact.crack.is_open()) {
            assert_eq!(row.contact.pattern_number(), Some(2), "{} s", row.time_s);
        }
        (response.top_displacement_m.value.abs(), rigid_rad, response.theta_max_over_alpha_i())
    };
    let results = [1e7, 1e8, 1e9, 1e10].map(of);
    eprintln!("held top: {results:?}");
    for (soft, stiff) in results.iter().zip(&results[1..]) {
        // Ten times the stiffness, a tenth of the displacement; the swing of the top on the spring, whose phase at the
        // end of the pulse is anybody's, adds up to a fifth.
        assert!((8.0..12.5).contains(&(soft.0 / stiff.0)), "{soft:?} {stiff:?}");
    }
    for (result, stiffness_n_per_m) in results.iter().zip([1e7, 1e8, 1e9, 1e10]) {
        // As one body the wall leans only as far as the spring, pushed by a fraction of the weight, gives way.
        let force_n = stiffness_n_per_m * 3.984 * result.1;
        assert!(force_n < 0.2 * (3614.0 + 179.0) * G_M_S2, "{force_n} N");
    }
    // What is left is bending, and it does not vanish.
    assert!(results[3].2[0] > 0.4 && results[3].2[1] > 0.4, "{results:?}");
}

#[test]
fn analytic_a_slender_block_on_a_spring_swings_as_an_oscillator() {
    // In the limit α → 0 a released block with a top mass, a carriage and a spring obeys I θ'' = -K (θ + θ_0), with
    // I the inertia about its corner, K = k h² - (m/2 + m_d) g h and K θ_0 = (m + m_d) g b/2.
    let (h, alpha, release) = (3.0, 1e-4, 1e-5);
    let mut wall = bare_wall(h * alpha, h, None);
    (wall.mass_kg, wall.diaphragm_mass_kg, wall.carriage_mass_kg) = (1000.0, 200.0, 300.0);
    wall.stiffness_n_per_m = 5e4;
    wall.initial_rotation_rad = [release; 2];
    let b = wall.lower_width_m;
    let inertia = 1000.0 * h * h / 3.0 + 500.0 * h * h;
    let stiffness = 5e4 * h * h - 700.0 * G_M_S2 * h;
    let offset = 1200.0 * G_M_S2 * b / 2.0 / stiffness;
    let omega = (stiffness / inertia).sqrt();
    let closes_s = (offset / (release + offset)).acos() / omega;
    let (response, history) = run(&wall, &Shaking { tail_s: 0.2, ..Shaking::default() });
    let first = Contact { ground: Pivot::Right, crack: Pivot::Closed };
    let mut compared = 0;
    for row in history.rows.iter().filter(|row| row.time_s < closes_s) {
        assert_eq!(row.contact, first);
        let expected = (release + offset) * (omega * row.time_s).cos() - offset;
        // Terms in α² = 1e-8, of the release.
        assert!((row.theta_rad[0] - expected).abs() < 1e-7 * release, "{} s", row.time_s);
        compared += 1;
    }
    assert!(compared > 5, "{compared} rows before {closes_s} s; {:?}", response.outcome);
}
