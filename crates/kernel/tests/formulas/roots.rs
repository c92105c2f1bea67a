//! Roots of a velocity, which rise without end where it is zero: a wall that all but rests creeps under them.

use super::*;

/// Two sines that come and go, so that the wall opens by a little again and again.
fn growing(scale: f64) -> Shaking {
    let a = |t: f64| scale * (0.35 * t).sin() * ((9.0 * t).sin() + (23.0 * t).sin());
    let samples = (0..900).map(|k| a(0.01 * f64::from(k))).collect();
    Shaking {
        horizontal: Some(Accelerogram::new(0.01, samples).expect("a record")),
        vertical: None,
        tail_s: 1.0,
    }
}

fn root(place: Place, rate: &str, c: f64, n: f64) -> Wall {
    let unit = if place == Place::Top { "N*(s/m)**n" } else { "N*m*s**n" };
    let text = format!("-c*sign({rate})*abs({rate})**n");
    let law = formula(place, &text, &[("c", c, unit), ("n", n, "")]);
    with_formulas(&[law], table_wall())
}

#[test]
fn analytic_a_wall_that_creeps_under_a_root_takes_no_endless_steps() {
    for (place, rate, c) in [(Place::Top, "v", 14e3), (Place::Ground, "w", 20e3), (Place::Crack, "w", 10e3)] {
        for n in [0.3, 0.5, 0.7] {
            for scale in [0.7, 1.1, 1.8] {
                let run = simulate(&root(place, rate, c, n), &growing(scale), Accuracy { tolerance: 1e-6 });
                let what = format!("{place:?}, power {n}, {scale} m/s²");
                assert_eq!(run.outcome, Outcome::Stood, "{what}");
                // Some fifty steps a sample of the record where a force is as steep as it may be; a run that stalled took 8e5 before it failed.
                assert!(run.work.evaluations < 300_000, "{what}: {}", run.work.evaluations);
                // As other runs at this tolerance.
                assert!(run.energy.residual() < 1e-7, "{what}: {}", run.energy.residual());
            }
        }
    }
}

#[test]
fn analytic_walls_that_creep_side_by_side_move_as_they_do_alone() {
    let walls = [0.3, 0.4, 0.5, 0.6, 0.7].map(|n| root(Place::Top, "v", 14e3, n));
    let accuracy = Accuracy { tolerance: 1e-6 };
    let simulators = walls.each_ref().map(|wall| Simulator::new(wall, &growing(1.1), accuracy));
    let mut waiting = simulators.iter().enumerate();
    let mut next = || waiting.next().map(|(index, simulator)| (index, simulator.prepared()));
    let mut beside = vec![None; walls.len()];
    simulate_side_by_side(&mut next, &mut |index, response| beside[index] = Some(response));
    for (wall, beside) in walls.iter().zip(beside) {
        let alone = simulate(wall, &growing(1.1), accuracy);
        assert_eq!(format!("{beside:?}"), format!("{:?}", Some(alone)));
    }
}
