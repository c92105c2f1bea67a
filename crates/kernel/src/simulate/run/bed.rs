//! A joint on a bed changes its contact.

use super::super::bed_events::{BedChange, BedChangeKind};
use super::super::history::Observer;
use super::{Run, Stop, failed};
use crate::model::{Contact, Joint, MechanicsError, Pivot, Vector};

impl<O: Observer> Run<O> {
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
}
