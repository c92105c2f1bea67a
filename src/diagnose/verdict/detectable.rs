//! How large an effect must be to show in these tests.

use crate::diagnose::trials::{Tried, kinds};

/// Standard deviations from doing nothing at which an effect is detected: it is then so large by chance once in a
/// thousand times.
pub const DETECTED: f64 = 3.3;

/// Whether at least half of the effects, at a size that matters, would have been told from nothing.
pub fn could_show(singles: &[Tried]) -> bool {
    let sizes = singles.iter().filter_map(detectable).collect::<Vec<_>>();
    2 * sizes.iter().filter(|(smallest, matters)| smallest < matters).count() >= sizes.len()
}

/// The smallest size of a single effect that would be told from nothing, by its first number, and the size that matters;
/// none where its fit leaves no covariance, or it is no effect.
pub fn detectable(tried: &Tried) -> Option<(f64, f64)> {
    let h = &tried.hypothesis;
    let i = h.nuisances;
    kinds(tried)?;
    let variance = tried.fit.covariance.as_ref()?[(i, i)];
    Some((DETECTED * variance.max(0.0).sqrt(), h.unknowns.get(i)?.scale))
}
