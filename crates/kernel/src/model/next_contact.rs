//! The contact state that follows a state, and the motion in it (model section 4).

use super::MechanicsError;
use super::contact::{Contact, Joint, Pivot, Touching};
use super::motion::MotionRate;
use super::rocking::{RockingWall, State, opening};
use super::vector::Vector;

/// Corner forces within this share of the weight count as zero where no state carries the forces exactly. It
/// is the rounding of the top's position times the stiffest spring.
pub(super) const FORCE_ROUNDING: f64 = 1e-9;

/// The motion in a contact state that carries its forces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carried {
    pub rate: MotionRate,
    pub top_velocity_m_s: f64,
    /// As [`RockingWall::smallest_reserve`] says.
    pub reserve: Option<f64>,
}

impl RockingWall {
    /// The contact state that follows a state whose joints in `contact` are closed or open (model section 4).
    /// It is the one in which fewest joints open. Its closed joints are compressed at both corners, its
    /// opened joints accelerate apart.
    ///
    /// # Errors
    /// [`MechanicsError::NoContactState`] where no state is admissible.
    pub fn next_contact(
        &self,
        contact: Contact,
        state: &State,
        ground: Vector,
    ) -> Result<Contact, MechanicsError> {
        self.next_contact_and_motion(contact, state, ground).map(|(next, _)| next)
    }

    /// [`RockingWall::next_contact`] with the motion in that state, where it is known.
    ///
    /// Part of what calls it, so that what it gives is not copied on the way.
    #[inline(always)]
    pub(crate) fn next_contact_and_motion(
        &self,
        contact: Contact,
        state: &State,
        ground: Vector,
    ) -> Result<(Contact, Option<Carried>), MechanicsError> {
        // The one state in which no further joint opens.
        match self.admissible_motion(contact, contact, state, ground) {
            Some(carried) => Ok((contact, Some(carried))),
            None => self.opened_contact_and_motion(contact, state, ground),
        }
    }

    /// The same where a joint opens.
    #[inline(never)]
    fn opened_contact_and_motion(
        &self,
        contact: Contact,
        state: &State,
        ground: Vector,
    ) -> Result<(Contact, Option<Carried>), MechanicsError> {
        for opened in 1..=2 {
            for candidate in self.states_opening(contact, opened) {
                if let Some(carried) = self.admissible_motion(contact, candidate, state, ground) {
                    return Ok((candidate, Some(carried)));
                }
            }
        }
        // A corner force so near zero that neither it nor the opening that would follow has a sign beyond roundings.
        let theta_dd = self.rate(contact, state, ground).theta_dd;
        let forces = self.joint_forces(contact, state, theta_dd, ground);
        if self.smallest_corner_force(contact, &forces).is_none_or(|least| least >= -FORCE_ROUNDING) {
            return Ok((contact, None));
        }
        Err(MechanicsError::NoContactState { from: contact.name() })
    }

    /// States that open `count` of the closed joints of `contact` and leave the others as they are.
    pub(super) fn states_opening(&self, contact: Contact, count: usize) -> impl Iterator<Item = Contact> {
        self.states_touching(contact, self.closed_edges(contact))
            .filter(move |c| c.open_joints() == contact.open_joints() + count)
    }

    /// Every state of the joints that touch, the others as in `contact`; closed before right before left.
    #[inline]
    pub(super) fn states_touching(
        &self,
        contact: Contact,
        touching: Touching,
    ) -> impl Iterator<Item = Contact> + use<> {
        let free_crack = touching.crack && self.wall().is_cracked();
        let choices = |free: bool, now: Pivot| -> &'static [Pivot] {
            match (free, now) {
                (true, _) => &Pivot::ALL,
                (false, Pivot::Closed) => &[Pivot::Closed],
                (false, Pivot::Right) => &[Pivot::Right],
                (false, Pivot::Left) => &[Pivot::Left],
            }
        };
        let cracks = choices(free_crack, contact.crack);
        choices(touching.ground, contact.ground)
            .iter()
            .flat_map(move |&ground| cracks.iter().map(move |&crack| Contact { ground, crack }))
    }

    pub(super) fn is_admissible(
        &self,
        before: Contact,
        candidate: Contact,
        state: &State,
        ground: Vector,
    ) -> bool {
        self.admissible_motion(before, candidate, state, ground).is_some()
    }

    /// The motion in a contact state that carries its forces and whose opened joints accelerate apart.
    #[inline(always)]
    fn admissible_motion(
        &self,
        before: Contact,
        candidate: Contact,
        state: &State,
        ground: Vector,
    ) -> Option<Carried> {
        let (rate, reactions) =
            self.motion(candidate).rate_and_reactions_at(state.theta, state.omega, ground);
        let apart = |joint: Joint| {
            let opens = before.at(joint).is_closed() && candidate.at(joint).is_open();
            !opens || candidate.at(joint).sign() * opening(joint, rate.theta_dd) > 0.0
        };
        let reserve = self.smallest_reserve(candidate, &reactions);
        let carries = self.joints().all(apart) && reserve.is_none_or(|least| least >= 0.0);
        carries.then_some(Carried { rate, top_velocity_m_s: reactions.top_velocity_m_s, reserve })
    }
}
