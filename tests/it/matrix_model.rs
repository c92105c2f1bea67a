//! The mechanics once more, as matrices over the mass points (x1, y1, θ1, x2, y2, θ2, xC, yC):
//! written from the model alone, sharing nothing with the kernel but the wall's parameters.

use mrbd_kernel::model::{Contact, G_M_S2, Joint, State, Touching, Vector, WallParameters};
use nalgebra::{DMatrix, DVector, Matrix2, SMatrix, SVector, Vector2};

pub type Jacobian = SMatrix<f64, 8, 2>;
pub type Points = SVector<f64, 8>;

/// Force through a joint in world axes and its clockwise moment about the middle of the joint.
#[derive(Debug, Clone, Copy)]
pub struct Through {
    pub force: Vector2<f64>,
    pub moment: f64,
}

/// A wall as matrices.
pub struct MatrixWall {
    p: WallParameters,
    h: [f64; 2],
    m: [f64; 2],
    i: [f64; 2],
    m_dp: f64,
    k_3: f64,
    c_top: f64,
    c_joint: [f64; 2],
}

/// Clockwise rotation R(θ).
fn r(theta: f64) -> Matrix2<f64> {
    Matrix2::new(theta.cos(), theta.sin(), -theta.sin(), theta.cos())
}

/// Derivative of a vector that turns clockwise.
fn d(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(v.y, -v.x)
}

/// Clockwise moment of a force at an arm.
fn moment(arm: Vector2<f64>, force: Vector2<f64>) -> f64 {
    arm.y * force.x - arm.x * force.y
}

/// Rotated arms r_1, r_Q, r_2, r_C and the corner O.
struct Arms {
    o: Vector2<f64>,
    r_1: Vector2<f64>,
    r_q: Vector2<f64>,
    r_2: Vector2<f64>,
    r_c: Vector2<f64>,
}

impl MatrixWall {
    pub fn new(p: &WallParameters) -> Self {
        let h1 = p.crack_height_m.expect("a cracked wall");
        let h = [h1, p.height_m - h1];
        let m = h.map(|h_i| p.mass_kg * h_i / p.height_m);
        let i = [0, 1].map(|k| m[k] * (p.thickness_m * p.thickness_m + h[k] * h[k]) / 12.0);
        let mut wall =
            Self { p: p.clone(), h, m, i, m_dp: p.carriage_mass_kg, k_3: 0.0, c_top: 0.0, c_joint: [0.0; 2] };
        for effect in &p.effects {
            let value = effect.parameters()[0];
            match effect.variant().name().as_str() {
                "carriage_mass" => wall.m_dp += value,
                "viscous_damping" => wall.c_top += value,
                "cubic_stiffness" => wall.k_3 += value,
                "joint_damping.ground" => wall.c_joint[0] += value,
                "joint_damping.crack" => wall.c_joint[1] += value,
                other => panic!("no {other} in matrix form"),
            }
        }
        wall
    }

    pub fn width(&self, joint: Joint) -> f64 {
        match joint {
            Joint::Ground => self.p.lower_width_m,
            Joint::Crack => self.p.upper_width_m,
        }
    }

    fn arms(&self, contact: Contact, theta: [f64; 2]) -> Arms {
        let [h1, h2] = self.h;
        let o = Vector2::new(contact.ground.sign() * self.p.lower_width_m / 2.0, 0.0);
        let q = Vector2::new(contact.crack.sign() * self.p.upper_width_m / 2.0, h1);
        let g1 = Vector2::new(0.0, h1 / 2.0);
        let g2 = Vector2::new(0.0, h1 + h2 / 2.0);
        let c = Vector2::new(self.p.eccentricity_m, h1 + h2);
        let (r1, r2) = (r(theta[0]), r(theta[1]));
        Arms { o, r_1: r1 * (g1 - o), r_q: r1 * (q - o), r_2: r2 * (g2 - q), r_c: r2 * (c - q) }
    }

    /// J of model section 3.
    pub fn jacobian(&self, contact: Contact, theta: [f64; 2]) -> Jacobian {
        let a = self.arms(contact, theta);
        let (d1, dq, d2, dc) = (d(a.r_1), d(a.r_q), d(a.r_2), d(a.r_c));
        Jacobian::from_row_slice(&[
            d1.x, 0.0, d1.y, 0.0, 1.0, 0.0, dq.x, d2.x, dq.y, d2.y, 0.0, 1.0, dq.x, dc.x, dq.y, dc.y,
        ])
    }

    /// The diagonal of M.
    pub fn weights(&self) -> Points {
        let ([m1, m2], [i1, i2], m_d) = (self.m, self.i, self.p.diaphragm_mass_kg);
        Points::from([m1, m1, i1, m2, m2, i2, m_d + self.m_dp, m_d])
    }

    fn centripetal(&self, contact: Contact, state: &State) -> Points {
        let a = self.arms(contact, state.theta);
        let [w1, w2] = state.omega.map(|w| w * w);
        let (g1, q) = (a.r_1 * -w1, a.r_q * -w1);
        let (g2, c) = (q - a.r_2 * w2, q - a.r_c * w2);
        Points::from([g1.x, g1.y, 0.0, g2.x, g2.y, 0.0, c.x, c.y])
    }

    /// Horizontal displacement of C.
    pub fn top_displacement(&self, contact: Contact, theta: [f64; 2]) -> f64 {
        let a = self.arms(contact, theta);
        (a.o + a.r_q + a.r_c).x - self.p.eccentricity_m
    }

    /// Horizontal force at C of the spring and the effects that act there.
    fn top_force(&self, contact: Contact, state: &State) -> f64 {
        let x = self.top_displacement(contact, state.theta);
        let velocity = (self.jacobian(contact, state.theta) * Vector2::from(state.omega))[6];
        -self.p.stiffness_n_per_m * x - self.k_3 * x.powi(3) - self.c_top * velocity
    }

    /// Generalised moments of the dampers in the joints: -Bᵀ c B θ', with the openings B θ' = (θ1', θ2' - θ1').
    fn joint_damping(&self, omega: [f64; 2]) -> Vector2<f64> {
        let b = Matrix2::new(1.0, 0.0, -1.0, 1.0);
        let c = Matrix2::from_diagonal(&Vector2::from(self.c_joint));
        -(b.transpose() * c * b * Vector2::from(omega))
    }

    /// The columns of J that a contact state leaves free, as combinations of the two.
    pub fn freedom(contact: Contact) -> DMatrix<f64> {
        match contact.pattern_number() {
            None => DMatrix::zeros(2, 0),
            Some(3) => DMatrix::from_column_slice(2, 1, &[1.0, 1.0]),
            Some(4) => DMatrix::from_column_slice(2, 1, &[0.0, 1.0]),
            _ => DMatrix::identity(2, 2),
        }
    }

    /// Solves Sᵀ A S q = Sᵀ f and gives S q.
    fn solve_free(contact: Contact, a: Matrix2<f64>, f: Vector2<f64>) -> [f64; 2] {
        let s = Self::freedom(contact);
        if s.ncols() == 0 {
            return [0.0; 2];
        }
        let a = DMatrix::from_column_slice(2, 2, a.as_slice());
        let f = DVector::from_column_slice(f.as_slice());
        let reduced = s.transpose() * a * &s;
        let q = reduced.lu().solve(&(s.transpose() * f)).expect("a positive mass matrix");
        let x = s * q;
        [x[0], x[1]]
    }

    /// JᵀMJ.
    pub fn mass_matrix(&self, contact: Contact, theta: [f64; 2]) -> Matrix2<f64> {
        let j = self.jacobian(contact, theta);
        j.transpose() * SMatrix::<f64, 8, 8>::from_diagonal(&self.weights()) * j
    }

    /// Everything in Jᵀ M (J θ'' + …) = Jᵀ F but the first term, moved to the right: its value and its size.
    pub fn forcing(&self, contact: Contact, state: &State, ground: Vector) -> (Vector2<f64>, Vector2<f64>) {
        let j = self.jacobian(contact, state.theta);
        let ground = Self::on_points(Vector { x: ground.x, y: ground.y + G_M_S2 });
        let inertial = (self.centripetal(contact, state) + ground).component_mul(&self.weights());
        let mut force = -inertial;
        force[6] += self.top_force(contact, state);
        let joints = self.joint_damping(state.omega);
        let size = j.abs().transpose() * (inertial.abs() + force.abs()) + joints.abs();
        (j.transpose() * force + joints, size)
    }

    fn on_points(v: Vector) -> Points {
        Points::from([v.x, v.y, 0.0, v.x, v.y, 0.0, v.x, v.y])
    }

    /// θ''.
    pub fn theta_dd(&self, contact: Contact, state: &State, ground: Vector) -> [f64; 2] {
        let a = self.mass_matrix(contact, state.theta);
        Self::solve_free(contact, a, self.forcing(contact, state, ground).0)
    }

    /// Power of the ground motion, -ground · M v, and of all dampers.
    pub fn powers(&self, contact: Contact, state: &State, ground: Vector) -> [f64; 2] {
        let omega = Vector2::from(state.omega);
        let v = self.jacobian(contact, state.theta) * omega;
        let work = -Self::on_points(ground).component_mul(&self.weights()).dot(&v);
        [work, self.c_top * v[6] * v[6] - self.joint_damping(state.omega).dot(&omega)]
    }

    /// What the dampers would take if no two terms of a velocity cancelled.
    pub fn most_damping(&self, contact: Contact, state: &State) -> f64 {
        let [w1, w2] = state.omega.map(f64::abs);
        let top = (self.jacobian(contact, state.theta).abs() * Vector2::new(w1, w2))[6];
        self.c_top * top * top + self.c_joint[0] * w1 * w1 + self.c_joint[1] * (w1 + w2).powi(2)
    }

    /// Kinetic energy ½ vᵀ M v.
    pub fn kinetic_energy(&self, contact: Contact, state: &State) -> f64 {
        let v = self.jacobian(contact, state.theta) * Vector2::from(state.omega);
        0.5 * v.component_mul(&self.weights()).dot(&v)
    }

    /// Velocities after an impact: Jnᵀ M Jn θ'⁺ = Jnᵀ M v⁻.
    pub fn after_impact(&self, from: Contact, to: Contact, state: &State) -> [f64; 2] {
        let v = self.jacobian(from, state.theta) * Vector2::from(state.omega);
        let momenta = self.jacobian(to, state.theta).transpose() * v.component_mul(&self.weights());
        Self::solve_free(to, self.mass_matrix(to, state.theta), momenta)
    }

    /// Forces through the ground and the crack, from Newton's and Euler's laws of each body alone.
    pub fn through_joints(
        &self,
        contact: Contact,
        state: &State,
        theta_dd: [f64; 2],
        ground: Vector,
    ) -> [Through; 2] {
        let j = self.jacobian(contact, state.theta);
        let ground = Self::on_points(Vector { x: ground.x, y: ground.y + G_M_S2 });
        let a = j * Vector2::from(theta_dd) + self.centripetal(contact, state) + ground;
        self.balance(contact, state.theta, &a, self.top_force(contact, state))
    }

    /// Forces through the ground and the crack of a wall at rest under a further force at the top.
    pub fn through_joints_pushed(
        &self,
        contact: Contact,
        state: &State,
        ground: Vector,
        top_force: f64,
    ) -> [Through; 2] {
        let ground = Self::on_points(Vector { x: ground.x, y: ground.y + G_M_S2 });
        self.balance(contact, state.theta, &ground, self.top_force(contact, state) + top_force)
    }

    /// Impulses through the ground and the crack in an impact.
    pub fn impulses(&self, from: Contact, to: Contact, state: &State, omega: [f64; 2]) -> [Through; 2] {
        let before = self.jacobian(from, state.theta) * Vector2::from(state.omega);
        let after = self.jacobian(to, state.theta) * Vector2::from(omega);
        self.balance(to, state.theta, &(after - before), 0.0)
    }

    fn balance(&self, contact: Contact, theta: [f64; 2], a: &Points, top_force: f64) -> [Through; 2] {
        let arms = self.arms(contact, theta);
        let (g1, q) = (arms.o + arms.r_1, arms.o + arms.r_q);
        let (g2, c) = (q + arms.r_2, q + arms.r_c);
        let across = r(theta[0]) * Vector2::new(contact.crack.sign() * self.p.upper_width_m / 2.0, 0.0);
        let middle = q - across;
        let f = a.component_mul(&self.weights());
        // The upper body with what it carries is pushed by the crack alone.
        let upper = Vector2::new(f[3], f[4]);
        let top = Vector2::new(f[6] - top_force, f[7]);
        let crack = Through {
            force: upper + top,
            moment: moment(g2 - middle, upper) + f[5] + moment(c - middle, top),
        };
        // The lower body is pushed by the ground, and back by the crack.
        let lower = Vector2::new(f[0], f[1]);
        let ground = Through {
            force: lower + crack.force,
            moment: moment(g1, lower) + f[2] + moment(middle, crack.force) + crack.moment,
        };
        [ground, crack]
    }

    /// Pushes at the left and right corners of a joint, across the joint.
    pub fn corners(&self, joint: Joint, theta: [f64; 2], through: &Through) -> [f64; 2] {
        let normal = match joint {
            Joint::Ground => through.force.y,
            Joint::Crack => (r(theta[0]).transpose() * through.force).y,
        };
        let lever = through.moment / self.width(joint);
        [normal / 2.0 + lever, normal / 2.0 - lever]
    }

    /// Contact states that an impact may lead to: touching joints in any state, the others as they are.
    pub fn candidates(from: Contact, touching: Touching) -> Vec<Contact> {
        let agrees = |to: &Contact, joint: Joint| touching.at(joint) || to.at(joint) == from.at(joint);
        Contact::ALL.into_iter().filter(|to| agrees(to, Joint::Ground) && agrees(to, Joint::Crack)).collect()
    }
}
