//! What happens first inside a step: a joint closes or opens, a law has a kink, a body collapses.

use super::bed_events::BedChange;
use super::run::CarriedStep;
use super::switches::first_turn;
use crate::model::{Contact, Kink, Pair, RockingWall, Touching};
use crate::solver::{Bernstein, Point, Quintic, hermite};

/// What ends a step early.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Event {
    /// A body passes its collapse rotation.
    Collapse,
    /// An open joint closes; closed joints touch too.
    Impact(Touching),
    /// A closed joint lifts at a corner, or friction can no longer hold the top.
    Opening,
    /// A law at the top has a kink.
    Kink(Kink),
    /// The contact of a joint on a bed changes.
    Bed(BedChange),
}

/// What of these happens to a wall on sharp edges by itself; small, so that it stays in registers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum EdgeEvent {
    Collapse,
    Impact(Touching),
    Opening,
}

impl From<EdgeEvent> for Event {
    fn from(event: EdgeEvent) -> Self {
        match event {
            EdgeEvent::Collapse => Event::Collapse,
            EdgeEvent::Impact(touching) => Event::Impact(touching),
            EdgeEvent::Opening => Event::Opening,
        }
    }
}

impl Event {
    /// The gap that closes, as the sum of so many times the rotations: exact, and without a choice for which the processor waits.
    #[inline]
    pub fn gap(self) -> Option<Pair> {
        match self {
            // θ_2 - θ_1, θ_2 and θ_1.
            Event::Impact(Touching { crack: true, ground: false }) => Some([-1.0, 1.0]),
            Event::Impact(Touching { crack: true, ground: true }) => Some([0.0, 1.0]),
            Event::Impact(_) => Some([1.0, 0.0]),
            _ => None,
        }
    }
}

/// Two closings nearer than this share of a step are one: roundings could not tell their order.
const SAME_INSTANT: f64 = 1e-12;
/// How far beyond its estimate the other side of a lift-off is looked for, as a share of a step.
const BEYOND: f64 = 0.4 * SAME_INSTANT;
/// A lift-off need not be located better than this share of a step. An opening is placed as much later
/// anyway.
const NEAR_ENOUGH: f64 = 1e-9;
/// Roundings a rotation gathers over a step of some ten operations.
pub(super) const ROUNDINGS: f64 = 8.0;
/// Corner forces are looked at inside a step where one at an end is small beside its size and change. Between
/// ends that are farther away a smooth force cannot dip below zero. The motion turns by less than a tenth of
/// a radian of its own period within a step.
pub(super) const NEAR_ZERO: f64 = 0.05;

/// The first event inside a step and the share of the step at which it happens.
///
/// Ties go to collapse, then to the closing of joints, then to opening. A collapsed wall has no impacts, and
/// a joint that closes changes the forces that would open another.
#[inline]
pub(super) fn first_event(
    contact: Contact,
    motion: &Quintic,
    collapse_rad: Pair,
    corner_force: (Option<f64>, Option<f64>),
    force_at: impl Fn(f64) -> f64,
) -> Option<(EdgeEvent, f64)> {
    let opening = match corner_force {
        (Some(start), Some(end)) => first_lift(start, end, force_at).map(|share| (EdgeEvent::Opening, share)),
        _ => None,
    };
    // Most steps are far from everything, and their coefficients prove it.
    let [lower, upper] = motion.bounds();
    let stands = lower < collapse_rad[0] && upper < collapse_rad[1];
    if stands && motion.keep_to([contact.ground.sign(), contact.crack.sign()]) {
        return opening;
    }
    let at_joints = sooner(first_closing(contact, motion), opening);
    if stands {
        return at_joints;
    }
    sooner(first_collapse(motion, collapse_rad).map(|share| (EdgeEvent::Collapse, share)), at_joints)
}

/// The first of two things inside a step, and of two at one instant the one that is named first.
#[inline(always)]
pub(super) fn sooner<T>(a: Option<(T, f64)>, b: Option<(T, f64)>) -> Option<(T, f64)> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.1 < a.1 { b } else { a }),
        (a, b) => a.or(b),
    }
}

fn first_collapse(motion: &Quintic, limit_rad: Pair) -> Option<f64> {
    let crossing = |i: usize| {
        let theta = motion.coordinate(i);
        let up = theta.below(limit_rad[i]).first_root();
        let down = theta.times(-1.0).below(limit_rad[i]).first_root();
        earlier(up, down)
    };
    earlier(crossing(0), crossing(1))
}

fn earlier(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}

#[inline(always)]
fn first_closing(contact: Contact, motion: &Quintic) -> Option<(EdgeEvent, f64)> {
    let [lower, upper] = motion.bounds();
    let ground = closing(contact.ground.sign(), motion.coordinate(0), lower);
    let crack = closing(contact.crack.sign(), motion.difference(), upper);
    let first = earlier(ground, crack)?;
    let now = |at: Option<f64>| at.is_some_and(|share| share - first <= SAME_INSTANT);
    let touching = Touching {
        ground: now(ground) || contact.ground.is_closed(),
        crack: now(crack) || contact.crack.is_closed(),
    };
    Some((EdgeEvent::Impact(touching), first))
}

/// Share at which a gap of a joint that is open on this side first closes; `size` is that of the rotations it is the
/// difference of.
fn closing(side: f64, gap: Bernstein<6>, size: f64) -> Option<f64> {
    if side == 0.0 {
        return None;
    }
    let mut gap = gap.times(side);
    if gap.is_surely_positive() {
        return None;
    }
    // A joint that has just opened is apart by less than the rotations' own roundings: that is no closing.
    let rounding = ROUNDINGS * f64::EPSILON * size;
    if gap.0.iter().all(|c| *c >= -rounding) {
        return None;
    }
    if gap.0[0] <= rounding {
        gap.0[0] = 0.0;
    }
    gap.first_root_after_start()
}

/// Share at which the smallest corner force, not negative at the start, turns negative; on the negative side.
#[inline]
fn first_lift(start: f64, end: f64, force_at: impl Fn(f64) -> f64) -> Option<f64> {
    if end < 0.0 {
        return Some(lift_between((0.0, start), (1.0, end), force_at));
    }
    let size = start.abs().max(end.abs()) + (end - start).abs();
    if start.min(end) > NEAR_ZERO * size {
        return None;
    }
    let middle = force_at(0.5);
    (middle < 0.0).then(|| lift_between((0.0, start), (0.5, middle), force_at))
}

/// Narrows a bracket by the Illinois form of false position; gives its negative side.
///
/// Estimates come near the zero from one side. So the other side is aimed at by a little more than the estimate says, and
/// the bracket closes from both: in seven evaluations at the mean, where estimates alone took thirty-four.
fn lift_between(mut positive: (f64, f64), mut negative: (f64, f64), force_at: impl Fn(f64) -> f64) -> f64 {
    let mut was_positive = false;
    for _ in 0..60 {
        if negative.0 - positive.0 <= SAME_INSTANT {
            break;
        }
        let share = positive.0 + (negative.0 - positive.0) * positive.1 / (positive.1 - negative.1);
        let beyond = if was_positive { BEYOND } else { -BEYOND };
        let aimed = (share + beyond).clamp(positive.0, negative.0);
        // Forces of a motion that runs away have no size to aim by.
        let share = if aimed.is_nan() { 0.5 * (positive.0 + negative.0) } else { aimed };
        let force = force_at(share);
        let is_positive = force >= 0.0;
        // A side that stays twice counts for half.
        let weight = if is_positive == was_positive { 0.5 } else { 1.0 };
        if is_positive {
            positive = (share, force);
            negative.1 *= weight;
        } else {
            negative = (share, force);
            positive.1 *= weight;
        }
        was_positive = is_positive;
    }
    let located = negative.0 - positive.0 <= NEAR_ENOUGH;
    while !located && negative.0 - positive.0 > SAME_INSTANT {
        let middle = 0.5 * (positive.0 + negative.0);
        if force_at(middle) < 0.0 {
            negative.0 = middle;
        } else {
            positive.0 = middle;
        }
    }
    negative.0
}

/// The first kink inside a step and the share of the step at which it lies.
///
/// The top's displacement over the step is a quintic, as that of the rotations is. It goes through its
/// displacements, velocities and accelerations at both ends.
#[inline]
pub(super) fn first_kink(
    wall: &RockingWall,
    contact: Contact,
    [start, end]: [&Point; 2],
    h: f64,
    carried: Option<&CarriedStep>,
) -> Option<(Kink, f64)> {
    let named = wall.piecewise_laws().and_then(|_| first_of(wall, contact, start, end, h));
    if !wall.formulas().have_switches() {
        return named;
    }
    let turn = first_turn(wall, contact, [start, end], h, carried);
    sooner(named, turn)
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
            // The cubic through velocities and accelerations. The quintic's slope would divide roundings of a
            // displacement by a step that may be as short.
            let ([_, v_0, a_0], [_, v_1, a_1]) = (from, to);
            let v_c = Bernstein([v_0, v_0 + h * a_0 / 3.0, v_1 - h * a_1 / 3.0, v_1]);
            first_end(v_c.times(sign), ROUNDINGS * f64::EPSILON * speed_m_s)
        }
        // Those of formulas are found by themselves.
        Kink::Turns { .. } => None,
    };
    let kinks = wall.piecewise_laws()?.kinks(&wall.regime());
    let roots = kinks.filter_map(|kink| share(kink).map(|share| (kink, share)));
    roots.reduce(|a, b| if b.1 < a.1 { b } else { a })
}

/// Share at which what is left to a kink turns negative. Where it begins at zero, its first coefficient
/// beyond roundings decides: it turns negative at once, or later.
pub(super) fn first_end<const N: usize>(mut left: Bernstein<N>, rounding: f64) -> Option<f64> {
    let first = left.0.iter().position(|c| c.abs() > rounding)?;
    if left.0[first] < 0.0 {
        return Some(0.0);
    }
    left.0[..first].fill(0.0);
    left.first_root()
}

/// What is left to a kink at an instant, and how fast it falls.
pub(super) fn left_to_kink(wall: &RockingWall, contact: Contact, kink: Kink, at: &Point) -> (f64, f64) {
    let moving = [at.position, at.velocity, at.acceleration];
    if let Kink::Turns { formula, switch } = kink {
        return wall.left_to_switch([formula, switch], contact, moving);
    }
    let [x_c, v_c, a_c] = wall.top(contact, at.position, at.velocity, at.acceleration);
    match kink {
        Kink::Passes { limit_m, .. } => (x_c - limit_m, v_c),
        Kink::Stops { .. } | Kink::Turns { .. } => (v_c, a_c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_a_force_without_bounds_is_located_by_halves() {
        let force = |share: f64| if share < 0.3 { f64::INFINITY } else { f64::NEG_INFINITY };
        let found = lift_between((0.0, force(0.0)), (1.0, force(1.0)), force);
        assert!((found - 0.3).abs() <= NEAR_ENOUGH, "{found}");
        // Nor does one that is no number end in a bracket without ends.
        let found = lift_between((0.0, 1.0), (1.0, -1.0), |_| f64::NAN);
        assert!((0.0..=1.0).contains(&found), "{found}");
    }

    #[test]
    fn analytic_a_force_on_a_line_vanishes_where_the_line_does() {
        // Linear to the last digit, so that false position stops within roundings of the root.
        for k in 1..1000 {
            let root = f64::from(k) * 1e-3;
            let line = |share: f64| 7.743666e-4 - 7.743666e-4 / root * share;
            let found = lift_between((0.0, line(0.0)), (1.0, line(1.0)), line);
            // The bracket's width, and a rounding of the line over its slope.
            assert!((found - root).abs() <= 2.0 * SAME_INSTANT, "{found} for {root}");
        }
    }
}
