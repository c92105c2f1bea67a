//! The residual of the equations of motion as a force at the top, by the weak form and its test function.

use std::sync::Arc;

use super::jumps::{Stretch, stretches};
use crate::diagnose::fit::{TopPast, largest_so_far_m, shaken, top_path};
use crate::diagnose::hypothesis::Physics;
use crate::experiment::{Freedom, TestData, rest_offset_rad};
use crate::limits::DIRECTION_CLEAR;
use mrbd_kernel::model::{Contact, Pair, RockingWall, State, Vector};
use mrbd_kernel::simulate::{Accuracy, Simulator};
use rayon::prelude::*;

/// Half the reach of a test function, as a share of the wall's time of response: over an eighth of a swing.
const HALF_REACH: f64 = 0.4;
/// Where a shorter reach still gives the force to this share of itself, the reach is shorter. The mean of a curved
/// law is not the law of the mean.
const KNOWN_TO: f64 = 0.1;
/// Samples to either side at least.
const LEAST_HALF: usize = 4;
/// Shorter stretches than this share of the full reach know the force too badly.
const LEAST_REACH: f64 = 0.5;
/// Parts in which the ground motion about a sample is summed.
const PARTS: i32 = 8;

/// What is missing in the equations of motion over a short stretch of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct ForcePoint {
    /// The test, by its place in the experiment.
    pub test: usize,
    /// Middle of the stretch, s.
    pub time_s: f64,
    /// Contact state.
    pub contact: Contact,
    /// Displacement of the top relative to the ground, weighed as the residual is, m.
    pub displacement_m: f64,
    /// Its velocity, m/s.
    pub velocity_m_s: f64,
    /// Its absolute acceleration, ẍ_C + ẍ_g, m/s².
    pub acceleration_m_s2: f64,
    /// M θ'' measured less M θ'' of the model, N m; one moment alone in patterns 3 and 4.
    pub moment_n_m: [Option<f64>; 2],
    /// The horizontal force at the top that comes nearest to it, N.
    pub force_n: f64,
    /// Standard deviation of that force by the noise of the rotations, N.
    pub force_sd_n: f64,
    /// Share of the squared residual moment off the direction of a force at the top; `None` where a single moment, or noise,
    /// has no direction.
    pub share_off_top: Option<f64>,
}

/// The residual of a wall in every stretch of every test that is long enough, half overlapping.
pub fn force_points(tests: &[TestData], physics: &Physics) -> Vec<ForcePoint> {
    let of = |(index, test): (usize, &TestData)| Residual::new(index, test, physics).points();
    tests.par_iter().enumerate().flat_map_iter(of).collect()
}

/// Median of the shares off the direction of the top that are known, and how many they are.
pub fn median_share_off_top(points: &[ForcePoint]) -> Option<(f64, usize)> {
    let mut shares = points.iter().filter_map(|p| p.share_off_top).collect::<Vec<_>>();
    shares.sort_by(f64::total_cmp);
    Some((*shares.get(shares.len() / 2)?, shares.len()))
}

/// One test under one wall.
pub(super) struct Residual {
    index: usize,
    pub(super) test: TestData,
    pub(super) wall: RockingWall,
    simulator: Simulator,
    past: TopPast,
    /// The largest |x_C| so far, m, by sample.
    pub(super) largest_m: Vec<f64>,
    /// Time (s) and displacement of the top (m) by sample.
    pub(super) path: Arc<[[f64; 2]]>,
}

impl Residual {
    pub(super) fn new(index: usize, test: &TestData, physics: &Physics) -> Self {
        // Rotations as they are, not as the sensors of this wall read them.
        let reading = physics.wall.reading();
        let mut test = test.clone();
        for theta in &mut test.theta_rad {
            *theta = [0, 1].map(|i| (theta[i] - reading.offset_rad[i]) / reading.gain[i]);
        }
        // What a sensor of this wall reads at rest, and its gain, are off now; they must not be taken off once more.
        test.rest_offset_rad = rest_offset_rad(&test.theta_rad, test.noise_rad);
        test.read_gain = [0, 1].map(|i| test.read_gain[i] / reading.gain[i]);
        let shaking = shaken(&test.shaking, physics.reversed_ratio);
        let wall = RockingWall::new(&physics.wall);
        Self {
            index,
            past: TopPast::new(&test, physics),
            largest_m: largest_so_far_m(&test, &wall),
            path: top_path(&test, &wall).into(),
            wall,
            simulator: Simulator::new(&physics.wall, &shaking, Accuracy::default()),
            test,
        }
    }

    fn points(mut self) -> Vec<ForcePoint> {
        let mut points = Vec::new();
        for (stretch, half) in self.telling(self.wall.response_time_s()) {
            let model = self.model(&stretch);
            let kernel = Kernel::new(half);
            for middle in (half..stretch.states.len() - half).step_by(half) {
                let point = self.point(&stretch, &kernel, &model, middle);
                let shorter = shorter(half, &point);
                points.push(match shorter < half {
                    true => self.point(&stretch, &Kernel::new(shorter), &model, middle),
                    false => point,
                });
            }
        }
        points
    }

    /// Stretches in motion that are long enough, each with half the reach of its test function, in samples; that follows the
    /// time of response of a wall, s.
    pub(super) fn telling(&self, response_time_s: f64) -> Vec<(Stretch, usize)> {
        let full = self.test.samples_in(HALF_REACH * response_time_s);
        let least = ((LEAST_REACH * full as f64) as usize).max(2);
        let reach = |stretch: &Stretch| full.min((stretch.states.len() - 1) / 2);
        let moving = stretches(&self.test).into_iter().filter(|stretch| stretch.freedom != Freedom::Rest);
        moving.map(|s| (reach(&s), s)).filter(|(half, _)| *half >= least).map(|(half, s)| (s, half)).collect()
    }

    /// Angular accelerations of the model at every sample of a stretch.
    pub(super) fn model(&mut self, stretch: &Stretch) -> Vec<Pair> {
        let at = |(i, state): (usize, &State)| {
            let k = stretch.from + i;
            let memory = self.past.memory(k, &self.wall, stretch.contact, state.theta);
            self.wall.enter_regime_of_state(stretch.contact, state, memory);
            self.wall.rate(stretch.contact, state, self.ground_about(self.test.time_s[k])).theta_dd
        };
        stretch.states.iter().enumerate().map(at).collect()
    }

    /// Ground acceleration about a sample, weighed as second differences weigh what is between samples: by a triangle.
    fn ground_about(&self, time_s: f64) -> Vector {
        let mut sum = Vector { x: 0.0, y: 0.0 };
        for part in 1 - PARTS..PARTS {
            let weight = f64::from(PARTS - part.abs()) / f64::from(PARTS * PARTS);
            let t = time_s + self.test.step_s * f64::from(part) / f64::from(PARTS);
            let ground = self.simulator.ground_m_s2(t.max(0.0));
            sum = Vector { x: sum.x + weight * ground.x, y: sum.y + weight * ground.y };
        }
        sum
    }

    fn point(&self, stretch: &Stretch, kernel: &Kernel, model: &[Pair], middle: usize) -> ForcePoint {
        let (contact, step_s) = (stretch.contact, self.test.step_s);
        let half = kernel.mean.len() / 2;
        let of_stretch = middle - half..=middle + half;
        let of_test = stretch.from + middle - half..=stretch.from + middle + half;
        let theta_rad = &self.test.theta_rad[of_test.clone()];
        let measured = [0, 1].map(|i| kernel.curvature_of(theta_rad.iter().map(|t| t[i]), step_s));
        let model = [0, 1].map(|i| kernel.mean_of(model[of_stretch.clone()].iter().map(|dd| dd[i])));
        let noise = self.test.noise_rad.map(|sigma| sigma * kernel.curvature_noise(step_s));
        let missing = one_pattern(stretch.freedom, [0, 1].map(|i| measured[i] - model[i]), noise);
        let theta = stretch.states[middle].theta;
        let per_force = self.wall.accelerations_by_force(contact, theta);
        let Missing { theta_dd, variance } = missing;
        // Least squares in standard deviations of the noise: the force that comes nearest to both accelerations.
        let weighed = |a: &dyn Fn(usize) -> f64| {
            let free = (0..2).filter(|&i| variance[i] > 0.0);
            free.map(|i| per_force[i] * a(i) / variance[i]).sum::<f64>()
        };
        let information = weighed(&|i| per_force[i]);
        let top_m = theta_rad.iter().map(|t| self.wall.top_displacement_m(contact, *t)).collect::<Vec<_>>();
        let ground = of_test.map(|k| self.ground_about(self.test.time_s[k]).x);
        ForcePoint {
            test: self.index,
            time_s: self.test.time_s[stretch.from + middle],
            contact,
            displacement_m: kernel.mean_of(top_m.iter().copied()),
            velocity_m_s: kernel.slope_of(&top_m, step_s),
            acceleration_m_s2: kernel.curvature_of(top_m.iter().copied(), step_s) + kernel.mean_of(ground),
            moment_n_m: self.moments(stretch.freedom, contact, theta, theta_dd),
            force_n: weighed(&|i| theta_dd[i]) / information,
            force_sd_n: information.powf(-0.5),
            share_off_top: self.share_off_top(stretch.freedom, contact, theta, &missing),
        }
    }

    fn moments(&self, freedom: Freedom, contact: Contact, theta: Pair, theta_dd: Pair) -> [Option<f64>; 2] {
        let [m1, m2] = self.wall.moments_n_m(contact, theta, theta_dd);
        match freedom {
            Freedom::Rest | Freedom::Held => [None, None],
            Freedom::Monolithic => [Some(m1 + m2), None],
            Freedom::Upper => [None, Some(m2)],
            Freedom::Both => [Some(m1), Some(m2)],
        }
    }

    fn share_off_top(
        &self,
        freedom: Freedom,
        contact: Contact,
        theta: Pair,
        missing: &Missing,
    ) -> Option<f64> {
        let size = (0..2).map(|i| missing.theta_dd[i].powi(2) / missing.variance[i]).sum::<f64>();
        if freedom != Freedom::Both || size < DIRECTION_CLEAR {
            return None;
        }
        let m = self.wall.moments_n_m(contact, theta, missing.theta_dd);
        let [y_q, y_c] = self.wall.top_arms_m(contact, theta);
        let across = m[0] * y_c - m[1] * y_q;
        Some(across * across / ((m[0] * m[0] + m[1] * m[1]) * (y_q * y_q + y_c * y_c)))
    }
}

/// The shortest reach that tells a force as well as is asked: its noise grows as the reach to the power of -5/2.
fn shorter(half: usize, point: &ForcePoint) -> usize {
    let share = (point.force_sd_n / (KNOWN_TO * point.force_n.abs())).powf(0.4);
    ((share * half as f64).ceil() as usize).max(LEAST_HALF).min(half)
}

/// Angular accelerations that the model lacks, and their variances by noise; a body that cannot move has neither.
#[derive(Debug, Clone, Copy)]
struct Missing {
    theta_dd: Pair,
    variance: Pair,
}

/// In pattern 3 both channels measure one rotation; in pattern 4 the lower body stands.
fn one_pattern(freedom: Freedom, theta_dd: Pair, noise: Pair) -> Missing {
    let variance = noise.map(|sd| sd * sd);
    match freedom {
        Freedom::Monolithic => {
            let weight = variance.map(|v| 1.0 / v);
            let total = weight[0] + weight[1];
            let mean = (weight[0] * theta_dd[0] + weight[1] * theta_dd[1]) / total;
            // The same number in both, counted once.
            Missing { theta_dd: [mean; 2], variance: [1.0 / total, 0.0] }
        }
        Freedom::Upper => Missing { theta_dd: [0.0, theta_dd[1]], variance: [0.0, variance[1]] },
        _ => Missing { theta_dd, variance },
    }
}

/// Weights over 2 h + 1 samples.
///
/// φ sums to 1, and φ ∝ (1 - s²)² but for the step. The weights of curvature are its second differences: Σ φ_j x''_j
/// = Σ c_j x_j, with x'' averaged over each sample and its neighbours. They are those of a parabola through the
/// samples in least squares, so no other weights of this reach know x'' better under white noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    /// φ_j.
    pub mean: Vec<f64>,
    /// c_j, for samples at distance 1.
    pub curvature: Vec<f64>,
}

impl Kernel {
    /// Over `half` samples to either side of the middle, 1 or more.
    pub fn new(half: usize) -> Self {
        let j = || (0..=2 * half).map(|i| i as f64 - half as f64);
        let moment = |p: i32| j().map(|x| x.powi(p)).sum::<f64>();
        let (s0, s2, s4) = (moment(0), moment(2), moment(4));
        let curvature = j().map(|x| 2.0 * (s0 * x * x - s2) / (s0 * s4 - s2 * s2)).collect::<Vec<_>>();
        // φ from its second differences: 0 at the first sample, and before it.
        let (mut slope, mut value) = (0.0, 0.0);
        let mean = curvature
            .iter()
            .map(|c| {
                let here = value;
                slope += c;
                value += slope;
                here
            })
            .collect();
        Self { mean, curvature }
    }

    /// Σ φ_j x_j.
    pub fn mean_of(&self, x: impl IntoIterator<Item = f64>) -> f64 {
        self.mean.iter().zip(x).map(|(w, x)| w * x).sum()
    }

    /// Σ c_j x_j over the square of the step: the mean second derivative.
    pub fn curvature_of(&self, x: impl IntoIterator<Item = f64>, step_s: f64) -> f64 {
        self.curvature.iter().zip(x).map(|(w, x)| w * x).sum::<f64>() / (step_s * step_s)
    }

    /// Σ φ_j x'_j by central differences, which only the inner samples need.
    pub fn slope_of(&self, x: &[f64], step_s: f64) -> f64 {
        let inner = 1..self.mean.len() - 1;
        inner.map(|j| self.mean[j] * (x[j + 1] - x[j - 1])).sum::<f64>() / (2.0 * step_s)
    }

    /// Standard deviation of the mean second derivative by white noise of 1.
    pub fn curvature_noise(&self, step_s: f64) -> f64 {
        self.curvature.iter().map(|c| c * c).sum::<f64>().sqrt() / (step_s * step_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_the_weights_are_a_test_function_and_its_second_differences() {
        let kernel = Kernel::new(9);
        assert!((kernel.mean.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(kernel.mean.iter().all(|w| *w > -1e-15), "{kernel:?}");
        assert!(kernel.mean[0].abs() < 1e-15 && kernel.mean[18].abs() < 1e-12);
        // Any x at all: both sides are the same sum.
        let x = (0..19).map(|i| f64::from(i * i * i % 7)).collect::<Vec<_>>();
        let differences = (1..18).map(|j| kernel.mean[j] * (x[j + 1] - 2.0 * x[j] + x[j - 1])).sum::<f64>();
        assert!((kernel.curvature_of(x, 1.0) - differences).abs() < 1e-12);
        // A parabola to roundings of squares up to 400.
        let parabola = (0..19).map(|i| 0.5 * 3.0 * f64::from(i * i) - f64::from(i)).collect::<Vec<_>>();
        assert!((kernel.curvature_of(parabola.clone(), 0.1) - 300.0).abs() < 1e-9);
        assert!((kernel.slope_of(&parabola, 1.0) - (3.0 * 9.0 - 1.0)).abs() < 1e-10);
    }
}
