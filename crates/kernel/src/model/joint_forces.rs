//! Forces and impulses through the joints by d'Alembert's balance of everything above (model section 4).
//!
//! Impulses are balanced over the mass points. Forces, which a run needs after every step, are balanced in
//! the static moments of [`super::sharp`].

use super::contact::Joint;
use super::geometry::{Arms, PointVelocities, TurnedArms};
use super::number::Number;
use super::vector::Vector;
use super::wall::Wall;

/// Force through a joint and its moment about the joint's middle: newtons and newton metres,
/// or their impulses.
///
/// `normal` and `shear` are taken in the axes of the joint, which turns with the body below it. Only so does
/// a corner force vanish exactly when the joint starts to open about the other corner.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointForce<N = f64> {
    /// Along the joint, towards +x.
    pub shear: N,
    /// Across the joint, compression positive.
    pub normal: N,
    /// Clockwise moment about the middle of the joint.
    pub moment: N,
}

impl JointForce {
    /// Forces at the left and right corners of a joint of width b: N/2 ± M_c/b.
    #[inline]
    pub fn corners(&self, width_m: f64) -> [f64; 2] {
        let half = self.normal / 2.0;
        let lever = self.moment / width_m;
        [half + lever, half - lever]
    }
}

/// Forces through both joints.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointForces<N = f64> {
    /// Through the ground.
    pub ground: JointForce<N>,
    /// Through the crack.
    pub crack: JointForce<N>,
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
pub(crate) struct Masses<N = f64> {
    pub m: [N; 2],
    pub i: [N; 2],
    pub m_d: N,
    pub m_dp: N,
}

impl Masses {
    pub fn new(wall: &Wall, carriage_mass_kg: f64) -> Self {
        let m_d = wall.parameters().diaphragm_mass_kg;
        Self { m: wall.mass_kg, i: wall.inertia_kg_m2, m_d, m_dp: carriage_mass_kg }
    }

    /// Impulses through the joints that make the mass points' velocities jump so.
    #[inline(always)]
    pub fn impulses(&self, arms: &TurnedArms, jump: &PointVelocities) -> JointForces {
        self.through_joints(arms, jump, 0.0)
    }
}

impl<N: Number> Masses<N> {
    /// I_1O and I_2Q, the moments of inertia of everything but the carriage about the pivots, kg m², and U at zero
    /// rotation, kg m. I_1O is that of the lower body about O, which is given too, and of what it carries.
    #[inline(always)]
    pub fn about_pivots(&self, arms: &Arms<N>) -> (N, [N; 2], Vector<N>) {
        let Self { m: [m1, m2], i: [i1, i2], m_d, .. } = *self;
        let lower = i1 + m1 * arms.g1.dot(arms.g1);
        let first = lower + (m2 + m_d) * arms.q.dot(arms.q);
        let second = i2 + m2 * arms.g2.dot(arms.g2) + m_d * arms.c.dot(arms.c);
        (lower, [first, second], arms.g2 * m2 + arms.c * m_d)
    }

    /// Forces through the joints at these accelerations of the mass points, gravity's in them, m/s², beside a
    /// horizontal force at the top, N. Or impulses by jumps of their velocities.
    #[inline(always)]
    pub fn through_joints(
        &self,
        arms: &TurnedArms<N>,
        jump: &PointVelocities<N>,
        at_top: N,
    ) -> JointForces<N> {
        let p = arms;
        let lower = jump.g1 * self.m[0];
        let upper = jump.g2 * self.m[1];
        // The carriage counts in x only.
        let top = Vector::new((self.m_d + self.m_dp) * jump.c.x - at_top, self.m_d * jump.c.y);
        let through_crack = upper + top;
        let about_q = p.r_2.moment_of(upper) + self.i[1] * jump.theta[1] + p.r_c.moment_of(top);
        let about_middle = about_q + p.q_from_middle.moment_of(through_crack);
        let through_ground = lower + through_crack;
        let about_o =
            p.r_1.moment_of(lower) + self.i[0] * jump.theta[0] + about_q + p.r_q.moment_of(through_crack);
        let about_origin = about_o + Vector::new(p.o_x, p.o_x.constant(0.0)).moment_of(through_ground);
        let in_crack = through_crack.rotated_back(p.turn_1);
        JointForces {
            ground: JointForce { shear: through_ground.x, normal: through_ground.y, moment: about_origin },
            crack: JointForce { shear: in_crack.x, normal: in_crack.y, moment: about_middle },
        }
    }

    /// Sum of the masses times the magnitudes of their velocities, N s.
    #[inline(always)]
    pub fn momentum_size(&self, v: &PointVelocities<N>) -> N {
        let speed = |v: Vector<N>| v.x.magnitude() + v.y.magnitude();
        self.m[0] * speed(v.g1) + self.m[1] * speed(v.g2) + (self.m_d + self.m_dp) * speed(v.c)
    }

    /// Power of a uniform acceleration on the masses, W: Σ m v · a, of the carriage in x only.
    #[inline(always)]
    pub fn power(&self, v: &PointVelocities<N>, a: Vector<N>) -> N {
        let momentum = v.g1 * self.m[0] + v.g2 * self.m[1] + v.c * self.m_d;
        momentum.dot(a) + self.m_dp * v.c.x * a.x
    }

    /// Generalised momenta Jᵀ M v in a contact state, for velocities of the mass points before the impact.
    #[inline(always)]
    pub fn momenta(&self, arms: &TurnedArms<N>, v: &PointVelocities<N>) -> [N; 2] {
        let p = arms;
        let lower = v.g1 * self.m[0];
        let upper = v.g2 * self.m[1];
        let top = Vector::new((self.m_d + self.m_dp) * v.c.x, self.m_d * v.c.y);
        [
            p.r_1.moment_of(lower) + self.i[0] * v.theta[0] + p.r_q.moment_of(upper + top),
            p.r_2.moment_of(upper) + self.i[1] * v.theta[1] + p.r_c.moment_of(top),
        ]
    }
}

/// Joint forces and motion of the top at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Reactions<N = f64> {
    pub forces: JointForces<N>,
    pub top_displacement_m: N,
    pub top_velocity_m_s: N,
    /// Relative to the ground, m/s².
    pub top_acceleration_m_s2: N,
    /// Force by which friction holds the top in place, N; 0 where it does not.
    pub holding_n: N,
}
