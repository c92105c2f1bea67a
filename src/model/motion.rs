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

use super::contact::Contact;
use super::effect::Laws;
use super::posture::{Arms, Pair};
use super::vector::{Vector, sin_cos};
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
}

/// The turned vectors that every term of the equations is made of.
struct Turned {
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
        Self {
            freedom: Freedom::of(contact),
            o_x: arms.o_x,
            e_c: wall.parameters().eccentricity_m,
            q: arms.q,
            c: arms.c,
            v: arms.g1 * m1 + arms.q * (m2 + m_d),
            u: arms.g2 * m2 + arms.c * m_d,
            inertia_1: wall.inertia_kg_m2[0] + m1 * arms.g1.dot(arms.g1) + (m2 + m_d) * arms.q.dot(arms.q),
            inertia_2: wall.inertia_kg_m2[1] + m2 * arms.g2.dot(arms.g2) + m_d * arms.c.dot(arms.c),
            laws,
        }
    }

    #[inline]
    fn turned(&self, theta: Pair) -> Turned {
        let turn_1 = sin_cos(theta[0]);
        // Bodies that turn together share the sine; so do their mirror images, to the bit.
        let turn_2 = if self.freedom == Freedom::Monolithic { turn_1 } else { sin_cos(theta[1]) };
        Turned {
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
    pub fn mass_matrix(&self, theta: Pair) -> MassMatrix {
        self.mass_matrix_of(&self.turned(theta))
    }

    /// Angular accelerations and powers at a state, under a ground acceleration in m/s² (y without gravity).
    #[inline]
    pub fn rate(&self, theta: Pair, omega: Pair, ground: Vector) -> MotionRate {
        let t = self.turned(theta);
        let m_dp = self.laws.carriage_mass_kg;
        let (a_x, a_y) = (ground.x, ground.y + G_M_S2);
        let [w1, w2] = omega.map(|w| w * w);
        let kappa = t.r_q.y * t.u.x - t.r_q.x * t.u.y;
        let x_c = self.o_x + t.r_q.x + t.r_c.x - self.e_c;
        let v_c = t.r_q.y * omega[0] + t.r_c.y * omega[1];
        let damping = self.laws.damping_force_n(v_c);
        let carriage = m_dp * (a_x - t.r_q.x * w1 - t.r_c.x * w2);
        let top = self.laws.spring_force_n(x_c) + damping - carriage;
        let joints = self.laws.joint_moments_n_m(omega);
        let f = [
            joints[0] + t.r_q.y * top + kappa * w2 - (t.v.y * a_x - t.v.x * a_y),
            joints[1] + t.r_c.y * top - kappa * w1 - (t.u.y * a_x - t.u.x * a_y),
        ];
        let momentum_x = t.v.y * omega[0] + t.u.y * omega[1] + m_dp * v_c;
        let momentum_y = -(t.v.x * omega[0] + t.u.x * omega[1]);
        MotionRate {
            theta_dd: self.mass_matrix_of(&t).solve(self.freedom, f),
            ground_power_w: -(ground.x * momentum_x + ground.y * momentum_y),
            loss_power_w: -(damping * v_c + joints[0] * omega[0] + joints[1] * omega[1]),
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
    pub fn kinetic_energy_j(&self, theta: Pair, omega: Pair) -> f64 {
        0.5 * self.mass_matrix(theta).quadratic(omega)
    }

    /// Horizontal force of springs and dampers on the top, N.
    pub fn top_force_n(&self, theta: Pair, omega: Pair) -> f64 {
        let t = self.turned(theta);
        let v_c = t.r_q.y * omega[0] + t.r_c.y * omega[1];
        let x_c = self.o_x + t.r_q.x + t.r_c.x - self.e_c;
        self.laws.spring_force_n(x_c) + self.laws.damping_force_n(v_c)
    }

    /// Horizontal displacement s_Cx of the top, m.
    pub fn top_displacement_m(&self, theta: Pair) -> f64 {
        let t = self.turned(theta);
        self.o_x + t.r_q.x + t.r_c.x - self.e_c
    }
}
