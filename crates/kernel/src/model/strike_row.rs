//! Impacts that rows of walls go through, number by number as vector registers take them.

use super::Table2Change;
use super::contact::Contact;
use super::parameters::ImpactLaw;
use super::rocking::RockingWall;
use crate::lanes::{Numbers, Wide, exchange};

/// What the impact leaves that ends a contact state of the walls of a row: that of [`super::whole_impact`] of walls that turn as
/// one, that at the crack of others.
#[derive(Debug, Clone, Default)]
pub(crate) struct StrikeRow {
    /// The coefficient of the change of pattern.
    pub coefficient: Numbers,
    /// What a velocity of 1 rad/s comes to of walls that turn as one: as [`super::whole_impact`] has it.
    pub plastic: Numbers,
    pub before_j: Numbers,
    pub after_j: Numbers,
    /// Impacts gone through since the run boarded.
    pub count: Numbers,
}

impl RockingWall {
    /// The contact state into which a row goes on through an impact, and the change: about the other corner at the ground of a wall
    /// that turns as one, at the crack of one whose bodies turn apart. `None` where that is not the same at every speed.
    pub(crate) fn strikes_on(&self, contact: Contact) -> Option<(Contact, Option<Table2Change>)> {
        let Contact { ground, crack } = contact;
        let alike = self.strikes_alike() && !self.wall().rolls();
        let onto = match (ground.is_open(), crack.is_open()) {
            (true, false) if alike => Contact { ground: ground.mirrored(), crack },
            (true, true) if alike && self.wall().parameters().restitution.law == ImpactLaw::Whole => {
                Contact { ground, crack: crack.mirrored() }
            }
            _ => return None,
        };
        Some((onto, Table2Change::of(contact, onto)))
    }
}

impl StrikeRow {
    /// Puts the impact that ends a contact state of a wall in a lane. False where the row cannot go on through it.
    pub fn put(&mut self, i: usize, wall: &RockingWall, contact: Contact) -> bool {
        let Some((_, change)) = wall.strikes_on(contact) else { return false };
        self.count[i] = 0.0;
        self.coefficient[i] = change.map_or(1.0, |change| wall.coefficients[change.index()]);
        if contact.crack.is_open() {
            return true;
        }
        let Some(whole) = wall.whole_impact_about(contact.ground) else { return false };
        (self.plastic[i], self.before_j[i], self.after_j[i]) = (whole.plastic, whole.before_j, whole.after_j);
        true
    }

    /// Exchanges those of some lanes.
    #[inline(always)]
    pub fn exchange<F: Wide>(&mut self, which: F::Mask, other: &mut Self) {
        exchange::<F>(which, &mut self.coefficient, &mut other.coefficient);
        exchange::<F>(which, &mut self.plastic, &mut other.plastic);
        exchange::<F>(which, &mut self.before_j, &mut other.before_j);
        exchange::<F>(which, &mut self.after_j, &mut other.after_j);
        exchange::<F>(which, &mut self.count, &mut other.count);
    }
}
