//! Impacts in the lanes: a row goes through most of them by itself, with the bits of walls that go one after another.

use fearless_simd::{Level, Simd};
use mrbd_formula::{Formula, Parameter, Place};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, Effect, ImpactLaw, Pair, Restitution, Wall, WallParameters};
use mrbd_kernel::simulate::{
    Accuracy, Observer, Response, Shaking, Simulator, simulate_side_by_side_at, simulate_watched_side_by_side,
};
use mrbd_kernel::solver::Quintic;

/// Ten seconds of sines that rock the table wall in all patterns, to both sides as far.
fn shaking(strength_m_s2: f64) -> Shaking {
    let a = |t: f64| strength_m_s2 * ((9.0 * t).sin() + (17.3 * t).sin() + 0.3 * (61.0 * t).sin());
    let samples = (0..1000).map(|k| a(0.01 * f64::from(k))).collect();
    let horizontal = Some(Accelerogram::new(0.01, samples).expect("a record"));
    Shaking { horizontal, vertical: None, tail_s: 3.0 }
}

/// Walls that strike alike at every speed and that do not, with a crack and without, that are captured early and late, and with
/// further laws: named ones and formulas, some with a branch for each way that the top moves.
fn walls() -> Vec<Wall> {
    let table = WallParameters::table_wall;
    let struck = |law: ImpactLaw, capture_velocity_rad_s: f64| {
        let restitution = Restitution { law, capture_velocity_rad_s, ..table().restitution };
        WallParameters { restitution, ..table() }
    };
    let with = |name: &str, values: &[f64]| {
        let effects = vec![Effect::with_parameters(name, values).expect("an effect")];
        WallParameters { effects, ..table() }
    };
    let written = |laws: &[(Place, &str, f64, &str)]| {
        let formula = |(place, text, value, unit): &(Place, &str, f64, &str)| {
            Formula::parse(text, *place, &[Parameter::new("c", *value, unit)]).expect("a formula")
        };
        WallParameters { formulas: laws.iter().map(formula).collect(), ..table() }
    };
    let linear = (Place::Top, "-c*v", 900.0, "N*s/m");
    let parameters = [
        table(),
        struck(ImpactLaw::Whole, 1e-6),
        struck(ImpactLaw::Whole, 0.05),
        struck(ImpactLaw::Contact, 1e-3),
        WallParameters { eccentricity_m: 0.02, ..table() },
        WallParameters { crack_height_m: None, ..table() },
        WallParameters { crack_height_m: Some(1.2), stiffness_n_per_m: 5e3, ..table() },
        with("impact_fading", &[0.3]),
        with("viscous_damping", &[1500.0]),
        with("joint_damping.crack", &[100.0]),
        with("cubic_stiffness", &[1e6]),
        written(&[linear]),
        written(&[linear, (Place::Crack, "-c*w", 60.0, "N*m*s")]),
        written(&[(Place::Top, "-c*sign(v)*abs(v)**1.3", 900.0, "N*(s/m)**1.3")]),
    ];
    parameters.into_iter().map(|parameters| Wall::new(parameters).expect("a wall that can exist")).collect()
}

fn responses(level: Level, tolerance: f64) -> Vec<Response> {
    let walls = walls();
    let strengths = [0.9, 1.3];
    let runs = strengths.iter().flat_map(|&strength| walls.iter().map(move |wall| (wall, shaking(strength))));
    let prepared = |(wall, shaking)| Simulator::new(wall, &shaking, Accuracy { tolerance }).prepared();
    let mut waiting = runs.map(prepared).enumerate();
    let mut responses = vec![None; strengths.len() * walls.len()];
    simulate_side_by_side_at(level, &mut || waiting.next(), &mut |number, response| {
        responses[number] = Some(response);
    });
    responses.into_iter().map(|response| response.expect("every run ends")).collect()
}

/// Instructions by which walls go one after another.
fn one_after_another() -> Option<Level> {
    #[cfg(target_arch = "x86_64")]
    return Level::new().as_sse2().map(Simd::level);
    #[cfg(not(target_arch = "x86_64"))]
    Some(Level::baseline())
}

#[test]
fn analytic_impacts_in_lanes_have_the_bits_of_impacts_one_after_another() {
    let Some(alone) = one_after_another() else { return };
    for tolerance in [1e-4, 1e-6, 1e-9] {
        let (expected, found) = (responses(alone, tolerance), responses(Level::new(), tolerance));
        for (expected, found) in expected.iter().zip(&found) {
            assert_eq!(format!("{found:?}"), format!("{expected:?}"), "at {tolerance:e}");
        }
        let table2 =
            |change: usize| found.iter().map(|response| response.impacts.table2[change]).sum::<u64>();
        // Walls strike the ground as one, and their cracks close in both directions.
        assert!(table2(5) > 100 && table2(0) > 100 && table2(1) > 100, "{:?}", found[0].impacts);
    }
}

/// Rotations and contacts every so often, s; nothing between is asked for where it may say so.
struct Sampled {
    every_s: f64,
    says_so: bool,
    rows: Vec<(Pair, Contact)>,
}

impl Sampled {
    fn next_s(&self) -> f64 {
        self.rows.len() as f64 * self.every_s
    }

    fn until(&mut self, end_s: f64, contact: Contact, theta_at: impl Fn(f64) -> Pair) {
        while self.next_s() < end_s {
            self.rows.push((theta_at(self.next_s()), contact));
        }
    }
}

impl Observer for Sampled {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        let theta_at = |time_s: f64| motion.sampled((time_s - start_s) / motion.h());
        self.until(start_s + motion.h(), contact, theta_at);
    }

    fn stood(&mut self, _: f64, to_s: f64) {
        self.until(to_s, Contact::REST, |_| [0.0; 2]);
    }

    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}

    fn wants_from_s(&self) -> f64 {
        if self.says_so { self.next_s() } else { f64::NEG_INFINITY }
    }
}

/// Runs watched every so often, beside each other or alone.
fn watched(every_s: f64, beside: bool) -> (Vec<Vec<(Pair, Contact)>>, Vec<Response>) {
    let simulators: Vec<_> = walls()
        .iter()
        .map(|wall| Simulator::new(wall, &shaking(1.3), Accuracy { tolerance: 1e-8 }))
        .collect();
    let sampled = |_: &Simulator| Sampled { every_s, says_so: beside, rows: Vec::new() };
    let mut watching: Vec<_> = simulators.iter().map(sampled).collect();
    let mut responses = vec![None; simulators.len()];
    let pairs = simulators.iter().zip(&mut watching).enumerate();
    if beside {
        let mut waiting = pairs.map(|(k, (simulator, observer))| {
            (k, simulator.watched_from(&simulator.release(), simulator.end_s(), observer))
        });
        simulate_watched_side_by_side(&mut || waiting.next(), &mut |k, response| {
            responses[k] = Some(response)
        });
    } else {
        for (k, (simulator, observer)) in pairs {
            responses[k] = Some(simulator.run(observer));
        }
    }
    let responses = responses.into_iter().map(|response| response.expect("every run ends")).collect();
    (watching.into_iter().map(|sampled| sampled.rows).collect(), responses)
}

#[test]
fn analytic_runs_that_are_watched_now_and_then_show_what_they_show_alone() {
    // Between samples of the record, at them, and so seldom that most impacts lie between.
    for every_s in [0.0037, 0.01, 0.31] {
        let (expected, alone) = watched(every_s, false);
        let (found, beside) = watched(every_s, true);
        assert_eq!(found, expected, "every {every_s} s");
        assert_eq!(format!("{beside:?}"), format!("{alone:?}"), "every {every_s} s");
        assert!(found.iter().all(|rows| rows.len() as f64 > 8.0 / every_s));
        let rejected = beside.iter().map(|response| response.work.rejected_steps).sum::<u64>();
        assert!(rejected > 10, "{rejected}");
    }
}
