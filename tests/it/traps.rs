//! Small traps: set-ups at the edge of what a wall or a record can be. Every run ends, with numbers that make sense.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, G_M_S2, ImpactLaw, WallParameters};
use mrbd_kernel::simulate::{Accuracy, History, Outcome, Response, Shaking, simulate_observed};
use rand::RngExt;

use crate::walls::{
    any_effects, any_restitution, any_shaking, any_wall, around_zero, bare_wall, effect, log_uniform, made,
    rng, table_wall,
};

/// Runs a wall and checks what any run must keep.
fn sane(name: &str, wall: &WallParameters, shaking: &Shaking, tolerance: f64) -> (Response, History) {
    let step_s = shaking.horizontal.as_ref().map_or(0.005, Accelerogram::step_s);
    let mut history = History::new(step_s);
    let response = simulate_observed(&made(wall), shaking, Accuracy { tolerance }, &mut history);
    let failed = matches!(response.outcome, Outcome::Failed { .. });
    assert!(!failed, "{name}: {:?}: {wall:?}", response.outcome);
    let total_s: f64 = response.pattern_time_s.iter().sum();
    // A few thousand roundings of times of some ten seconds.
    assert!((total_s - response.end_time_s).abs() < 1e-10, "{name}: {total_s} of {}", response.end_time_s);
    let rows = (response.end_time_s / step_s + 1e-6) as usize + 1;
    assert_eq!(history.rows.len(), rows, "{name}: rows");
    let turned = history.rows.iter().flat_map(|row| row.theta_rad);
    assert!(turned.into_iter().all(f64::is_finite), "{name}: rotations");
    for (i, peak) in response.theta_max_rad.iter().enumerate() {
        let largest = history.rows.iter().map(|row| row.theta_rad[i].abs()).fold(0.0, f64::max);
        // The maximum of the run is at least that of its rows, up to a rounding.
        assert!(peak.value.abs() >= largest * (1.0 - 1e-12), "{name}: {} below {largest}", peak.value);
    }
    let demands = response.demand.map(|d| d.friction);
    assert!(demands.iter().all(|friction| friction.is_finite() && *friction >= 0.0), "{name}: {demands:?}");
    assert!(response.energy.residual().is_finite(), "{name}: {:?}", response.energy);
    (response, history)
}

fn record(samples: Vec<f64>) -> Option<Accelerogram> {
    Some(Accelerogram::new(0.005, samples).expect("a record"))
}

/// One second of a sine of one hertz.
fn sine(peak_m_s2: f64) -> Shaking {
    let samples =
        (0..200).map(|k| peak_m_s2 * (std::f64::consts::TAU * f64::from(k) * 0.005).sin()).collect();
    Shaking { horizontal: record(samples), vertical: None, tail_s: 3.0 }
}

fn released(theta_rad: [f64; 2], wall: WallParameters) -> WallParameters {
    WallParameters { initial_rotation_rad: theta_rad, ..wall }
}

const FREE: Shaking = Shaking { horizontal: None, vertical: None, tail_s: 10.0 };

#[test]
fn analytic_first_sample_above_the_threshold_moves_at_once() {
    let shaking = Shaking { horizontal: record(vec![3.0, 2.0, 1.0, 0.0]), vertical: None, tail_s: 5.0 };
    for wall in [bare_wall(0.3, 3.0, Some(1.4)), bare_wall(0.3, 3.0, None), table_wall(ImpactLaw::Whole)] {
        let (response, history) = sane("first sample", &wall, &shaking, 1e-6);
        assert_ne!(history.rows[0].contact, Contact::REST);
        assert!(response.theta_max_rad[0].value < 0.0, "the ground moves to +x, the wall leans to -x");
    }
}

#[test]
fn analytic_no_shaking_moves_nothing() {
    for wall in [bare_wall(0.3, 3.0, Some(1.4)), bare_wall(0.3, 3.0, None), table_wall(ImpactLaw::Whole)] {
        let (response, _) = sane("zeros", &wall, &sine(0.0), 1e-6);
        assert_eq!(response.outcome, Outcome::Stood);
        assert!(response.pattern_time_s[1..].iter().all(|time_s| *time_s == 0.0));
        assert_eq!(response.theta_max_rad.map(|peak| peak.value), [0.0; 2]);
        assert_eq!(response.work.steps, 0);
    }
}

#[test]
fn analytic_a_plateau_at_the_threshold_ends() {
    let wall = bare_wall(0.3, 3.0, None);
    let threshold = G_M_S2 * 0.3 / 3.0;
    for ulps in -8_i64..=8 {
        let a = f64::from_bits(threshold.to_bits().wrapping_add_signed(ulps));
        let shaking = Shaking { horizontal: record(vec![a; 200]), vertical: None, tail_s: 1.0 };
        let (response, _) = sane("plateau", &wall, &shaking, 1e-6);
        assert_eq!(response.outcome, Outcome::Stood, "{ulps} roundings from the threshold");
    }
}

#[test]
fn analytic_a_capture_velocity_of_zero_lets_walls_come_to_rest() {
    for slenderness in [1.0, 3.0, 10.0, 60.0] {
        for crack in [None, Some(0.5), Some(0.95)] {
            for (law, c) in [(ImpactLaw::Whole, 1.0), (ImpactLaw::Whole, 0.9), (ImpactLaw::Contact, 0.9)] {
                let height_m = 0.1 * slenderness;
                let mut wall = bare_wall(0.1, height_m, crack.map(|share| share * height_m));
                wall.restitution.capture_velocity_rad_s = 0.0;
                wall.restitution.coefficients = [c; 8];
                wall.restitution.law = law;
                let alpha = made(&wall).alpha_rad();
                let name = format!("slenderness {slenderness}, crack {crack:?}, C {c}");
                let wall = released([0.5 * alpha; 2], wall);
                let (response, history) = sane(&name, &wall, &Shaking { tail_s: 100.0, ..FREE }, 1e-6);
                assert_eq!(response.outcome, Outcome::Stood, "{name}");
                let rest = history.rows.last().expect("a row").contact == Contact::REST;
                assert!(rest || (slenderness == 60.0 && c == 1.0), "{name} still rocks after 100 s");
            }
        }
    }
}

#[test]
fn analytic_releases_of_every_kind_end() {
    let wall = bare_wall(0.3, 3.0, Some(1.5));
    for theta in [[0.03, 0.03], [0.0, 0.03], [0.03, 0.0], [0.03, -0.03], [-0.05, 0.0], [1e-12, -1e-12]] {
        for capture in [0.0, 1e-9, 1e-3] {
            for law in [ImpactLaw::Whole, ImpactLaw::Contact] {
                let mut wall = released(theta, wall.clone());
                wall.restitution.capture_velocity_rad_s = capture;
                wall.restitution.law = law;
                sane(&format!("release from {theta:?}, capture {capture:e}"), &wall, &FREE, 1e-6);
            }
        }
    }
    // Leaning beyond its collapse rotation it has collapsed before it moves.
    let (response, _) = sane("collapsed", &released([0.5; 2], wall), &FREE, 1e-6);
    assert_eq!(response.outcome, Outcome::Collapsed { time_s: 0.0 });
}

#[test]
fn analytic_both_joints_closing_together_end() {
    // Released to opposite sides in the ratio of a symmetric three-hinged wall, both joints close near one instant.
    for ratio in [-0.5, -1.0, -1.0 + 1e-9, -1.0 - 1e-12, -2.0, 2.0] {
        let wall = bare_wall(0.4, 4.0, Some(2.0));
        for stiffness_n_per_m in [0.0, 1e5, 1e7] {
            let wall = WallParameters { stiffness_n_per_m, ..released([0.02, 0.02 * ratio], wall.clone()) };
            sane(&format!("ratio {ratio}, k {stiffness_n_per_m:e}"), &wall, &FREE, 1e-6);
        }
    }
}

#[test]
fn analytic_extreme_shapes_and_springs_end() {
    for (name, wall, peak) in [
        ("squat", bare_wall(1.0, 1.0, Some(0.5)), 15.0),
        ("squat, uncracked", bare_wall(1.0, 1.0, None), 15.0),
        ("twice as thick as high", bare_wall(2.0, 1.0, Some(0.3)), 25.0),
        ("slender", bare_wall(0.1, 6.0, Some(3.0)), 0.3),
        ("slender, uncracked", bare_wall(0.1, 6.0, None), 0.3),
        ("thin upper body", bare_wall(0.3, 3.0, Some(2.999)), 2.0),
        ("thin lower body", bare_wall(0.3, 3.0, Some(0.001)), 2.0),
    ] {
        sane(name, &wall, &sine(peak), 1e-6);
    }
    for stiffness_n_per_m in [1e7, 1e9, 1e11] {
        for law in [ImpactLaw::Whole, ImpactLaw::Contact] {
            let wall = WallParameters { stiffness_n_per_m, ..table_wall(law) };
            sane(&format!("k {stiffness_n_per_m:e}"), &wall, &sine(6.0), 1e-6);
        }
    }
}

#[test]
fn analytic_tails_shorter_than_a_step_end_on_time() {
    for tail_s in [0.0, 1e-12, 1e-4, 0.0049999, 0.005, 0.0050001] {
        let shaking = Shaking { tail_s, ..sine(1.5) };
        let (response, _) = sane(&format!("tail {tail_s}"), &table_wall(ImpactLaw::Whole), &shaking, 1e-6);
        assert_eq!(response.end_time_s, 0.995 + tail_s);
    }
}

#[test]
fn analytic_ground_that_falls_faster_than_the_wall_ends() {
    for down in [9.0, 9.81, 12.0, 30.0, 100.0] {
        for across in [0.0, 0.5, 3.0] {
            for wall in
                [bare_wall(0.3, 3.0, Some(1.5)), bare_wall(0.3, 3.0, None), table_wall(ImpactLaw::Whole)]
            {
                let shaking = Shaking { vertical: sine(down).horizontal, ..sine(across) };
                let (response, _) = sane(&format!("{down} down, {across} across"), &wall, &shaking, 1e-6);
                let flies = response.demand[0].tensions > 0;
                assert!(
                    down < G_M_S2 || flies || across > 1.0 || down == 9.81,
                    "{down} {across}: no tension told"
                );
            }
        }
    }
}

#[test]
fn regress_once_failed() {
    // An impact of both joints within a rounding of each other went round in circles.
    let mut plate = bare_wall(0.496, 0.821, Some(0.0264));
    (plate.mass_kg, plate.carriage_mass_kg) = (497.9, 235.5);
    plate.restitution.law = ImpactLaw::Contact;
    plate.restitution.capture_velocity_rad_s = 4.5e-3;
    for theta in [[-0.677, 0.039], [-0.5, 0.1], [-0.3, 0.3]] {
        sane("plate", &released(theta, plate.clone()), &FREE, 4e-4);
    }
    // A damped joint and a stiff spring at a loose tolerance: flights lower than the error of a step.
    let mut stiff = bare_wall(0.438, 3.497, Some(2.431));
    stiff.stiffness_n_per_m = 9.4e8;
    stiff.effects = vec![effect("joint_damping.ground", &[631.0])];
    for tolerance in [1e-3, 1e-5] {
        sane("stiff", &stiff, &sine(8.0), tolerance);
    }
}

/// A wall and a shaking from far outside of what a study would run.
fn fuzzed(index: u64) -> (WallParameters, Shaking, f64) {
    let mut rng = rng(101, index);
    let mut wall = any_wall(&mut rng);
    if rng.random_bool(0.5) {
        wall.effects = any_effects(&mut rng, &wall);
    }
    wall.restitution = any_restitution(&mut rng, 1.1);
    match rng.random_range(0..6) {
        0 => wall.restitution.capture_velocity_rad_s = 0.0,
        1 => wall.restitution.capture_velocity_rad_s = 1e-12,
        _ => {}
    }
    if rng.random_bool(0.2) {
        wall.restitution.coefficients = [1.0; 8];
    }
    if rng.random_bool(0.1) {
        wall.stiffness_n_per_m = log_uniform(&mut rng, 1e5, 1e9);
    }
    if rng.random_bool(0.2) {
        wall.crack_height_m = None;
        wall.effects.retain(|effect| effect.variant().choice != Some("crack"));
    }
    if rng.random_bool(0.2) {
        let lean = made(&wall).alpha_i_rad().map(|a| (a * around_zero(&mut rng, 1.5)).clamp(-1.5, 1.5));
        wall.initial_rotation_rad = match (wall.crack_height_m, rng.random_range(0..4)) {
            (None, _) | (_, 0) => [lean[0]; 2],
            (_, 1) => [lean[0], 0.0],
            (_, 2) => [0.0, lean[1]],
            _ => lean,
        };
    }
    let vertical = rng.random_bool(0.3);
    let mut shaking = any_shaking(&mut rng, &wall, vertical);
    if rng.random_bool(0.3) {
        let factor = rng.random_range(0.5..3.0);
        shaking.vertical = shaking.vertical.map(|record| record.scaled(factor * G_M_S2 / record.peak_m_s2()));
    }
    match rng.random_range(0..10) {
        0 => shaking.tail_s = rng.random_range(0.0..0.01),
        1 => shaking.tail_s = 30.0,
        2 => (shaking.horizontal, shaking.vertical) = (None, None),
        3 => shaking.horizontal = shaking.horizontal.map(|record| record.scaled(0.0)),
        _ => {}
    }
    let tolerance = log_uniform(&mut rng, 1e-10, 1e-3);
    (wall, shaking, tolerance)
}

#[test]
fn analytic_no_random_run_fails() {
    let mut ends = [0_u32; 2];
    let mut impacts = 0;
    for index in 0..8000 {
        let (wall, shaking, tolerance) = fuzzed(index);
        let (response, _) = sane(&format!("run {index}"), &wall, &shaking, tolerance);
        ends[usize::from(response.collapsed())] += 1;
        impacts += response.impacts.total();
    }
    eprintln!("{} stood, {} collapsed, {impacts} impacts", ends[0], ends[1]);
    assert!(ends.iter().all(|count| *count > 1000), "{ends:?}");
}
