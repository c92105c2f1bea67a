//! Laws written as formulas: the same runs as the laws of the catalogue, exact kinks, energy accounted for.

mod carried;
mod impacts;
mod memory;
mod roots;

use mrbd_formula::{Formula, Parameter, Place};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, Effect, ImpactLaw, RockingWall, Wall, WallParameters};
use mrbd_kernel::simulate::{
    Accuracy, Observer, Outcome, Response, Shaking, Simulator, simulate, simulate_observed,
    simulate_side_by_side,
};
use mrbd_kernel::solver::Quintic;

const ACCURACY: Accuracy = Accuracy { tolerance: 1e-8 };

fn table_wall() -> WallParameters {
    let mut wall = WallParameters::table_wall();
    wall.restitution.law = ImpactLaw::Contact;
    wall
}

/// Two sines that rock the table wall in all patterns.
fn shaking(sign: f64) -> Shaking {
    let a = |t: f64| sign * 1.2 * ((9.0 * t).sin() + (23.0 * t).sin());
    let samples = (0..300).map(|k| a(0.01 * f64::from(k))).collect();
    Shaking {
        horizontal: Some(Accelerogram::new(0.01, samples).expect("a record")),
        vertical: None,
        tail_s: 1.0,
    }
}

fn formula(place: Place, text: &str, parameters: &[(&str, f64, &str)]) -> Formula {
    let own: Vec<_> =
        parameters.iter().map(|(name, value, unit)| Parameter::new(name, *value, unit)).collect();
    Formula::parse(text, place, &own).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn with_formulas(formulas: &[Formula], parameters: WallParameters) -> Wall {
    let formulas = formulas.to_vec();
    Wall::new(WallParameters { formulas, ..parameters }).unwrap_or_else(|e| panic!("{e}"))
}

fn run(wall: &Wall) -> Response {
    let response = simulate(wall, &shaking(1.0), ACCURACY);
    assert_eq!(response.outcome, Outcome::Stood);
    assert!(response.impacts.total() > 3, "{:?}", response.impacts);
    response
}

/// Everything of a run but its energy.
fn motion(response: &Response) -> String {
    let Response {
        theta_max_rad, top_displacement_m, pattern_time_s, impacts, openings, demand, work, ..
    } = response;
    format!(
        "{theta_max_rad:?} {top_displacement_m:?} {pattern_time_s:?} {impacts:?} {openings:?} {demand:?} {work:?}"
    )
}

#[test]
fn analytic_dampers_and_friction_as_formulas_give_the_same_bits() {
    for (name, values, law) in [
        ("viscous_damping", &[1500.0][..], formula(Place::Top, "-c*v", &[("c", 1500.0, "N*s/m")])),
        ("coulomb_friction", &[300.0], formula(Place::Top, "-F*sign(v)", &[("F", 300.0, "N")])),
        ("joint_damping.ground", &[800.0], formula(Place::Ground, "-c*w", &[("c", 800.0, "N*m*s")])),
        ("joint_damping.crack", &[800.0], formula(Place::Crack, "-c*w", &[("c", 800.0, "N*m*s")])),
    ] {
        let effects = vec![Effect::with_parameters(name, values).expect("an effect")];
        let named = Wall::new(WallParameters { effects, ..table_wall() }).expect("a wall");
        let written = with_formulas(&[law], table_wall());
        assert_eq!(format!("{:?}", run(&written)), format!("{:?}", run(&named)), "{name}");
    }
}

#[test]
fn analytic_the_floors_spring_as_a_formula_gives_the_same_motion_to_the_bit() {
    let law = formula(Place::Top, "-k*x", &[("k", 37e3, "N/m")]);
    let written = with_formulas(&[law], WallParameters { stiffness_n_per_m: 0.0, ..table_wall() });
    let named = Wall::new(table_wall()).expect("a wall");
    let (written, named) = (run(&written), run(&named));
    assert_eq!(motion(&written), motion(&named));
    // What the spring takes is told as lost, not as stored: the ledger closes with it.
    let residual = written.energy.residual();
    assert!(residual < 1e-8, "{residual}");
}

/// Laws of the catalogue whose formulas do other sums.
#[test]
fn analytic_springs_with_kinks_as_formulas_give_the_same_motion() {
    let k = ("k", 37e3, "N/m");
    for (name, values, floor_n_per_m, law) in [
        ("cubic_stiffness", &[4e6][..], 37e3, formula(Place::Top, "-k3*x**3", &[("k3", 4e6, "N/m**3")])),
        ("gap", &[0.01], 0.0, formula(Place::Top, "-k*max(0, abs(x) - g)*sign(x)", &[k, ("g", 0.01, "m")])),
        (
            "gap",
            &[0.01],
            0.0,
            formula(Place::Top, "-k*(x - g)*(x > g) - k*(x + g)*(x < -g)", &[k, ("g", 0.01, "m")]),
        ),
        (
            "one_sided_spring.positive",
            &[20e3],
            37e3,
            formula(Place::Top, "-k*max(x, 0)", &[("k", 20e3, "N/m")]),
        ),
    ] {
        let effects = vec![Effect::with_parameters(name, values).expect("an effect")];
        let named = Wall::new(WallParameters { effects, ..table_wall() }).expect("a wall");
        let written =
            with_formulas(&[law], WallParameters { stiffness_n_per_m: floor_n_per_m, ..table_wall() });
        let (found, expected) = (run(&written), run(&named));
        for i in 0..2 {
            let [a, b] = [&found, &expected].map(|r| r.theta_max_rad[i].value);
            // The tolerance of both runs, over α.
            assert!((a - b).abs() <= 1e-7 * expected.alpha_rad, "{name}: {a} and {b}");
        }
        assert_eq!(found.impacts.table2, expected.impacts.table2, "{name}");
        let residual = found.energy.residual();
        assert!(residual < 1e-8, "{name}: {residual}");
    }
}

/// A block that is let go, and what a law at its top has taken by the end.
fn released(
    parameters: WallParameters,
    law: Formula,
    tail_s: f64,
    observer: &mut dyn Observer,
) -> (Wall, Response) {
    let wall = with_formulas(&[law], parameters);
    let shaking = Shaking { horizontal: None, vertical: None, tail_s };
    let response = simulate_observed(&wall, &shaking, Accuracy { tolerance: 1e-10 }, observer);
    (wall, response)
}

/// A wall as one block on the right corner, far from upright.
fn leaning() -> WallParameters {
    WallParameters {
        diaphragm_mass_kg: 200.0,
        stiffness_n_per_m: 20e3,
        initial_rotation_rad: [0.03, 0.03],
        ..WallParameters::strip(0.3, 3.0, 1800.0)
    }
}

/// Displacement of the top at the ends of stretches, and whether it passed a value inside of one.
struct Stretches {
    wall: RockingWall,
    at_m: f64,
    ends_m: Vec<f64>,
    passed_inside: usize,
}

impl Observer for Stretches {
    fn moved(&mut self, _: f64, contact: Contact, motion: &Quintic) {
        let x_c = |share: f64| self.wall.top_displacement_m(contact, motion.position(share)) - self.at_m;
        let inside: Vec<f64> = (1..20).map(|k| x_c(f64::from(k) / 20.0)).collect();
        // Beyond the roundings of an end that lies on the value.
        let sides = [inside.iter().any(|x| *x > 1e-14), inside.iter().any(|x| *x < -1e-14)];
        self.passed_inside += usize::from(sides == [true, true]);
        self.ends_m.push(x_c(1.0));
    }
    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: [f64; 2]) {}
}

#[test]
fn analytic_a_run_stops_exactly_where_a_formula_has_a_kink() {
    let x_g = 0.05;
    for text in [
        "-k*max(0, x - g)",
        "-k*g*(x > g)",
        "-k*(abs(x) - g)*(abs(x) > g)*(x > 0)",
        "-k*max(0, x**2/g - g)*(x > 0)",
    ] {
        let law = formula(Place::Top, text, &[("k", 50e3, "N/m"), ("g", x_g, "m")]);
        let wall = Wall::new(leaning()).expect("a wall");
        let mut seen =
            Stretches { wall: RockingWall::new(&wall), at_m: x_g, ends_m: Vec::new(), passed_inside: 0 };
        let (_, response) = released(leaning(), law, 2.0, &mut seen);
        assert_eq!((seen.passed_inside, &response.outcome), (0, &Outcome::Stood), "{text}");
        let on_it = seen.ends_m.iter().filter(|x| x.abs() < 1e-15).count();
        assert!(on_it >= 2, "{text}: {on_it} of {} ends", seen.ends_m.len());
    }
}

#[test]
fn analytic_what_a_spring_takes_is_its_potential() {
    // Over half a swing: no impact, and the path of a conservative law does not matter.
    let (k, g) = (50e3, 0.05);
    let own = [("k", k, "N/m"), ("g", g, "m")];
    let kinked = |x: f64| 0.5 * k * (x - g).max(0.0).powi(2);
    for (text, tail_s, potential_j) in [
        ("-k*max(0, x - g)", 0.15, &kinked as &dyn Fn(f64) -> f64),
        ("-k*g*(x > g)", 0.15, &|x: f64| k * g * (x - g).max(0.0)),
        ("-k*x**3/g**2", 0.08, &|x: f64| 0.25 * k * x.powi(4) / (g * g)),
        ("-k*g*tanh(x/g)", 0.15, &|x: f64| k * g * g * (x / g).cosh().ln()),
        ("-k*g*(abs(x)/g)**1.5*sign(x)", 0.11, &|x: f64| k * g * g * (x / g).powf(2.5) / 2.5),
    ] {
        let law = formula(Place::Top, text, &own);
        let mut path = Stretches {
            wall: RockingWall::new(&Wall::new(leaning()).expect("a wall")),
            at_m: 0.0,
            ends_m: Vec::new(),
            passed_inside: 0,
        };
        let (wall, response) = released(leaning(), law, tail_s, &mut path);
        assert_eq!(response.impacts.total(), 0, "{text}");
        let lower =
            Contact { ground: mrbd_kernel::model::Pivot::Right, crack: mrbd_kernel::model::Pivot::Closed };
        let from_m = RockingWall::new(&wall).top_displacement_m(lower, [0.03, 0.03]);
        let to_m = *path.ends_m.last().expect("it moved");
        assert!(from_m > g && to_m < g, "{text}: from {from_m} to {to_m} m");
        let taken_j = potential_j(to_m) - potential_j(from_m);
        // The error of a run at this tolerance; over a kink that was missed it would be a million times as large.
        let error = (response.energy.effect_loss_j - taken_j).abs() / potential_j(from_m);
        assert!(error < 1e-11, "{text}: {error}");
        assert!(response.energy.residual() < 1e-11, "{text}: {}", response.energy.residual());
    }
}

#[test]
fn analytic_a_joints_spring_takes_its_potential() {
    let k = 3e4;
    let law = formula(Place::Ground, "-k*phi", &[("k", k, "N*m")]);
    let mut path = End([0.0; 2]);
    let (_, response) = released(leaning(), law, 0.1, &mut path);
    let End([theta, _]) = path;
    let taken_j = 0.5 * k * (theta * theta - 0.03 * 0.03);
    // The error of a run at this tolerance.
    assert!((response.energy.effect_loss_j - taken_j).abs() < 1e-10 * taken_j.abs(), "{theta}");
}

struct End([f64; 2]);

impl Observer for End {
    fn moved(&mut self, _: f64, _: Contact, motion: &Quintic) {
        self.0 = motion.position(1.0);
    }
    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: [f64; 2]) {}
}

/// Laws that no catalogue has.
fn strangers() -> Vec<Formula> {
    let top = |text: &str, own: &[(&str, f64, &str)]| formula(Place::Top, text, own);
    vec![
        top("-c*abs(v)**1.7*sign(v)", &[("c", 900.0, "N*(s/m)**1.7")]),
        top("-c*abs(v)**0.5*sign(v)", &[("c", 200.0, "N*(s/m)**0.5")]),
        top("-k*x**5", &[("k", 5e8, "N/m**5")]),
        top("-F*tanh(v/s)", &[("F", 300.0, "N"), ("s", 0.05, "m/s")]),
        top("-F*(1 + b*exp(-abs(v)/s))*sign(v)", &[("F", 200.0, "N"), ("b", 0.5, ""), ("s", 0.05, "m/s")]),
        top("-F*abs(x)/g*sign(v)", &[("F", 300.0, "N"), ("g", 0.02, "m")]),
        top("-k*x*(1 + b*sign(x*v))", &[("k", 5e3, "N/m"), ("b", 0.3, "1")]),
        top("-k*x/(1 + abs(x)/s)", &[("k", 20e3, "N/m"), ("s", 0.01, "m")]),
        top("-c*v*(abs(x) > g)", &[("c", 3000.0, "N*s/m"), ("g", 0.01, "m")]),
        top("-k*x/(g + x_max)", &[("k", 300.0, "N"), ("g", 0.01, "m")]),
        top("k*x*x_max/(g + x_max)", &[("k", 10e3, "N/m"), ("g", 0.02, "m")]),
        top("-k*sign(x)*max(abs(x) - a*x_max, 0)", &[("k", 20e3, "N/m"), ("a", 0.4, "1")]),
        top("-F*(1 + x_max/g)*sign(v)", &[("F", 100.0, "N"), ("g", 0.01, "m")]),
        top("-k*x*(x_max < g)", &[("k", 20e3, "N/m"), ("g", 0.008, "m")]),
        carried::maxwell(20e3, 0.3),
        carried::maxwell(20e6, 1e-4),
        carried::bouc_wen(30e3, 0.01),
        // Two in a row: the second follows the first.
        carried::carrying(
            "-z - k*y",
            &[("z", "k*v - z/tau", 0.0, "N"), ("y", "(z/k - y)/tau", 0.0, "m")],
            &[("k", 10e3, "N/m"), ("tau", 0.2, "s")],
        ),
        // A wall that is held by friction goes on relaxing.
        carried::carrying(
            "-z - F*sign(v)",
            &[("z", "k*v - max(abs(z) - F, 0)*sign(z)/tau", 0.0, "N")],
            &[("k", 20e3, "N/m"), ("tau", 0.05, "s"), ("F", 100.0, "N")],
        ),
        top("-c*max(0, v + x/t)", &[("c", 1500.0, "N*s/m"), ("t", 0.1, "s")]),
        formula(
            Place::Crack,
            "-k*phi*abs(phi) - mu*N*tanh(w/s)*b",
            &[("k", 2e5, "N*m"), ("mu", 0.1, ""), ("s", 0.05, "1/s"), ("b", 0.05, "m")],
        ),
        formula(Place::Crack, "-c*w*max(N - L, 0)/L*(N > L)", &[("c", 500.0, "N*m*s"), ("L", 10e3, "N")]),
        formula(Place::Ground, "-M*(abs(phi)/r)**0.7*sign(phi)", &[("M", 300.0, "N*m"), ("r", 0.01, "rad")]),
    ]
}

#[test]
fn analytic_the_ledger_closes_over_any_law() {
    for law in strangers() {
        let response = run(&with_formulas(std::slice::from_ref(&law), table_wall()));
        let residual = response.energy.residual();
        // The error of a run at this tolerance.
        assert!(residual < 1e-7, "{law}: {residual}");
    }
}

#[test]
fn analytic_an_odd_law_has_a_mirror() {
    for law in strangers() {
        if law.to_string().contains("max(0, v") {
            // Not odd.
            continue;
        }
        let wall = with_formulas(std::slice::from_ref(&law), table_wall());
        let [run, mirror] = [1.0, -1.0].map(|sign| simulate(&wall, &shaking(sign), ACCURACY));
        for i in 0..2 {
            assert_eq!(run.theta_max_rad[i].value, -mirror.theta_max_rad[i].value, "{law}");
        }
        assert_eq!(run.energy, mirror.energy, "{law}");
        assert_eq!(run.impacts, mirror.impacts, "{law}");
        assert_eq!(run.work, mirror.work, "{law}");
    }
}

#[test]
fn analytic_a_run_converges_with_its_tolerance() {
    for law in strangers() {
        let wall = with_formulas(std::slice::from_ref(&law), table_wall());
        let largest = |tolerance: f64| {
            let response = simulate(&wall, &shaking(1.0), Accuracy { tolerance });
            response.theta_max_rad.map(|peak| peak.value)
        };
        let [loose, tight] = [1e-6, 1e-9].map(largest);
        for i in 0..2 {
            let error = (loose[i] - tight[i]).abs() / wall.alpha_i_rad()[i];
            assert!(error < 1e-5, "{law}: {error} of α");
        }
    }
}

#[test]
fn analytic_formulas_add_up_and_go_beside_effects() {
    let (c, f) = (("c", 1500.0, "N*s/m"), ("F", 300.0, "N"));
    let together = with_formulas(&[formula(Place::Top, "-c*v - F*sign(v)", &[c, f])], table_wall());
    let apart = [formula(Place::Top, "-c*v", &[c]), formula(Place::Top, "-F*sign(v)", &[f])];
    let apart = with_formulas(&apart, table_wall());
    let effects = vec![Effect::with_parameters("coulomb_friction", &[100.0]).expect("an effect")];
    let lesser = formula(Place::Top, "-c*v - F*sign(v)", &[c, ("F", 200.0, "N")]);
    let beside = with_formulas(&[lesser], WallParameters { effects, ..table_wall() });
    let expected = run(&together);
    for wall in [apart, beside] {
        let found = run(&wall);
        for i in 0..2 {
            let [a, b] = [&found, &expected].map(|r| r.theta_max_rad[i].value);
            // The tolerance of both runs.
            assert!((a - b).abs() <= 1e-7 * expected.alpha_rad, "{a} and {b}");
        }
    }
}

#[test]
fn analytic_a_wall_with_a_formula_moves_side_by_side_as_alone_to_the_bit() {
    let bed = Effect::with_parameters("compliant_joint.both", &[5e9, 1e-4]).expect("an effect");
    let mut walls = Vec::new();
    for parameters in [table_wall(), WallParameters { effects: vec![bed], ..table_wall() }] {
        walls.extend(strangers().into_iter().map(|law| with_formulas(&[law], parameters.clone())));
        let at_all_places = [
            formula(Place::Top, "-c*v*abs(v)", &[("c", 1500.0, "N*s**2/m**2")]),
            formula(Place::Ground, "-c*w", &[("c", 800.0, "N*m*s")]),
            formula(Place::Crack, "-k*phi", &[("k", 900.0, "N*m")]),
        ];
        walls.push(with_formulas(&at_all_places, parameters.clone()));
        // Strangers to formulas in the same rows: with a damper, and without any law.
        let damper = Effect::with_parameters("viscous_damping", &[1500.0]).expect("an effect");
        for further in [None, Some(damper)] {
            let effects = parameters.effects.iter().copied().chain(further).collect();
            let named = Wall::new(WallParameters { effects, ..parameters.clone() }).expect("a wall");
            walls.extend([named.clone(), named]);
        }
    }
    let mut waiting = walls.iter().enumerate();
    let mut next = || {
        let (index, wall) = waiting.next()?;
        Some((index, Simulator::new(wall, &shaking(1.0), ACCURACY).prepared()))
    };
    let mut beside = vec![None; walls.len()];
    simulate_side_by_side(&mut next, &mut |index, response| beside[index] = Some(response));
    for (wall, beside) in walls.iter().zip(beside) {
        let alone = simulate(wall, &shaking(1.0), ACCURACY);
        assert_eq!(format!("{beside:?}"), format!("{:?}", Some(alone)), "{:?}", wall.parameters().formulas);
    }
}

#[test]
fn analytic_a_formula_on_beds_closes_the_ledger() {
    let bed = Effect::with_parameters("compliant_joint.both", &[5e9, 1e-4]).expect("an effect");
    let damper = Effect::with_parameters("viscous_damping", &[1500.0]).expect("an effect");
    let law = formula(Place::Top, "-c*v", &[("c", 1500.0, "N*s/m")]);
    let parameters = WallParameters { effects: vec![bed], ..table_wall() };
    let written = with_formulas(&[law], parameters.clone());
    let named =
        Wall::new(WallParameters { effects: vec![bed, damper], ..parameters.clone() }).expect("a wall");
    let [written, named] = [written, named].map(|wall| simulate(&wall, &shaking(1.0), ACCURACY));
    assert_eq!(format!("{written:?}"), format!("{named:?}"));
    for law in strangers() {
        let wall = with_formulas(std::slice::from_ref(&law), parameters.clone());
        let response = simulate(&wall, &shaking(1.0), ACCURACY);
        assert_eq!(response.outcome, Outcome::Stood, "{law}");
        assert!(response.energy.residual() < 1e-7, "{law}: {}", response.energy.residual());
    }
}

#[test]
fn rejects_formulas_that_the_wall_cannot_have() {
    let uncracked = WallParameters { crack_height_m: None, ..table_wall() };
    for (parameters, law, parts) in [
        (
            table_wall(),
            formula(Place::Top, "-F*g/(0.5*g - x)", &[("F", 1.0, "N"), ("g", 0.1, "m")]),
            &["formulas.0.force_n", "`0.5*g - x` may be zero", "x from -"][..],
        ),
        (
            uncracked.clone(),
            formula(Place::Crack, "-k*phi", &[("k", 1.0, "N*m")]),
            &["formulas.0.moment_n_m", "crack of a wall without one"],
        ),
        (
            table_wall(),
            formula(Place::Ground, "-k*(phi - p)", &[("k", 1.0, "N*m"), ("p", 0.1, "rad")]),
            &["a moment of 0.1 N m at phi = 0", "no moment there"],
        ),
        (
            table_wall(),
            formula(Place::Ground, "-M*sign(w)", &[("M", 1.0, "N*m")]),
            &["a moment that jumps at w = 0", "tanh(w/s)"],
        ),
    ] {
        let refused = Wall::new(WallParameters { formulas: vec![law], ..parameters }).expect_err("refused");
        for part in parts {
            assert!(refused.to_string().contains(part), "{refused} without {part}");
        }
    }
    // A pole beyond what the wall can reach is none.
    let far = formula(Place::Top, "-F*x/(g - x)", &[("F", 1.0, "N"), ("g", 5.0, "m")]);
    Wall::new(WallParameters { formulas: vec![far], ..table_wall() }).expect("far away");
}
