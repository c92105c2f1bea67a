//! What does not depend on which side is left, or on the unit of length.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::WallParameters;
use mrbd_kernel::simulate::{Accuracy, History, Response, Shaking, simulate_observed};
use rand::RngExt;

use crate::walls::{
    any_effects, any_restitution, any_shaking, any_wall, around_zero, effect, largest_difference, made, rng,
};

fn run(wall: &WallParameters, shaking: &Shaking, accuracy: Accuracy) -> (Response, History) {
    let step_s = shaking.horizontal.as_ref().map_or(0.005, Accelerogram::step_s);
    let mut history = History::new(step_s);
    let response = simulate_observed(&made(wall), shaking, accuracy, &mut history);
    (response, history)
}

/// A wall with everything that can tell left from right or one size from another, and what shakes it.
fn drawn(test: u64, index: u64) -> (WallParameters, Shaking) {
    let mut rng = rng(test, index);
    let mut wall = any_wall(&mut rng);
    wall.effects = any_effects(&mut rng, &wall);
    wall.restitution = any_restitution(&mut rng, 1.05);
    let alpha = made(&wall).alpha_i_rad();
    if rng.random_bool(0.3) {
        wall.initial_rotation_rad = alpha.map(|a| around_zero(&mut rng, a.min(1.0)));
    }
    let vertical = rng.random_bool(0.5);
    let shaking = any_shaking(&mut rng, &wall, vertical);
    (wall, shaking)
}

#[test]
fn analytic_mirrored_input_gives_the_mirrored_answer_to_the_bit() {
    for index in 0..400 {
        let (wall, shaking) = drawn(30, index);
        let mirrored_wall = WallParameters {
            eccentricity_m: -wall.eccentricity_m,
            initial_rotation_rad: wall.initial_rotation_rad.map(|theta| -theta),
            ..wall.clone()
        };
        let mirrored_shaking = Shaking {
            horizontal: shaking.horizontal.as_ref().map(|record| record.scaled(-1.0)),
            ..shaking.clone()
        };
        let (response, history) = run(&wall, &shaking, Accuracy::default());
        let (mirrored, mirrored_history) = run(&mirrored_wall, &mirrored_shaking, Accuracy::default());
        assert_eq!(history.rows.len(), mirrored_history.rows.len(), "wall {index}");
        for (row, other) in history.rows.iter().zip(&mirrored_history.rows) {
            assert_eq!(row.theta_rad, other.theta_rad.map(|theta| -theta), "wall {index}, {} s", row.time_s);
            assert_eq!(row.contact, other.contact.mirrored(), "wall {index}, {} s", row.time_s);
        }
        assert_eq!(response.outcome, mirrored.outcome);
        assert_eq!(response.impacts, mirrored.impacts);
        assert_eq!(response.energy, mirrored.energy);
        assert_eq!(response.demand, mirrored.demand);
        assert_eq!(response.work, mirrored.work);
        for (peak, other) in response.theta_max_rad.iter().zip(&mirrored.theta_max_rad) {
            assert_eq!((peak.value, peak.time_s), (-other.value, other.time_s));
        }
    }
}

/// The same wall `s` times as large and of `mu` times the mass: with g fixed, times grow as √s, forces as μ,
/// stiffness as μ/s, and so on by their units.
fn scaled_wall(wall: &WallParameters, s: f64, mu: f64) -> WallParameters {
    let root = s.sqrt();
    let mut scaled = WallParameters {
        thickness_m: s * wall.thickness_m,
        height_m: s * wall.height_m,
        crack_height_m: wall.crack_height_m.map(|h1| s * h1),
        length_m: s * wall.length_m,
        mass_kg: mu * wall.mass_kg,
        lower_width_m: s * wall.lower_width_m,
        upper_width_m: s * wall.upper_width_m,
        diaphragm_mass_kg: mu * wall.diaphragm_mass_kg,
        carriage_mass_kg: mu * wall.carriage_mass_kg,
        stiffness_n_per_m: mu / s * wall.stiffness_n_per_m,
        eccentricity_m: s * wall.eccentricity_m,
        ..wall.clone()
    };
    scaled.restitution.capture_velocity_rad_s /= root;
    for scaled in &mut scaled.effects {
        let name = scaled.variant().name();
        // N, N/m, … by their units: mass times length by time squared.
        let factor = match name.split('.').next().expect("a kind") {
            "carriage_mass" => mu,
            "viscous_damping" => mu / root,
            "cubic_stiffness" => mu / (s * s * s),
            "joint_damping" => mu * s * root,
            other => panic!("no rule for {other}"),
        };
        *scaled = effect(&name, &scaled.parameters().iter().map(|value| value * factor).collect::<Vec<_>>());
    }
    scaled
}

/// The same accelerations, √s times as slowly.
fn stretched(shaking: &Shaking, root: f64) -> Shaking {
    let stretch = |record: &Accelerogram| {
        Accelerogram::new(root * record.step_s(), record.acceleration_m_s2().to_vec()).expect("a record")
    };
    Shaking {
        horizontal: shaking.horizontal.as_ref().map(stretch),
        vertical: shaking.vertical.as_ref().map(stretch),
        tail_s: root * shaking.tail_s,
    }
}

#[test]
fn analytic_four_times_as_large_is_the_same_to_the_bit() {
    // Factors that are powers of two change no digit, only exponents.
    for index in 0..200 {
        let (wall, shaking) = drawn(31, index);
        let (response, history) = run(&wall, &shaking, Accuracy::default());
        let (large, large_history) =
            run(&scaled_wall(&wall, 4.0, 64.0), &stretched(&shaking, 2.0), Accuracy::default());
        assert_eq!(history.rows.len(), large_history.rows.len(), "wall {index}");
        for (row, other) in history.rows.iter().zip(&large_history.rows) {
            assert_eq!((row.theta_rad, row.contact), (other.theta_rad, other.contact), "wall {index}");
        }
        assert_eq!(response.impacts, large.impacts);
        assert_eq!(response.work, large.work);
        assert_eq!(response.end_time_s * 2.0, large.end_time_s);
        assert_eq!(response.energy.residual(), large.energy.residual());
    }
}

#[test]
fn analytic_any_size_is_the_same_within_roundings() {
    let mut differences: Vec<f64> = (0..200)
        .map(|index| {
            let (wall, shaking) = drawn(32, index);
            let s: f64 = [0.37, 3.0, 17.0][index as usize % 3];
            let accuracy = Accuracy { tolerance: 1e-10 };
            let (_, history) = run(&wall, &shaking, accuracy);
            let (_, large) = run(&scaled_wall(&wall, s, s.powi(3)), &stretched(&shaking, s.sqrt()), accuracy);
            largest_difference(&wall, &history, &large)
        })
        .collect();
    differences.sort_by(f64::total_cmp);
    let [median, ninety] = [0.5, 0.9].map(|q| differences[(q * 199.0) as usize]);
    eprintln!("similarity: median {median:e}, nine in ten {ninety:e}, worst {:e}", differences[199]);
    // Roundings of 1e-16 that impacts magnify; where two impacts nearly coincide they may decide the later motion,
    // and a collapsing wall doubles them every few hundredths of a second, so a few walls may differ by anything.
    assert!(median < 1e-12, "median {median:e}");
    assert!(ninety < 1e-9, "nine in ten {ninety:e}");
}
