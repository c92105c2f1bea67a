//! A plain integration of the matrix equations with one law of the top that has kinks: classical Runge–Kutta at a tiny
//! fixed step, stops and slips by bisection. It shares nothing with the solver or its regimes.

use mrbd_kernel::model::{Contact, State, Vector, WallParameters};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use crate::matrix_model::MatrixWall;

/// A law at the top with kinks.
#[derive(Debug, Clone, Copy)]
pub enum Law {
    Friction { force_n: f64 },
    Gap { stiffness_n_per_m: f64, half_width_m: f64 },
    OneSided { stiffness_n_per_m: f64, side: f64 },
    Yielding { stiffness_n_per_m: f64, force_n: f64 },
}

/// What friction does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slide {
    Towards(f64),
    Not,
}

/// A wall in a contact state with both joints open, and its law.
pub struct Reference {
    wall: MatrixWall,
    contact: Contact,
    law: Law,
    /// Ground acceleration at samples, linear between, and their step.
    ground: (Vec<f64>, f64),
    slide: Slide,
    plastic_m: f64,
    /// Stops, slips, and passages of a displacement.
    pub kinks: u32,
}

const STEP_S: f64 = 5e-5;

impl Reference {
    pub fn new(parameters: &WallParameters, contact: Contact, law: Law, ground: (Vec<f64>, f64)) -> Self {
        let wall = MatrixWall::new(parameters);
        Self { wall, contact, law, ground, slide: Slide::Not, plastic_m: 0.0, kinks: 0 }
    }

    fn ground(&self, t: f64) -> Vector {
        let (samples, step_s) = &self.ground;
        let k = ((t / step_s) as usize).min(samples.len() - 2);
        Vector { x: samples[k] + (t / step_s - k as f64) * (samples[k + 1] - samples[k]), y: 0.0 }
    }

    fn top(&self, state: &State) -> (f64, f64) {
        let row = self.wall.jacobian(self.contact, state.theta).row(6).into_owned();
        let velocity = row[0] * state.omega[0] + row[1] * state.omega[1];
        (self.wall.top_displacement(self.contact, state.theta), velocity)
    }

    /// Force of the law but for friction that holds.
    fn force(&self, x: f64) -> f64 {
        match (self.law, self.slide) {
            (Law::Friction { force_n }, Slide::Towards(side)) => -side * force_n,
            (Law::Friction { .. }, Slide::Not) => 0.0,
            (Law::Gap { stiffness_n_per_m: k, half_width_m: g }, _) => {
                if x.abs() > g {
                    -k * (x - g * x.signum())
                } else {
                    0.0
                }
            }
            (Law::OneSided { stiffness_n_per_m: k, side }, _) => {
                if x * side > 0.0 {
                    -k * x
                } else {
                    0.0
                }
            }
            (Law::Yielding { stiffness_n_per_m: k, force_n }, _) => {
                (-k * (x - self.plastic_m)).clamp(-force_n, force_n)
            }
        }
    }

    /// θ'' and the force by which friction holds the top, from the equations with the constraint a_C = 0 beside them.
    fn held(&self, state: &State, ground: Vector) -> ([f64; 2], f64) {
        let mass = self.wall.mass_matrix(self.contact, state.theta);
        let (forcing, _) = self.wall.forcing(self.contact, state, ground);
        let row = self.wall.jacobian(self.contact, state.theta).row(6).into_owned();
        let system = Matrix3::new(
            mass[(0, 0)],
            mass[(0, 1)],
            -row[0],
            mass[(1, 0)],
            mass[(1, 1)],
            -row[1],
            row[0],
            row[1],
            0.0,
        );
        // a_C = J θ'' + J' θ', the second by a difference along the motion.
        let dt = 1e-6;
        let later = |sign: f64| {
            let theta = [0, 1].map(|i| state.theta[i] + sign * dt * state.omega[i]);
            let row = self.wall.jacobian(self.contact, theta).row(6).into_owned();
            row[0] * state.omega[0] + row[1] * state.omega[1]
        };
        let turning = (later(1.0) - later(-1.0)) / (2.0 * dt);
        let solution =
            system.lu().solve(&Vector3::new(forcing[0], forcing[1], -turning)).expect("a regular system");
        ([solution[0], solution[1]], solution[2])
    }

    fn theta_dd(&self, state: &State, ground: Vector) -> [f64; 2] {
        if let (Law::Friction { .. }, Slide::Not) = (self.law, self.slide) {
            return self.held(state, ground).0;
        }
        let mass: Matrix2<f64> = self.wall.mass_matrix(self.contact, state.theta);
        let (forcing, _) = self.wall.forcing(self.contact, state, ground);
        let row = self.wall.jacobian(self.contact, state.theta).row(6).into_owned();
        let force = self.force(self.top(state).0);
        let push = Vector2::new(row[0] * force, row[1] * force);
        let theta_dd = mass.lu().solve(&(forcing + push)).expect("a positive mass matrix");
        [theta_dd[0], theta_dd[1]]
    }

    fn step(&self, t: f64, state: &State, h: f64) -> State {
        let rate = |after: f64, s: &State| (s.omega, self.theta_dd(s, self.ground(t + after)));
        let moved = |(v, a): ([f64; 2], [f64; 2]), h: f64| State {
            theta: [0, 1].map(|i| state.theta[i] + h * v[i]),
            omega: [0, 1].map(|i| state.omega[i] + h * a[i]),
        };
        let k1 = rate(0.0, state);
        let k2 = rate(0.5 * h, &moved(k1, 0.5 * h));
        let k3 = rate(0.5 * h, &moved(k2, 0.5 * h));
        let k4 = rate(h, &moved(k3, h));
        let mean = |a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]| {
            [0, 1].map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0)
        };
        moved((mean(k1.0, k2.0, k3.0, k4.0), mean(k1.1, k2.1, k3.1, k4.1)), h)
    }

    /// What is left until the friction's way of sliding ends, for a step that is bisected where it turns negative.
    fn left(&self, t: f64, state: &State) -> f64 {
        match (self.law, self.slide) {
            (Law::Friction { .. }, Slide::Towards(side)) => side * self.top(state).1,
            (Law::Friction { force_n }, Slide::Not) => force_n - self.held(state, self.ground(t)).1.abs(),
            _ => 1.0,
        }
    }

    /// At a velocity of zero: holds, or slides the way it is pushed.
    fn choose(&mut self, t: f64, state: &State) {
        let Law::Friction { force_n } = self.law else { return };
        let holding = self.held(state, self.ground(t)).1;
        self.slide = if holding.abs() <= force_n { Slide::Not } else { Slide::Towards(-holding.signum()) };
    }

    /// The state at the end, from one at t = 0.
    pub fn run(&mut self, mut state: State, end_s: f64) -> State {
        let (x, v) = self.top(&state);
        self.slide = Slide::Towards(v.signum());
        self.follow(x);
        let steps = (end_s / STEP_S).round() as u32;
        for n in 0..steps {
            let (mut t, end) = (f64::from(n) * STEP_S, f64::from(n + 1) * STEP_S);
            let before = self.force(self.top(&state).0);
            while t < end {
                let next = self.step(t, &state, end - t);
                if self.left(end, &next) >= 0.0 {
                    (t, state) = (end, next);
                    continue;
                }
                let (mut low, mut high) = (0.0, end - t);
                while high - low > 1e-15 {
                    let middle = 0.5 * (low + high);
                    let negative = self.left(t + middle, &self.step(t, &state, middle)) < 0.0;
                    if negative { high = middle } else { low = middle }
                }
                state = self.step(t, &state, high);
                t += high;
                self.kinks += 1;
                self.choose(t, &state);
            }
            let x = self.top(&state).0;
            self.follow(x);
            let after = self.force(x);
            self.kinks +=
                u32::from((before == 0.0) != (after == 0.0) && !matches!(self.law, Law::Friction { .. }));
        }
        state
    }

    /// The plastic displacement goes along where the spring yields.
    fn follow(&mut self, x: f64) {
        if let Law::Yielding { stiffness_n_per_m: k, force_n } = self.law {
            let before = self.plastic_m;
            self.plastic_m = before.clamp(x - force_n / k, x + force_n / k);
            self.kinks += u32::from(self.plastic_m != before);
        }
    }
}
