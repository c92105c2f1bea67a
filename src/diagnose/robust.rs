//! A loss that lets go of windows no model follows.
//!
//! Some windows hold an impact decided by less than the noise: the true model misses them too. With S the reduced
//! chi-square of a window, the loss is S/(1 + S/c) (Geman and McClure): c bounds what one window can cost.

/// Bound on the loss of a window at the end of a fit.
pub const LAST_BOUND: f64 = 3.0;
/// Bounds before it.
const MIDDLE_BOUND: f64 = 8.0;
const FIRST_BOUND: f64 = 20.0;

/// The loss.
pub fn loss(reduced: f64, bound: f64) -> f64 {
    reduced / (1.0 + reduced / bound)
}

/// Its slope: the weight of a window in least squares.
pub fn weight(reduced: f64, bound: f64) -> f64 {
    (1.0 + reduced / bound).powi(-2)
}

/// Bounds in the order a fit goes through them, from one that two thirds of the windows lie well inside.
pub fn bounds(mut reduced: Vec<f64>) -> [f64; 3] {
    reduced.sort_by(f64::total_cmp);
    let two_thirds = reduced.get(reduced.len() * 2 / 3).copied().unwrap_or(1.0);
    [(3.0 * two_thirds).max(FIRST_BOUND), MIDDLE_BOUND, LAST_BOUND]
}
