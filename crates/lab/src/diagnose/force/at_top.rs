//! Whether what is missing is a horizontal force at the top, whatever its law.

use super::explained::explained_by;
use super::law_curves::Against;
use super::points::{ForcePoint, median_share_off_top};

/// Share of the squared moments off the direction of the top below which they are of a force there. Twins of forces at the
/// top have 1e-3 and less, a record 0.01 s late 0.1.
pub const ALONG: f64 = 0.03;
/// Fewest stretches with a direction.
const LEAST_POINTS: usize = 3;
/// Share that a curve against one quantity must explain: chosen; a stop outside the catalogue has 0.999, dampers of twins
/// more than 0.9.
const EXPLAINED: f64 = 0.8;

/// Whether the points lie along the direction of a force at the top, and on a curve against what the top does.
///
/// Wrong corners make a curve of displacement too, a step at zero, but off that direction.
pub fn acts_at_top(points: &[ForcePoint]) -> bool {
    let along =
        median_share_off_top(points).is_some_and(|(share, count)| share < ALONG && count >= LEAST_POINTS);
    let explained = |against| explained_by(points, against).is_some_and(|share| share > EXPLAINED);
    along && Against::ALL.into_iter().any(explained)
}
