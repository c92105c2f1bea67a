//! The equations of motion of one contact state (model section 3), in the scalar form that runs.
//!
//! With r_Q, r_C and the static moments V = m_1 r_1 + (m_2 + m_d) r_Q and U = m_2 r_2 + m_d r_C, the law
//! Jᵀ M (J θ'' + centripetal + ground) = Jᵀ F becomes, with Y, X the components of an arm:
//!
//! - M_11 = I_1O + m_dp Y_Q²,  M_22 = I_2Q + m_dp Y_C²,  M_12 = r_Q·U + m_dp Y_Q Y_C
//! - f_1 = -(V_y a_x - V_x a_y) + κ ω_2² + Y_Q (F - m_dp a_dp),
//! - f_2 = -(U_y a_x - U_x a_y) - κ ω_1² + Y_C (F - m_dp a_dp),
//!
//! with κ = Y_Q U_x - X_Q U_y and a_dp = a_x - X_Q ω_1² - X_C ω_2² the part of the carriage's acceleration
//! that is known before θ''.

use wide::f64x2;

use super::contact::Contact;
use super::joint::{JointForce, JointForces};
use super::laws::Laws;
use super::posture::{Arms, Pair, Turns};
use super::vector::{Vector, sin_cos, sin_cos_pair};
use super::wall::{G_M_S2, Wall};

/// Which rotations a contact state leaves free.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Freedom {
    /// None: rest.
    None,
    /// θ_1 = θ_2: pattern 3, and the uncracked wall.
    Monolithic,
    /// θ_2 alone: pattern 4.
    Upper,
    /// Both: patterns 1 and 2.
    Both,
}

impl Freedom {
    pub fn of(contact: Contact) -> Self {
        match (contact.ground.is_open(), contact.crack.is_open()) {
            (false, false) => Freedom::None,
            (true, false) => Freedom::Monolithic,
            (false, true) => Freedom::Upper,
            (true, true) => Freedom::Both,
        }
    }
}

/// How a contact state moves: as it is free to, or with its top held in place by friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Moves {
    Not,
    AsOne,
    AsTwo,
    WithTopHeld,
}

/// Symmetric 2 × 2 mass matrix of the two rotations, kg m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MassMatrix {
    pub m11: f64,
    pub m12: f64,
    pub m22: f64,
}

impl MassMatrix {
    /// Solves M x = f in the rotations that are free; the others follow or stay.
    #[inline]
    pub fn solve(&self, freedom: Freedom, f: Pair) -> Pair {
        match freedom {
            Freedom::None => [0.0, 0.0],
            Freedom::Monolithic => {
                let x = (f[0] + f[1]) / (self.m11 + 2.0 * self.m12 + self.m22);
                [x, x]
            }
            Freedom::Upper => [0.0, f[1] / self.m22],
            Freedom::Both => {
                let inverse = 1.0 / (self.m11 * self.m22 - self.m12 * self.m12);
                [(self.m22 * f[0] - self.m12 * f[1]) * inverse, (self.m11 * f[1] - self.m12 * f[0]) * inverse]
            }
        }
    }

    /// Twice the kinetic energy, ωᵀ M ω, J.
    pub fn quadratic(&self, omega: Pair) -> f64 {
        self.m11 * omega[0] * omega[0] + 2.0 * self.m12 * omega[0] * omega[1] + self.m22 * omega[1] * omega[1]
    }
}

/// What the equations of motion give at a state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionRate {
    /// Angular accelerations, rad/s².
    pub theta_dd: Pair,
    /// Work of the ground motion on the wall per time, W.
    pub ground_power_w: f64,
    /// Energy lost in dampers per time, W.
    pub loss_power_w: f64,
}

/// The equations of motion of one contact state, with everything that does not change in time worked out.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    pub freedom: Freedom,
    moves: Moves,
    o_x: f64,
    e_c: f64,
    q: Vector,
    c: Vector,
    /// V and U at zero rotation, kg m.
    v: Vector,
    u: Vector,
    /// I_1O and I_2Q: moments of inertia of everything but the carriage, kg m².
    inertia_1: f64,
    inertia_2: f64,
    laws: Laws,
    /// x and y of (q, c) and of (V, U), and the moments of inertia: the same numbers side by side.
    lanes: [f64x2; 4],
    inertias: f64x2,
    /// C - O and V + U at zero rotation, and the moment of inertia about O of a wall that turns as one.
    whole_arm: Vector,
    whole_moment: Vector,
    whole_inertia: f64,
    /// m_1, m_2 + m_d, and the moment of inertia of the lower body about O.
    lower_mass: f64,
    upper_mass: f64,
    lower_inertia: f64,
    /// s_2 b_2/2.
    q_x: f64,
}

/// Joint forces and motion of the top at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Aftermath {
    pub forces: JointForces,
    pub top_displacement_m: f64,
    pub top_velocity_m_s: f64,
    /// Relative to the ground, m/s².
    pub top_acceleration_m_s2: f64,
    /// Force by which friction holds the top in place, N; 0 where it does not.
    pub holding_n: f64,
}

/// The turned vectors that every term of the equations is made of.
struct Turned {
    turn_1: (f64, f64),
    r_q: Vector,
    r_c: Vector,
    v: Vector,
    u: Vector,
}

impl Motion {
    pub fn new(wall: &Wall, contact: Contact, laws: Laws) -> Self {
        let arms = Arms::new(wall, contact);
        let [m1, m2] = wall.mass_kg;
        let m_d = wall.parameters().diaphragm_mass_kg;
        let upper_mass = m2 + m_d;
        let lower_inertia = wall.inertia_kg_m2[0] + m1 * arms.g1.dot(arms.g1);
        let inertia_1 = lower_inertia + upper_mass * arms.q.dot(arms.q);
        let inertia_2 = wall.inertia_kg_m2[1] + m2 * arms.g2.dot(arms.g2) + m_d * arms.c.dot(arms.c);
        let v = arms.g1 * m1 + arms.q * upper_mass;
        let u = arms.g2 * m2 + arms.c * m_d;
        let mut motion = Self {
            freedom: Freedom::of(contact),
            moves: Moves::Not,
            o_x: arms.o_x,
            e_c: wall.parameters().eccentricity_m,
            q: arms.q,
            c: arms.c,
            v,
            u,
            inertia_1,
            inertia_2,
            laws,
            lanes: [[arms.q.x, arms.c.x], [arms.q.y, arms.c.y], [v.x, u.x], [v.y, u.y]].map(f64x2::new),
            inertias: f64x2::new([inertia_1, inertia_2]),
            whole_arm: arms.q + arms.c,
            whole_moment: v + u,
            whole_inertia: inertia_1 + 2.0 * arms.q.dot(u) + inertia_2,
            lower_mass: m1,
            upper_mass,
            lower_inertia,
            q_x: arms.q_x,
        };
        motion.set_laws(laws, false);
        motion
    }

    /// The laws beyond weight and inertia.
    pub fn laws(&self) -> &Laws {
        &self.laws
    }

    /// Puts other laws at the top, and holds it in place or lets it go.
    pub fn set_laws(&mut self, laws: Laws, held: bool) {
        self.laws = laws;
        self.moves = match self.freedom {
            Freedom::None => Moves::Not,
            _ if held => Moves::WithTopHeld,
            Freedom::Monolithic => Moves::AsOne,
            Freedom::Upper | Freedom::Both => Moves::AsTwo,
        };
    }

    #[inline]
    fn turned(&self, theta: Pair) -> Turned {
        self.turned_by(Turns::new(theta))
    }

    #[inline]
    fn turned_by(&self, Turns([turn_1, turn_2]): Turns) -> Turned {
        Turned {
            turn_1,
            r_q: self.q.rotated(turn_1),
            v: self.v.rotated(turn_1),
            r_c: self.c.rotated(turn_2),
            u: self.u.rotated(turn_2),
        }
    }

    #[inline]
    fn mass_matrix_of(&self, t: &Turned) -> MassMatrix {
        let m_dp = self.laws.carriage_mass_kg;
        MassMatrix {
            m11: self.inertia_1 + m_dp * t.r_q.y * t.r_q.y,
            m12: t.r_q.dot(t.u) + m_dp * t.r_q.y * t.r_c.y,
            m22: self.inertia_2 + m_dp * t.r_c.y * t.r_c.y,
        }
    }

    /// Mass matrix Jᵀ M J of the two rotations at a posture, whether free or not.
    pub fn mass_matrix(&self, turns: Turns) -> MassMatrix {
        self.mass_matrix_of(&self.turned_by(turns))
    }

    /// Angular accelerations and powers at a state, under a ground acceleration in m/s² (y without gravity).
    #[inline]
    pub fn rate(&self, theta: Pair, omega: Pair, ground: Vector) -> MotionRate {
        match self.moves {
            Moves::Not => MotionRate { theta_dd: [0.0; 2], ground_power_w: 0.0, loss_power_w: 0.0 },
            Moves::AsOne => self.monolithic_rate(theta[0], omega[0], ground),
            Moves::AsTwo => self.two_body_rate(theta, omega, ground),
            Moves::WithTopHeld => self.held(theta, omega, ground).0,
        }
    }

    /// The motion with the top held in place, a_C = 0, and the force by which friction holds it, N.
    ///
    /// Of the accelerations without it, θ''_0, the force λ makes θ'' = θ''_0 + M⁻¹ Jᵀ λ with J = (Y_Q, Y_C), so that
    /// λ = -a_C0 / (J M⁻¹ Jᵀ). What can move in one way only stands still.
    #[cold]
    #[inline(never)]
    fn held(&self, theta: Pair, omega: Pair, ground: Vector) -> (MotionRate, f64) {
        let mut rate = match self.freedom {
            Freedom::Monolithic => self.monolithic_rate(theta[0], omega[0], ground),
            _ => self.two_body_rate(theta, omega, ground),
        };
        let t = self.turned(theta);
        let [_, _, free] = self.top(theta, omega, rate.theta_dd);
        let push = [t.r_q.y, t.r_c.y];
        let per_force = self.mass_matrix_of(&t).solve(self.freedom, push);
        let holding_n = -free / (push[0] * per_force[0] + push[1] * per_force[1]);
        rate.theta_dd = match self.freedom {
            Freedom::Both => [0, 1].map(|i| rate.theta_dd[i] + per_force[i] * holding_n),
            _ => [0.0; 2],
        };
        (rate, holding_n)
    }

    /// Displacement (m), velocity (m/s) and acceleration (m/s²) of the top, all relative to the ground.
    pub fn top(&self, theta: Pair, omega: Pair, theta_dd: Pair) -> [f64; 3] {
        let t = self.turned(theta);
        let along = |rates: Pair| t.r_q.y * rates[0] + t.r_c.y * rates[1];
        let centripetal = t.r_q.x * omega[0] * omega[0] + t.r_c.x * omega[1] * omega[1];
        [self.o_x + t.r_q.x + t.r_c.x - self.e_c, along(omega), along(theta_dd) - centripetal]
    }

    /// The velocities without those of the top: what can move in one way only stops.
    pub fn stopped(&self, theta: Pair, omega: Pair) -> Pair {
        if self.freedom != Freedom::Both {
            return [0.0; 2];
        }
        let t = self.turned(theta);
        let [y_q, y_c] = [t.r_q.y, t.r_c.y];
        let share = (y_q * omega[0] + y_c * omega[1]) / (y_q * y_q + y_c * y_c);
        [omega[0] - share * y_q, omega[1] - share * y_c]
    }

    /// Largest speed (m/s) the top could have at these velocities if none cancelled: what its roundings are of.
    pub fn top_speed_size(&self, omega: Pair) -> f64 {
        self.q.y * omega[0].abs() + self.c.y * omega[1].abs()
    }

    /// Both bodies side by side: the first lane is the lower body (r_Q, V), the second the upper (r_C, U).
    #[inline]
    fn two_body_rate(&self, theta: Pair, omega: Pair, ground: Vector) -> MotionRate {
        let (sin, cos) = sin_cos_pair(theta);
        let [arm_x, arm_y, moment_x, moment_y] = self.lanes;
        let (x, y) = (arm_x * cos + arm_y * sin, arm_y * cos - arm_x * sin);
        let (s_x, s_y) = (moment_x * cos + moment_y * sin, moment_y * cos - moment_x * sin);
        let ([x_q, x_c], [y_q, y_c], [u_x, u_y]) =
            (x.to_array(), y.to_array(), [s_x.to_array()[1], s_y.to_array()[1]]);
        let m_dp = self.laws.carriage_mass_kg;
        let (a_x, a_y) = (ground.x, ground.y + G_M_S2);
        let rate = f64x2::new(omega);
        let [w1, w2] = (rate * rate).to_array();
        let v_c = y_q * omega[0] + y_c * omega[1];
        let damping = self.laws.damping_force_n(v_c);
        let carriage = m_dp * (a_x - x_q * w1 - x_c * w2);
        let top = self.laws.spring_force_n(self.o_x + x_q + x_c - self.e_c) + damping - carriage;
        let kappa = y_q * u_x - x_q * u_y;
        let joints = self.laws.joint_moments_n_m(omega);
        let f =
            f64x2::new(joints) + y * top + f64x2::new([kappa * w2, -(kappa * w1)]) - (s_y * a_x - s_x * a_y);
        let [m11, m22] = (self.inertias + y * y * m_dp).to_array();
        let mass = MassMatrix { m11, m12: x_q * u_x + y_q * u_y + m_dp * y_q * y_c, m22 };
        let momentum_x = (s_y * rate).to_array().iter().sum::<f64>() + m_dp * v_c;
        let momentum_y = -(s_x * rate).to_array().iter().sum::<f64>();
        MotionRate {
            theta_dd: mass.solve(self.freedom, f.to_array()),
            ground_power_w: -(ground.x * momentum_x + ground.y * momentum_y),
            loss_power_w: -(damping * v_c + joints[0] * omega[0] + joints[1] * omega[1]),
        }
    }

    /// The same law with θ_1 = θ_2: one arm r = r_Q + r_C and one static moment W = V + U, for pattern 3 and the
    /// uncracked wall, where most of the time is spent.
    #[inline]
    fn monolithic_rate(&self, theta: f64, omega: f64, ground: Vector) -> MotionRate {
        let turn = sin_cos(theta);
        let r = self.whole_arm.rotated(turn);
        let w = self.whole_moment.rotated(turn);
        let m_dp = self.laws.carriage_mass_kg;
        let (a_x, a_y) = (ground.x, ground.y + G_M_S2);
        let v_c = r.y * omega;
        let damping = self.laws.damping_force_n(v_c);
        let carriage = m_dp * (a_x - r.x * omega * omega);
        let top = self.laws.spring_force_n(self.o_x + r.x - self.e_c) + damping - carriage;
        let joint = self.laws.joint_moments_n_m([omega, omega])[0];
        let f = joint + r.y * top - (w.y * a_x - w.x * a_y);
        let theta_dd = f / (self.whole_inertia + m_dp * r.y * r.y);
        MotionRate {
            theta_dd: [theta_dd, theta_dd],
            ground_power_w: ground.y * w.x * omega - ground.x * (w.y * omega + m_dp * v_c),
            loss_power_w: -(damping * v_c + joint * omega),
        }
    }

    /// Joint forces and motion of the top at a state whose angular accelerations are known.
    ///
    /// The balance of [`super::joint`], in the static moments of this file: what a run asks for after every step.
    #[inline]
    pub fn aftermath(&self, theta: Pair, omega: Pair, theta_dd: Pair, ground: Vector) -> Aftermath {
        if self.moves == Moves::WithTopHeld {
            return self.aftermath_held(theta, omega, theta_dd, ground);
        }
        self.aftermath_holding(theta, omega, theta_dd, ground, 0.0)
    }

    #[cold]
    #[inline(never)]
    fn aftermath_held(&self, theta: Pair, omega: Pair, theta_dd: Pair, ground: Vector) -> Aftermath {
        let holding_n = self.held(theta, omega, ground).1;
        self.aftermath_holding(theta, omega, theta_dd, ground, holding_n)
    }

    /// The same under the force by which friction holds the top, N.
    #[inline]
    fn aftermath_holding(
        &self,
        theta: Pair,
        omega: Pair,
        theta_dd: Pair,
        ground: Vector,
        holding_n: f64,
    ) -> Aftermath {
        let t = self.turned(theta);
        let m_dp = self.laws.carriage_mass_kg;
        let [w1, w2] = omega.map(|w| w * w);
        let x_c = self.o_x + t.r_q.x + t.r_c.x - self.e_c;
        let v_c = t.r_q.y * omega[0] + t.r_c.y * omega[1];
        let top_force = self.laws.spring_force_n(x_c) + self.laws.damping_force_n(v_c) + holding_n;
        let with_gravity = Vector::new(ground.x, ground.y + G_M_S2);
        let at_q = with_gravity + t.r_q.turned() * theta_dd[0] - t.r_q * w1;
        let carriage = at_q.x + t.r_c.y * theta_dd[1] - t.r_c.x * w2;
        let top = Vector::new(m_dp * carriage - top_force, 0.0);
        let through_crack = at_q * self.upper_mass + t.u.turned() * theta_dd[1] - t.u * w2 + top;
        let about_q = t.u.moment_of(at_q) + self.inertia_2 * theta_dd[1] + t.r_c.moment_of(top);
        let about_middle = about_q + Vector::new(self.q_x, 0.0).rotated(t.turn_1).moment_of(through_crack);
        let w = t.v - t.r_q * self.upper_mass;
        let lower = with_gravity * self.lower_mass + w.turned() * theta_dd[0] - w * w1;
        let through_ground = lower + through_crack;
        let about_o = w.moment_of(with_gravity)
            + self.lower_inertia * theta_dd[0]
            + about_q
            + t.r_q.moment_of(through_crack);
        let about_origin = about_o - self.o_x * through_ground.y;
        let in_crack = through_crack.rotated_back(t.turn_1);
        let forces = JointForces {
            ground: JointForce { shear: through_ground.x, normal: through_ground.y, moment: about_origin },
            crack: JointForce { shear: in_crack.x, normal: in_crack.y, moment: about_middle },
        };
        Aftermath {
            forces,
            top_displacement_m: x_c,
            top_velocity_m_s: v_c,
            top_acceleration_m_s2: carriage - ground.x,
            holding_n,
        }
    }

    /// Kinetic, gravity and spring energy at a state, J; gravity is zero at rest.
    pub fn energy_j(&self, theta: Pair, omega: Pair) -> f64 {
        let t = self.turned(theta);
        let kinetic = 0.5 * self.mass_matrix_of(&t).quadratic(omega);
        let lifted = (t.v.y - self.v.y) + (t.u.y - self.u.y);
        kinetic + G_M_S2 * lifted + self.laws.spring_energy_j(self.top_displacement_m(theta))
    }

    /// Kinetic energy at a state, J.
    pub fn kinetic_energy_j(&self, turns: Turns, omega: Pair) -> f64 {
        0.5 * self.mass_matrix(turns).quadratic(omega)
    }

    /// Horizontal displacement s_Cx of the top, m.
    pub fn top_displacement_m(&self, theta: Pair) -> f64 {
        let t = self.turned(theta);
        self.o_x + t.r_q.x + t.r_c.x - self.e_c
    }
}
