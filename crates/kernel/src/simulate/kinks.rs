//! Kinks of the laws at the top inside a step: where the top passes a displacement, where it stops.

use crate::model::{Contact, Kink, RockingWall};
use crate::solver::{Bernstein, Point, hermite};

/// Roundings that a displacement or a velocity of the top gathers over a step of some ten operations.
const ROUNDINGS: f64 = 8.0;

/// The first kink inside a step and the share of the step at which it lies.
///
/// The top's displacement over the step is the quintic through its displacements, velocities and accelerations at both
/// ends, as that of the rotations is.
#[inline]
pub(super) fn first_kink(
    wall: &RockingWall,
    contact: Contact,
    start: &Point,
    end: &Point,
    h: f64,
) -> Option<(Kink, f64)> {
    wall.restraint().and_then(|_| first_of(wall, contact, start, end, h))
}

#[cold]
fn first_of(wall: &RockingWall, contact: Contact, start: &Point, end: &Point, h: f64) -> Option<(Kink, f64)> {
    if wall.is_held() {
        // A top that is held moves by roundings only, which are no kinks.
        return None;
    }
    let top = |p: &Point| wall.top(contact, p.position, p.velocity, p.acceleration);
    let (from, to) = (top(start), top(end));
    // What x_C and its velocity are sums of.
    let width_m = wall.wall().parameters().thickness_m;
    let speed_m_s =
        wall.top_speed_size(contact, start.velocity).max(wall.top_speed_size(contact, end.velocity));
    let share = |kink: Kink| match kink {
        Kink::Passes { limit_m, sign, .. } => {
            let left = |[x_c, v_c, a_c]: [f64; 3]| [limit_m - x_c, -v_c, -a_c].map(|term| sign * term);
            let rounding_m = ROUNDINGS * f64::EPSILON * (width_m + limit_m.abs());
            first_end(hermite(left(from), left(to), h), rounding_m)
        }
        Kink::Stops { sign } => {
            // The cubic through velocities and accelerations: the quintic's slope would divide a displacement's roundings
            // by a step that may be as short as they are.
            let ([_, v_0, a_0], [_, v_1, a_1]) = (from, to);
            let v_c = Bernstein([v_0, v_0 + h * a_0 / 3.0, v_1 - h * a_1 / 3.0, v_1]);
            first_end(v_c.times(sign), ROUNDINGS * f64::EPSILON * speed_m_s)
        }
    };
    let kinks = wall.restraint()?.kinks(&wall.regime());
    let roots = kinks.filter_map(|kink| share(kink).map(|share| (kink, share)));
    roots.reduce(|a, b| if b.1 < a.1 { b } else { a })
}

/// Share at which what is left to a kink turns negative, where it may begin at zero: then its first coefficient beyond
/// roundings tells whether it turns negative at once or comes back later.
fn first_end<const N: usize>(mut left: Bernstein<N>, rounding: f64) -> Option<f64> {
    let first = left.0.iter().position(|c| c.abs() > rounding)?;
    if left.0[first] < 0.0 {
        return Some(0.0);
    }
    left.0[..first].fill(0.0);
    left.first_root()
}

/// What is left to a kink at an instant, and how fast it falls.
pub(super) fn left(wall: &RockingWall, contact: Contact, kink: Kink, at: &Point) -> (f64, f64) {
    let [x_c, v_c, a_c] = wall.top(contact, at.position, at.velocity, at.acceleration);
    match kink {
        Kink::Passes { limit_m, .. } => (x_c - limit_m, v_c),
        Kink::Stops { .. } => (v_c, a_c),
    }
}
