//! The contact state that follows a state, and the motion in it (model section 4).

use wide::f64x2;

use super::MechanicsError;
use super::contact::{Contact, Joint, Pivot, Touching};
use super::joint_forces::Reactions;
use super::motion::MotionRate;
use super::rocking::{RockingWall, State, opening};
use super::vector::Vector;
use crate::instructions::dispatch;

/// Corner forces within this share of the weight count as zero where no state carries the forces exactly. It
/// is the rounding of the top's position times the stiffest spring.
pub(super) const FORCE_ROUNDING: f64 = 1e-9;

/// The motion in a contact state that carries its forces.
#[derive(Debug, Clone, Copy, Default)]
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
        self.next_contact_and_motion(contact, state, ground, &mut Carried::default()).map(|(next, _)| next)
    }

    /// [`RockingWall::next_contact`], and whether the motion in that state is known: it is written where it is to stay, because
    /// copies of what was just written wait for the writing.
    #[inline(always)]
    pub(crate) fn next_contact_and_motion(
        &self,
        contact: Contact,
        state: &State,
        ground: Vector,
        carried: &mut Carried,
    ) -> Result<(Contact, bool), MechanicsError> {
        // The one state in which no further joint opens.
        match self.is_admissible_by(contact, contact, state, ground, carried) {
            true => Ok((contact, true)),
            false => self.opened_contact_and_motion(contact, state, ground, carried),
        }
    }

    /// The same where a joint opens.
    #[inline(never)]
    fn opened_contact_and_motion(
        &self,
        contact: Contact,
        state: &State,
        ground: Vector,
        carried: &mut Carried,
    ) -> Result<(Contact, bool), MechanicsError> {
        for opened in 1..=2 {
            for candidate in self.states_opening(contact, opened) {
                if self.is_admissible_by(contact, candidate, state, ground, carried) {
                    return Ok((candidate, true));
                }
            }
        }
        // A corner force so near zero that neither it nor the opening that would follow has a sign beyond roundings.
        let theta_dd = self.rate(contact, state, ground).theta_dd;
        let forces = self.joint_forces(contact, state, theta_dd, ground);
        if self.smallest_corner_force(contact, &forces).is_none_or(|least| least >= -FORCE_ROUNDING) {
            return Ok((contact, false));
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
        self.is_admissible_by(before, candidate, state, ground, &mut Carried::default())
    }

    /// Whether a contact state carries its forces and its opened joints accelerate apart, by the motion in it.
    #[inline(always)]
    fn is_admissible_by(
        &self,
        before: Contact,
        candidate: Contact,
        state: &State,
        ground: Vector,
        carried: &mut Carried,
    ) -> bool {
        self.carry(candidate, state, ground, carried);
        let apart = |joint: Joint| {
            let opens = before.at(joint).is_closed() && candidate.at(joint).is_open();
            !opens || candidate.at(joint).sign() * opening(joint, carried.rate.theta_dd) > 0.0
        };
        self.joints().all(apart) && carried.reserve.is_none_or(|least| least >= 0.0)
    }

    /// The motion in a contact state and what it has in reserve.
    #[inline(always)]
    fn carry(&self, contact: Contact, state: &State, ground: Vector, carried: &mut Carried) {
        let motion = self.motion(contact);
        if motion.on_beds().is_some() {
            let (rate, reactions) = motion.rate_and_reactions_at(state.theta, state.omega, ground);
            *carried = self.carried_by(contact, rate, &reactions);
            return;
        }
        let (theta, omega) = (f64x2::new(state.theta), f64x2::new(state.omega));
        dispatch!(motion.level, _ => {
            let (rate, reactions) = motion.rate_and_reactions(&motion.configuration(theta), omega, ground);
            *carried = self.carried_by(contact, rate.into(), &reactions);
        });
    }

    #[inline(always)]
    fn carried_by(&self, contact: Contact, rate: MotionRate, reactions: &Reactions) -> Carried {
        let reserve = self.smallest_reserve(contact, reactions);
        Carried { rate, top_velocity_m_s: reactions.top_velocity_m_s, reserve }
    }
}
