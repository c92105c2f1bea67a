//! A wall under a ground motion, sampled at the motion's step.

use super::Coordinates;
use super::bodies::Bodies;
use super::rosenbrock::{Slopes, State, Tried, step};
use super::scaling::Scaling;
use super::wall::CompliantWall;

/// Errors allowed in one step: of places, m and rad, and of velocities, m/s and rad/s.
///
/// Ten times smaller ones give the same rotations to a thousandth until two impacts nearly coincide.
const ALLOWED: [f64; 2] = [1e-7, 1e-5];
/// Rotation at which a wall counts as fallen, rad: far beyond what a case may reach.
const FALLEN_RAD: f64 = 0.3;

/// Ground acceleration, linear between samples and zero after the last.
#[derive(Debug, Clone)]
pub struct GroundMotion {
    /// Time between samples, s.
    pub step_s: f64,
    /// Samples in x, m/s².
    pub x_m_s2: Vec<f64>,
    /// Samples in y, m/s²; zero after its end.
    pub y_m_s2: Vec<f64>,
}

/// Rotations at the samples of the ground motion and beyond.
#[derive(Debug, Clone)]
pub struct Readings {
    /// θ_1 and θ_2, rad; a fallen wall ends them.
    pub theta_rad: Vec<[f64; 2]>,
}

impl GroundMotion {
    fn sample(&self, k: usize) -> [f64; 2] {
        [&self.x_m_s2, &self.y_m_s2].map(|axis| axis.get(k).copied().unwrap_or(0.0))
    }

    /// In the piece that starts at sample `k`, m/s².
    fn at(&self, k: usize, time_s: f64) -> [f64; 2] {
        let [from, to] = [self.sample(k), self.sample(k + 1)];
        let share = time_s / self.step_s - k as f64;
        [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
    }
}

/// Runs a wall through a ground motion and `tail_s` beyond its last sample.
pub fn run(wall: CompliantWall, ground: &GroundMotion, tail_s: f64) -> Readings {
    let pieces = ground.x_m_s2.len() - 1 + (tail_s / ground.step_s).round() as usize;
    let mut motion = Motion::new(wall, ground);
    let mut theta_rad = vec![[0.0; 2]];
    for k in 0..pieces {
        motion.piece(k);
        let theta = [motion.state.q[2], motion.state.q[5]];
        theta_rad.push(theta);
        if theta.iter().any(|t| t.abs() > FALLEN_RAD) {
            break;
        }
    }
    Readings { theta_rad }
}

struct Motion<'a> {
    bodies: Bodies,
    ground: &'a GroundMotion,
    scaling: Scaling,
    state: State,
    time_s: f64,
    h_s: f64,
}

impl<'a> Motion<'a> {
    fn new(wall: CompliantWall, ground: &'a GroundMotion) -> Self {
        let (bodies, q) = Bodies::new(wall);
        let scaling = Scaling::new(&bodies);
        let state = State { q, v: Coordinates::zeros() };
        Self { bodies, ground, scaling, state, time_s: 0.0, h_s: 1e-5 }
    }

    /// Moves on to the end of a piece of the ground motion.
    fn piece(&mut self, k: usize) {
        let end_s = (k + 1) as f64 * self.ground.step_s;
        // The last step lands on the end but for rounding.
        let landed_s = end_s - 1e-9 * self.ground.step_s;
        while self.time_s < landed_s {
            let h_s = self.h_s.min(end_s - self.time_s);
            let (h_s, tried) = self.accepted(k, h_s);
            self.time_s += h_s;
            self.state = tried.state;
            let x_m = self.bodies.top_displacement_m(&self.state.q);
            self.bodies.wall.top.iter_mut().for_each(|law| law.remember(x_m, h_s));
            if self.scaling.look(&self.bodies, self.time_s, &mut self.state) {
                self.h_s = self.h_s.min(1e-5);
            }
        }
        self.time_s = end_s;
    }

    /// Tries shorter and shorter steps until one is accurate enough; sets the length of the next.
    fn accepted(&mut self, k: usize, first_h_s: f64) -> (f64, Tried) {
        const SHORTEST_S: f64 = 1e-9;
        let (bodies, ground) = (&self.bodies, self.ground);
        let acceleration =
            |t: f64, q: &Coordinates, v: &Coordinates| bodies.acceleration(ground.at(k, t), q, v);
        let here = acceleration(self.time_s, &self.state.q, &self.state.v);
        let slopes = Slopes::new(&acceleration, self.time_s, &self.state, &here);
        let mut h_s = first_h_s;
        loop {
            let tried = step(&acceleration, self.time_s, h_s, &self.state, &here, &slopes);
            let error = tried.as_ref().map_or(f64::INFINITY, error_over_allowed);
            // Order 2: the error of a step goes with h³.
            let factor = (0.8 * error.max(1e-9).powf(-1.0 / 3.0)).clamp(0.1, 4.0);
            match tried {
                Some(tried) if error <= 1.0 || h_s < SHORTEST_S => {
                    // A step cut short by the end of a piece says nothing against longer ones.
                    self.h_s =
                        (h_s * factor).max(if h_s < self.h_s && factor >= 1.0 { self.h_s } else { 0.0 });
                    return (h_s, tried);
                }
                _ => h_s *= factor.min(0.5),
            }
        }
    }
}

fn error_over_allowed(tried: &Tried) -> f64 {
    let worst = |error: &Coordinates| error.amax();
    (worst(&tried.error.q) / ALLOWED[0]).max(worst(&tried.error.v) / ALLOWED[1])
}
