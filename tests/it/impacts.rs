//! Every impact has exactly one outcome: over random walls, postures and velocities, and over the impacts of runs.

use std::collections::BTreeMap;

use mrbd_kernel::model::{Contact, Joint, RockingWall, State, Touching};
use mrbd_kernel::simulate::{Accuracy, Outcome, simulate};
use rand::RngExt;

use crate::matrix_model::MatrixWall;
use crate::walls::{any_effects, any_impact, any_restitution, any_shaking, any_wall, made, rng};

/// Random impacts whose joints move at 1 rad/s or slower, down to `slowest`; counts by pattern, joints and outcome.
fn count_outcomes(draws: u64, slowest: f64) -> BTreeMap<String, u64> {
    let mut seen = BTreeMap::new();
    for index in 0..draws {
        let mut rng = rng(10, index);
        let parameters = any_wall(&mut rng);
        let wall = RockingWall::new(&made(&parameters));
        let (from, touching, state) = any_impact(&mut rng, wall.wall(), slowest);
        let outcomes = wall.admissible_outcomes(from, touching, &state);
        let found: Vec<Contact> = outcomes.into_iter().flatten().collect();
        let [to] = found[..] else {
            panic!("{found:?} after {touching:?} in {} at {state:?}: {parameters:?}", from.name())
        };
        // It is found without a look at the others, where they need none.
        let impact = wall.impact(from, touching, &state).expect("an outcome");
        assert!(impact.captured || impact.contact == to, "{to:?} or {impact:?} at {state:?}: {parameters:?}");
        let joints = match (touching.ground, touching.crack) {
            (true, true) => "both joints",
            (true, false) => "the ground",
            _ => "the crack",
        };
        // Seen from the side on which the pattern is an `a`.
        let mirrored = from.name().ends_with('b');
        let [from, to] = [from, to].map(|c| if mirrored { c.mirrored().name() } else { c.name() });
        *seen.entry(format!("{from} strikes {joints}: {to}")).or_default() += 1;
    }
    seen
}

#[test]
fn analytic_every_random_impact_has_one_outcome() {
    let seen = count_outcomes(500_000, 1e-3);
    eprintln!("{seen:#?}");
    // All changes of Table 2 that an impact brings about, and every pattern that an impact can start from.
    for change in [
        "1a strikes the crack: 2a",
        "2a strikes the crack: 1a",
        "1a strikes the ground: 2b",
        "2a strikes the ground: 1b",
        "3a strikes both joints: 1b",
        "3a strikes both joints: 3b",
        "1a strikes the crack: 3a",
        "2a strikes the crack: 3a",
        "4a strikes both joints: 4b",
    ] {
        assert!(seen.get(change).is_some_and(|count| *count > 100), "{change}: {seen:#?}");
    }
}

#[test]
fn analytic_impacts_slower_than_roundings_have_one_outcome() {
    // A joint that closes at 1e-18 of the speed of the bodies cannot be told from one that stays closed: a tie.
    for slowest in [1e-9, 1e-13, 1e-15, 1e-18] {
        count_outcomes(200_000, slowest);
    }
}

/// Contact states that the matrix form admits; none of them if one could not be told from a tie.
fn admitted(wall: &MatrixWall, from: Contact, touching: Touching, state: &State) -> Option<Vec<Contact>> {
    let speed = state.omega[0].abs().max(state.omega[1].abs());
    let mut found = Vec::new();
    for to in MatrixWall::candidates(from, touching) {
        let omega = wall.after_impact(from, to, state);
        let impulses = wall.impulses(from, to, state, omega);
        let size = impulses.iter().map(|impulse| impulse.force.abs().sum()).sum::<f64>();
        // Each must be positive: separations over the speed of the bodies, pushes over the impulses.
        let mut margins = Vec::new();
        for (joint, impulse) in [Joint::Ground, Joint::Crack].into_iter().zip(&impulses) {
            let opens = match joint {
                Joint::Ground => omega[0],
                Joint::Crack => omega[1] - omega[0],
            };
            if to.at(joint).is_closed() {
                margins.extend(wall.corners(joint, state.theta, impulse).map(|push| push / size));
            } else if touching.at(joint) {
                margins.push(to.at(joint).sign() * opens / speed);
            }
        }
        let least = margins.into_iter().fold(f64::INFINITY, f64::min);
        // Roundings of 1e-16, magnified by slenderness and by joints a thousand times as slow as the bodies.
        if least.abs() < 1e-10 {
            return None;
        }
        if least > 0.0 {
            found.push(to);
        }
    }
    Some(found)
}

#[test]
fn analytic_outcomes_agree_with_the_matrix_form() {
    let (mut compared, mut ties) = (0, 0);
    for index in 0..100_000 {
        let mut rng = rng(11, index);
        let parameters = any_wall(&mut rng);
        let wall = RockingWall::new(&made(&parameters));
        let matrices = MatrixWall::new(&parameters);
        let (from, touching, state) = any_impact(&mut rng, wall.wall(), 1e-3);
        let Some(expected) = admitted(&matrices, from, touching, &state) else {
            // Without a margin for roundings neither program can be held to the sign of such a number.
            ties += 1;
            continue;
        };
        let outcomes = wall.admissible_outcomes(from, touching, &state);
        let found: Vec<Contact> = outcomes.into_iter().flatten().collect();
        assert_eq!(found, expected, "from {} at {state:?}: {parameters:?}", from.name());
        compared += 1;
    }
    eprintln!("{compared} compared, {ties} ties");
    assert!(ties < 10, "{ties} ties");
}

#[test]
fn analytic_every_impact_of_runs_has_one_outcome() {
    let (mut impacts, mut index) = (0, 0);
    while impacts < 150_000 {
        let mut rng = rng(12, index);
        let mut wall = any_wall(&mut rng);
        wall.effects = any_effects(&mut rng, &wall);
        wall.restitution = any_restitution(&mut rng, 1.05);
        let vertical = rng.random_bool(0.3);
        let shaking = any_shaking(&mut rng, &wall, vertical);
        let response = simulate(&made(&wall), &shaking, Accuracy::default());
        let failed = matches!(response.outcome, Outcome::Failed { .. });
        assert!(!failed, "wall {index}: {:?}: {wall:?}", response.outcome);
        impacts += response.impacts.total();
        index += 1;
    }
    eprintln!("{impacts} impacts in {index} runs");
}
