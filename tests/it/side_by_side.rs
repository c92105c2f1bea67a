//! Walls side by side in the lanes of vector registers move as each does alone.

use fearless_simd::{Level, Simd};
use mrbd_formula::{Formula, Parameter, Place};
use mrbd_kernel::model::State;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{
    Accuracy, History, Outcome, Response, Shaking, Simulator, Start, simulate, simulate_side_by_side_at,
    simulate_watched_side_by_side,
};
use rand::RngExt;

use crate::walls::{any_bed, any_effects, any_restitution, any_shaking, any_wall, made, rng};

/// Walls of all kinds, cracked and not, most without effects, each under a shaking of its own.
fn anything(count: u64) -> Vec<(Wall, Shaking, Accuracy)> {
    let one = |index| {
        let mut rng = rng(83, index);
        let mut wall = any_wall(&mut rng);
        if rng.random_bool(0.2) {
            wall.effects = any_effects(&mut rng, &wall);
        }
        wall.restitution = any_restitution(&mut rng, 1.0);
        let vertical = rng.random_bool(0.5);
        let shaking = any_shaking(&mut rng, &wall, vertical);
        (made(&wall), shaking, Accuracy { tolerance: 10_f64.powf(-rng.random_range(3.0..10.0)) })
    };
    (0..count).map(one).collect()
}

fn side_by_side<'a>(runs: impl Iterator<Item = &'a (Wall, Shaking, Accuracy)>) -> Vec<Response> {
    side_by_side_at(Level::new(), runs)
}

fn side_by_side_at<'a>(
    level: Level,
    runs: impl Iterator<Item = &'a (Wall, Shaking, Accuracy)>,
) -> Vec<Response> {
    let mut runs = runs.enumerate();
    let mut next = || {
        let (index, (wall, shaking, accuracy)) = runs.next()?;
        Some((index, Simulator::new(wall, shaking, *accuracy).prepared()))
    };
    let mut told = Vec::new();
    simulate_side_by_side_at(level, &mut next, &mut |index, response| told.push((index, response)));
    told.sort_by_key(|(index, _)| *index);
    told.into_iter().map(|(_, response)| response).collect()
}

/// Side by side the runs have the bits of each alone: by every set of vector instructions of this processor, and in other company, from
/// the last to the first.
fn go_as_alone(runs: &[(Wall, Shaking, Accuracy)], alone: &[Response]) {
    for level in levels() {
        assert!(side_by_side_at(level, runs.iter()) == alone, "{level:?}");
    }
    let mut backwards = side_by_side(runs.iter().rev());
    backwards.reverse();
    assert!(backwards == alone);
}

#[test]
fn analytic_walls_side_by_side_move_as_alone_to_the_bit() {
    let runs = anything(400);
    let alone: Vec<Response> = runs.iter().map(|(wall, shaking, of)| simulate(wall, shaking, *of)).collect();
    let collapsed = alone.iter().filter(|response| response.collapsed()).count();
    let impacts: u64 = alone.iter().map(|response| response.impacts.total()).sum();
    assert!(collapsed > 20 && impacts > 5000, "{collapsed} collapses, {impacts} impacts");
    // All numbers are finite, so that equal ones have the same bits but for the sign of a zero.
    assert!(side_by_side(runs.iter()) == alone);
    go_as_alone(&runs, &alone);
    // In smaller company: five, two, and one alone.
    for few in [1, 2, 5] {
        assert!(side_by_side(runs.iter().take(few)) == alone[..few]);
    }
    assert!(side_by_side(runs.iter().take(0)).is_empty());
}

/// Formulas at the top and the units of their parameters c and g: smooth ones, and with branches by where the top is and which way or
/// how fast it moves.
const FORMULAS: [(&str, &str, Option<&str>); 8] = [
    ("-c*v", "N*s/m", None),
    ("-c*x*abs(x)", "N/m**2", None),
    ("-c*v*abs(v)", "N*s**2/m**2", None),
    ("-c*sign(v)*abs(v)**1.4", "N*(s/m)**1.4", None),
    ("-c*max(v, 0)", "N*s/m", None),
    ("-c*max(v - g, 0)", "N*s/m", Some("m/s")),
    ("-c*max(x - g, 0)", "N/m", Some("m")),
    ("-c*max(-g - x, 0)", "N/m", Some("m")),
];

/// Walls with a formula, some with effects beside it.
fn with_formulas(count: u64) -> Vec<(Wall, Shaking, Accuracy)> {
    let one = |index| {
        let mut rng = rng(86, index);
        let mut wall = any_wall(&mut rng);
        if rng.random_bool(0.2) {
            wall.effects = any_effects(&mut rng, &wall);
        }
        let (text, unit, limit) = FORMULAS[rng.random_range(0..FORMULAS.len())];
        let c = Parameter::new("c", wall.mass_kg * rng.random_range(0.2..4.0), unit);
        let g = limit.map(|unit| Parameter::new("g", 0.01, unit));
        let own: Vec<Parameter> = [c].into_iter().chain(g).collect();
        wall.formulas.push(Formula::parse(text, Place::Top, &own).expect("a formula"));
        wall.restitution = any_restitution(&mut rng, 1.0);
        let shaking = any_shaking(&mut rng, &wall, true);
        let accuracy = Accuracy { tolerance: 10_f64.powf(-rng.random_range(3.0..9.0)) };
        Some((Wall::new(wall).ok()?, shaking, accuracy))
    };
    (0..count).filter_map(one).collect()
}

#[test]
fn analytic_walls_with_formulas_side_by_side_move_as_alone_to_the_bit() {
    let runs = with_formulas(160);
    let alone: Vec<Response> = runs.iter().map(|(wall, shaking, of)| simulate(wall, shaking, *of)).collect();
    let impacts: u64 = alone.iter().map(|response| response.impacts.total()).sum();
    assert!(runs.len() > 100 && impacts > 2000, "{} walls, {impacts} impacts", runs.len());
    go_as_alone(&runs, &alone);
}

/// Walls with a bed in a joint or in both, some with effects beside it. None where the wall would fall on its bed.
fn on_beds(count: u64) -> Vec<(Wall, Shaking, Accuracy)> {
    let one = |index| {
        let mut rng = rng(85, index);
        let mut wall = any_wall(&mut rng);
        if rng.random_bool(0.3) {
            wall.effects = any_effects(&mut rng, &wall);
        }
        let bed = any_bed(&mut rng, &wall, &wall.effects)?;
        wall.effects.push(bed);
        wall.restitution = any_restitution(&mut rng, 1.0);
        let shaking = any_shaking(&mut rng, &wall, true);
        Some((made(&wall), shaking, Accuracy { tolerance: 10_f64.powf(-rng.random_range(3.0..7.0)) }))
    };
    (0..count).filter_map(one).collect()
}

#[test]
fn analytic_walls_on_beds_side_by_side_move_as_alone_to_the_bit() {
    let runs = on_beds(60);
    let alone: Vec<Response> = runs.iter().map(|(wall, shaking, of)| simulate(wall, shaking, *of)).collect();
    let changes: u64 = alone.iter().map(|response| response.openings.total()).sum();
    assert!(runs.len() > 40 && changes > 2000, "{} walls, {changes} changes of contact", runs.len());
    go_as_alone(&runs, &alone);
}

/// The sets of vector instructions that this processor has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let older =
        [best.as_sse2().map(Simd::level), best.as_sse4_2().map(Simd::level), best.as_avx2().map(Simd::level)];
    #[cfg(not(target_arch = "x86_64"))]
    let older = [Some(Level::baseline())];
    older.into_iter().flatten().chain([best]).collect()
}

#[test]
fn analytic_windows_side_by_side_are_seen_as_alone_to_the_bit() {
    let simulators: Vec<Simulator> =
        anything(60).iter().map(|(wall, shaking, of)| Simulator::new(wall, shaking, *of)).collect();
    let start = |index: usize| {
        let mut rng = rng(84, index as u64);
        let [mut theta, omega] = [0.02, 0.1].map(|reach| [0; 2].map(|_| reach * rng.random_range(-1.0..1.0)));
        if index == 7 {
            theta[1] = f64::NAN;
        }
        Start { time_s: 0.5, state: State { theta, omega }, ..Start::default() }
    };
    let seen_alone = |(index, simulator): (usize, &Simulator)| {
        let mut history = History::starting(0.5, 0.01);
        let response = simulator.run_from(&start(index), 1.5, &mut history);
        (response, history.rows)
    };
    let alone = simulators.iter().enumerate().map(seen_alone).collect::<Vec<_>>();
    let mut histories = vec![History::starting(0.5, 0.01); simulators.len()];
    let mut responses = vec![None; simulators.len()];
    let mut waiting = simulators.iter().zip(&mut histories).enumerate();
    let mut next = || {
        let (index, (simulator, history)) = waiting.next()?;
        Some((index, simulator.watched_from(&start(index), 1.5, history)))
    };
    simulate_watched_side_by_side(&mut next, &mut |index, response| responses[index] = Some(response));
    let told = responses.into_iter().map(|response| response.expect("told once"));
    for (index, (found, alone)) in told.zip(histories.into_iter().map(|h| h.rows)).zip(alone).enumerate() {
        if index == 7 {
            assert!(matches!(found.0.outcome, Outcome::Failed { .. }), "{:?}", found.0.outcome);
        } else {
            assert!(found == alone, "window {index}: {:?}, alone {:?}", found.0, alone.0);
        }
    }
}

#[test]
fn analytic_the_motion_of_runs_that_keep_no_account_is_that_of_others() {
    let runs = anything(120);
    // Every other one keeps none, in the same lanes as those that do.
    let simulator = |(index, (wall, shaking, accuracy)): (usize, &(Wall, Shaking, Accuracy))| {
        let simulator = Simulator::new(wall, shaking, *accuracy);
        if index % 2 == 0 { simulator.without_accounts() } else { simulator }
    };
    let simulators = runs.iter().enumerate().map(simulator).collect::<Vec<_>>();
    let mut histories = simulators.iter().map(|_| History::new(0.013)).collect::<Vec<_>>();
    let mut told = vec![None; runs.len()];
    let mut waiting = simulators.iter().zip(&mut histories).enumerate();
    let mut next = || {
        let (index, (simulator, history)) = waiting.next()?;
        Some((index, simulator.watched_from(&simulator.release(), simulator.end_s(), history)))
    };
    simulate_watched_side_by_side(&mut next, &mut |index, response| told[index] = Some(response));
    let mut struck = 0;
    for (index, (wall, shaking, accuracy)) in runs.iter().enumerate() {
        let mut history = History::new(0.013);
        let simulator = Simulator::new(wall, shaking, *accuracy);
        let expected = simulator.run(&mut history);
        let mut found = told[index].take().expect("told once");
        assert_eq!(histories[index].rows, history.rows, "run {index}");
        if index % 2 == 0 {
            let Response { theta_max_rad, top_displacement_m, energy, demand, .. } = &found;
            let numbers = [theta_max_rad[0].value, theta_max_rad[1].time_s, top_displacement_m.value];
            let ledger = [energy.initial_j, energy.final_j, energy.ground_work_j, energy.residual()];
            let forces = demand.map(|demand| demand.friction + demand.compression_n);
            assert!(numbers.iter().chain(&ledger).chain(&forces).all(|number| number.is_nan()), "{found:?}");
            let Response { theta_max_rad, top_displacement_m, crack_displacement_m, energy, demand, .. } =
                expected.clone();
            found =
                Response { theta_max_rad, top_displacement_m, crack_displacement_m, energy, demand, ..found };
            struck += expected.impacts.table2.iter().sum::<u64>();
        }
        assert_eq!(found, expected, "run {index}");
    }
    assert!(struck > 1000, "{struck} impacts of runs without accounts");
}
