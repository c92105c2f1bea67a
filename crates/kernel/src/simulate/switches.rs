//! Where a formula changes its branch inside a step: at a displacement, at a velocity, or at what is made of
//! both.

use super::events::{ROUNDINGS, first_end};
use super::run::CarriedStep;
use crate::model::{Contact, Kink, Pair, Path, RockingWall, Turn};
use crate::solver::{Bernstein, Point, hermite};

/// A wall beyond a switch by less than this share of what its argument does over the step has just passed it,
/// and was located less well than to roundings.
const JUST_PASSED: f64 = 1e-9;

/// The coefficients of the quintic through values at 0, 1/5, … 1 of a step, times 240: the inverse of the
/// Bernstein polynomials there. Those after the middle are these in reverse.
const FIRST: [f64; 6] = [-308.0, 1200.0, -1200.0, 800.0, -300.0, 48.0];
const SECOND: [f64; 6] = [269.0, -1450.0, 2950.0, -2300.0, 925.0, -154.0];

/// Roundings of its values that such a coefficient gathers: the sum of the magnitudes of [`SECOND`] over 240.
const GATHERED: f64 = 34.0;

fn through(values: [f64; 6]) -> Bernstein<6> {
    let sum = |weights: [f64; 6], values: [f64; 6]| {
        weights.iter().zip(values).map(|(weight, value)| weight * value).sum::<f64>() / 240.0
    };
    let mut back = values;
    back.reverse();
    let [start, .., end] = values;
    Bernstein([start, sum(FIRST, values), sum(SECOND, values), sum(SECOND, back), sum(FIRST, back), end])
}

/// The first switch that turns inside a step, and the share of the step at which it does.
#[cold]
pub(super) fn first_turn(
    wall: &RockingWall,
    contact: Contact,
    ends: [&Point; 2],
    h: f64,
    carried: Option<&CarriedStep>,
) -> Option<(Kink, f64)> {
    let held = wall.is_held();
    // A top that is held moves by roundings only; what it carries along moves on.
    let turns = wall.formulas().turns();
    let turns = turns.filter(|turn| !(held && turn.is_at_top() && !turn.depends_on_states()));
    let found = turns.filter_map(|turn| {
        let share = share_of(wall, contact, &turn, ends, (h, carried))?;
        Some((Kink::Turns { formula: turn.formula, switch: turn.index }, share))
    });
    found.reduce(|a, b| if b.1 < a.1 { b } else { a })
}

fn share_of(
    wall: &RockingWall,
    contact: Contact,
    turn: &Turn,
    ends: [&Point; 2],
    (h, carried): (f64, Option<&CarriedStep>),
) -> Option<f64> {
    let of = |p: &Point| [p.position, p.velocity, p.acceleration];
    let [from, to] = ends.map(|end| turn.place(wall, contact, of(end)));
    let errors = ends.map(|end| wall.place_errors(turn, contact, [end.position, end.velocity]));
    let errors: Pair = [0, 1].map(|i| errors[0][i].max(errors[1][i]));
    let side = turn.side();
    match turn.path() {
        Path::Displacement(value) => {
            let left = |[q, rate, second]: [f64; 3]| [q - value, rate, second];
            let rounding = errors[0] + ROUNDINGS * f64::EPSILON * value.abs();
            end_of(hermite(left(from), left(to), h).times(side), rounding)
        }
        Path::Rate(value) => {
            let rounding = errors[1] + ROUNDINGS * f64::EPSILON * value.abs();
            let Bernstein(rates) = rates(from, to, h);
            end_of(Bernstein(rates.map(|rate| side * (rate - value))), rounding)
        }
        Path::Nowhere => None,
        Path::Both => {
            let (displacement, rates) = (hermite(from, to, h), rates(from, to, h));
            let at = |k: usize| {
                let share = k as f64 / 5.0;
                let place = [displacement.value(share), rates.value(share), 0.0];
                turn.argument_with(place, carried.map_or(turn.states(), |c| turn.own_states(&c.at(share))))
            };
            let rounding = turn.rounding(from, errors).max(turn.rounding(to, errors));
            end_of(through(std::array::from_fn(at)).times(side), GATHERED * rounding)
        }
    }
}

/// The cubic through rates and second rates. The quintic's slope would divide roundings of a displacement by a
/// step that may be as short.
fn rates([_, v_0, a_0]: [f64; 3], [_, v_1, a_1]: [f64; 3], h: f64) -> Bernstein<4> {
    Bernstein([v_0, v_0 + h * a_0 / 3.0, v_1 - h * a_1 / 3.0, v_1])
}

/// Where what is left turns negative. What has just been passed the other way begins at zero.
fn end_of<const N: usize>(mut left: Bernstein<N>, rounding: f64) -> Option<f64> {
    let start = left.0[0];
    let size = left.magnitude_bound();
    if start < 0.0 && left.0[1] > start && -start <= (JUST_PASSED * size).max(rounding) {
        left.0.iter_mut().for_each(|c| *c -= start);
    }
    first_end(left, rounding)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_quintic_goes_through_its_values() {
        let x = |s: f64| 1.0 - 3.0 * s + s.powi(2) + 0.5 * s.powi(3) - 2.0 * s.powi(4) + 0.7 * s.powi(5);
        let quintic = through(std::array::from_fn(|k| x(k as f64 / 5.0)));
        for k in 0..=20 {
            let share = f64::from(k) / 20.0;
            // Some tens of roundings of numbers near one.
            assert!((quintic.value(share) - x(share)).abs() < 1e-14, "at {share}");
        }
    }

    #[test]
    fn analytic_what_was_just_passed_does_not_turn_back() {
        // Beyond by a rounding of the step, and going on; later it comes back.
        let away = Bernstein([-1e-12, 1.0, 1.0, -2.0]);
        let back = end_of(away, 1e-16).expect("it comes back");
        assert!(back > 0.5, "{back}");
        // Beyond by much: it is on the other side.
        assert_eq!(end_of(Bernstein([-1e-3, 1.0, 1.0, 2.0]), 1e-16), Some(0.0));
    }
}
