//! Forces and impulses through the joints by d'Alembert's balance of everything above (model section 4).

use super::contact::Joint;
use super::posture::{Posture, Rates};
use super::vector::Vector;
use super::wall::Wall;

/// Force through a joint and its moment about the joint's middle: newtons and newton metres,
/// or their impulses.
///
/// `normal` and `shear` are taken in the axes of the joint, which turns with the body below it:
/// only so is the force at a corner zero exactly when the joint starts to open about the other one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointForce {
    /// Along the joint, towards +x.
    pub shear: f64,
    /// Across the joint, compression positive.
    pub normal: f64,
    /// Clockwise moment about the middle of the joint.
    pub moment: f64,
}

impl JointForce {
    /// Forces at the left and right corners of a joint of width b: N/2 ± M_c/b.
    pub fn corners(&self, width_m: f64) -> [f64; 2] {
        let half = self.normal / 2.0;
        let lever = self.moment / width_m;
        [half + lever, half - lever]
    }
}

/// Forces through both joints.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointForces {
    /// Through the ground.
    pub ground: JointForce,
    /// Through the crack.
    pub crack: JointForce,
}

impl JointForces {
    pub(crate) fn at(&self, joint: Joint) -> &JointForce {
        match joint {
            Joint::Ground => &self.ground,
            Joint::Crack => &self.crack,
        }
    }
}

/// Masses as they enter the balance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Masses {
    pub m: [f64; 2],
    pub i: [f64; 2],
    pub m_d: f64,
    pub m_dp: f64,
}

impl Masses {
    pub fn new(wall: &Wall, carriage_mass_kg: f64) -> Self {
        let m_d = wall.parameters().diaphragm_mass_kg;
        Self { m: wall.mass_kg, i: wall.inertia_kg_m2, m_d, m_dp: carriage_mass_kg }
    }

    /// Impulses through the joints that make the mass points' velocities jump so.
    pub fn impulses(&self, posture: &Posture, jump: &Rates) -> JointForces {
        let p = posture;
        let lower = jump.g1 * self.m[0];
        let upper = jump.g2 * self.m[1];
        // The carriage counts in x only.
        let top = Vector::new((self.m_d + self.m_dp) * jump.c.x, self.m_d * jump.c.y);
        let through_crack = upper + top;
        let about_q = p.r_2.moment_of(upper) + self.i[1] * jump.theta[1] + p.r_c.moment_of(top);
        let about_middle = about_q + p.q_from_middle.moment_of(through_crack);
        let through_ground = lower + through_crack;
        let about_o =
            p.r_1.moment_of(lower) + self.i[0] * jump.theta[0] + about_q + p.r_q.moment_of(through_crack);
        let about_origin = about_o + Vector::new(p.o_x, 0.0).moment_of(through_ground);
        let in_crack = through_crack.rotated_back(p.turn_1);
        JointForces {
            ground: JointForce { shear: through_ground.x, normal: through_ground.y, moment: about_origin },
            crack: JointForce { shear: in_crack.x, normal: in_crack.y, moment: about_middle },
        }
    }

    /// Sum of the masses times the magnitudes of their velocities, N s.
    pub fn momentum_size(&self, v: &Rates) -> f64 {
        let speed = |v: Vector| v.x.abs() + v.y.abs();
        self.m[0] * speed(v.g1) + self.m[1] * speed(v.g2) + (self.m_d + self.m_dp) * speed(v.c)
    }

    /// Generalised momenta Jᵀ M v of a state with this posture for velocities of the mass points that came from another.
    pub fn momenta(&self, posture: &Posture, v: &Rates) -> [f64; 2] {
        let p = posture;
        let lower = v.g1 * self.m[0];
        let upper = v.g2 * self.m[1];
        let top = Vector::new((self.m_d + self.m_dp) * v.c.x, self.m_d * v.c.y);
        [
            p.r_1.moment_of(lower) + self.i[0] * v.theta[0] + p.r_q.moment_of(upper + top),
            p.r_2.moment_of(upper) + self.i[1] * v.theta[1] + p.r_c.moment_of(top),
        ]
    }
}
