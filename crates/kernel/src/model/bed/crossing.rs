//! What is lost where a joint on a bed passes from one side to the other.
//!
//! A bed that is soft beside the speed of the passage lets the weight down and lifts it again: nothing is lost
//! but in its dampers. A stiff one has no time to, and the passage is the impact of a sharp edge. Which of
//! them it is follows from r, the time in whole contact over that of a bounce on the bed
//! ([`super::Bed::passage_over_bounce`]). The share s = 1/(1 + (r/r_0)²) of the impact's change of velocities
//! is taken.

use super::super::MechanicsError;
use super::super::contact::{Contact, Joint, Pivot, Touching};
use super::super::geometry::{Pair, Rotations};
use super::super::impact::Impact;
use super::super::mass_matrix::{Freedom, MassMatrix};
use super::super::rocking::{RockingWall, State, opening};
use super::joint_law::JointLaw;
use super::shape::Branch;

/// r_0: where half of the change of an impact is taken. Of 0.1, 0.2, 0.3 and 0.5 it leaves the least error, or one
/// within 2 % of the least, in each of three walls that another program moved on springs (docs/model.md).
const HALF_IMPACT: f64 = 0.2;

impl RockingWall {
    /// The passage of a joint on a bed through φ = 0, after it had been open on a side.
    ///
    /// # Errors
    /// [`MechanicsError::ImpactOutcomes`] where the impact of the sharp edges has no single outcome.
    pub(crate) fn crossing(
        &self,
        contact: Contact,
        joint: Joint,
        side: Pivot,
        state: &State,
    ) -> Result<Impact, MechanicsError> {
        let (Some(edges), Some(bed)) = (&self.edges, self.bed(joint)) else {
            unreachable!("only a joint on a bed crosses")
        };
        let from = contact.with(joint, side);
        let ratio = bed.passage_over_bounce(opening(joint, state.omega)) / HALF_IMPACT;
        let share = 1.0 / (1.0 + ratio * ratio);
        let rotations = Rotations::new(state.theta);
        let on_bed = |contact: Contact| self.motion(contact).mass_matrix(rotations);
        let on_edges = |contact: Contact| edges.motion(contact).mass_matrix(rotations);
        let along = |contact: Contact| self.motion(contact).freedom.along(joint);
        let omega = passed([&on_bed(contact), &on_edges(from)], along(contact), state.omega);
        let touching = Touching {
            ground: joint == Joint::Ground || from.ground.is_closed(),
            crack: joint == Joint::Crack || from.crack.is_closed(),
        };
        let impact = edges.impact(from, touching, &State { theta: state.theta, omega })?;
        // Joints on sharp edges change as the impact says; that on the bed is in whole contact.
        let after = self.joints().filter(|joint| self.bed(*joint).is_none());
        let after = after.fold(contact, |state, joint| state.with(joint, impact.contact.at(joint)));
        let sharp = passed([&on_edges(impact.contact), &on_bed(after)], along(after), impact.omega);
        let omega = [0, 1].map(|i| state.omega[i] + share * (sharp[i] - state.omega[i]));
        let loss_j = 0.5 * (on_bed(contact).quadratic(state.omega) - on_bed(after).quadratic(omega));
        Ok(Impact { contact: after, omega, loss_j, ..impact })
    }
}

impl RockingWall {
    /// A joint begins to crush, or ends to: its edge goes inwards from now on, or no more. So the point about which the body
    /// turns moves at once. Gives the velocities after it.
    pub(crate) fn turn_crushing(
        &mut self,
        contact: Contact,
        joint: Joint,
        (law, branch): (JointLaw, Branch),
        state: &State,
    ) -> Pair {
        let rotations = Rotations::new(state.theta);
        let before = self.motion(contact).mass_matrix(rotations);
        self.set_branch(joint, law, branch);
        let motion = self.motion(contact);
        passed([&before, &motion.mass_matrix(rotations)], motion.freedom.along(joint), state.omega)
    }
}

/// Velocities of a wall while the rotation φ across one of its joints changes.
enum Along {
    /// One way to move: φ and all else change together.
    OneWay(Pair),
    /// The velocities that leave φ as it is, and those that change it alone.
    Free { n: Pair, unit: Pair },
}

impl Freedom {
    fn along(self, joint: Joint) -> Along {
        match (self, joint) {
            (Freedom::Monolithic, _) => Along::OneWay([1.0, 1.0]),
            (Freedom::Upper | Freedom::None, _) => Along::OneWay([0.0, 1.0]),
            (Freedom::Both, Joint::Ground) => Along::Free { n: [0.0, 1.0], unit: [1.0, 0.0] },
            (Freedom::Both, Joint::Crack) => Along::Free { n: [1.0, 1.0], unit: [0.0, 1.0] },
        }
    }
}

/// Velocities after the pivot of a joint has moved, with the inertia from one matrix to another.
///
/// Nothing but the joint's own moment acts meanwhile. So the energy and the momentum along the velocities n
/// that leave φ as it is are kept: nᵀ M ω and ωᵀ M ω. The sign of φ' is kept.
fn passed([from, to]: [&MassMatrix; 2], along: Along, omega: Pair) -> Pair {
    let (n, unit) = match along {
        Along::OneWay(way) => return omega.map(|w| w * (from.quadratic(way) / to.quadratic(way)).sqrt()),
        Along::Free { n, unit } => (n, unit),
    };
    let phi_rate = if n[0] == 0.0 { omega[0] } else { omega[1] - omega[0] };
    if phi_rate == 0.0 {
        // The pivot stays.
        return omega;
    }
    // The velocity with φ' = 1 that has no momentum along n.
    let across = |mass: &MassMatrix| {
        let share = mass.product(n, unit) / mass.quadratic(n);
        [0, 1].map(|i| unit[i] - share * n[i])
    };
    let momentum = from.product(n, omega);
    let [before, after] = [from, to].map(across);
    let freed = momentum * momentum * (1.0 / from.quadratic(n) - 1.0 / to.quadratic(n));
    let energy = (phi_rate * phi_rate * from.quadratic(before) + freed).max(0.0);
    let rate = (energy / to.quadratic(after)).sqrt().copysign(phi_rate);
    let kept = momentum / to.quadratic(n);
    [0, 1].map(|i| kept * n[i] + rate * after[i])
}
