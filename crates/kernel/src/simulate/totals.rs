//! Keeping account of a run while it goes: maxima, pattern times, friction, tension, energy.

use super::response::{EnergyLedger, Impacts, JointDemand, Openings, Peak, Work};
use crate::model::{Contact, Impact, JointForces};
use crate::solver::{Bernstein, Quintic};

/// A change of forces over times of 1e-7 of a sample step, with room: over such a time they change by some 1e-7.
pub(super) const LITTLE: f64 = 1e-5;

/// Everything a run adds up.
#[derive(Debug, Clone, Default)]
pub(crate) struct Totals {
    /// Whether anybody asks for largest values, forces and energy.
    pub accounts: bool,
    pub theta_max: [Peak; 2],
    pub top_max: Peak,
    pub pattern_time_s: [f64; 9],
    pub impacts: Impacts,
    pub openings: Openings,
    pub energy: EnergyLedger,
    pub demand: [JointDemand; 2],
    pub work: Work,
    pub in_tension: [bool; 2],
    /// Joints the wall has: one, or two where it is cracked.
    pub joints: usize,
}

/// Raises the largest rotations by what happens inside a step.
#[inline]
pub(super) fn raise_rotations(theta_max: &mut [Peak; 2], start_s: f64, motion: &Quintic) {
    for (i, bound) in motion.bounds().into_iter().enumerate() {
        if bound > theta_max[i].value.abs() {
            raise(&mut theta_max[i], start_s, &motion.coordinate(i), motion.h());
        }
    }
}

fn raise(peak: &mut Peak, start_s: f64, theta: &Bernstein<6>, h: f64) {
    // A step may cross zero; both sides count.
    for sign in [1.0, -1.0] {
        let theta = theta.times(sign);
        let so_far = peak.value.abs();
        if theta.0.iter().all(|c| *c <= so_far) {
            continue;
        }
        let (value, share) = theta.maximum();
        if value > so_far {
            *peak = Peak { value: sign * value, time_s: start_s + share * h };
        }
    }
}

impl Totals {
    /// Nothing yet, for a wall with this many joints.
    pub fn new(joints: usize) -> Self {
        Self { joints, accounts: true, ..Self::default() }
    }

    /// The same where nobody asks for largest values: nothing ever exceeds these, so none is looked for.
    pub fn without_accounts(joints: usize) -> Self {
        let all = f64::INFINITY;
        let peak = Peak { value: all, time_s: 0.0 };
        let demand = JointDemand { friction: all, compression_n: all, tensions: 0 };
        Self {
            accounts: false,
            theta_max: [peak; 2],
            top_max: peak,
            demand: [demand; 2],
            ..Self::new(joints)
        }
    }

    /// No number in the place of all that was not asked for.
    pub fn untold(self) -> Self {
        let none = f64::NAN;
        let peak = Peak { value: none, time_s: none };
        let demand = JointDemand { friction: none, compression_n: none, tensions: 0 };
        let energy = EnergyLedger {
            initial_j: none,
            final_j: none,
            ground_work_j: none,
            impact_loss_j: none,
            effect_loss_j: none,
            passed_through_j: none,
        };
        Self { theta_max: [peak; 2], top_max: peak, demand: [demand; 2], energy, ..self }
    }

    /// Raises the largest rotations by what happens inside a step.
    #[inline]
    pub fn rotations(&mut self, start_s: f64, motion: &Quintic) {
        raise_rotations(&mut self.theta_max, start_s, motion);
    }

    /// Raises the largest top displacement.
    #[inline]
    pub fn top(&mut self, displacement_m: f64, time_s: f64) {
        if displacement_m.abs() > self.top_max.value.abs() {
            self.top_max = Peak { value: displacement_m, time_s };
        }
    }

    /// Counts friction and tension at both joints.
    #[inline]
    pub fn forces(&mut self, forces: &JointForces) {
        for (i, force) in [forces.ground, forces.crack].iter().enumerate().take(self.joints) {
            let tension = force.normal < 0.0;
            let demand = &mut self.demand[i];
            // A division only where the demand does rise.
            if force.normal > 0.0 && force.shear.abs() > demand.friction * force.normal {
                demand.friction = force.shear.abs() / force.normal;
            }
            demand.compression_n = demand.compression_n.max(force.normal);
            demand.tensions += u64::from(tension && !self.in_tension[i]);
            self.in_tension[i] = tension;
        }
    }

    /// Whether forces, and all that differ from them by little, raise no largest one and leave no pivot under tension.
    #[inline]
    pub fn surely_outdo(&self, forces: &JointForces) -> bool {
        [forces.ground, forces.crack].iter().enumerate().take(self.joints).all(|(i, force)| {
            let (demand, normal) = (&self.demand[i], force.normal * (1.0 + LITTLE));
            !self.in_tension[i]
                && force.shear.abs() * (1.0 + LITTLE) < demand.friction * force.normal
                && normal < demand.compression_n
        })
    }

    /// Adds the work of the ground and the losses of effects over a step.
    #[inline]
    pub fn energy(&mut self, [work_j, loss_j]: [f64; 2]) {
        self.energy.ground_work_j += work_j;
        self.energy.effect_loss_j += loss_j;
        self.energy.passed_through_j += work_j.abs() + loss_j.abs();
    }

    /// Counts an impact and its loss.
    pub fn impact(&mut self, impact: &Impact) {
        self.impacts.count(impact.change, impact.captured);
        self.energy.impact_loss_j += impact.loss_j;
        self.energy.passed_through_j += impact.loss_j.abs();
    }

    /// Counts an opening.
    pub fn opening(&mut self, from: Contact, to: Contact) {
        let o = &mut self.openings;
        match (from.pattern_number(), to.pattern_number()) {
            (None, Some(3)) => o.rest_to_3 += 1,
            (None, Some(4)) => o.rest_to_4 += 1,
            (None, _) => o.rest_to_both += 1,
            (Some(3), _) => o.crack += 1,
            _ => o.ground += 1,
        }
    }
}
