//! Signed errors of every sample, and their slopes by the variables of a search.

use nalgebra::{DMatrix, DVector};

use super::prior::LnPrior;
use super::search::Bounds;
use mrbd_files::error::Result;

/// The cost of a vector and its signed errors, the sum of whose sizes goes with the cost.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fitted {
    pub cost: f64,
    pub residuals: Vec<f64>,
}

/// Simulates vectors with their errors; none for one whose runs could not be finished.
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

/// Slopes of the errors, one row an error, one column a variable, over shares of the bounds; a side whose runs could not
/// be finished is replaced by the middle, and the slope is zero where both are.
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
