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

use super::super::contact::{Contact, Joint, Pivot};
use super::super::geometry::{Pair, PointVelocities, Rotations, TurnedArms};
use super::super::joint_forces::{Masses, Reactions};
use super::super::mass_matrix::{Freedom, MassMatrix};
use super::super::motion::Motion;
use super::super::number::Number;
use super::super::vector::{Vector, sin_cos};
use super::super::wall::{G_M_S2, Wall};
use super::joint_law::JointLaw;
use super::roll::{Roll, across};
use super::shape::{Branch, JointShape};
use crate::instructions::dispatch;

/// What a joint does as it turns by φ.
pub(crate) trait Rolls<N> {
    fn roll(&self, phi: N) -> Roll<N>;

    /// Moment against the opening of a joint that crushes, by which energy is lost, N m.
    #[inline(always)]
    fn crushing_n_m(&self, _phi: N) -> Option<N> {
        None
    }
}

/// What acts on a wall beyond weight, inertia and beds.
pub(crate) trait Acting<N> {
    /// Force of the springs at the top, N, at its displacement in m.
    fn spring_force_n(&self, x_c_m: N) -> N;
    /// Force at the top against its velocity in m/s, and that of formulas, N.
    fn damping_force_n(&self, x_c_m: N, v_c_m_s: N) -> N;
    /// Moments of the joint dampers on θ_1 and θ_2, and those of formulas, N m.
    fn joint_moments_n_m(&self, theta: impl Fn() -> [N; 2], omega: [N; 2]) -> [N; 2];
}

/// The motion of one contact state of a wall with beds, or those of several walls side by side. The laws at the
/// top are those of [`super::super::motion::Motion`].
#[derive(Debug, Clone)]
pub(crate) struct BeddedMotion<N = f64, J = JointShape> {
    pub joints: [J; 2],
    pub freedom: Freedom,
    pub masses: Masses<N>,
    pub height_1_m: N,
    pub g1: Vector<N>,
    pub g2: Vector<N>,
    pub c: Vector<N>,
}

/// A wall turned by its rotations: what is where, and how it moves with the rotations.
pub(crate) struct Pose<N = f64> {
    rolls: [Roll<N>; 2],
    arms: TurnedArms<N>,
    turns: [(N, N); 2],
    /// R(θ_1) q and R(θ_1) q', R(θ_1) q''.
    q: [Vector<N>; 3],
    /// Displacement of A; G_1 - A, G_2 - B and C - B as turned.
    foot: Vector<N>,
    g1: Vector<N>,
    g2: Vector<N>,
    c: Vector<N>,
}

/// All that the equations give at a state.
pub(crate) struct Balance<N = f64> {
    /// Accelerations of the mass points without θ'', the ground's and gravity in them, m/s².
    drift: PointVelocities<N>,
    /// The same of C, relative to the ground, horizontally.
    top_drift_x: N,
    /// Displacement (m) and velocity (m/s) of the top, and the force there, N.
    x_c: N,
    v_c: N,
    force_n: N,
    pub theta_dd: [N; 2],
    /// Force by which friction holds the top, N.
    holding_n: N,
    /// Of the ground and of losses, W.
    pub powers_w: [N; 2],
}

/// What a step needs.
pub(crate) struct BeddedRate {
    pub theta_dd: Pair,
    /// Of the ground and of losses, W.
    pub powers_w: Pair,
}

/// The arm to the instantaneous pivot whose turning gives this velocity per rate: (X, Y)^⊥ = (Y, -X).
#[inline(always)]
fn arm_of<N: Number>(slope: Vector<N>) -> Vector<N> {
    Vector::new(-slope.y, slope.x)
}

/// What both bodies' sums are of: one product for each.
#[inline(always)]
fn along<N: Number>(levers: [N; 2], pair: [N; 2]) -> N {
    levers[0] * pair[0] + levers[1] * pair[1]
}

impl Balance {
    fn rate(&self) -> BeddedRate {
        BeddedRate { theta_dd: self.theta_dd, powers_w: self.powers_w }
    }
}

impl<N: Number, J: Rolls<N>> BeddedMotion<N, J> {
    #[inline(always)]
    pub fn pose(&self, theta: [N; 2]) -> Pose<N> {
        let [ground, crack] = across(theta);
        let rolls = [self.joints[0].roll(ground), self.joints[1].roll(crack)];
        let turns = [theta[0].sine_and_cosine(), theta[1].sine_and_cosine()];
        let up = Vector::new(self.height_1_m.constant(0.0), self.height_1_m);
        let Roll { place, slope, bend, .. } = rolls[1];
        let q = [(place + up).rotated(turns[0]), slope.rotated(turns[0]), bend.rotated(turns[0])];
        let (g1, g2, c) = (self.g1.rotated(turns[0]), self.g2.rotated(turns[1]), self.c.rotated(turns[1]));
        // From the instantaneous pivots to the middles of the joints' upper faces.
        let (to_foot, to_crack) = (arm_of(rolls[0].slope), arm_of(q[1]));
        let arms = TurnedArms {
            o_x: (rolls[0].place - to_foot).x,
            r_1: to_foot + g1,
            r_q: to_foot + q[0] - to_crack,
            r_2: to_crack + g2,
            r_c: to_crack + c,
            q_from_middle: place.rotated(turns[0]) - to_crack,
            turn_1: turns[0],
        };
        Pose { foot: rolls[0].place, rolls, arms, turns, q, g1, g2, c }
    }

    #[inline(always)]
    pub fn mass_of(&self, arms: &TurnedArms<N>) -> MassMatrix<N> {
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
    fn drift(&self, pose: &Pose<N>, [w1, w2]: [N; 2]) -> PointVelocities<N> {
        let opening = w2 - w1;
        let foot = pose.rolls[0].bend * (w1 * w1);
        let crack = foot - pose.q[0] * (w1 * w1)
            + pose.q[1].perpendicular() * (w1.constant(2.0) * w1 * opening)
            + pose.q[2] * (opening * opening);
        PointVelocities {
            g1: foot - pose.g1 * (w1 * w1),
            g2: crack - pose.g2 * (w2 * w2),
            c: crack - pose.c * (w2 * w2),
            theta: [w1.constant(0.0); 2],
        }
    }

    /// Moments of the beds on θ_1 and θ_2, those that store and those that lose energy, N m.
    #[inline(always)]
    fn bed_moments(&self, pose: &Pose<N>, [theta, omega]: [[N; 2]; 2]) -> [[N; 2]; 2] {
        let (rotations, rates) = (across(theta), across(omega));
        let [ground, crack] = &pose.rolls;
        let [lost_0, lost_1] = [0, 1].map(|j: usize| {
            let damper = pose.rolls[j].damping_n_m_s * rates[j];
            match self.joints[j].crushing_n_m(rotations[j]) {
                Some(crushing) => damper + crushing,
                None => damper,
            }
        });
        [[crack.moment_n_m - ground.moment_n_m, -crack.moment_n_m], [lost_1 - lost_0, -lost_1]]
    }

    /// The equations of motion in a pose, at its rotations and velocities; `held`: friction holds the top in place.
    #[inline(always)]
    pub fn balance_in(
        &self,
        pose: &Pose<N>,
        acting: &impl Acting<N>,
        held: bool,
        [theta, omega]: [[N; 2]; 2],
        ground: Vector<N>,
    ) -> Balance<N> {
        let mass = self.mass_of(&pose.arms);
        let moving = self.drift(pose, omega);
        let shaking = Vector::new(ground.x, ground.y + ground.y.constant(G_M_S2));
        let drift = PointVelocities {
            g1: moving.g1 + shaking,
            g2: moving.g2 + shaking,
            c: moving.c + shaking,
            theta: moving.theta,
        };
        let arms = &pose.arms;
        let x_c = self.top_of(pose);
        let v = arms.velocities(omega);
        let damping_n = acting.damping_force_n(x_c, v.c.x);
        let dampers = acting.joint_moments_n_m(|| theta, omega);
        let force_n = acting.spring_force_n(x_c) + damping_n;
        let [stored, lost] = self.bed_moments(pose, [theta, omega]);
        let inertia = self.masses.momenta(arms, &drift);
        let levers = [arms.r_q.y, arms.r_c.y];
        let f = [
            levers[0] * force_n - inertia[0] + stored[0] + lost[0] + dampers[0],
            levers[1] * force_n - inertia[1] + stored[1] + lost[1] + dampers[1],
        ];
        let free = mass.solve(self.freedom, f);
        let (theta_dd, holding_n) = match held {
            true => self.with_held_top(&mass, levers, moving.c.x, free),
            false => (free, x_c.constant(0.0)),
        };
        let loss_w = damping_n * v.c.x + along([lost[0] + dampers[0], lost[1] + dampers[1]], omega);
        Balance {
            drift,
            top_drift_x: moving.c.x,
            x_c,
            v_c: v.c.x,
            force_n,
            theta_dd,
            holding_n,
            powers_w: [-self.masses.power(&v, ground), -loss_w],
        }
    }

    /// As [`super::super::top`]: the force that keeps a_C = 0.
    #[inline(always)]
    fn with_held_top(&self, mass: &MassMatrix<N>, levers: [N; 2], drift_x: N, free: [N; 2]) -> ([N; 2], N) {
        let per_force = mass.solve(self.freedom, levers);
        let holding_n = -(along(levers, free) + drift_x) / along(levers, per_force);
        match self.freedom {
            Freedom::Both => {
                ([free[0] + per_force[0] * holding_n, free[1] + per_force[1] * holding_n], holding_n)
            }
            _ => ([drift_x.constant(0.0); 2], holding_n),
        }
    }

    /// Displacement of the top, m.
    #[inline(always)]
    pub fn top_of(&self, pose: &Pose<N>) -> N {
        (pose.foot + pose.q[0] + pose.c).x - self.c.x
    }

    /// The reactions to these angular accelerations.
    #[inline(always)]
    pub fn reactions_by(&self, pose: &Pose<N>, balance: &Balance<N>, theta_dd: [N; 2]) -> Reactions<N> {
        let turning = pose.arms.velocities(theta_dd);
        let accelerations = PointVelocities {
            g1: balance.drift.g1 + turning.g1,
            g2: balance.drift.g2 + turning.g2,
            c: balance.drift.c + turning.c,
            theta: theta_dd,
        };
        let at_top = balance.force_n + balance.holding_n;
        Reactions {
            forces: self.masses.through_joints(&pose.arms, &accelerations, at_top),
            top_displacement_m: balance.x_c,
            top_velocity_m_s: balance.v_c,
            top_acceleration_m_s2: balance.top_drift_x + turning.c.x,
            holding_n: balance.holding_n,
        }
    }
}

impl BeddedMotion {
    pub fn new(wall: &Wall, contact: Contact, carriage_mass_kg: f64) -> Self {
        let [h1, h2] = wall.height_m;
        let law = |joint: Joint| wall.joint_laws[joint as usize].as_ref();
        let moves = |joint: Joint| law(joint).is_some_and(JointLaw::gives) || contact.at(joint).is_open();
        let free = |joint: Joint| if moves(joint) { Pivot::Right } else { Pivot::Closed };
        let freedom = Freedom::of(Contact { ground: free(Joint::Ground), crack: free(Joint::Crack) });
        Self {
            joints: [Joint::Ground, Joint::Crack].map(|joint| {
                let width_m = wall.width_m[joint as usize];
                JointShape::new(law(joint), width_m, contact.at(joint), Branch::default())
            }),
            freedom,
            masses: Masses::new(wall, carriage_mass_kg),
            height_1_m: h1,
            g1: Vector::new(0.0, h1 / 2.0),
            g2: Vector::new(0.0, h2 / 2.0),
            c: Vector::new(wall.parameters().eccentricity_m, h2),
        }
    }

    pub fn freedom(&self) -> Freedom {
        self.freedom
    }

    pub fn turned_arms(&self, motion: &Motion, rotations: Rotations) -> TurnedArms {
        let theta = rotations.angles();
        dispatch!(motion.level, _ => self.pose(theta).arms)
    }

    /// The rate at rotations and velocities. Keeps the pose there.
    pub fn rate(
        &self,
        motion: &Motion,
        moving: [Pair; 2],
        ground: Vector,
        pose: &mut Option<Pose>,
    ) -> BeddedRate {
        dispatch!(motion.level, _ => {
            let pose = pose.insert(self.pose(moving[0]));
            self.balance_in(pose, motion, motion.held, moving, ground).rate()
        })
    }

    /// The same with the reactions, in a pose that may be known.
    pub fn rate_and_reactions(
        &self,
        motion: &Motion,
        moving: [Pair; 2],
        ground: Vector,
        known: &mut Option<Pose>,
    ) -> (BeddedRate, Reactions) {
        dispatch!(motion.level, _ => {
            let pose = known.get_or_insert_with(|| self.pose(moving[0]));
            let balance = self.balance_in(pose, motion, motion.held, moving, ground);
            (balance.rate(), self.reactions_by(pose, &balance, balance.theta_dd))
        })
    }

    /// Joint forces and motion of the top with these angular accelerations.
    pub fn reactions(&self, motion: &Motion, moving: [Pair; 2], theta_dd: Pair, ground: Vector) -> Reactions {
        dispatch!(motion.level, _ => {
            let pose = self.pose(moving[0]);
            let balance = self.balance_in(&pose, motion, motion.held, moving, ground);
            self.reactions_by(&pose, &balance, theta_dd)
        })
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
        let [ground, crack] = self.joints.map(|joint| joint.stiffness_and_damping());
        [0, 1].map(|i| MassMatrix { m11: ground[i] + crack[i], m12: -crack[i], m22: crack[i] })
    }

    /// Puts a joint into another branch of its law, or under another law.
    pub fn reshape(&mut self, joint: Joint, shape: JointShape) {
        self.joints[joint as usize] = shape;
    }
}
