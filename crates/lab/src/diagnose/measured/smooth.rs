//! Smoothed rotations and velocities at an instant: a cubic through the samples around it.

/// Samples to either side of the middle.
pub const HALF: usize = 8;
const COUNT: usize = 2 * HALF + 1;
/// Free numbers of a cubic.
pub const CUBIC: f64 = 4.0;

/// A channel about the middle of 2 [`HALF`] + 1 samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// Value in the middle.
    pub value: f64,
    /// Slope in the middle, per sample.
    pub slope: f64,
    /// Curvature in the middle, per sample squared.
    pub curvature: f64,
    /// Sum of the squared residuals of the cubic.
    pub residual: f64,
}

/// Least squares of a cubic: even and odd parts are orthogonal on a symmetric grid (Savitzky and Golay).
pub fn local(y: &[f64; COUNT]) -> Local {
    let x = |i: usize| i as f64 - HALF as f64;
    let moment = |p: i32| (0..COUNT).map(|i| x(i).powi(p)).sum::<f64>();
    let with = |p: i32| (0..COUNT).map(|i| x(i).powi(p) * y[i]).sum::<f64>();
    let (s0, s2, s4, s6) = (COUNT as f64, moment(2), moment(4), moment(6));
    let even = s0 * s4 - s2 * s2;
    let odd = s2 * s6 - s4 * s4;
    let a0 = (s4 * with(0) - s2 * with(2)) / even;
    let a2 = (s0 * with(2) - s2 * with(0)) / even;
    let a1 = (s6 * with(1) - s4 * with(3)) / odd;
    let a3 = (s2 * with(3) - s4 * with(1)) / odd;
    let fitted = |i: usize| a0 + x(i) * (a1 + x(i) * (a2 + x(i) * a3));
    let residual = (0..COUNT).map(|i| (y[i] - fitted(i)).powi(2)).sum();
    Local { value: a0, slope: a1, curvature: 2.0 * a2, residual }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_given_back() {
        let at = |i: usize| {
            let x = i as f64 - HALF as f64;
            0.3 - 0.2 * x + 0.05 * x * x + 0.01 * x * x * x
        };
        let found = local(&std::array::from_fn(at));
        // Roundings of sums of cubes up to 512.
        assert!((found.value - 0.3).abs() < 1e-12 && (found.slope + 0.2).abs() < 1e-12);
        assert!((found.curvature - 0.1).abs() < 1e-12 && found.residual < 1e-20);
    }
}
