//! Formulas with carried states: Maxwell's spring and damper, Bouc's and Wen's loop.

use mrbd_formula::{CarriedState, Formula, Parameter, Place};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, Effect, G_M_S2, RockingWall, Wall, WallParameters};
use mrbd_kernel::simulate::{
    Accuracy, Observer, Outcome, Response, Shaking, Simulator, Start, simulate, simulate_observed,
    simulate_sequence, simulate_side_by_side,
};
use mrbd_kernel::solver::Quintic;

use super::{ACCURACY, formula, leaning, shaking, table_wall, with_formulas};

/// A state of a law: name, rate, start, unit.
type State<'a> = (&'a str, &'a str, f64, &'a str);

pub fn carrying(text: &str, states: &[State], parameters: &[(&str, f64, &str)]) -> Formula {
    let own: Vec<_> =
        parameters.iter().map(|(name, value, unit)| Parameter::new(name, *value, unit)).collect();
    let state = |(name, rate, start, unit): &State| CarriedState {
        name: (*name).to_owned(),
        rate: (*rate).to_owned(),
        start: *start,
        unit: (*unit).to_owned(),
        range: None,
    };
    let states: Vec<_> = states.iter().map(state).collect();
    Formula::parse_with_states(text, Place::Top, &own, &states).unwrap_or_else(|e| panic!("{text}: {e}"))
}

pub fn maxwell(k_n_per_m: f64, tau_s: f64) -> Formula {
    carrying("-z", &[("z", "k*v - z/tau", 0.0, "N")], &[("k", k_n_per_m, "N/m"), ("tau", tau_s, "s")])
}

/// ż = v - |z/y|^n (b |v| sign z + g v), which Bouc and Wen write with β = b/y^n and γ = g/y^n.
const LOOP: &str = "v*(1 - abs(z/y)**n*(b*sign(v*z) + g))";

pub fn bouc_wen(k_n_per_m: f64, y_m: f64) -> Formula {
    let own = [("k", k_n_per_m, "N/m"), ("y", y_m, "m"), ("n", 1.6, ""), ("b", 0.7, ""), ("g", 0.3, "")];
    carrying("-k*z", &[("z", LOOP, 0.0, "m")], &own)
}

/// A state along the motion of a run, by the classical method of Runge and Kutta in parts of its steps.
struct Along<F> {
    wall: RockingWall,
    rate: F,
    z: f64,
    at_rest_s: f64,
}

impl<F: Fn(f64, f64, f64) -> f64> Observer for Along<F> {
    fn moved(&mut self, _: f64, contact: Contact, motion: &Quintic) {
        const PARTS: u32 = 32;
        let h = motion.h() / f64::from(PARTS);
        let arms = |share: f64| {
            let (theta, omega) = (motion.position(share), motion.velocity(share));
            let [a, b] = self.wall.top_arms_m(contact, theta);
            (self.wall.top_displacement_m(contact, theta), a * omega[0] + b * omega[1])
        };
        let rate = |share: f64, z: f64| {
            let (x, v) = arms(share);
            (self.rate)(x, v, z)
        };
        for part in 0..PARTS {
            let at = |of_part: f64| (f64::from(part) + of_part) / f64::from(PARTS);
            let z = self.z;
            let r1 = rate(at(0.0), z);
            let r2 = rate(at(0.5), z + 0.5 * h * r1);
            let r3 = rate(at(0.5), z + 0.5 * h * r2);
            let r4 = rate(at(1.0), z + h * r3);
            self.z += h / 6.0 * (r1 + 2.0 * r2 + 2.0 * r3 + r4);
        }
        if contact == Contact::REST {
            self.at_rest_s += motion.h();
        }
    }
    fn stood(&mut self, _: f64, _: f64) {
        panic!("a wall that carries states steps at rest too");
    }
    fn ended(&mut self, _: f64, _: Contact, _: [f64; 2]) {}
}

fn carried(response: &Response) -> f64 {
    response.left.carried.expect("a state")[0]
}

#[test]
fn analytic_a_state_is_its_rate_along_the_motion_through_impacts_and_rest() {
    let (k, tau, y) = (20e3, 0.3, 0.01);
    let relaxes = move |_: f64, v: f64, z: f64| k * v - z / tau;
    let loops =
        move |_: f64, v: f64, z: f64| v - (z / y).abs().powf(1.6) * (0.7 * v.abs() * z.signum() + 0.3 * v);
    for (law, rate, size) in
        [(maxwell(k, tau), &relaxes as &dyn Fn(f64, f64, f64) -> f64, 100.0), (bouc_wen(30e3, y), &loops, y)]
    {
        let wall = with_formulas(std::slice::from_ref(&law), table_wall());
        let mut along = Along { wall: RockingWall::new(&wall), rate, z: 0.0, at_rest_s: 0.0 };
        let response = simulate_observed(&wall, &shaking(1.0), ACCURACY, &mut along);
        assert_eq!(response.outcome, Outcome::Stood);
        assert!(response.impacts.total() > 3 && along.at_rest_s > 0.01, "{law}: {} s", along.at_rest_s);
        let off = (carried(&response) - along.z).abs() / size;
        // The tolerance of the run, and what is left of a kink that parts of a step do not stop at.
        assert!(off < 1e-6, "{law}: {} and {}", carried(&response), along.z);
        let residual = response.energy.residual();
        assert!(residual < 1e-7, "{law}: {residual}");
    }
}

/// A block on its right corner with a mass and a force at the top, apart from the kernel: I θ'' = g W_x + Y_C F.
struct Block<'a> {
    parameters: &'a WallParameters,
    force_n: &'a dyn Fn(f64, f64) -> f64,
    rate: &'a dyn Fn(f64, f64, f64) -> f64,
}

impl Block<'_> {
    /// Rates of θ, ω and z.
    fn rates(&self, [theta, omega, z]: [f64; 3]) -> [f64; 3] {
        let p = self.parameters;
        let (b, h) = (p.thickness_m, p.height_m);
        let (sin, cos) = theta.sin_cos();
        let turned = |x: f64, y: f64| [x * cos + y * sin, y * cos - x * sin];
        let ([g_x, _], [c_x, c_y]) = (turned(-b / 2.0, h / 2.0), turned(-b / 2.0, h));
        let (x, v) = (c_x + b / 2.0, c_y * omega);
        let inertia = p.mass_kg / 3.0 * (b * b + h * h) + p.diaphragm_mass_kg * (b * b / 4.0 + h * h);
        let weight = G_M_S2 * (p.mass_kg * g_x + p.diaphragm_mass_kg * c_x);
        let force_n = -p.stiffness_n_per_m * x + (self.force_n)(x, z);
        [omega, (weight + c_y * force_n) / inertia, (self.rate)(x, v, z)]
    }

    fn after(&self, mut at: [f64; 3], time_s: f64) -> [f64; 3] {
        let parts = 20_000;
        let h = time_s / f64::from(parts);
        let plus = |at: [f64; 3], h: f64, rates: [f64; 3]| [0, 1, 2].map(|i| at[i] + h * rates[i]);
        for _ in 0..parts {
            let r1 = self.rates(at);
            let r2 = self.rates(plus(at, 0.5 * h, r1));
            let r3 = self.rates(plus(at, 0.5 * h, r2));
            let r4 = self.rates(plus(at, h, r3));
            at = [0, 1, 2].map(|i| at[i] + h / 6.0 * (r1[i] + 2.0 * r2[i] + 2.0 * r3[i] + r4[i]));
        }
        at
    }
}

fn released_for(law: &Formula, tail_s: f64, tolerance: f64) -> Response {
    let wall = with_formulas(std::slice::from_ref(law), leaning());
    let shaking = Shaking { tail_s, ..Shaking::default() };
    simulate(&wall, &shaking, Accuracy { tolerance })
}

#[test]
fn analytic_a_block_with_a_state_moves_as_an_integrator_of_its_own_says() {
    let (k, tau, y) = (20e3, 0.05, 0.02);
    let pulls = |_: f64, z: f64| -z;
    let relaxes = move |_: f64, v: f64, z: f64| k * v - z / tau;
    let yields = move |_: f64, z: f64| -k * z;
    let loops =
        move |_: f64, v: f64, z: f64| v - (z / y).abs().powf(1.6) * (0.7 * v.abs() * z.signum() + 0.3 * v);
    for (law, force_n, rate) in [
        (maxwell(k, tau), &pulls as &dyn Fn(f64, f64) -> f64, &relaxes as &dyn Fn(f64, f64, f64) -> f64),
        (bouc_wen(k, y), &yields, &loops),
    ] {
        let response = released_for(&law, 0.12, 1e-10);
        assert_eq!(response.impacts.total(), 0);
        let block = Block { parameters: &leaning(), force_n, rate };
        let [theta, omega, z] = block.after([0.03, 0.0, 0.0], 0.12);
        let left = response.left;
        let state = left.state;
        // The tolerance of the run over rotations, velocities and the state of this size.
        assert!(
            (state.theta[0] - theta).abs() < 1e-10 && theta > 1e-3,
            "{law}: {} and {theta}",
            state.theta[0]
        );
        assert!((state.omega[0] - omega).abs() < 1e-9, "{law}: {} and {omega}", state.omega[0]);
        assert!((carried(&response) - z).abs() < 1e-8 * z.abs(), "{law}: {} and {z}", carried(&response));
    }
}

#[test]
fn analytic_a_looser_run_with_a_state_is_as_near_as_its_tolerance_says() {
    for law in [maxwell(20e3, 0.02), maxwell(2e6, 1e-4), bouc_wen(20e3, 0.002)] {
        let [loose, middle, tight] = [1e-4, 1e-7, 1e-11].map(|tolerance| released_for(&law, 0.5, tolerance));
        let off = |run: &Response| (run.left.state.theta[0] - tight.left.state.theta[0]).abs();
        let alpha = 0.1;
        assert!(
            off(&loose) < 1e-4 * alpha && off(&middle) < 1e-7 * alpha,
            "{law}: {} and {}",
            off(&loose),
            off(&middle)
        );
    }
}

#[test]
fn analytic_maxwell_is_a_spring_where_it_is_slow_and_a_damper_where_it_is_fast() {
    let run = |law: &Formula| released_for(law, 0.12, 1e-9).left.state.theta[0];
    let spring = run(&formula(Place::Top, "-k*(x - x_0)", &[("k", 20e3, "N/m"), ("x_0", start_m(), "m")]));
    // What relaxes over the run is its time over τ of the force: so is the difference.
    let [slow, slower] = [1e3, 1e5].map(|tau| (run(&maxwell(20e3, tau)) - spring).abs());
    assert!(slow < 1e-5 && slow > 1e-9, "{slow}");
    assert!((slow / slower / 100.0 - 1.0).abs() < 0.05, "{slow} and {slower}");
    let c = 2000.0;
    let damper = run(&formula(Place::Top, "-c*v", &[("c", c, "N*s/m")]));
    let [fast, faster] = [1e-3, 2.5e-4].map(|tau| (run(&maxwell(c / tau, tau)) - damper).abs());
    // A force later by τ: of first order in it.
    assert!((fast / faster / 4.0 - 1.0).abs() < 0.05 && faster < 1e-4, "{fast} and {faster}");
}

/// Where the top of the leaning block starts, m.
fn start_m() -> f64 {
    let wall = RockingWall::new(&Wall::new(leaning()).expect("a wall"));
    let contact = Contact::of_rotations([0.03; 2]);
    wall.top_displacement_m(Contact { crack: mrbd_kernel::model::Pivot::Closed, ..contact }, [0.03; 2])
}

fn upright() -> WallParameters {
    WallParameters { initial_rotation_rad: [0.0; 2], ..leaning() }
}

#[test]
fn analytic_a_state_relaxes_while_the_wall_rests() {
    let wall = with_formulas(&[maxwell(20e3, 0.3)], upright());
    let quiet = Shaking {
        horizontal: Some(Accelerogram::new(0.01, vec![0.0; 100]).expect("a record")),
        ..Shaking::default()
    };
    for effects in [vec![], vec![Effect::with_parameters("coulomb_friction", &[50.0]).expect("an effect")]] {
        let wall = Wall::new(WallParameters { effects, ..wall.parameters().clone() }).expect("a wall");
        let simulator = Simulator::new(&wall, &quiet, Accuracy { tolerance: 1e-9 });
        let leans = Start { carried: Some([100.0, 0.0, 0.0, 0.0]), ..simulator.release() };
        let response = simulator.run_from(&leans, 1.0, &mut ());
        let expected = 100.0 * (-1.0_f64 / 0.3).exp();
        // Of a force whose error of a step is below 1e-12 of what moves the wall.
        assert!((carried(&response) - expected).abs() < 1e-7, "{} for {expected}", carried(&response));
        assert!((response.pattern_time_s[Contact::REST.index()] - 1.0).abs() < 1e-12);
        assert_eq!(response.openings.total(), 0);
    }
}

/// When the top first moved, s.
struct FirstMove(Option<f64>);

impl Observer for FirstMove {
    fn moved(&mut self, start_s: f64, contact: Contact, _: &Quintic) {
        if contact != Contact::REST && self.0.is_none() {
            self.0 = Some(start_s);
        }
    }
    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: [f64; 2]) {}
}

#[test]
fn analytic_a_wall_leaves_rest_when_its_state_pushes_it() {
    let (f, tau) = (3000.0, 0.3);
    let own = [("F", f, "N"), ("tau", tau, "s")];
    let p = upright();
    // The block lifts about its edge where the moment of the force is that of the weights.
    let lifts_n = G_M_S2 * (p.mass_kg + p.diaphragm_mass_kg) * p.thickness_m / 2.0 / p.height_m;
    assert!(lifts_n < 0.9 * f, "{lifts_n}");
    let friction = Effect::with_parameters("coulomb_friction", &[200.0]).expect("an effect");
    for (sign, effects, holds_n) in [(1.0, vec![], 0.0), (-1.0, vec![], 0.0), (1.0, vec![friction], 200.0)] {
        let text = if sign > 0.0 { "z" } else { "-z" };
        let law = carrying(text, &[("z", "(F - z)/tau", 0.0, "N")], &own);
        let wall = with_formulas(&[law], WallParameters { effects, ..upright() });
        let shaking = Shaking { tail_s: 1.0, ..Shaking::default() };
        let mut first = FirstMove(None);
        let response = simulate_observed(&wall, &shaking, Accuracy { tolerance: 1e-9 }, &mut first);
        let expected_s = -tau * (1.0 - (lifts_n + holds_n) / f).ln();
        let found_s = first.0.expect("it moves");
        assert!((found_s - expected_s).abs() < 1e-7, "{found_s} for {expected_s}");
        assert_eq!(response.top_displacement_m.value.signum(), sign);
    }
}

#[test]
fn analytic_a_window_and_a_sequence_go_on_with_the_state() {
    for law in [maxwell(20e3, 0.8), bouc_wen(30e3, 0.01)] {
        let wall = with_formulas(std::slice::from_ref(&law), table_wall());
        let simulator = Simulator::new(&wall, &shaking(1.0), ACCURACY);
        let whole = simulator.run(&mut ());
        let first = simulator.run_from(&simulator.release(), 1.7, &mut ());
        let end_s = simulator.end_s();
        let rest = simulator.run_from(&first.left, end_s, &mut ());
        let forgot = simulator.run_from(&Start { carried: None, ..first.left }, end_s, &mut ());
        let apart = |run: &Response| (run.left.state.theta[1] - whole.left.state.theta[1]).abs();
        // The tolerance of a run, beside what the state does.
        assert!(apart(&rest) < 1e-6 * whole.alpha_rad, "{law}: {}", apart(&rest));
        assert!((carried(&rest) - carried(&whole)).abs() < 1e-5 * carried(&whole).abs(), "{law}");
        assert_ne!(forgot.energy, rest.energy, "{law}: a run that starts without the state");
        let parts = [shaking(1.0), shaking(1.0)];
        let runs = simulate_sequence(&wall, &parts, ACCURACY);
        let (before, after) = (runs[0].as_ref().expect("a run"), runs[1].as_ref().expect("a run"));
        assert_eq!(before.left.carried, whole.left.carried);
        assert!(after.energy != before.energy, "{law}: the second part starts with another state");
    }
}

#[test]
fn analytic_walls_with_states_go_beside_others_with_the_same_bits() {
    let walls =
        [maxwell(20e3, 0.3), formula(Place::Top, "-c*v", &[("c", 800.0, "N*s/m")]), bouc_wen(30e3, 0.01)]
            .map(|law| with_formulas(&[law], table_wall()));
    let alone = walls.each_ref().map(|wall| simulate(wall, &shaking(1.0), ACCURACY));
    let mut waiting = walls.iter().cycle().take(9).enumerate();
    let mut next =
        || waiting.next().map(|(i, wall)| (i, Simulator::new(wall, &shaking(1.0), ACCURACY).prepared()));
    let mut count = 0;
    simulate_side_by_side(&mut next, &mut |i, response| {
        assert_eq!(format!("{response:?}"), format!("{:?}", alone[i % 3]), "{i}");
        count += 1;
    });
    assert_eq!(count, 9);
}

#[test]
fn rejects_a_run_of_more_steps_than_it_may_try_alone_and_side_by_side() {
    let law = formula(Place::Top, "-c*v", &[("c", 1e10, "N*s/m")]);
    let (steep, gentle) = (with_formulas(&[law], table_wall()), with_formulas(&[], table_wall()));
    let most = 2000;
    let bounded = |wall| Simulator::new(wall, &shaking(1.0), ACCURACY).with_most_steps(most);
    let alone = bounded(&steep).run(&mut ());
    match &alone.outcome {
        Outcome::Failed { reason, .. } => assert!(reason.contains("too fast to be followed"), "{reason}"),
        other => panic!("{other:?}"),
    }
    // It ends where a step is not kept.
    let tried = alone.work.steps + alone.work.rejected_steps;
    assert!((most..most + 100).contains(&tried), "{tried}");
    let free = simulate(&gentle, &shaking(1.0), ACCURACY);
    let mut waiting = [&steep, &gentle].into_iter().cycle().take(18).enumerate();
    let mut next = || waiting.next().map(|(i, wall)| (i, bounded(wall).prepared()));
    let mut count = 0;
    simulate_side_by_side(&mut next, &mut |i, response| {
        let one = if i % 2 == 0 { &alone } else { &free };
        assert_eq!(format!("{response:?}"), format!("{one:?}"), "{i}");
        count += 1;
    });
    assert_eq!(count, 18);
}

#[test]
fn rejects_states_that_cannot_be_followed() {
    // Some hundred thousand times faster than a sample of the record.
    let response = simulate(&with_formulas(&[maxwell(1e12, 1e-9)], table_wall()), &shaking(1.0), ACCURACY);
    match &response.outcome {
        Outcome::Failed { reason, .. } => assert!(reason.contains("too fast to be followed"), "{reason}"),
        other => panic!("{other:?}"),
    }
    // A state that leaves the range that was given for it.
    let own = [Parameter::new("k", 2e3, "N/m"), Parameter::new("t", 0.3, "s")];
    let state = |range: Option<[f64; 2]>| CarriedState {
        name: "z".to_owned(),
        rate: "x/t".to_owned(),
        start: 0.0,
        unit: "m".to_owned(),
        range,
    };
    let of =
        |range| Formula::parse_with_states("-k*z", Place::Top, &own, &[state(range)]).expect("a formula");
    let wall = with_formulas(&[of(Some([-1e-4, 1e-4]))], table_wall());
    match simulate(&wall, &shaking(1.0), ACCURACY).outcome {
        Outcome::Failed { reason, .. } => assert!(reason.contains("left its range"), "{reason}"),
        other => panic!("{other:?}"),
    }
    let wall = with_formulas(&[of(Some([-1.0, 1.0]))], table_wall());
    assert_eq!(simulate(&wall, &shaking(1.0), ACCURACY).outcome, Outcome::Stood);
    // Nothing bounds the integral of a displacement.
    let parameters = WallParameters { formulas: vec![of(None)], ..table_wall() };
    let refused = Wall::new(parameters).expect_err("unbounded");
    assert!(refused.key == "formulas.0.states.z.rate" && refused.allowed.contains("range = "), "{refused}");
    // A pole within the range.
    let own = [Parameter::new("k", 2e3, "N/m"), Parameter::new("g", 1e-3, "m")];
    let pole = CarriedState { rate: "v".to_owned(), ..state(Some([-1.0, 1.0])) };
    let law = Formula::parse_with_states("-k*z*g/(g - z)", Place::Top, &own, &[pole]).expect("a formula");
    let refused = Wall::new(WallParameters { formulas: vec![law], ..table_wall() }).expect_err("a pole");
    assert!(refused.key == "formulas.0.force_n" && refused.allowed.contains("z from -1 to 1"), "{refused}");
}
