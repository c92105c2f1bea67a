//! Impacts: instantaneous, plastic, without sliding or bouncing (model section 5).
//!
//! The velocities after an impact are a projection, in the mass metric, of those before. They are projected
//! onto the velocities that the new contact state allows. The coefficient of the change of pattern then
//! scales them.

use fearless_simd::{Simd, f64x4};

use super::MechanicsError;
use super::Table2Change;
use super::contact::{Contact, Joint, Pivot, Touching};
use super::geometry::{Pair, PointVelocities, Rotations, TurnedArms};
use super::joint_forces::JointForces;
use super::parameters::ImpactLaw;
use super::rocking::{RockingWall, State, opening};
use crate::instructions::dispatch;

/// Contact states side by side: nine are looked at, so that eight would leave as many over as four.
pub(super) const BESIDE: usize = 4;

/// Separations and impulses within this share of the motion before count as zero: some hundred roundings.
pub(super) const ROUNDING: f64 = 1e-13;

/// What came of an impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Contact state after.
    pub contact: Contact,
    /// Angular velocities after, rad/s.
    pub omega: Pair,
    /// The change of Table 2, if it is one.
    pub change: Option<Table2Change>,
    /// Whether a joint was held closed because it would open slower than the capture velocity.
    pub captured: bool,
    /// Kinetic energy lost, J; negative where a coefficient above 1 adds energy.
    pub loss_j: f64,
}

impl Table2Change {
    /// Which change of Table 2 this is, mirrored changes included.
    pub fn of(from: Contact, to: Contact) -> Option<Self> {
        let same_corner = from.ground == to.ground;
        let index = match (from.pattern_number()?, to.pattern_number()?, same_corner) {
            (1, 2, true) => 0,  // C_1: 1a to 2a
            (2, 1, true) => 1,  // C_2: 2a to 1a
            (1, 2, false) => 2, // C_3: 1a to 2b
            (2, 1, false) => 3, // C_4: 2a to 1b
            (3, 1, false) => 4, // C_5: 3a to 1b
            (3, 3, false) => 5, // C_6: 3a to 3b
            (1, 3, true) => 6,  // C_7: 1a to 3a
            (2, 3, true) => 7,  // C_8: 2a to 3a
            _ => return None,
        };
        Some(Table2Change(index))
    }
}

/// An impact while it is worked out: the rotations, and the velocities of the mass points before.
pub(super) struct Collision {
    pub touching: Touching,
    pub rotations: Rotations,
    pub v_before: PointVelocities,
    /// The faster of both bodies before, rad/s; not zero.
    pub speed: f64,
    /// What impulses at corners are small beside, N s; not zero.
    pub impulse_size: f64,
}

impl RockingWall {
    /// The outcome of an impact, from the velocities before.
    ///
    /// # Errors
    /// [`MechanicsError::ImpactOutcomes`] unless exactly one contact state is admissible.
    pub(super) fn worked_out_impact(
        &self,
        from: Contact,
        touching: Touching,
        state: &State,
    ) -> Result<Impact, MechanicsError> {
        dispatch!(self.motion(from).level, simd => self.plastic_impact(simd, from, touching, state))
    }

    #[inline(always)]
    fn plastic_impact<S: Simd>(
        &self,
        simd: S,
        from: Contact,
        touching: Touching,
        state: &State,
    ) -> Result<Impact, MechanicsError> {
        let collision = self.collision(from, touching, state);
        let plastic = self.struck_through(from, &collision);
        let (plastic, projected) = match plastic {
            Some(outcome) => outcome,
            None => self.only_admissible(simd, from, &collision, state)?,
        };
        let (contact, projected) = self.captured(plastic, projected, &collision);
        let change = Table2Change::of(from, contact);
        let omega = self.scaled(change, contact, projected, &collision);
        let before_j = self.motion(from).kinetic_energy_j(collision.rotations, state.omega);
        let after_j = self.motion(contact).kinetic_energy_j(collision.rotations, omega);
        Ok(Impact { contact, omega, change, captured: contact != plastic, loss_j: before_j - after_j })
    }

    /// The outcome of most impacts: every open joint that touches turns on about its other corner. `None` where that is not
    /// admissible, or not shown to be the only one.
    ///
    /// Where no pivot is pulled, velocities and impulses fulfil the conditions of the nearest velocities at which no
    /// corner penetrates. These velocities are a convex set, and the distance is strictly convex: there is one nearest, and
    /// no other state need be looked at.
    #[inline(always)]
    pub(super) fn struck_through(&self, from: Contact, collision: &Collision) -> Option<(Contact, Pair)> {
        if self.wall().rolls() {
            return None;
        }
        let turned = |joint: Joint| match collision.touching.at(joint) {
            true => from.at(joint).mirrored(),
            false => from.at(joint),
        };
        let to = Contact { ground: turned(Joint::Ground), crack: turned(Joint::Crack) };
        let arms = self.turned_arms(to, collision.rotations);
        let omega = self.projected_onto(to, &arms, collision);
        if self.separation(to, omega, collision) <= ROUNDING {
            return None;
        }
        let impulses = self.impulses(&arms, omega, collision);
        let pushed = self.joints().all(|joint| impulses.at(joint).normal > ROUNDING * collision.impulse_size);
        let margin = self.smallest_corner_impulse(to, &impulses, collision);
        (pushed && margin > ROUNDING).then_some((to, omega))
    }

    /// The one contact state that is admissible, and the velocities in it.
    #[inline(never)]
    fn only_admissible<S: Simd>(
        &self,
        simd: S,
        from: Contact,
        collision: &Collision,
        state: &State,
    ) -> Result<(Contact, Pair), MechanicsError> {
        let (mut count, mut plastic) = (0, None);
        self.admissible(simd, from, collision, |to, omega| {
            count += 1;
            plastic = Some((to, omega));
        });
        match (count, plastic) {
            (1, Some(outcome)) => Ok(outcome),
            _ => {
                let touching = collision.touching;
                Err(MechanicsError::ImpactOutcomes { from: from.name(), touching, state: *state, count })
            }
        }
    }

    /// Every admissible contact state after an impact; exactly one is expected.
    ///
    /// Admissible: every closed joint receives impulses that push at both corners, every opened joint separates.
    /// Where no state is so by more than rounding, the tie goes to the one with most joints closed.
    pub fn admissible_outcomes(
        &self,
        from: Contact,
        touching: Touching,
        state: &State,
    ) -> [Option<Contact>; 9] {
        let mut outcomes = [None; 9];
        let collision = self.collision(from, touching, state);
        dispatch!(self.motion(from).level, simd => {
            self.admissible(simd, from, &collision, |to, _| outcomes[to.index()] = Some(to));
        });
        outcomes
    }

    #[inline(always)]
    pub(super) fn collision(&self, from: Contact, touching: Touching, state: &State) -> Collision {
        let mut rotations = Rotations::new(state.theta);
        if self.wall().rolls() {
            rotations = rotations.with_angles();
        }
        let v_before = self.turned_arms(from, rotations).velocities(state.omega);
        // A wall that stands still as joints touch separates by nothing: a tie, not a zero over zero.
        let [w1, w2] = v_before.theta.map(|w| w.abs().max(f64::MIN_POSITIVE));
        // A corner's impulse is a moment over a width: its roundings are those of the momentum times the slimness.
        let size = (self.masses.momentum_size(&v_before) * self.slimness).max(f64::MIN_POSITIVE);
        Collision { touching, rotations, v_before, speed: w1.max(w2), impulse_size: size }
    }

    /// Tells the admissible contact states, with the velocities in them.
    #[inline(always)]
    fn admissible<S: Simd>(
        &self,
        simd: S,
        from: Contact,
        collision: &Collision,
        mut report: impl FnMut(Contact, Pair),
    ) {
        let (mut candidates, mut count) = ([from; 9], 0);
        for to in self.states_touching(from, collision.touching) {
            candidates[count] = to;
            count += 1;
        }
        let (mut any, mut tie) = (false, None::<(Contact, Pair)>);
        for four in candidates[..count].chunks(BESIDE) {
            for (&to, (margin, omega)) in four.iter().zip(self.margins(simd, four, collision)) {
                let fewer = |(tied, _): (Contact, Pair)| to.open_joints() < tied.open_joints();
                if margin > ROUNDING {
                    any = true;
                    report(to, omega);
                } else if margin >= -ROUNDING && tie.is_none_or(fewer) {
                    tie = Some((to, omega));
                }
            }
        }
        if let (false, Some((to, omega))) = (any, tie) {
            report(to, omega);
        }
    }

    /// By how much up to four contact states are admissible, and the velocities in them.
    #[inline(always)]
    fn margins<S: Simd>(&self, simd: S, four: &[Contact], collision: &Collision) -> [(f64, Pair); BESIDE] {
        if let [one] = four {
            // The last of nine by itself costs less than four times.
            return [self.margin(*one, collision); BESIDE];
        }
        let last = four.len() - 1;
        let to = [four[0], four[last.min(1)], four[last.min(2)], four[last]];
        if self.wall().rolls() {
            return to.map(|to| self.margin(to, collision));
        }
        self.margins_on_edges::<f64x4<_>>(simd, &to, collision)
    }

    /// By how much a contact state is admissible, and the velocities in it. The margin is the smallest corner
    /// impulse of closed joints or separation of opened ones. It is taken over the momentum or speed before.
    #[inline(always)]
    fn margin(&self, to: Contact, collision: &Collision) -> (f64, Pair) {
        let arms = self.turned_arms(to, collision.rotations);
        let omega = self.projected_onto(to, &arms, collision);
        let separation = self.separation(to, omega, collision);
        if separation < -ROUNDING {
            return (separation, omega);
        }
        (separation.min(self.smallest_impulse(to, &arms, omega, collision)), omega)
    }

    /// Smallest separation of the joints that touched and are open after, over the speed before; infinite where none is.
    #[inline(always)]
    fn separation(&self, to: Contact, omega: Pair, collision: &Collision) -> f64 {
        self.joints()
            .filter(|joint| collision.touching.at(*joint) && to.at(*joint).is_open())
            .map(|joint| to.at(joint).sign() * opening(joint, omega))
            .fold(f64::INFINITY, f64::min)
            / collision.speed
    }

    /// Velocities that a contact state allows, nearest to those before: Jnᵀ M Jn θ'⁺ = Jnᵀ M v⁻.
    #[inline(always)]
    fn projected_onto(&self, to: Contact, arms: &TurnedArms, collision: &Collision) -> Pair {
        let motion = self.motion(to);
        let momenta = self.masses.momenta(arms, &collision.v_before);
        motion.mass_matrix_by(arms, collision.rotations).solve(motion.freedom, momenta)
    }

    #[inline(always)]
    fn projected(&self, to: Contact, collision: &Collision) -> Pair {
        self.projected_onto(to, &self.turned_arms(to, collision.rotations), collision)
    }

    /// Smallest impulse at the corners of the closed joints over the momentum before; infinite where all are open.
    #[inline(always)]
    fn smallest_impulse(&self, to: Contact, arms: &TurnedArms, omega: Pair, collision: &Collision) -> f64 {
        if to.ground.is_open() && to.crack.is_open() {
            return f64::INFINITY;
        }
        self.smallest_corner_impulse(to, &self.impulses(arms, omega, collision), collision)
    }

    /// Impulses through the joints that bring about these velocities.
    #[inline(always)]
    fn impulses(&self, arms: &TurnedArms, omega: Pair, collision: &Collision) -> JointForces {
        self.masses.impulses(arms, &arms.velocities(omega).minus(collision.v_before))
    }

    /// Smallest of impulses at the corners of the closed joints over the momentum before; infinite where none is.
    #[inline(always)]
    fn smallest_corner_impulse(&self, to: Contact, impulses: &JointForces, collision: &Collision) -> f64 {
        self.joints()
            .filter(|joint| to.at(*joint).is_closed() && self.bed(*joint).is_none())
            .flat_map(|joint| impulses.at(joint).corners(self.width_m(joint)))
            .fold(f64::INFINITY, f64::min)
            / collision.impulse_size
    }

    /// Closes touching joints that would open slower than the capture velocity. Each time it projects once
    /// more from before the impact.
    #[inline(always)]
    fn captured(&self, plastic: Contact, projected: Pair, collision: &Collision) -> (Contact, Pair) {
        let (mut contact, mut omega) = (plastic, projected);
        loop {
            let slow = self.joints().find(|joint| {
                let opened = collision.touching.at(*joint) && contact.at(*joint).is_open();
                opened && opening(*joint, omega).abs() < self.capture_rad_s
            });
            match slow {
                Some(joint) => contact = contact.with(joint, Pivot::Closed),
                None => return (contact, omega),
            }
            omega = self.projected(contact, collision);
        }
    }

    /// Scales the projected velocities by the coefficient of the change.
    #[inline(always)]
    fn scaled(
        &self,
        change: Option<Table2Change>,
        contact: Contact,
        omega: Pair,
        collision: &Collision,
    ) -> Pair {
        let restitution = self.wall().parameters().restitution;
        let Some(change) = change else { return omega };
        let c_l = self.coefficients[change.index()]
            * self.factor_at_impact(collision.touching, collision.v_before.theta);
        let u = match restitution.law {
            // Eq. 7 of the paper.
            ImpactLaw::Whole => [0.0, 0.0],
            // The motion if every touching joint stuck: what the impact cannot see.
            ImpactLaw::Contact => {
                let stuck = self.joints().filter(|joint| collision.touching.at(*joint));
                let stuck = stuck.fold(contact, |state, joint| state.with(joint, Pivot::Closed));
                self.projected(stuck, collision)
            }
        };
        [0, 1].map(|i| u[i] + c_l * (omega[i] - u[i]))
    }
}
