//! Errors over whole runs for numbers that fit a hypothesis as well as the fitted ones.

use nalgebra::DVector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::diagnose::trials::Tried;
use mrbd_kernel::model::Wall;

/// Draws beside the fitted numbers.
const DRAWS: usize = 8;
/// Seed of the draws.
const SEED: u64 = 11;

/// The wall as fitted, and walls drawn from the covariance of the fit, within bounds; the fitted one alone where the fit
/// leaves no covariance. `None` if the fitted numbers are no wall.
///
/// An impact system is nearly chaotic: the error of one whole run says little without those of its neighbours.
pub fn ensemble(tried: &Tried) -> Option<Vec<Wall>> {
    let h = &tried.hypothesis;
    let fitted = DVector::from_column_slice(&tried.fit.values);
    let mut walls = vec![h.physics(&tried.fit.values)?.wall];
    let Some(factor) = tried.fit.covariance.clone().and_then(|c| c.cholesky()) else { return Some(walls) };
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    for _ in 0..DRAWS {
        let normal = DVector::from_fn(fitted.len(), |_, _| StandardNormal.sample(&mut random));
        let drawn = &fitted + factor.l() * normal;
        let within = h.unknowns.iter().zip(drawn.iter()).map(|(u, value)| value.clamp(u.lower, u.upper));
        walls.extend(h.physics(&within.collect::<Vec<_>>()).map(|physics| physics.wall));
    }
    Some(walls)
}
