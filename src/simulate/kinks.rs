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
    let x_c = hermite(top(start), top(end), h);
    // What x_C and its velocity are sums of.
    let width_m = wall.wall().parameters().thickness_m;
    let speed_m_s =
        wall.top_speed_size(contact, start.velocity).max(wall.top_speed_size(contact, end.velocity));
    let share = |kink: Kink| match kink {
        Kink::Passes { limit_m, sign, .. } => {
            let mut left = x_c.below(limit_m).times(sign);
            let rounding = ROUNDINGS * f64::EPSILON * (width_m + limit_m.abs());
            match begins(&mut left, rounding) {
                true => left.first_root_after_start(),
                false => Some(0.0),
            }
        }
        Kink::Stops { sign } => {
            let mut speed = x_c.derivative().times(sign / h);
            match begins(&mut speed, ROUNDINGS * f64::EPSILON * speed_m_s) {
                true => speed.first_root_after_start(),
                false => Some(0.0),
            }
        }
    };
    let kinks = wall.restraint()?.kinks(&wall.regime());
    let roots = kinks.filter_map(|kink| share(kink).map(|share| (kink, share)));
    roots.reduce(|a, b| if b.1 < a.1 { b } else { a })
}

/// Whether what is left to a kink begins on the right side of it, or at it within roundings and not on the way back.
fn begins<const N: usize>(left: &mut Bernstein<N>, rounding: f64) -> bool {
    if left.0[0] < -rounding {
        return false;
    }
    if left.0[0] <= rounding {
        left.0[0] = 0.0;
        return left.0[1] >= -rounding;
    }
    true
}

/// What is left to a kink at an instant, and how fast it falls.
pub(super) fn left(wall: &RockingWall, contact: Contact, kink: Kink, at: &Point) -> (f64, f64) {
    let [x_c, v_c, a_c] = wall.top(contact, at.position, at.velocity, at.acceleration);
    match kink {
        Kink::Passes { limit_m, .. } => (x_c - limit_m, v_c),
        Kink::Stops { .. } => (v_c, a_c),
    }
}
