//! The equations of motion of a wall with joints that give (model section 3, with places that depend on φ).
//!
//! Each joint moves the middle of its upper face by p(φ), φ = θ_1 at the ground and θ_2 - θ_1 at the crack:
//!
//! - A = p_1(θ_1), the middle of the foot,
//! - B = A + R(θ_1) q, q = (0, h_1) + p_2(φ), the middle of the foot of the upper body,
//! - G_1 = A + R(θ_1) g_1, G_2 = B + R(θ_2) g_2, C = B + R(θ_2) c.
//!
//! Their velocities are those of bodies that turn about instantaneous pivots: the arms of the sharp edges with
//! other pivots. So impacts and joint forces are those of [`super::super::joint_forces`]. The accelerations
//! without θ'' have the curvature of p besides:
//!
//! - γ_A = A'' ω_1²,
//! - γ_B = γ_A - R(θ_1) q ω_1² + 2 ω_1 φ' (R(θ_1) q')^⊥ + R(θ_1) q'' φ'².

use fearless_simd::{Level, dispatch};

use super::super::contact::{Contact, Joint, Pivot};
use super::super::formula::FormulaLaws;
use super::super::geometry::{Pair, PointVelocities, Rotations, TurnedArms};
use super::super::joint_forces::{Masses, Reactions};
use super::super::laws::Laws;
use super::super::mass_matrix::{Freedom, MassMatrix};
use super::super::vector::{Vector, sin_cos};
use super::super::wall::{G_M_S2, Wall};
use super::roll::{Roll, RollingBed, across, roll_about_edge};

/// One joint in its state of contact.
#[derive(Debug, Clone, Copy)]
enum JointShape {
    /// Closed (0), or turning about a sharp edge at ± half the width, m.
    Edge { half_m: f64 },
    /// On a bed, in whole contact (0) or in part towards a side.
    Bed { bed: RollingBed, side: f64 },
}

impl JointShape {
    fn of(wall: &Wall, contact: Contact, joint: Joint) -> Self {
        let side = contact.at(joint).sign();
        match wall.beds[joint as usize] {
            Some(bed) => Self::Bed { bed: RollingBed::new(bed), side },
            None => Self::Edge { half_m: side * wall.width_m[joint as usize] / 2.0 },
        }
    }

    #[inline(always)]
    fn roll(&self, phi: f64) -> Roll {
        match self {
            Self::Edge { half_m: 0.0 } => Roll::default(),
            Self::Edge { half_m } => roll_about_edge(*half_m, phi),
            Self::Bed { bed, side: 0.0 } => bed.in_full_contact(phi),
            Self::Bed { bed, side } => bed.in_part(*side, phi),
        }
    }

    fn stored_j(&self, phi: f64) -> f64 {
        match self {
            Self::Edge { .. } => 0.0,
            Self::Bed { bed, side } => bed.bed.stored_j(*side, phi),
        }
    }
}

/// The motion of one contact state of a wall with beds. The laws at the top are those of
/// [`super::super::motion::Motion`].
#[derive(Debug, Clone)]
pub(crate) struct BeddedMotion {
    joints: [JointShape; 2],
    freedom: Freedom,
    masses: Masses,
    height_1_m: f64,
    g1: Vector,
    g2: Vector,
    c: Vector,
    /// Instructions that this processor has, which change nothing but the time it takes.
    level: Level,
}

/// A wall turned by its rotations: what is where, and how it moves with the rotations.
struct Pose {
    rolls: [Roll; 2],
    arms: TurnedArms,
    turns: [(f64, f64); 2],
    /// R(θ_1) q and R(θ_1) q', R(θ_1) q''.
    q: [Vector; 3],
    /// Displacement of A; G_1 - A, G_2 - B and C - B as turned.
    foot: Vector,
    g1: Vector,
    g2: Vector,
    c: Vector,
}

/// All that the equations give at a state.
struct Balance {
    pose: Pose,
    /// Accelerations of the mass points without θ'', the ground's and gravity in them, m/s².
    drift: PointVelocities,
    /// The same of C, relative to the ground, horizontally.
    top_drift_x: f64,
    /// Displacement (m) and velocity (m/s) of the top, and the force there, N.
    x_c: f64,
    v_c: f64,
    force_n: f64,
    theta_dd: Pair,
    /// Force by which friction holds the top, N.
    holding_n: f64,
    powers_w: Pair,
}

/// What a step needs.
pub(crate) struct BeddedRate {
    pub theta_dd: Pair,
    /// Of the ground and of losses, W.
    pub powers_w: Pair,
}

/// The arm to the instantaneous pivot whose turning gives this velocity per rate: (X, Y)^⊥ = (Y, -X).
#[inline(always)]
fn arm_of(slope: Vector) -> Vector {
    Vector::new(-slope.y, slope.x)
}

impl BeddedMotion {
    pub fn new(wall: &Wall, contact: Contact, carriage_mass_kg: f64) -> Self {
        let [h1, h2] = wall.height_m;
        let moves = |joint: Joint| wall.beds[joint as usize].is_some() || contact.at(joint).is_open();
        let free = |joint: Joint| if moves(joint) { Pivot::Right } else { Pivot::Closed };
        let freedom = Freedom::of(Contact { ground: free(Joint::Ground), crack: free(Joint::Crack) });
        Self {
            joints: [Joint::Ground, Joint::Crack].map(|joint| JointShape::of(wall, contact, joint)),
            freedom,
            masses: Masses::new(wall, carriage_mass_kg),
            height_1_m: h1,
            g1: Vector::new(0.0, h1 / 2.0),
            g2: Vector::new(0.0, h2 / 2.0),
            c: Vector::new(wall.parameters().eccentricity_m, h2),
            level: Level::new(),
        }
    }

    pub fn freedom(&self) -> Freedom {
        self.freedom
    }

    #[inline(always)]
    fn pose(&self, theta: Pair) -> Pose {
        let [ground, crack] = across(theta);
        let rolls = [self.joints[0].roll(ground), self.joints[1].roll(crack)];
        let turns = theta.map(sin_cos);
        let q = [rolls[1].place + Vector::new(0.0, self.height_1_m), rolls[1].slope, rolls[1].bend]
            .map(|v| v.rotated(turns[0]));
        let (g1, g2, c) = (self.g1.rotated(turns[0]), self.g2.rotated(turns[1]), self.c.rotated(turns[1]));
        // From the instantaneous pivots to the middles of the joints' upper faces.
        let (to_foot, to_crack) = (arm_of(rolls[0].slope), arm_of(q[1]));
        let arms = TurnedArms {
            o_x: (rolls[0].place - to_foot).x,
            r_1: to_foot + g1,
            r_q: to_foot + q[0] - to_crack,
            r_2: to_crack + g2,
            r_c: to_crack + c,
            q_from_middle: rolls[1].place.rotated(turns[0]) - to_crack,
            turn_1: turns[0],
        };
        Pose { foot: rolls[0].place, rolls, arms, turns, q, g1, g2, c }
    }

    pub fn turned_arms(&self, rotations: Rotations) -> TurnedArms {
        self.pose(rotations.angles()).arms
    }

    pub fn mass_matrix(&self, rotations: Rotations) -> MassMatrix {
        self.mass_of(&self.pose(rotations.angles()).arms)
    }

    #[inline(always)]
    fn mass_of(&self, arms: &TurnedArms) -> MassMatrix {
        let Masses { m: [m1, m2], i: [i1, i2], m_d, m_dp } = self.masses;
        let TurnedArms { r_1, r_q, r_2, r_c, .. } = *arms;
        let above = r_2 * m2 + r_c * m_d;
        MassMatrix {
            m11: i1 + m1 * r_1.dot(r_1) + (m2 + m_d) * r_q.dot(r_q) + m_dp * r_q.y * r_q.y,
            m12: r_q.dot(above) + m_dp * r_q.y * r_c.y,
            m22: i2 + m2 * r_2.dot(r_2) + m_d * r_c.dot(r_c) + m_dp * r_c.y * r_c.y,
        }
    }

    /// Accelerations of the mass points without θ'', relative to the ground.
    #[inline(always)]
    fn drift(&self, pose: &Pose, [w1, w2]: Pair) -> PointVelocities {
        let opening = w2 - w1;
        let foot = pose.rolls[0].bend * (w1 * w1);
        let crack = foot - pose.q[0] * (w1 * w1)
            + pose.q[1].perpendicular() * (2.0 * w1 * opening)
            + pose.q[2] * (opening * opening);
        PointVelocities {
            g1: foot - pose.g1 * (w1 * w1),
            g2: crack - pose.g2 * (w2 * w2),
            c: crack - pose.c * (w2 * w2),
            theta: [0.0; 2],
        }
    }

    /// Moments of the beds on θ_1 and θ_2, those that store and those that lose energy, N m.
    #[inline(always)]
    fn bed_moments(&self, pose: &Pose, omega: Pair) -> [Pair; 2] {
        let rates = across(omega);
        let [stored, lost] = [
            [0, 1].map(|j| pose.rolls[j].moment_n_m),
            [0, 1].map(|j| pose.rolls[j].damping_n_m_s * rates[j]),
        ];
        [stored, lost].map(|[ground, crack]| [crack - ground, -crack])
    }

    #[inline(always)]
    fn balance(
        &self,
        laws: &Laws,
        formulas: &FormulaLaws,
        held: bool,
        [theta, omega]: [Pair; 2],
        ground: Vector,
    ) -> Balance {
        let pose = self.pose(theta);
        let mass = self.mass_of(&pose.arms);
        let moving = self.drift(&pose, omega);
        let shaking = Vector::new(ground.x, ground.y + G_M_S2);
        let drift = PointVelocities {
            g1: moving.g1 + shaking,
            g2: moving.g2 + shaking,
            c: moving.c + shaking,
            theta: [0.0; 2],
        };
        let arms = &pose.arms;
        let x_c = self.top_of(&pose);
        let v = arms.velocities(omega);
        let mut damping_n = laws.damping_force_n(v.c.x);
        let mut dampers = laws.joint_moments_n_m(wide::f64x2::new(omega)).to_array();
        if !formulas.is_empty() {
            damping_n += formulas.top_force_n(x_c, v.c.x);
            let [on_1, on_2] = formulas.joint_moments_n_m(theta, omega);
            dampers = [dampers[0] + on_1, dampers[1] + on_2];
        }
        let force_n = laws.spring_force_n(x_c) + damping_n;
        let [stored, lost] = self.bed_moments(&pose, omega);
        let inertia = self.masses.momenta(arms, &drift);
        let levers = [arms.r_q.y, arms.r_c.y];
        let f = [0, 1].map(|i| levers[i] * force_n - inertia[i] + stored[i] + lost[i] + dampers[i]);
        let free = mass.solve(self.freedom, f);
        let (theta_dd, holding_n) = match held {
            true => self.with_held_top(&mass, levers, moving.c.x, free),
            false => (free, 0.0),
        };
        let powers_w = [
            -self.masses.power(&v, ground),
            -(damping_n * v.c.x + (0..2).map(|i| (lost[i] + dampers[i]) * omega[i]).sum::<f64>()),
        ];
        Balance {
            drift,
            top_drift_x: moving.c.x,
            x_c,
            v_c: v.c.x,
            force_n,
            theta_dd,
            holding_n,
            powers_w,
            pose,
        }
    }

    /// As [`super::super::top`]: the force that keeps a_C = 0.
    #[inline(always)]
    fn with_held_top(&self, mass: &MassMatrix, levers: Pair, drift_x: f64, free: Pair) -> (Pair, f64) {
        let per_force = mass.solve(self.freedom, levers);
        let along = |theta_dd: Pair| levers[0] * theta_dd[0] + levers[1] * theta_dd[1];
        let holding_n = -(along(free) + drift_x) / along(per_force);
        match self.freedom {
            Freedom::Both => ([0, 1].map(|i| free[i] + per_force[i] * holding_n), holding_n),
            _ => ([0.0; 2], holding_n),
        }
    }

    #[inline(always)]
    fn top_of(&self, pose: &Pose) -> f64 {
        (pose.foot + pose.q[0] + pose.c).x - self.c.x
    }

    pub fn rate(
        &self,
        laws: &Laws,
        formulas: &FormulaLaws,
        held: bool,
        moving: [Pair; 2],
        ground: Vector,
    ) -> BeddedRate {
        let balance = dispatch!(self.level, _ => self.balance(laws, formulas, held, moving, ground));
        BeddedRate { theta_dd: balance.theta_dd, powers_w: balance.powers_w }
    }

    /// Joint forces and motion of the top, with these angular accelerations or those of the motion.
    pub fn reactions(
        &self,
        laws: &Laws,
        formulas: &FormulaLaws,
        held: bool,
        moving: [Pair; 2],
        theta_dd: Option<Pair>,
        ground: Vector,
    ) -> (BeddedRate, Reactions) {
        dispatch!(self.level, _ => {
            let balance = self.balance(laws, formulas, held, moving, ground);
            let reactions = self.reactions_by(&balance, theta_dd.unwrap_or(balance.theta_dd));
            (BeddedRate { theta_dd: balance.theta_dd, powers_w: balance.powers_w }, reactions)
        })
    }

    #[inline(always)]
    fn reactions_by(&self, balance: &Balance, theta_dd: Pair) -> Reactions {
        let turning = balance.pose.arms.velocities(theta_dd);
        let accelerations = PointVelocities {
            g1: balance.drift.g1 + turning.g1,
            g2: balance.drift.g2 + turning.g2,
            c: balance.drift.c + turning.c,
            theta: theta_dd,
        };
        let at_top = balance.force_n + balance.holding_n;
        Reactions {
            forces: self.masses.through_joints(&balance.pose.arms, &accelerations, at_top),
            top_displacement_m: balance.x_c,
            top_velocity_m_s: balance.v_c,
            top_acceleration_m_s2: balance.top_drift_x + turning.c.x,
            holding_n: balance.holding_n,
        }
    }

    /// Displacement (m), velocity (m/s) and acceleration (m/s²) of the top, relative to the ground.
    pub fn top(&self, theta: Pair, omega: Pair, theta_dd: Pair) -> [f64; 3] {
        let pose = self.pose(theta);
        let along = |pair: Pair| pose.arms.velocities(pair).c.x;
        [self.top_of(&pose), along(omega), along(theta_dd) + self.drift(&pose, omega).c.x]
    }

    /// ∂x_C/∂θ, m.
    pub fn top_levers_m(&self, theta: Pair) -> Pair {
        let arms = self.pose(theta).arms;
        [arms.r_q.y, arms.r_c.y]
    }

    /// Horizontal displacement of the middle of the crack, m; of an uncracked wall that of its top.
    pub fn crack_displacement_m(&self, theta_1: f64) -> f64 {
        let turn = sin_cos(theta_1);
        (self.joints[0].roll(theta_1).place + Vector::new(0.0, self.height_1_m).rotated(turn)).x
    }

    /// Kinetic, gravity and bed energy, J; the springs at the top not counted. Zero at rest.
    pub fn energy_j(&self, theta: Pair, omega: Pair) -> f64 {
        let pose = self.pose(theta);
        let Masses { m: [m1, m2], m_d, .. } = self.masses;
        // Heights lost by turning: h (1 - cos θ), without cancellation.
        let lost = |(sin, cos): (f64, f64)| sin * sin / (1.0 + cos);
        let [lost_1, lost_2] = pose.turns.map(lost);
        let risen = |arm: Vector, turned: (f64, f64), lost: f64| -arm.y * lost - arm.x * turned.0;
        let foot = pose.foot.y;
        let crack = foot + pose.rolls[1].place.rotated(pose.turns[0]).y - self.height_1_m * lost_1;
        let lifted = m1 * (foot + risen(self.g1, pose.turns[0], lost_1))
            + m2 * (crack + risen(self.g2, pose.turns[1], lost_2))
            + m_d * (crack + risen(self.c, pose.turns[1], lost_2));
        let [ground, opening] = across(theta);
        let stored = self.joints[0].stored_j(ground) + self.joints[1].stored_j(opening);
        0.5 * self.mass_of(&pose.arms).quadratic(omega) + G_M_S2 * lifted + stored
    }

    /// Stiffness of the beds in whole contact and their damping, on θ_1 and θ_2: what small motions feel.
    pub fn stiffness_and_damping(&self) -> [MassMatrix; 2] {
        let of = |number: fn(&Roll) -> f64| {
            let at = |joint: &JointShape| match joint {
                JointShape::Edge { .. } => 0.0,
                JointShape::Bed { bed, .. } => number(&bed.in_full_contact(1.0)),
            };
            let [ground, crack] = [at(&self.joints[0]), at(&self.joints[1])];
            MassMatrix { m11: ground + crack, m12: -crack, m22: crack }
        };
        [of(|roll| roll.moment_n_m), of(|roll| roll.damping_n_m_s)]
    }
}
