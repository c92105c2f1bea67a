//! Where the contact of a joint on a bed changes inside a step: whole, in part, or past the middle.

use super::events::{Event, ROUNDINGS, first_end};
use crate::model::{Contact, Joint, Pivot, RockingWall, opening};
use crate::solver::{Bernstein, Point, Quintic};

/// A change of the contact of a joint on a bed: sign × (limit - φ) falls below zero.
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
}

impl BedChange {
    /// What is left to the change at an instant, and its rate.
    pub fn left(&self, at: &Point) -> (f64, f64) {
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
    motion: &Quintic,
) -> Option<(Event, f64)> {
    if !wall.wall().gives() {
        return None;
    }
    let size: f64 = motion.bounds().iter().sum();
    let [least, most] = motion.gaps_between();
    let mut first = None;
    for joint in wall.joints() {
        let Some(bed) = wall.bed(joint) else { continue };
        let (i, was_open) = (joint as usize, opened[joint as usize]);
        let changes = changes_of(joint, bed.full_contact_rad(), contact.at(joint), was_open);
        for change in changes.into_iter().flatten() {
            let rounding = ROUNDINGS * f64::EPSILON * size.max(change.limit_rad.abs());
            // Most steps are far from every limit, and their coefficients prove it.
            if change.least_left([least[i], most[i]]) > rounding {
                continue;
            }
            let path = motion.gap(i);
            let Some(share) = share_of(&change, &path, rounding) else { continue };
            if first.is_none_or(|(_, earliest)| share < earliest) {
                first = Some((Event::Bed(change), share));
            }
        }
    }
    first
}

/// The changes that may come next of a joint on a bed, whose contact is whole up to ±φ_c.
#[inline]
fn changes_of(joint: Joint, phi_c: f64, side: Pivot, was_open: Pivot) -> [Option<BedChange>; 3] {
    let to = |limit_rad: f64, sign: f64, kind: BedChangeKind| BedChange { joint, kind, limit_rad, sign };
    match side {
        Pivot::Closed => [
            Some(to(phi_c, 1.0, BedChangeKind::Opens(Pivot::Right))),
            Some(to(-phi_c, -1.0, BedChangeKind::Opens(Pivot::Left))),
            was_open.is_open().then(|| to(0.0, -was_open.sign(), BedChangeKind::Crosses(was_open))),
        ],
        side => [Some(to(side.sign() * phi_c, -side.sign(), BedChangeKind::Closes)), None, None],
    }
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
