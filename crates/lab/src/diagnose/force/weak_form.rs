//! The equations of motion of every stretch in weak form, so that any law can be held against them.
//!
//! A law of the mean is not the mean of the law: a stretch keeps its samples, and what a law does at each of them is
//! weighed with the test function as the measured motion is.

use std::sync::Arc;

use super::jumps::Stretch;
use super::points::{Kernel, Residual};
use crate::diagnose::formula::Site;
use crate::diagnose::hypothesis::Physics;
use crate::experiment::{Freedom, TestData};
use mrbd_kernel::model::{Pair, State};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

/// What moves at each place at an instant, and what a unit of force or moment there does to the free bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// By place: displacement, velocity and the largest displacement so far, which is told at the top alone; m and m/s at
    /// the top, rad and rad/s at joints.
    pub motion: [[f64; 3]; 3],
    /// By place: angular accelerations of both bodies by 1 N or 1 N m, rad/s².
    by_unit: [Pair; 3],
}

/// The weak form over one stretch of one contact state.
#[derive(Debug, Clone)]
pub struct WeakStretch {
    /// The test, by its place in the experiment.
    pub test: usize,
    /// Every sample of the stretch.
    pub samples: Vec<Sample>,
    /// The first of them, by sample of the test.
    pub from: usize,
    /// Times (s) and displacements of the top (m) of the whole test, for laws that carry a state along.
    pub path: Arc<[[f64; 2]]>,
    /// Middles of the supports of the test function, by sample of the stretch.
    middles: Vec<usize>,
    kernel: Kernel,
    /// The bodies that are told, with the noise of their mean accelerations, rad/s².
    bodies: Vec<(usize, f64)>,
    /// Factor of the correlations of noise between overlapping supports.
    correlations: Cholesky<f64, Dyn>,
    /// Angular accelerations that the model lacks, over the noise and free of correlation.
    missing: Vec<f64>,
}

/// The weak form of a wall in every stretch of tests that is long enough for test functions of a wall of this time of
/// response, s: so a wall whose numbers move a little has the same rows.
pub fn weak_stretches(
    tests: &[(usize, &TestData)],
    physics: &Physics,
    response_time_s: f64,
) -> Vec<WeakStretch> {
    let of = |(index, test): &(usize, &TestData)| {
        let mut residual = Residual::new(*index, test, physics);
        let telling = residual.telling(response_time_s);
        telling
            .into_iter()
            .filter_map(|(stretch, half)| WeakStretch::new(*index, &mut residual, &stretch, half))
            .collect::<Vec<_>>()
    };
    tests.par_iter().flat_map_iter(of).collect()
}

impl WeakStretch {
    fn new(index: usize, residual: &mut Residual, stretch: &Stretch, half: usize) -> Option<Self> {
        let model = residual.model(stretch);
        let (test, kernel) = (&residual.test, Kernel::new(half));
        let middles = (half..stretch.states.len() - half).step_by(half).collect::<Vec<_>>();
        let bodies = bodies(stretch.freedom, test.noise_rad, kernel.curvature_noise(test.step_s));
        let mut weak = Self {
            test: index,
            from: stretch.from,
            path: Arc::clone(&residual.path),
            samples: (0..stretch.states.len()).map(|i| sample(residual, stretch, i)).collect(),
            correlations: correlations(&kernel, half, middles.len())?,
            middles,
            kernel,
            bodies,
            missing: Vec::new(),
        };
        let channels = channels(stretch.freedom, test.noise_rad);
        let at = |body: usize, middle: usize| {
            let around = stretch.from + middle - half..=stretch.from + middle + half;
            let read = test.theta_rad[around].iter().map(|theta| channels(body, *theta));
            let measured = weak.kernel.curvature_of(read, test.step_s);
            measured - weak.mean(middle, |k| model[k][body])
        };
        weak.missing = weak.whitened(at);
        Some(weak)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.missing.len()
    }

    /// What the model lacks, over the noise: a row for each body and support.
    pub fn missing(&self) -> &[f64] {
        &self.missing
    }

    /// The same rows for a force or moment at a place, given at every sample.
    pub fn by_law(&self, site: Site, law: &[f64]) -> Vec<f64> {
        let by = |k: usize, body: usize| self.samples[k].by_unit[site as usize][body];
        self.whitened(|body, middle| self.mean(middle, |k| by(k, body) * law[k]))
    }

    /// A quantity of samples, weighed with the test function about a middle.
    fn mean(&self, middle: usize, of: impl Fn(usize) -> f64) -> f64 {
        let half = self.kernel.mean.len() / 2;
        self.kernel.mean_of((middle - half..=middle + half).map(of))
    }

    /// Rows of a quantity of body and middle, over the noise and free of correlation.
    fn whitened(&self, of: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.bodies.len() * self.middles.len());
        for &(body, noise) in &self.bodies {
            let values = self.middles.iter().map(|middle| of(body, *middle) / noise);
            let mut column = DVector::from_iterator(self.middles.len(), values);
            // The factor has a positive diagonal.
            self.correlations.l_dirty().solve_lower_triangular_mut(&mut column);
            rows.extend(column.iter());
        }
        rows
    }
}

fn sample(residual: &Residual, stretch: &Stretch, i: usize) -> Sample {
    let (wall, contact) = (&residual.wall, stretch.contact);
    let State { theta, omega } = stretch.states[i];
    let arms = wall.top_arms_m(contact, theta);
    let of_moments = |moments: Pair| wall.accelerations_by_moments(contact, theta, moments);
    let x_c = wall.top_displacement_m(contact, theta);
    let largest_m = residual.largest_m[stretch.from + i].max(x_c.abs());
    Sample {
        motion: [
            [x_c, arms[0] * omega[0] + arms[1] * omega[1], largest_m],
            [theta[0], omega[0], 0.0],
            [theta[1] - theta[0], omega[1] - omega[0], 0.0],
        ],
        by_unit: [of_moments(arms), of_moments([1.0, 0.0]), of_moments([-1.0, 1.0])],
    }
}

/// Bodies whose motion is told, with the noise of the mean of their acceleration. In pattern 3 both channels measure
/// one rotation, counted once; in pattern 4 the lower body stands.
fn bodies(freedom: Freedom, noise_rad: Pair, of_noise: f64) -> Vec<(usize, f64)> {
    let [lower, upper] = noise_rad.map(|sigma| sigma * of_noise);
    match freedom {
        Freedom::Rest | Freedom::Held => Vec::new(),
        Freedom::Monolithic => vec![(0, lower * upper / lower.hypot(upper))],
        Freedom::Upper => vec![(1, upper)],
        Freedom::Both => vec![(0, lower), (1, upper)],
    }
}

/// How the rotation of a body follows from both channels.
fn channels(freedom: Freedom, noise_rad: Pair) -> impl Fn(usize, Pair) -> f64 {
    let weight = noise_rad.map(|sigma| sigma.powi(-2));
    let together = freedom == Freedom::Monolithic;
    move |body, theta| match together {
        true => (weight[0] * theta[0] + weight[1] * theta[1]) / (weight[0] + weight[1]),
        false => theta[body],
    }
}

/// Correlations of the noise of mean accelerations over supports half overlapping: those of their weights.
fn correlations(kernel: &Kernel, half: usize, count: usize) -> Option<Cholesky<f64, Dyn>> {
    let c = &kernel.curvature;
    let shared = |by: usize| c.iter().zip(c.iter().skip(by * half)).map(|(a, b)| a * b).sum::<f64>();
    let all = shared(0);
    DMatrix::from_fn(count, count, |i, k| shared(i.abs_diff(k)) / all).cholesky()
}
