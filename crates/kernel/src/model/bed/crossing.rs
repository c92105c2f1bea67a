//! What is lost where a joint on a bed passes from one side to the other.
//!
//! A bed that is soft beside the speed of the passage lets the weight down and lifts it again: nothing is lost
//! but in its dampers. A stiff one has no time to, and the passage is the impact of a sharp edge. Which of
//! them it is follows from r, the time in whole contact over that of a bounce on the bed
//! ([`super::Bed::passage_over_bounce`]). The share s = 1/(1 + r (1 + r²)/r_0) of the impact's change of
//! velocities is taken. The part with r³ is felt where a passage is slower than a bounce: it excites none.

use super::super::MechanicsError;
use super::super::contact::{Contact, Joint, Pivot, Touching};
use super::super::geometry::{Pair, Rotations};
use super::super::impact::Impact;
use super::super::mass_matrix::{Freedom, MassMatrix};
use super::super::rocking::{RockingWall, State, opening};
use super::joint_law::JointLaw;
use super::shape::Branch;

/// r_0: where half of the change of an impact is taken. It is small, for a passage lasts longer than whole contact does: at ten φ_c
/// the zone of contact is still a third of the joint. So it is of a body that a joint on springs lets down and lifts while it turns at a
/// steady rate. Of eleven walls that two other programs moved on rows of springs ten are followed as well or better than with the share
/// 1/(1 + (r/0.2)²), measured without r² (docs/model.md).
const HALF_IMPACT: f64 = 0.02;

/// The share of an impact's change of velocities that a passage takes, r times as long in whole contact as a bounce.
fn share_of_impact(r: f64) -> f64 {
    1.0 / (1.0 + r * (1.0 + r * r) / HALF_IMPACT)
}

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
        let r = bed.passage_over_bounce(opening(joint, state.omega));
        let share = share_of_impact(r);
        let rotations = Rotations::new(state.theta).with_angles();
        let on_bed = |contact: Contact| self.motion(contact).mass_matrix(rotations);
        let on_edges = |contact: Contact| edges.motion(contact).mass_matrix(rotations);
        let along = |contact: Contact| self.motion(contact).freedom.along(joint);
        let before = on_bed(contact);
        let omega = passed([&before, &on_edges(from)], along(contact), state.omega);
        let touching = Touching {
            ground: joint == Joint::Ground || from.ground.is_closed(),
            crack: joint == Joint::Crack || from.crack.is_closed(),
        };
        let impact = edges.impact(from, touching, &State { theta: state.theta, omega })?;
        // Joints on sharp edges change as the impact says; that on the bed is in whole contact.
        let after = self.joints().filter(|joint| self.bed(*joint).is_none());
        let after = after.fold(contact, |state, joint| state.with(joint, impact.contact.at(joint)));
        let beyond = if after == contact { before } else { on_bed(after) };
        let sharp = passed([&on_edges(impact.contact), &beyond], along(after), impact.omega);
        let omega = [0, 1].map(|i| state.omega[i] + share * (sharp[i] - state.omega[i]));
        let loss_j = 0.5 * (before.quadratic(state.omega) - beyond.quadratic(omega));
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
        let rotations = Rotations::new(state.theta).with_angles();
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

#[cfg(test)]
mod tests {
    use super::share_of_impact;

    /// A row of springs without tension, with dampers, under a weight: times in 1/ω_z, depths in that at rest, forces in the weight, places
    /// in half of the width. It turns by φ_c in the time r.
    struct Row {
        r: f64,
        damping_ratio: f64,
    }

    impl Row {
        const SPRINGS: u32 = 80;

        /// Force and moment of the row, deep by u with the rate v, turned by p φ_c.
        fn carries(&self, p: f64, [u, v]: [f64; 2]) -> [f64; 2] {
            let count = f64::from(Self::SPRINGS);
            let places = (0..Self::SPRINGS).map(|i| (2.0 * f64::from(i) + 1.0) / count - 1.0);
            let pushes = places.map(|x| {
                let [depth, rate] = [u + p * x, v + x / self.r];
                let push = if depth > 0.0 { (depth + 2.0 * self.damping_ratio * rate).max(0.0) } else { 0.0 };
                [push / count, x * push / count]
            });
            pushes.fold([0.0; 2], |sum, push| [sum[0] + push[0], sum[1] + push[1]])
        }

        /// What the model takes without a share: the static moment and k ζ L c³/12 φ'.
        fn modelled(&self, p: f64) -> f64 {
            let contact = if p.abs() <= 1.0 { 1.0 } else { p.abs().sqrt().recip() };
            let of_rest = if p.abs() <= 1.0 { p / 3.0 } else { p.signum() * (1.0 - 2.0 / 3.0 * contact) };
            of_rest + 2.0 * self.damping_ratio / self.r * contact.powi(3) / 3.0
        }

        /// What turning loses beyond that from -`farthest` φ_c to `farthest` φ_c, over the loss of a sharp edge: the mean over the second
        /// half of the way out, for the weight goes on bouncing.
        fn share(&self) -> f64 {
            let farthest = (25.0 / self.r).max(300.0);
            let h = (0.05 * self.r).min(0.005);
            let mut p = -farthest;
            let mut at = [p + 2.0 * farthest.sqrt(), (1.0 - farthest.sqrt().recip()) / self.r];
            let (mut lost, mut sum, mut count) = (0.0, 0.0, 0.0);
            while p < farthest {
                let [force, _] = self.carries(p, at);
                let middle = [at[0] + 0.5 * h * at[1], at[1] + 0.5 * h * (1.0 - force)];
                let [force, moment] = self.carries(p + 0.5 * h / self.r, middle);
                lost += h * (moment - self.modelled(p + 0.5 * h / self.r));
                at = [at[0] + h * middle[1], at[1] + h * (1.0 - force)];
                p += h / self.r;
                if p > 0.5 * farthest {
                    (sum, count) = (sum + lost, count + 1.0);
                }
            }
            // Weight times half of the width over m φ'² b²/2 is r/2 in these measures.
            0.5 * self.r * sum / count
        }
    }

    #[test]
    fn analytic_the_share_of_an_impact_is_nearly_that_of_a_row_of_springs() {
        for damping_ratio in [0.1, 0.4] {
            for r in [0.005, 0.02, 0.05, 0.1, 0.3] {
                let row = Row { r, damping_ratio }.share();
                let share = share_of_impact(r);
                println!("r = {r}, ζ ω_z/2 = {damping_ratio}: {row:.3} of a row, {share:.3} taken");
                // The share knows no damping: rows part by a tenth among themselves, and stiff ones stay below an impact.
                assert!((row - share).abs() < 0.14, "r = {r}: {row}, {share}");
            }
        }
    }
}
