//! The test function of the weak form, over samples at equal times.

/// Weights over 2 h + 1 samples.
///
/// φ sums to 1, φ ∝ (1 - s²)² but for the step, and the weights of curvature are its second differences: Σ φ_j x''_j =
/// Σ c_j x_j with x'' averaged over each sample and its neighbours. They are those of a parabola through the samples in
/// least squares, so no other weights of this reach know x'' better under white noise.
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
