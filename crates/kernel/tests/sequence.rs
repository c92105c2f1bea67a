//! Sequences of ground motions: what is carried from one to the next, and that it is all.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, Effect, Pair, Wall, WallParameters};
use mrbd_kernel::simulate::{
    Accuracy, Observer, Outcome, Response, Shaking, following, simulate, simulate_observed, simulate_sequence,
};
use mrbd_kernel::solver::Quintic;

const STEP_S: f64 = 0.01;

/// Strict, so that what two ways of stepping differ by is far below what is compared.
const STRICT: Accuracy = Accuracy { tolerance: 1e-10 };

/// The table wall of the paper's Table 1, with a floor that may yield in the place of its spring.
fn table_wall(yield_force_n: Option<f64>) -> Wall {
    let mut wall = WallParameters::table_wall();
    if let Some(force_n) = yield_force_n {
        let spring = Effect::with_parameters("yielding_spring", &[wall.stiffness_n_per_m, force_n]);
        wall.effects.push(spring.expect("an effect"));
        wall.stiffness_n_per_m = 0.0;
    }
    Wall::new(wall).expect("a wall that can exist")
}

/// Two sines that begin with zero, so that a record which follows another has no jump to begin with.
fn samples(amplitude_m_s2: f64, rate_rad_s: f64) -> Vec<f64> {
    let a = |t: f64| amplitude_m_s2 * ((rate_rad_s * t).sin() + (2.5 * rate_rad_s * t).sin());
    (0..150).map(|k| a(STEP_S * f64::from(k))).collect()
}

fn shaking(samples: Vec<f64>, tail_s: f64) -> Shaking {
    let horizontal = Some(Accelerogram::new(STEP_S, samples).expect("a record"));
    Shaking { horizontal, vertical: None, tail_s }
}

fn first(rest_s: f64) -> Shaking {
    shaking(samples(1.3, 9.0), rest_s)
}

fn second() -> Shaking {
    shaking(samples(1.1, 7.0), 2.0)
}

/// Both records as one, with zeros between.
fn joined(rest_s: f64) -> Shaking {
    let (one, two) = (samples(1.3, 9.0), samples(1.1, 7.0));
    let zeros = (rest_s / STEP_S).round() as usize - 1;
    shaking([one, vec![0.0; zeros], two].concat(), 2.0)
}

/// Largest rotations in the steps from a time on.
struct Late {
    from_s: f64,
    largest: Pair,
}

impl Observer for Late {
    fn moved(&mut self, start_s: f64, _: Contact, motion: &Quintic) {
        // Times gather roundings; a record's samples end steps.
        if start_s < self.from_s - 1e-9 {
            return;
        }
        for (i, largest) in self.largest.iter_mut().enumerate() {
            let swing = |sign: f64| motion.coordinate(i).times(sign).maximum().0;
            *largest = largest.max(swing(1.0)).max(swing(-1.0));
        }
    }

    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}
}

fn both(wall: &Wall, rest_s: f64) -> [Response; 2] {
    let parts = simulate_sequence(wall, &[first(rest_s), second()], STRICT);
    let parts: Vec<Response> = parts.into_iter().map(|part| part.expect("it stands")).collect();
    parts.try_into().expect("two parts")
}

fn largest(response: &Response) -> Pair {
    response.theta_max_rad.map(|peak| peak.value.abs())
}

/// A wall that yields and one that does not, at rest again before the second record, and still rocking.
#[test]
fn analytic_a_sequence_is_the_run_of_the_joined_record() {
    for (wall, rest_s) in [
        (table_wall(None), 20.0),
        (table_wall(None), 0.3),
        (table_wall(Some(300.0)), 20.0),
        (table_wall(Some(300.0)), 0.3),
    ] {
        let [before, after] = both(&wall, rest_s);
        let from_s = first(rest_s).horizontal.expect("a record").duration_s() + rest_s;
        let mut late = Late { from_s, largest: [0.0; 2] };
        let whole = simulate_observed(&wall, &joined(rest_s), STRICT, &mut late);
        assert_eq!(whole.outcome, Outcome::Stood);
        assert!(whole.impacts.total() > 3 && largest(&after)[0] > 1e-3, "it rocks in both: {after:?}");
        for i in 0..2 {
            let alpha_rad = wall.alpha_i_rad()[i];
            let of_both = largest(&before)[i].max(largest(&after)[i]);
            let apart = |x: f64, y: f64| (x - y).abs() / alpha_rad;
            // Ten times the tolerance: impacts magnify what steps of another length make.
            let parted = apart(largest(&after)[i], late.largest[i]).max(apart(of_both, largest(&whole)[i]));
            assert!(parted < 1e-9, "rest {rest_s} s: {parted}");
        }
        let impacts = before.impacts.total() + after.impacts.total();
        assert_eq!(impacts, whole.impacts.total(), "rest {rest_s} s");
        let set_m = whole.left.plastic_displacement_m;
        assert!((after.left.plastic_displacement_m - set_m).abs() < 1e-9 * wall.parameters().height_m);
    }
}

#[test]
fn analytic_a_wall_without_memory_at_rest_again_is_as_new() {
    let wall = table_wall(None);
    let [before, after] = both(&wall, 20.0);
    assert!(largest(&before)[0] > 1e-3);
    assert_eq!(before.left.state.theta, [0.0; 2]);
    assert_eq!(after, simulate(&wall, &second(), STRICT));
    // Still rocking it is another wall.
    let [_, after] = both(&wall, 0.3);
    assert_ne!(largest(&after), largest(&simulate(&wall, &second(), STRICT)));
}

#[test]
fn analytic_a_yielding_floor_carries_its_set() {
    let wall = table_wall(Some(300.0));
    let [before, after] = both(&wall, 20.0);
    let alone = simulate(&wall, &second(), STRICT);
    let set_m = before.left.plastic_displacement_m;
    // The elastic displacement is 300 / 37e3 = 8 mm.
    assert!(set_m.abs() > 1e-4, "{set_m}");
    assert_eq!(following(&before).expect("it stands").plastic_displacement_m, set_m);
    assert_ne!(largest(&after), largest(&alone));
}

#[test]
fn analytic_nothing_follows_a_collapse() {
    let wall = table_wall(None);
    let strong = shaking(samples(8.0, 4.0), 1.0);
    let parts = simulate_sequence(&wall, &[strong, second(), second()], Accuracy::default());
    assert!(parts[0].as_ref().is_some_and(Response::collapsed));
    assert_eq!(parts[1..], [None, None]);
}
