//! A joint on a bed changes its contact.

use super::super::bed_events::{BedChange, BedChangeKind, first_bed_change};
use super::super::events::Event;
use super::super::history::Observer;
use super::{Run, Stop, failed};
use crate::model::{Branch, Contact, Joint, MechanicsError, Pivot, Touching, Vector, opening};
use crate::solver::{Quintic, Step};

impl<O: Observer> Run<O> {
    /// The first change of contact inside a step, and the share of the step at which it is.
    #[inline]
    pub(super) fn first_bed_change(&self, step: &Step, motion: &Quintic) -> Option<(Event, f64)> {
        first_bed_change(&self.wall, self.contact, self.opened, step, motion)
    }

    /// An event as far as sharp edges go: joints on beds take no part in their impacts.
    #[inline]
    pub(super) fn on_edges(&self, event: Event) -> Event {
        match event {
            Event::Impact(touching) if self.wall.wall().gives() => {
                let of = |joint: Joint| touching.at(joint) && self.wall.bed(joint).is_none();
                Event::Impact(Touching { ground: of(Joint::Ground), crack: of(Joint::Crack) })
            }
            event => event,
        }
    }

    /// Enters the contact state after a change, and takes what is lost where the joint passes its middle.
    pub(super) fn change_contact(
        &mut self,
        change: BedChange,
        ground: Vector,
        time_s: f64,
    ) -> Result<(), Stop> {
        let BedChange { joint, kind, .. } = change;
        let contact = match kind {
            BedChangeKind::Opens(side) => {
                self.opened[joint as usize] = side;
                let opened = self.contact.with(joint, side);
                self.totals.opening(self.contact, opened);
                opened
            }
            BedChangeKind::Closes => self.contact.with(joint, Pivot::Closed),
            BedChangeKind::Crosses(side) => self.cross(joint, side).map_err(|e| failed(time_s, &e))?,
            BedChangeKind::Passes(_) | BedChangeKind::Returns | BedChangeKind::Stops(_) => {
                self.turn_branch(joint, kind);
                self.contact
            }
        };
        self.contact = contact;
        self.enter(contact, ground, time_s)
    }

    fn cross(&mut self, joint: Joint, side: Pivot) -> Result<Contact, MechanicsError> {
        self.opened[joint as usize] = Pivot::Closed;
        match joint {
            Joint::Ground => self.now.position[0] = 0.0,
            Joint::Crack => self.now.position[1] = self.now.position[0],
        }
        let impact = self.wall.crossing(self.contact, joint, side, &self.state())?;
        self.totals.impact(&impact);
        self.now.velocity = impact.omega;
        Ok(impact.contact)
    }

    /// Goes into another branch of a joint's law.
    fn turn_branch(&mut self, joint: Joint, kind: BedChangeKind) {
        let Some(law) = self.wall.joint_law(joint).copied() else { return };
        match kind {
            BedChangeKind::Stops(side) => {
                if side.sign() * opening(joint, self.now.velocity) > 0.0 {
                    // What is left of the rate is the error of a step.
                    match joint {
                        Joint::Ground => self.now.velocity[0] = 0.0,
                        Joint::Crack => self.now.velocity[1] = self.now.velocity[0],
                    }
                }
                // An impact at the other joint may have turned it back at a rate.
                let law = law.turned_by(side, opening(joint, self.now.position));
                self.now.velocity =
                    self.wall.turn_crushing(self.contact, joint, (law, Branch::Before), &self.state());
            }
            BedChangeKind::Passes(_) if law.crushes() => {
                self.now.velocity =
                    self.wall.turn_crushing(self.contact, joint, (law, Branch::Beyond), &self.state());
            }
            BedChangeKind::Passes(_) => self.wall.set_branch(joint, law, Branch::Beyond),
            _ => self.wall.set_branch(joint, law, Branch::Before),
        }
    }
}
