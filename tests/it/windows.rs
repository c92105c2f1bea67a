//! Windows of a run: started from a state of the whole run they go on as it does, from any state they do not fail.

use mrbd_kernel::model::{Contact, G_M_S2, ImpactLaw, Pair, State, TopMemory, WallParameters};
use mrbd_kernel::simulate::{Accuracy, History, Observer, Outcome, Shaking, Simulator, Start};
use mrbd_kernel::solver::Quintic;
use rand::RngExt;

use crate::walls::{any_record, any_shaking, any_wall, around_zero, effect, made, rng, table_wall};

/// Every stretch of a run: its start, contact state and motion.
#[derive(Default)]
struct Stretches(Vec<(f64, Contact, Quintic)>);

impl Observer for Stretches {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        self.0.push((start_s, contact, *motion));
    }
    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}
}

/// The table wall under the law whose impacts do not magnify errors.
fn shaken_table_wall() -> (WallParameters, Shaking) {
    let wall = table_wall(ImpactLaw::Contact);
    let shaking =
        Shaking { horizontal: Some(any_record(&mut rng(300, 0), 2.0)), vertical: None, tail_s: 1.0 };
    (wall, shaking)
}

#[test]
fn analytic_a_window_goes_on_as_the_whole_run() {
    let (wall, shaking) = shaken_table_wall();
    let simulator = Simulator::new(&made(&wall), &shaking, Accuracy { tolerance: 1e-10 });
    let mut whole = Stretches::default();
    simulator.run(&mut whole);
    let stretches = &whole.0;
    assert!(stretches.len() > 500, "{}", stretches.len());
    let (mut worst, mut impacts) = (0.0_f64, 0);
    for window in stretches.windows(60).step_by(20) {
        let ((start_s, contact, first), (last_s, end_contact, last)) = (window[0], window[59]);
        // Not at an event and not inside a burst of impacts, where an ever so little earlier is another pattern.
        if last.h() < 1e-3 {
            continue;
        }
        let state = State { theta: first.position(0.0), omega: first.velocity(0.0) };
        let start = Start { time_s: start_s, state, contact: Some(contact), ..Start::default() };
        let mut ends = Stretches::default();
        let response = simulator.run_from(&start, last_s + 0.5 * last.h(), &mut ends);
        assert_eq!(response.outcome, Outcome::Stood);
        let (_, found_contact, found) = ends.0[ends.0.len() - 1];
        assert_eq!(found_contact, end_contact, "from {start_s}");
        for i in 0..2 {
            worst = worst.max((found.position(1.0)[i] - last.position(0.5)[i]).abs());
        }
        impacts += response.impacts.total();
    }
    eprintln!("windows end within {worst:e} rad of the whole run, over {impacts} impacts");
    assert!(impacts > 20, "{impacts}");
    // The tolerance of 1e-10 of α, some 0.1 rad, magnified by a few impacts.
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn analytic_a_window_with_memory_goes_on_as_the_whole_run() {
    let (mut wall, shaking) = shaken_table_wall();
    wall.effects = vec![
        effect("yielding_spring", &[2e4, 150.0]),
        effect("coulomb_friction", &[80.0]),
        effect("gap", &[0.002]),
    ];
    let checked = made(&wall);
    let simulator = Simulator::new(&checked, &shaking, Accuracy { tolerance: 1e-10 });
    let mut whole = Stretches::default();
    simulator.run(&mut whole);
    let stretches = &whole.0;
    let (mut plastic_m, mut yielded_m, mut worst, mut compared) = (0.0, 0.0_f64, 0.0_f64, 0);
    for (k, (start_s, contact, first)) in stretches.iter().enumerate() {
        let x_c_m = simulator.wall().top_displacement_m(*contact, first.position(0.0));
        let now_m = checked.plastic_displacement_m(plastic_m, x_c_m);
        yielded_m += (now_m - plastic_m).abs();
        plastic_m = now_m;
        let Some((last_s, _, last)) = stretches.get(k + 40) else { break };
        if k % 20 != 0 || last.h() < 1e-3 || first.h() < 1e-3 {
            continue;
        }
        let state = State { theta: first.position(0.0), omega: first.velocity(0.0) };
        let memory = TopMemory { plastic_m, ..TopMemory::default() };
        let start = Start::with_memory(*start_s, state, *contact, memory);
        let mut ends = Stretches::default();
        let response = simulator.run_from(&start, last_s + 0.5 * last.h(), &mut ends);
        let (_, _, found) = ends.0[ends.0.len() - 1];
        assert_eq!(response.outcome, Outcome::Stood, "from {start_s}");
        for i in 0..2 {
            worst = worst.max((found.position(1.0)[i] - last.position(0.5)[i]).abs());
        }
        compared += 1;
    }
    eprintln!("{compared} windows end within {worst:e} rad of the whole run; {yielded_m} m yielded");
    assert!(compared > 10 && yielded_m > 0.01, "{compared} windows, {yielded_m} m");
    // As without effects; a velocity read from a quintic has a rounding over the step more.
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn regress_a_window_from_the_start_is_the_whole_run() {
    let (wall, shaking) = shaken_table_wall();
    let simulator = Simulator::new(&made(&wall), &shaking, Accuracy::default());
    let start = Start::default();
    let by_window = simulator.run_from(&start, simulator.end_s(), &mut ());
    assert_eq!(by_window, simulator.run(&mut ()));
    // Nothing is left behind for the next window, and another wall takes nothing along.
    assert_eq!(by_window, simulator.run_from(&start, simulator.end_s(), &mut ()));
    let mut heavier = wall;
    heavier.mass_kg *= 1.5;
    let fresh = Simulator::new(&made(&heavier), &shaking, Accuracy::default()).run(&mut ());
    assert_eq!(simulator.with_wall(&made(&heavier), Accuracy::default()).run(&mut ()), fresh);
}

#[test]
fn analytic_a_window_has_rows_at_its_own_samples() {
    let (wall, shaking) = shaken_table_wall();
    let simulator = Simulator::new(&made(&wall), &shaking, Accuracy::default());
    let mut whole = History::new(0.01);
    simulator.run(&mut whole);
    let row = whole.rows.iter().position(|row| row.theta_rad[0].abs() > 1e-3).expect("the wall rocks");
    let from = whole.rows[row];
    let mut window = History::starting(from.time_s, 0.01);
    let start = Start {
        time_s: from.time_s,
        state: State { theta: from.theta_rad, omega: [0.0; 2] },
        contact: Some(from.contact),
        ..Start::default()
    };
    simulator.run_from(&start, from.time_s + 0.2, &mut window);
    assert_eq!(window.rows.len(), 21);
    assert_eq!(window.rows[0], from);
    assert!((window.rows[20].time_s - from.time_s - 0.2).abs() < 1e-12);
}

#[test]
fn analytic_any_start_gives_a_run() {
    let mut moved = 0;
    for index in 0..3000 {
        let mut rng = rng(301, index);
        let wall = any_wall(&mut rng);
        let shaking = any_shaking(&mut rng, &wall, index % 2 == 0);
        let simulator = Simulator::new(&made(&wall), &shaking, Accuracy { tolerance: 1e-10 });
        let [a1, a2] = made(&wall).alpha_i_rad();
        let noise = [1e-12, 1e-4, 0.3][index as usize % 3];
        let zeroed = |x: f64, zero: bool| if zero { 0.0 } else { x };
        let state = State {
            theta: [a1, a2].map(|a| zeroed(a * around_zero(&mut rng, noise), rng.random_bool(0.2))),
            omega: [(); 2].map(|()| zeroed(around_zero(&mut rng, noise), rng.random_bool(0.2))),
        };
        let contact = rng.random_bool(0.5).then(|| Contact::ALL[rng.random_range(0..9)]);
        let start = Start { time_s: rng.random_range(0.0..3.0), state, contact, ..Start::default() };
        let response = simulator.run_from(&start, start.time_s + 0.3, &mut ());
        assert!(!matches!(response.outcome, Outcome::Failed { .. }), "{index}: {:?}", response.outcome);
        // As for whole runs (`energy` in these tests), and roundings of the weight's energy where hardly any moves.
        let lost_j = response.energy.residual() * response.energy.passed_through_j;
        let overturning_j = wall.mass_kg * G_M_S2 * wall.lower_width_m;
        let allowed_j = 1e-8 * response.energy.passed_through_j + 1e-12 * overturning_j;
        assert!(lost_j <= allowed_j, "{index}: {lost_j:e} J of {allowed_j:e} J");
        moved += u32::from(response.pattern_time_s[0] < 0.3);
    }
    assert!(moved > 2000, "{moved}");
}

#[test]
fn rejects_a_start_that_is_no_state() {
    let (wall, shaking) = shaken_table_wall();
    let simulator = Simulator::new(&made(&wall), &shaking, Accuracy::default());
    for (time_s, theta1) in [(-1.0, 0.0), (f64::NAN, 0.0), (1.0, f64::NAN), (1.0, f64::INFINITY)] {
        let state = State { theta: [theta1, 0.0], omega: [0.0; 2] };
        let response = simulator.run_from(&Start { time_s, state, ..Start::default() }, 2.0, &mut ());
        assert!(matches!(response.outcome, Outcome::Failed { .. }), "{time_s} {theta1}");
    }
}
