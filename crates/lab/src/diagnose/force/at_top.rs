//! Whether what is missing is a horizontal force at the top, whatever its law.

use super::explained::explained_by;
use super::law_curves::Against;
use super::points::{ForcePoint, median_share_off_top};
use crate::limits::{ALONG_TOP, EXPLAINED_BY_ONE, LEAST_DIRECTIONS};

/// Whether the points lie along the direction of a force at the top, and on a curve against what the top does.
///
/// Wrong corners make a curve of displacement too, a step at zero, but off that direction.
pub fn acts_at_top(points: &[ForcePoint]) -> bool {
    let along = median_share_off_top(points)
        .is_some_and(|(share, count)| share < ALONG_TOP && count >= LEAST_DIRECTIONS);
    let explained = |against| explained_by(points, against).is_some_and(|share| share > EXPLAINED_BY_ONE);
    along && Against::ALL.into_iter().any(explained)
}
