//! Walls that fit about as well as a fitted one.

use super::hypothesis::Unknown;
use super::trials::FittedHypothesis;
use mrbd_kernel::model::Wall;
use nalgebra::DVector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Draws beside the fitted numbers.
const DRAWS: usize = 8;
/// Seed of the draws.
const SEED: u64 = 11;

/// The wall as fitted, and walls drawn from the covariance of the fit, within bounds. Without a covariance the fitted
/// one is alone. `None` if the fitted numbers are no wall.
///
/// An impact system is nearly chaotic: the error of one whole run says little without those of its neighbours.
pub fn ensemble(tried: &FittedHypothesis) -> Option<Vec<Wall>> {
    let h = &tried.hypothesis;
    let fitted = DVector::from_column_slice(&tried.fit.values);
    let mut walls = vec![h.physics(&tried.fit.values)?.wall];
    let Some(covariance) = tried.fit.covariance.clone() else { return Some(walls) };
    let Some(factor) = covariance.clone().cholesky() else { return Some(walls) };
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    for _ in 0..DRAWS {
        let normal = DVector::from_fn(fitted.len(), |_, _| StandardNormal.sample(&mut random));
        let drawn = &fitted + factor.l() * normal;
        // A number that the tests do not tell stays as it is: whole runs hardly depend on it, and dampers of a sharp edge may be so
        // large that they do not end.
        let near = |(i, u): (usize, &Unknown)| {
            let is_told = covariance[(i, i)].sqrt() < u.scale;
            if is_told { drawn[i].clamp(u.lower, u.upper) } else { fitted[i] }
        };
        let within = h.unknowns.iter().enumerate().map(near);
        walls.extend(h.physics(&within.collect::<Vec<_>>()).map(|physics| physics.wall));
    }
    Some(walls)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::Fit;
    use crate::diagnose::hypothesis::example::starter_with;
    use nalgebra::DMatrix;
    use std::collections::BTreeSet;

    #[test]
    fn analytic_a_number_that_is_not_told_is_not_drawn() {
        let h = starter_with(&["viscous_damping"]);
        let scale = h.unknowns[0].scale;
        let walls = |sd: f64| {
            let covariance = Some(DMatrix::from_element(1, 1, sd * sd));
            let fit = Fit { values: vec![scale], windows: Vec::new(), cost: 0.0, covariance };
            let tried = FittedHypothesis { hypothesis: h.clone(), fit: fit.clone(), held_out: fit };
            let walls = ensemble(&tried).expect("a wall");
            walls.iter().map(|wall| format!("{:?}", wall.parameters())).collect::<BTreeSet<_>>().len()
        };
        assert_eq!(walls(10.0 * scale), 1);
        assert_eq!(walls(0.01 * scale), 1 + DRAWS);
    }
}
