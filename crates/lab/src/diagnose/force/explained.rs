//! How much of the missing force is a curve against one quantity, whatever the curve.

use super::law_curves::Against;
use super::points::ForcePoint;
use crate::limits::FORCE_CLEAR;

/// A point says nothing if its noise is so many times the usual and such a share of its force.
const NOISY: f64 = 2.0;
const NOISY_SHARE: f64 = 0.2;

/// Share of the squared missing force, noise taken off, that a line from neighbour to neighbour explains at each point
/// without the point itself; `None` where the force is hardly more than noise.
///
/// 1: the force is a function of this quantity alone, sampled closely enough; 0 or less: it is none.
pub fn explained_by(points: &[ForcePoint], against: Against) -> Option<f64> {
    let mut points = telling(points);
    points.sort_by(|a, b| against.of(a).total_cmp(&against.of(b)));
    let inner = points.get(1..points.len().saturating_sub(1))?;
    let force = inner.iter().map(|p| p.force_n.powi(2)).sum::<f64>();
    let noise = inner.iter().map(|p| p.force_sd_n.powi(2)).sum::<f64>();
    if inner.is_empty() || force < FORCE_CLEAR * noise {
        return None;
    }
    let mut left = 0.0;
    for trio in points.windows(3) {
        let [before, here, after] = [trio[0], trio[1], trio[2]];
        let [x0, x, x1] = [before, here, after].map(|p| against.of(p));
        let share = if x1 > x0 { (x - x0) / (x1 - x0) } else { 0.5 };
        let apart = here.force_n - (1.0 - share) * before.force_n - share * after.force_n;
        let part = |share: f64, p: &ForcePoint| (share * p.force_sd_n).powi(2);
        left += apart * apart - part(1.0, here) - part(1.0 - share, before) - part(share, after);
    }
    Some(1.0 - left.max(0.0) / (force - noise))
}

fn telling(points: &[ForcePoint]) -> Vec<&ForcePoint> {
    let mut noise = points.iter().map(|p| p.force_sd_n).collect::<Vec<_>>();
    noise.sort_by(f64::total_cmp);
    let usual = noise.get(noise.len() / 2).copied().unwrap_or(0.0);
    let tells =
        |p: &&ForcePoint| p.force_sd_n < NOISY * usual || p.force_sd_n < NOISY_SHARE * p.force_n.abs();
    points.iter().filter(tells).collect()
}
