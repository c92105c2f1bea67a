//! Whole runs with every effect: energy, mirror, tolerance, and no input that fails.

use mrbd_kernel::model::{Effect, G_M_S2, Role, WallParameters};
use mrbd_kernel::simulate::{Accuracy, History, Outcome, Response, Shaking, simulate, simulate_observed};
use rand::RngExt;

use crate::walls::{
    any_of_all_effects, any_restitution, any_shaking, any_wall, around_zero, effect, largest_difference,
    log_uniform, made, rng,
};

fn drawn(test: u64, index: u64) -> (WallParameters, Shaking) {
    let mut rng = rng(test, index);
    let mut wall = any_wall(&mut rng);
    wall.effects = any_of_all_effects(&mut rng, &wall);
    wall.restitution = any_restitution(&mut rng, 1.0);
    if rng.random_bool(0.3) {
        let alpha = made(&wall).alpha_i_rad();
        wall.initial_rotation_rad = alpha.map(|a| around_zero(&mut rng, a.min(1.0)));
    }
    let vertical = rng.random_bool(0.5);
    let shaking = any_shaking(&mut rng, &wall, vertical);
    (wall, shaking)
}

fn run(wall: &WallParameters, shaking: &Shaking, tolerance: f64) -> (Response, History) {
    let step_s = shaking.horizontal.as_ref().expect("a record").step_s();
    let mut history = History::new(step_s);
    let response = simulate_observed(&made(wall), shaking, Accuracy { tolerance }, &mut history);
    (response, history)
}

/// Whether an effect takes energy while it drags.
fn drags(effect: &Effect) -> bool {
    match effect.entry().role {
        Role::Friction | Role::Memory => true,
        Role::Mass | Role::Damper | Role::Spring | Role::Corners | Role::Bed | Role::JointLaw => false,
        Role::Impact | Role::ImpactSpeed | Role::GroundMotion | Role::Sensor => false,
    }
}

#[test]
fn analytic_the_ledger_balances_with_every_effect() {
    let mut worst = 0.0_f64;
    let (mut impacts, mut lossy) = (0, 0);
    for index in 0..500 {
        let (wall, shaking) = drawn(320, index);
        let (response, _) = run(&wall, &shaking, 1e-10);
        assert!(!matches!(response.outcome, Outcome::Failed { .. }), "wall {index}: {:?}", response.outcome);
        let residual = response.energy.residual();
        assert!(residual.is_finite(), "wall {index}");
        worst = worst.max(residual);
        impacts += response.impacts.total();
        let dissipates = wall.effects.iter().any(drags);
        lossy += u32::from(dissipates && response.energy.effect_loss_j > 0.0);
        assert!(response.energy.effect_loss_j >= 0.0, "wall {index}: effects gave energy");
    }
    eprintln!("energy residual: worst {worst:e} over 500 runs and {impacts} impacts, {lossy} with drag");
    assert!(lossy > 200, "{lossy}");
    // Ten times that without kinks (`energy` in these tests): a bed of 1e11 Pa/m magnifies the roundings of φ.
    assert!(worst <= 1e-7, "{worst:e}");
}

fn mirrored(effects: &[Effect]) -> Vec<Effect> {
    let mirror = |one: &Effect| match one.variant().name().as_str() {
        "one_sided_spring.positive" => effect("one_sided_spring.negative", &one.parameters()),
        "one_sided_spring.negative" => effect("one_sided_spring.positive", &one.parameters()),
        "vertical_ground_motion" => effect("vertical_ground_motion", &[-one.parameters()[0]]),
        "sensor_offset.upper" => effect("sensor_offset.upper", &[-one.parameters()[0]]),
        _ => *one,
    };
    effects.iter().map(mirror).collect()
}

#[test]
fn analytic_mirrored_effects_give_the_mirrored_answer_to_the_bit() {
    for index in 0..200 {
        let (wall, shaking) = drawn(321, index);
        let mirrored_wall = WallParameters {
            eccentricity_m: -wall.eccentricity_m,
            initial_rotation_rad: wall.initial_rotation_rad.map(|theta| -theta),
            effects: mirrored(&wall.effects),
            ..wall.clone()
        };
        let mirrored_shaking = Shaking {
            horizontal: shaking.horizontal.as_ref().map(|record| record.scaled(-1.0)),
            ..shaking.clone()
        };
        let (response, history) = run(&wall, &shaking, 1e-6);
        let (other, other_history) = run(&mirrored_wall, &mirrored_shaking, 1e-6);
        assert_eq!(history.rows.len(), other_history.rows.len(), "wall {index}");
        for (row, other) in history.rows.iter().zip(&other_history.rows) {
            assert_eq!(row.theta_rad, other.theta_rad.map(|theta| -theta), "wall {index}, {} s", row.time_s);
        }
        assert_eq!(response.energy, other.energy, "wall {index}: {:?}", wall.effects);
        assert_eq!(response.work, other.work);
    }
}

#[test]
fn analytic_tolerance_bounds_the_error_with_kinks() {
    let tolerances = [1e-4, 1e-7];
    let mut well = [0_u32; 2];
    let mut worst = [0.0_f64; 2];
    for index in 0..150 {
        let (wall, shaking) = drawn(322, index);
        let difference = |a: &History, b: &History| largest_difference(&wall, a, b);
        let (_, exact) = run(&wall, &shaking, 1e-12);
        for (k, tolerance) in tolerances.into_iter().enumerate() {
            // Well-conditioned: shaking harder by a tenth of the tolerance moves nothing by more than the tolerance.
            let harder = Shaking {
                horizontal: shaking.horizontal.as_ref().map(|record| record.scaled(1.0 + 0.1 * tolerance)),
                ..shaking.clone()
            };
            if difference(&run(&wall, &harder, 1e-12).1, &exact) <= tolerance {
                let error = difference(&run(&wall, &shaking, tolerance).1, &exact) / tolerance;
                well[k] += 1;
                worst[k] = worst[k].max(error);
            }
        }
    }
    eprintln!("150 runs at {tolerances:?}: well-conditioned {well:?}, worst error/tolerance {worst:?}");
    for k in 0..2 {
        assert!(well[k] > 90, "{well:?}");
        assert!(worst[k] <= 1.0, "{worst:?}");
    }
}

/// Effects at the top of any size, from nothing to far beyond the weight of the wall.
fn extreme(rng: &mut rand_chacha::ChaCha8Rng, wall: &WallParameters) -> Vec<Effect> {
    let weight_n = wall.mass_kg * G_M_S2;
    let mut of = |size: f64| size * log_uniform(rng, 1e-9, 1e3);
    let h = wall.height_m;
    let mut all = vec![
        effect("coulomb_friction", &[of(weight_n)]),
        effect("gap", &[of(wall.thickness_m * 1e-2)]),
        effect("one_sided_spring.positive", &[of(weight_n / h)]),
        effect("one_sided_spring.negative", &[of(weight_n / h)]),
        effect("yielding_spring", &[of(weight_n / h), of(weight_n)]),
        effect("viscous_damping", &[of(weight_n / h * 0.1)]),
    ];
    all.retain(|_| rng.random_bool(0.6));
    all
}

#[test]
fn analytic_extreme_effects_do_not_fail() {
    for index in 0..1500 {
        let mut rng = rng(323, index);
        let mut wall = any_wall(&mut rng);
        wall.restitution = any_restitution(&mut rng, 1.0);
        if rng.random_bool(0.3) {
            wall.restitution.capture_velocity_rad_s = 0.0;
        }
        if rng.random_bool(0.2) {
            wall.crack_height_m = None;
        }
        wall.effects = extreme(&mut rng, &wall);
        if rng.random_bool(0.3) {
            let lean = made(&wall).alpha_i_rad().map(|a| (a * around_zero(&mut rng, 1.0)).clamp(-1.5, 1.5));
            wall.initial_rotation_rad = if wall.crack_height_m.is_some() { lean } else { [lean[0]; 2] };
        }
        let shaking = any_shaking(&mut rng, &wall, index % 2 == 0);
        let response =
            simulate(&made(&wall), &shaking, Accuracy { tolerance: log_uniform(&mut rng, 1e-9, 1e-3) });
        assert!(
            !matches!(response.outcome, Outcome::Failed { .. }),
            "{index}: {:?} with {:?}",
            response.outcome,
            wall.effects
        );
        assert!(response.theta_max_rad.iter().all(|peak| peak.value.is_finite()), "{index}");
    }
}
