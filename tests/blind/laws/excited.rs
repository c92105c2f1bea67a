//! Where the tests of a case took the wall, and the force of the hidden laws there.

use serde_json::{Value, json};

use super::super::cases::draw::Case;
use super::super::cases::hidden::Hidden;
use super::super::cases::tests::{STEP_S, Test};
use super::atom::{Atom, Site};

/// Most points of the tests to fit, and of those held out.
const POINTS: usize = 300;
/// A wall that moves by less than this share of the largest is at rest.
const MOVES: f64 = 0.02;

/// Displacements, velocities, the law's force or moment at its place and the largest displacement so far, of tests to fit and
/// held out, and of each atom its share of the force in those to fit; null without a law.
pub fn excited(case: &Case, tests: &[Test]) -> Value {
    let law = |hidden: &Hidden| if let Hidden::Law(atom) = hidden { Some(*atom) } else { None };
    let atoms = case.hidden.iter().filter_map(law).collect::<Vec<_>>();
    let Some(first) = atoms.first() else { return Value::Null };
    if first.carries() {
        // Every sample: a state follows from all before it.
        let all = |tests: &[Test]| tests.iter().flat_map(|test| along(case, test, first)).collect::<Vec<_>>();
        let (fit, held_out) = tests.split_at(case.fit_tests);
        return json!({ "fit": all(fit), "held_out": all(held_out) });
    }
    let moving = |tests: &[Test]| {
        let all = tests.iter().flat_map(|test| motion(case, test, first.site)).collect::<Vec<_>>();
        let most = all.iter().fold(0.0, |most: f64, [q, ..]| most.max(q.abs()));
        all.into_iter().filter(|[q, ..]| q.abs() > MOVES * most).collect::<Vec<_>>()
    };
    let points = |moving: &[[f64; 3]]| {
        let every = moving.len().div_ceil(POINTS).max(1);
        let force = |motion: &[f64; 3]| atoms.iter().map(|atom| atom.force(*motion)).sum::<f64>();
        moving.iter().step_by(every).map(|m| json!([m[0], m[1], force(m), m[2]])).collect::<Vec<_>>()
    };
    let (fit, held_out) = tests.split_at(case.fit_tests);
    let fit = moving(fit);
    json!({ "fit": points(&fit), "held_out": points(&moving(held_out)), "shares": shares(&atoms, &fit) })
}

/// Of each atom the root mean square of its force over that of them all.
fn shares(atoms: &[Atom], motion: &[[f64; 3]]) -> Vec<f64> {
    let squares = |atoms: &[Atom]| {
        let force = |m: &[f64; 3]| atoms.iter().map(|atom| atom.force(*m)).sum::<f64>();
        motion.iter().map(|m| force(m).powi(2)).sum::<f64>()
    };
    let all = squares(atoms);
    atoms.iter().map(|atom| (squares(std::slice::from_ref(atom)) / all).sqrt()).collect()
}

/// The points of a test with a law that carries a state along.
fn along(case: &Case, test: &Test, atom: &Atom) -> Vec<Value> {
    let (mut z, mut before) = (0.0, None::<f64>);
    let point = |[x, v, largest]: [f64; 3]| {
        z = before.map_or(0.0, |before| atom.carried(z, x - before, STEP_S));
        before = Some(x);
        json!([x, v, atom.force([x, v, z * atom.reach[0]]), largest])
    };
    motion(case, test, atom.site).into_iter().map(point).collect()
}

/// Displacement, velocity and largest displacement so far at a place. At the top they are those of small rotations, enough to
/// tell where a test went.
fn motion(case: &Case, test: &Test, site: Site) -> Vec<[f64; 3]> {
    let heights = [case.actual.crack_height_m, case.actual.height_m - case.actual.crack_height_m];
    let at = |theta: &[f64; 2]| match site {
        Site::Top => theta[0] * heights[0] + theta[1] * heights[1],
        Site::Ground => theta[0],
        Site::Crack => theta[1] - theta[0],
    };
    let three = test.true_rad.windows(3);
    let mut largest = 0.0_f64;
    let mut so_far = |q: f64| {
        largest = largest.max(q.abs());
        largest
    };
    three.map(|w| [at(&w[1]), (at(&w[2]) - at(&w[0])) / (2.0 * STEP_S), so_far(at(&w[1]))]).collect()
}
