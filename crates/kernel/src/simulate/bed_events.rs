//! Where the contact of a joint changes inside a step: whole, in part, past the middle, or past a kink of its law.

use super::events::{Event, ROUNDINGS, first_end};
use crate::model::{Branch, Contact, Joint, JointLaw, Pivot, RockingWall, opening};
use crate::solver::{Bernstein, Point, Quintic, Step};

/// A change of the contact of a joint: sign × (limit - φ) falls below zero; of one that stops, sign × φ'.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BedChange {
    pub joint: Joint,
    pub kind: BedChangeKind,
    limit_rad: f64,
    sign: f64,
}

/// What changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum BedChangeKind {
    /// Whole contact becomes contact in part, open towards a side.
    Opens(Pivot),
    /// Contact in part becomes whole.
    Closes,
    /// A joint that had been open on this side passes the middle.
    Crosses(Pivot),
    /// An open joint passes the kink of its law outwards; one that crushes begins to.
    Passes(Pivot),
    /// The same inwards.
    Returns,
    /// A joint that crushes stops.
    Stops(Pivot),
}

impl BedChange {
    /// What is left to the change at an instant, and its rate.
    pub fn left(&self, at: &Point) -> (f64, f64) {
        if let BedChangeKind::Stops(_) = self.kind {
            return (opening(self.joint, at.velocity), opening(self.joint, at.acceleration));
        }
        (opening(self.joint, at.position) - self.limit_rad, opening(self.joint, at.velocity))
    }

    /// Smallest of what is left at the coefficients of a path, given the smallest and the largest of them.
    #[inline]
    fn least_left(&self, [least, most]: [f64; 2]) -> f64 {
        let nearest = if self.sign > 0.0 { most } else { least };
        (self.limit_rad - nearest) * self.sign
    }
}

/// The first change of contact inside a step, and the share of the step at which it is.
#[inline]
pub(super) fn first_bed_change(
    wall: &RockingWall,
    contact: Contact,
    opened: [Pivot; 2],
    step: &Step,
    motion: &Quintic,
) -> Option<(Event, f64)> {
    if !wall.wall().rolls() {
        return None;
    }
    let size: f64 = motion.bounds().iter().sum();
    let [least, most] = motion.gaps_between();
    let mut first = None;
    for joint in wall.joints() {
        let Some(law) = wall.joint_law(joint) else { continue };
        let (i, was_open) = (joint as usize, opened[joint as usize]);
        let changes = match (contact.at(joint), wall.branch(joint)) {
            (side, Branch::Beyond) if side.is_open() => beyond_kink(joint, law, side),
            (side, _) => changes_of(joint, law, side, was_open),
        };
        for change in changes.into_iter().flatten() {
            let share = match change.kind {
                BedChangeKind::Stops(_) => share_of_stop(&change, step),
                _ => {
                    let rounding = ROUNDINGS * f64::EPSILON * size.max(change.limit_rad.abs());
                    // Most steps are far from every limit, and their coefficients prove it.
                    if change.least_left([least[i], most[i]]) > rounding {
                        continue;
                    }
                    share_of(&change, &motion.gap(i), rounding)
                }
            };
            let Some(share) = share else { continue };
            if first.is_none_or(|(_, earliest)| share < earliest) {
                first = Some((Event::Bed(change), share));
            }
        }
    }
    first
}

/// Between which rotations (rad) a joint keeps its contact, and its law stays before its kink; finite. Between none where that is
/// beyond it.
pub(super) fn keeps_contact_between(
    wall: &RockingWall,
    contact: Contact,
    opened: [Pivot; 2],
    joint: Joint,
) -> [f64; 2] {
    let Some(law) = wall.joint_law(joint) else { return [-f64::MAX, f64::MAX] };
    if contact.at(joint).is_open() && wall.branch(joint) == Branch::Beyond {
        return [f64::MAX, -f64::MAX];
    }
    let changes = changes_of(joint, law, contact.at(joint), opened[joint as usize]);
    changes.into_iter().flatten().fold([-f64::MAX, f64::MAX], |[low, high], change| {
        if change.sign > 0.0 { [low, high.min(change.limit_rad)] } else { [low.max(change.limit_rad), high] }
    })
}

/// The changes that may come next of a joint before the kink of its law. Its contact is whole up to ±φ_c; sharp edges
/// open and close by impacts.
#[inline]
fn changes_of(joint: Joint, law: &JointLaw, side: Pivot, was_open: Pivot) -> [Option<BedChange>; 3] {
    let to = |limit_rad: f64, sign: f64, kind: BedChangeKind| BedChange { joint, kind, limit_rad, sign };
    let gives = |change: BedChange| law.gives().then_some(change);
    let phi_c = law.full_contact_rad();
    let sign = side.sign();
    match side {
        Pivot::Closed => [
            gives(to(phi_c, 1.0, BedChangeKind::Opens(Pivot::Right))),
            gives(to(-phi_c, -1.0, BedChangeKind::Opens(Pivot::Left))),
            was_open
                .is_open()
                .then(|| to(0.0, -was_open.sign(), BedChangeKind::Crosses(was_open)))
                .and_then(gives),
        ],
        side => [
            gives(to(sign * phi_c, -sign, BedChangeKind::Closes)),
            law.kink_rad(side).map(|kink| to(sign * kink, sign, BedChangeKind::Passes(side))),
            None,
        ],
    }
}

/// The change that comes next of a joint beyond the kink of its law.
fn beyond_kink(joint: Joint, law: &JointLaw, side: Pivot) -> [Option<BedChange>; 3] {
    let sign = side.sign();
    let change = match law.kink_rad(side) {
        _ if law.crushes() => BedChange { joint, kind: BedChangeKind::Stops(side), limit_rad: 0.0, sign },
        Some(kink) => BedChange { joint, kind: BedChangeKind::Returns, limit_rad: sign * kink, sign: -sign },
        None => return [None; 3],
    };
    [Some(change), None, None]
}

/// Where a joint stops that has been opening: on the cubic through velocities and accelerations.
fn share_of_stop(change: &BedChange, step: &Step) -> Option<f64> {
    let of = |pair: [f64; 2]| opening(change.joint, pair);
    let [start, end] =
        [&step.start, &step.end].map(|at| [of(at.velocity), step.h * of(at.acceleration) / 3.0]);
    let rate = Bernstein([start[0], start[0] + start[1], end[0] - end[1], end[0]]);
    let size = [&step.start, &step.end].map(|at| at.velocity[0].abs() + at.velocity[1].abs());
    first_end(rate.times(change.sign), ROUNDINGS * f64::EPSILON * size[0].max(size[1]))
}

/// Where the rotation across the joint passes the limit, of a step that is not surely far from it.
fn share_of(change: &BedChange, path: &Bernstein<6>, rounding: f64) -> Option<f64> {
    let mut left = path.below(change.limit_rad).times(change.sign);
    let [start, next, ..] = left.0;
    if start < 0.0 && next > start {
        // Beyond the limit by what the change before was located less well than to roundings, and on its way back.
        left.0.iter_mut().for_each(|c| *c -= start);
    }
    first_end(left, rounding)
}
