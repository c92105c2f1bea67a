//! Signed errors of every sample, and their slopes: by the variables of a search, or along the axes of a valley.
//!
//! The axes are directions in which the cost rises alike, however narrow or slanting the valley is.

use nalgebra::{DMatrix, DVector};

use super::objective::LnPrior;
use super::search::Bounds;
use mrbd_files::error::Result;

/// The cost of a vector and its signed errors, the sum of whose sizes goes with the cost.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fitted {
    pub cost: f64,
    pub residuals: Vec<f64>,
}

/// Simulates vectors with their errors; `None` for one whose runs could not be finished.
pub(super) trait Fit {
    fn fitted(&mut self, generation: u32, candidates: &[Vec<f64>]) -> Result<Vec<Option<Fitted>>>;

    /// How the logarithm of the cost grows with what was known beforehand, about a vector.
    fn ln_prior(&self, values: &[f64]) -> LnPrior {
        LnPrior::flat(values.len())
    }
}

/// Vectors below and above in each variable by turns; differences are shares of the bounds.
pub(super) fn sides(values: &[f64], differences: &[f64], bounds: &[Bounds]) -> Vec<Vec<f64>> {
    let side = |v: usize, sign: f64| {
        let mut moved = values.to_vec();
        moved[v] = bounds[v].clamp(values[v] + sign * differences[v] * bounds[v].width());
        moved
    };
    (0..bounds.len()).flat_map(|v| [side(v, -1.0), side(v, 1.0)]).collect()
}

/// Slopes of the errors, one row an error, one column a variable, over shares of the bounds. A side whose runs could
/// not be finished is replaced by the middle. The slope is zero where both are.
pub(super) fn slopes(
    values: &[f64],
    sides: &[Vec<f64>],
    around: &[Option<Fitted>],
    now: &Fitted,
    bounds: &[Bounds],
) -> DMatrix<f64> {
    let column = |v: usize| {
        let at = |side: usize| match &around[side] {
            Some(fitted) => (sides[side][v], &fitted.residuals),
            None => (values[v], &now.residuals),
        };
        let ((below, errors_below), (above, errors_above)) = (at(2 * v), at(2 * v + 1));
        let share = (above - below) / bounds[v].width();
        let slope = |k: usize| if share > 0.0 { (errors_above[k] - errors_below[k]) / share } else { 0.0 };
        DVector::from_fn(now.residuals.len(), |k, _| slope(k))
    };
    DMatrix::from_columns(&(0..bounds.len()).map(column).collect::<Vec<_>>())
}

/// A vector and the axes about it.
pub(super) struct Axes<'a> {
    pub about: &'a [f64],
    /// One axis a column, in shares of the bounds.
    pub root: &'a DMatrix<f64>,
    pub bounds: &'a [Bounds],
}

impl Axes<'_> {
    /// The vector so many lengths along each axis, within the bounds.
    pub fn at(&self, lengths: &DVector<f64>) -> Vec<f64> {
        let step = self.root * lengths;
        let all = self.about.iter().zip(self.bounds).zip(step.iter());
        all.map(|((x, b), step): ((&f64, &Bounds), &f64)| b.clamp(x + step * b.width())).collect()
    }

    /// Vectors a length below and above along each axis by turns.
    pub fn sides(&self) -> Vec<Vec<f64>> {
        let n = self.bounds.len();
        let side =
            |v: usize, sign: f64| self.at(&DVector::from_fn(n, |k, _| if k == v { sign } else { 0.0 }));
        (0..n).flat_map(|v| [side(v, -1.0), side(v, 1.0)]).collect()
    }

    /// Slopes of the errors, one row an error, one column an axis; `None` where the bounds leave no room for an axis.
    pub fn slopes(
        &self,
        sides: &[Vec<f64>],
        around: &[Option<Fitted>],
        now: &Fitted,
    ) -> Option<DMatrix<f64>> {
        let n = self.bounds.len();
        let (mut moved, mut changes) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for v in 0..n {
            let at = |side: usize| match &around[side] {
                Some(fitted) => (sides[side].as_slice(), &fitted.residuals),
                None => (self.about, &now.residuals),
            };
            let ((below, errors_below), (above, errors_above)) = (at(2 * v), at(2 * v + 1));
            let share = |k: usize| (above[k] - below[k]) / self.bounds[k].width();
            moved.push(DVector::from_fn(n, |k, _| share(k)));
            changes.push(DVector::from_fn(now.residuals.len(), |k, _| errors_above[k] - errors_below[k]));
        }
        let lengths = self.root.clone().try_inverse()? * DMatrix::from_columns(&moved);
        Some(DMatrix::from_columns(&changes) * lengths.try_inverse()?)
    }

    /// What was known beforehand along the axes, of each by itself.
    pub fn prior(&self, ln: &LnPrior) -> LnPrior {
        let squares = self.root.map(|x| x * x).transpose();
        LnPrior {
            slope: self.root.transpose() * &ln.slope,
            curvature: &squares * &ln.curvature,
            scatter: (squares * ln.scatter.map(|x| x * x)).map(f64::sqrt),
        }
    }

    /// The axes of a root in these axes, no longer than a share of the bounds.
    pub fn next(&self, root: &DMatrix<f64>, widest: f64) -> Option<DMatrix<f64>> {
        let n = self.bounds.len();
        let inverse = (self.root * root).try_inverse()?;
        let precision = inverse.transpose() * inverse + DMatrix::from_diagonal_element(n, n, widest.powi(-2));
        precision.cholesky()?.l().transpose().try_inverse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_slopes_along_slanting_axes_are_those_of_linear_errors() {
        let bounds = [Bounds { lower: 0.0, upper: 2.0 }, Bounds { lower: 1.0, upper: 1.5 }];
        let root = DMatrix::from_row_slice(2, 2, &[0.1, 1e-4, 0.0, -1e-4]);
        // About a vector so near a bound that one side is cut off there.
        let axes = Axes { about: &[0.1, 1.2], root: &root, bounds: &bounds };
        let fitted =
            |x: &Vec<f64>| Fitted { cost: 0.0, residuals: vec![x[0] - 3.0 * x[1], 2.0 * x[0] + x[1], x[1]] };
        let sides = axes.sides();
        let around = sides.iter().map(|x| Some(fitted(x))).collect::<Vec<_>>();
        let slopes = axes.slopes(&sides, &around, &fitted(&vec![0.1, 1.2])).expect("room along both axes");
        // By shares of the bounds, 2 and 0.5 wide, times the axes.
        let by_share = DMatrix::from_row_slice(3, 2, &[2.0, -1.5, 4.0, 0.5, 0.0, 0.5]);
        // Differences of numbers near one over steps of 1e-4: roundings of 1e-12.
        assert!((slopes - by_share * &root).amax() < 1e-11);
    }

    #[test]
    fn analytic_the_next_axes_are_of_the_shape_they_are_given_but_no_longer_than_allowed() {
        let bounds = [Bounds { lower: 0.0, upper: 1.0 }; 2];
        let root = DMatrix::from_row_slice(2, 2, &[1e-3, 2e-3, 0.0, 1e-3]);
        let axes = Axes { about: &[0.5, 0.5], root: &root, bounds: &bounds };
        let next =
            axes.next(&DMatrix::from_diagonal(&DVector::from_vec(vec![0.5, 2.0])), 1e3).expect("a valley");
        let expected = &root * DMatrix::from_diagonal(&DVector::from_vec(vec![0.25, 4.0])) * root.transpose();
        // Roundings of a covariance of 1e-5, whose inverse has a condition of some hundred.
        assert!((&next * next.transpose() - expected).amax() < 1e-10);
        let cut = axes.next(&(DMatrix::identity(2, 2) * 1e6), 0.1).expect("a valley");
        // A thousand bounds wide, cut to a tenth; 1e-8 of which the valley's own width changes.
        assert!((&cut * cut.transpose() - DMatrix::identity(2, 2) * 0.01).amax() < 1e-6);
    }
}
