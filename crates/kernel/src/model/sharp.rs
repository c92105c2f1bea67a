//! The equations of motion of one contact state of a wall on sharp edges (model section 3), and the balance of its joints
//! (section 4), in the scalar form that runs: written once, for one wall and for walls side by side.
//!
//! The static moments are V = m_1 r_1 + (m_2 + m_d) r_Q and U = m_2 r_2 + m_d r_C. With X, Y the components
//! of an arm, Jᵀ M (J θ'' + centripetal + ground) = Jᵀ F becomes:
//!
//! - M_11 = I_1O + m_dp Y_Q²,  M_22 = I_2Q + m_dp Y_C²,  M_12 = r_Q·U + m_dp Y_Q Y_C
//! - f_1 = -(V_y a_x - V_x a_y) + κ ω_2² + Y_Q (F - m_dp a_dp),
//! - f_2 = -(U_y a_x - U_x a_y) - κ ω_1² + Y_C (F - m_dp a_dp),
//!
//! Here κ = Y_Q U_x - X_Q U_y and a_dp = a_x - X_Q ω_1² - X_C ω_2². The latter is the part of the carriage's
//! acceleration that is known before θ''.

use super::bed::Acting;
use super::joint_forces::{JointForce, JointForces, Reactions};
use super::mass_matrix::MassMatrix;
use super::number::Number;
use super::vector::Vector;
use super::wall::G_M_S2;

/// Springs at the top, and what else acts on a wall on sharp edges.
pub(crate) trait TopLaws<N>: Acting<N> {
    /// Whether anything but springs acts: dampers, formulas.
    fn has_dampers(&self) -> bool;

    /// A number and what dampers add to it; of a wall without them the number as it is.
    fn with(&self, number: N, further: N) -> N;

    /// What dampers make; of a wall without them none.
    fn where_damped(&self, number: N) -> N;
}

/// The equations, with everything that does not change in time worked out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SharpMotion<N = f64> {
    pub o_x: N,
    /// O less e_C: where the top is at rest, seen from C - O, m.
    pub o_c: N,
    /// s_2 b_2/2.
    pub q_x: N,
    pub q: Vector<N>,
    pub c: Vector<N>,
    /// V and U at zero rotation, kg m.
    pub v: Vector<N>,
    pub u: Vector<N>,
    /// I_1O and I_2Q: moments of inertia of everything but the carriage, kg m².
    pub inertias: [N; 2],
    /// m_1 and m_2 + m_d, kg.
    pub lower_mass: N,
    pub upper_mass: N,
    /// Moment of inertia of the lower body about O, kg m².
    pub lower_inertia: N,
    /// Of a wall that turns as one: C - O and V + U at zero rotation, and the moment of inertia about O.
    pub whole_arm: Vector<N>,
    pub whole_moment: Vector<N>,
    pub whole_inertia: N,
    /// m_dp, kg.
    pub m_dp: N,
}

/// Arms and static moments turned by the rotations. Every term of the equations is made of it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Configuration<N = f64> {
    /// Sine and cosine of θ_1 and of θ_2.
    pub turns: [(N, N); 2],
    /// r_Q and r_C, m.
    pub q: Vector<N>,
    pub c: Vector<N>,
    /// V and U, kg m.
    pub v: Vector<N>,
    pub u: Vector<N>,
}

/// The equations M θ'' = f in a configuration at given velocities, and what their terms are made of.
pub(crate) struct Equations<N> {
    pub mass: MassMatrix<N>,
    pub f: [N; 2],
    /// Squares of the angular velocities.
    pub squares: [N; 2],
    /// Displacement (m) and velocity (m/s) of the top.
    pub x_c: N,
    pub v_c: N,
    /// Force of the damper and of formulas at the top, and with that of the spring, N.
    pub damping: N,
    pub spring_and_damping: N,
    /// Moments of dampers and formulas at the joints, on θ_1 and θ_2, N m.
    pub joint_moments: [N; 2],
}

impl<N: Number> SharpMotion<N> {
    /// Everything turned by the rotations with these sines and cosines.
    #[inline(always)]
    pub fn turned(&self, turns: [(N, N); 2]) -> Configuration<N> {
        let [lower, upper] = turns;
        Configuration {
            turns,
            q: self.q.rotated(lower),
            c: self.c.rotated(upper),
            v: self.v.rotated(lower),
            u: self.u.rotated(upper),
        }
    }

    /// Displacement of the top, m.
    #[inline(always)]
    pub fn top_displacement_m(&self, t: &Configuration<N>) -> N {
        (t.q.x + t.c.x) + self.o_c
    }

    #[inline(always)]
    pub fn mass_matrix(&self, t: &Configuration<N>) -> MassMatrix<N> {
        MassMatrix {
            m11: self.inertias[0] + t.q.y * t.q.y * self.m_dp,
            m12: t.q.dot(t.u) + self.m_dp * t.q.y * t.c.y,
            m22: self.inertias[1] + t.c.y * t.c.y * self.m_dp,
        }
    }

    /// θ'' of a wall that turns as one, the power of the ground and that of losses, W: pattern 3 and the uncracked wall. Most of the
    /// time is spent there. It has one arm r = r_Q + r_C and one static moment W = V + U.
    #[inline(always)]
    pub fn monolithic_rate(
        &self,
        laws: &impl TopLaws<N>,
        (theta, turn): (N, (N, N)),
        omega: N,
        ground: Vector<N>,
    ) -> (N, [N; 2]) {
        let r = self.whole_arm.rotated(turn);
        let w = self.whole_moment.rotated(turn);
        let (a_x, a_y) = (ground.x, ground.y + omega.constant(G_M_S2));
        let v_c = r.y * omega;
        let carriage_acceleration = (-r.x).fused(omega * omega, a_x);
        let x_c = r.x + self.o_c;
        let mut top = laws.spring_force_n(x_c) - self.m_dp * carriage_acceleration;
        let mut weight_and_ground = w.x.fused(a_y, -w.y * a_x);
        let mut loss_w = omega.constant(0.0);
        if laws.has_dampers() {
            let damping = laws.damping_force_n(x_c, v_c);
            let [joint, _] = laws.joint_moments_n_m(|| [theta; 2], [omega; 2]);
            top = laws.with(top, damping);
            weight_and_ground = laws.with(weight_and_ground, joint);
            loss_w = laws.where_damped(-damping.fused(v_c, joint * omega));
        }
        // The inverse is ready before the forces are.
        let inverse = omega.constant(1.0) / (self.m_dp * r.y).fused(r.y, self.whole_inertia);
        let theta_dd = r.y.fused(top, weight_and_ground) * inverse;
        let momentum_x = w.y.fused(omega, self.m_dp * v_c);
        let power_w = (ground.y * w.x).fused(omega, -ground.x * momentum_x);
        (theta_dd, [power_w, loss_w])
    }

    #[inline(always)]
    pub fn equations(
        &self,
        laws: &impl TopLaws<N>,
        t: &Configuration<N>,
        omega: [N; 2],
        ground: Vector<N>,
    ) -> Equations<N> {
        let [w1, w2] = omega;
        let (a_x, a_y) = (ground.x, ground.y + w1.constant(G_M_S2));
        let squares = [w1 * w1, w2 * w2];
        let x_c = self.top_displacement_m(t);
        let v_c = t.q.y * w1 + t.c.y * w2;
        let spring = laws.spring_force_n(x_c);
        let none = w1.constant(0.0);
        let (mut damping, mut spring_and_damping, mut joint_moments) = (none, spring, [none; 2]);
        if laws.has_dampers() {
            damping = laws.where_damped(laws.damping_force_n(x_c, v_c));
            spring_and_damping = laws.with(spring, damping);
            joint_moments = laws.joint_moments_n_m(|| t.theta(), omega);
        }
        let carriage_acceleration = a_x - t.q.x * squares[0] - t.c.x * squares[1];
        let kappa = t.q.y * t.u.x - t.q.x * t.u.y;
        let forces = [
            kappa.fused(squares[1], t.v.x.fused(a_y, -t.v.y * a_x)),
            kappa.fused(-squares[0], t.u.x.fused(a_y, -t.u.y * a_x)),
        ];
        let top = spring_and_damping - self.m_dp * carriage_acceleration;
        let mut f = [t.q.y.fused(top, forces[0]), t.c.y.fused(top, forces[1])];
        if laws.has_dampers() {
            f = [laws.with(f[0], joint_moments[0]), laws.with(f[1], joint_moments[1])];
        }
        let mass = self.mass_matrix(t);
        Equations { mass, f, squares, x_c, v_c, damping, spring_and_damping, joint_moments }
    }

    /// The power of the ground and that of losses, W.
    #[inline(always)]
    pub fn powers_w(
        &self,
        laws: &impl TopLaws<N>,
        equations: &Equations<N>,
        t: &Configuration<N>,
        [w1, w2]: [N; 2],
        ground: Vector<N>,
    ) -> [N; 2] {
        let momentum_x = self.m_dp.fused(equations.v_c, t.v.y * w1 + t.u.y * w2);
        let ground_w = ground.y.fused(t.v.x * w1 + t.u.x * w2, -ground.x * momentum_x);
        let mut loss_w = w1.constant(0.0);
        if laws.has_dampers() {
            let [j_1, j_2] = equations.joint_moments;
            loss_w = laws.where_damped(-equations.damping.fused(equations.v_c, j_1 * w1 + j_2 * w2));
        }
        [ground_w, loss_w]
    }

    /// Joint forces and motion of the top at these accelerations, under a force of springs, dampers and what holds it there, N:
    /// d'Alembert's balance, in the static moments.
    #[inline(always)]
    pub fn reactions(
        &self,
        equations: &Equations<N>,
        t: &Configuration<N>,
        [dd_1, dd_2]: [N; 2],
        ground: Vector<N>,
        [at_top, holding_n]: [N; 2],
    ) -> Reactions<N> {
        let with_gravity = Vector::new(ground.x, ground.y + dd_1.constant(G_M_S2));
        let [w1, w2] = equations.squares;
        // J θ'' and centripetal: accelerations of the ends of the arms, forces of inertia of U.
        let q_x = t.q.y.fused(dd_1, -t.q.x * w1);
        let c_x = t.c.y.fused(dd_2, -t.c.x * w2);
        let q_y = t.q.x.fused(dd_1, t.q.y * w1);
        let u_x = t.u.y.fused(dd_2, -t.u.x * w2);
        let u_y = t.u.x.fused(dd_2, t.u.y * w2);
        let top = self.m_dp.fused(with_gravity.x + q_x + c_x, -at_top);
        let at_q = Vector::new(with_gravity.x + q_x, with_gravity.y - q_y);
        let through_crack =
            Vector::new(self.upper_mass.fused(at_q.x, u_x) + top, self.upper_mass.fused(at_q.y, -u_y));
        let about_q = t.c.y.fused(top, self.inertias[1].fused(dd_2, t.u.moment_of(at_q)));
        // The static moment of the lower body alone.
        let w = t.q.times_plus(-self.upper_mass, t.v);
        let turning = w.perpendicular().times_plus(dd_1, w * -w1);
        let through_ground = with_gravity.times_plus(self.lower_mass, turning) + through_crack;
        let about_o = self.lower_inertia.fused(dd_1, w.moment_of(with_gravity))
            + about_q
            + t.q.moment_of(through_crack);
        let in_crack = through_crack.rotated_back(t.turns[0]);
        let at_origin = (-self.o_x).fused(through_ground.y, about_o);
        let at_middle = (-self.q_x).fused(in_crack.y, about_q);
        Reactions {
            forces: JointForces {
                ground: JointForce { shear: through_ground.x, normal: through_ground.y, moment: at_origin },
                crack: JointForce { shear: in_crack.x, normal: in_crack.y, moment: at_middle },
            },
            top_displacement_m: equations.x_c,
            top_velocity_m_s: equations.v_c,
            top_acceleration_m_s2: q_x + c_x,
            holding_n,
        }
    }
}

impl<N: Number> Configuration<N> {
    /// θ_1 and θ_2, to a rounding.
    #[inline(always)]
    fn theta(&self) -> [N; 2] {
        let [(sin_1, cos_1), (sin_2, cos_2)] = self.turns;
        [sin_1.angle(cos_1), sin_2.angle(cos_2)]
    }
}
