//! The error of a run: how it falls with the step, and that the tolerance bounds it.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{ImpactLaw, WallParameters};
use mrbd_kernel::simulate::{Accuracy, History, Response, Shaking, simulate_observed};
use rand::RngExt;

use crate::walls::{
    any_effects, any_restitution, any_shaking, any_wall, largest_difference, made, rng, table_wall,
};

fn run(wall: &WallParameters, shaking: &Shaking, tolerance: f64) -> (Response, History) {
    let step_s = shaking.horizontal.as_ref().expect("a record").step_s();
    let mut history = History::new(step_s);
    let response = simulate_observed(&made(wall), shaking, Accuracy { tolerance }, &mut history);
    (response, history)
}

/// The same piecewise linear motion, each sample step cut into `parts`.
fn cut(coarse: &Accelerogram, parts: usize) -> Accelerogram {
    let a = coarse.acceleration_m_s2();
    let last = a.len() - 1;
    let at = |k: usize| {
        let (whole, part) = (k / parts, (k % parts) as f64 / parts as f64);
        a[whole] + part * (a[(whole + 1).min(last)] - a[whole])
    };
    let samples = (0..=last * parts).map(at).collect();
    Accelerogram::new(coarse.step_s() / parts as f64, samples).expect("a record")
}

#[test]
fn analytic_order_through_openings_and_impacts_is_five() {
    let dt = 0.04;
    let a = |t: f64| if t < 1.6 { 1.4 * ((2.5 * t).sin() + (7.0 * t).sin()) } else { 0.0 };
    let coarse = Accelerogram::new(dt, (0..=100).map(|k| a(f64::from(k) * dt)).collect()).expect("a record");
    let wall = table_wall(ImpactLaw::Contact);
    // A tolerance that refuses no step: the samples alone set the steps.
    let of = |parts: usize, tolerance: f64| {
        let shaking = Shaking { horizontal: Some(cut(&coarse, parts)), vertical: None, tail_s: 0.0 };
        let (response, history) = run(&wall, &shaking, tolerance);
        let rows: Vec<_> = history.rows.iter().step_by(parts).map(|row| row.theta_rad).collect();
        (response, rows)
    };
    let (response, exact) = of(64, 1e-12);
    assert!(response.impacts.total() > 5 && response.openings.crack > 0, "{response:?}");
    let error = |parts: usize| {
        let (_, rows) = of(parts, 1e9);
        assert_eq!(rows.len(), exact.len());
        let pairs = rows.iter().flatten().zip(exact.iter().flatten());
        pairs.map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max)
    };
    let errors = [1, 2, 4, 8].map(error);
    let orders: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    let overall = (errors[0] / errors[3]).log2() / 3.0;
    eprintln!(
        "errors {errors:?}, orders {orders:?}, overall {overall}, {} impacts",
        response.impacts.total()
    );
    // Fifth order; an event cuts a step where it lies, so the order of a pair of steps scatters about it.
    assert!((4.7..5.3).contains(&overall), "order {overall}: {errors:?}");
}

#[test]
fn analytic_tolerance_bounds_the_error() {
    let tolerances = [1e-4, 1e-6, 1e-8];
    let mut well = [0_u32; 3];
    let mut worst = [0.0_f64; 3];
    let mut within_anyhow = [0_u32; 3];
    let runs = 300;
    for index in 0..runs {
        let mut rng = rng(50, index);
        let mut wall = any_wall(&mut rng);
        wall.effects = any_effects(&mut rng, &wall);
        wall.restitution = any_restitution(&mut rng, 1.0);
        let vertical = rng.random_bool(0.5);
        let shaking = any_shaking(&mut rng, &wall, vertical);
        let difference = |a: &History, b: &History| largest_difference(&wall, a, b);
        let (_, exact) = run(&wall, &shaking, 1e-12);
        for (k, tolerance) in tolerances.into_iter().enumerate() {
            // Well-conditioned: shaking harder by a tenth of the tolerance moves nothing by more than the tolerance.
            let harder = Shaking {
                horizontal: shaking.horizontal.as_ref().map(|record| record.scaled(1.0 + 0.1 * tolerance)),
                ..shaking.clone()
            };
            let (_, shifted) = run(&wall, &harder, 1e-12);
            let (_, found) = run(&wall, &shaking, tolerance);
            let error = difference(&found, &exact);
            within_anyhow[k] += u32::from(error <= tolerance);
            if difference(&shifted, &exact) <= tolerance {
                well[k] += 1;
                worst[k] = worst[k].max(error / tolerance);
            }
        }
    }
    eprintln!(
        "{runs} runs at {tolerances:?}: well-conditioned {well:?}, worst error/tolerance {worst:?}, all within {within_anyhow:?}"
    );
    for (k, tolerance) in tolerances.into_iter().enumerate() {
        assert!(well[k] > 200, "at {tolerance:e} only {} runs are well-conditioned", well[k]);
        assert!(worst[k] <= 1.0, "at {tolerance:e} an error of {} tolerances", worst[k]);
    }
}
