//! Intervals and correlations: where the best vector would lie had other stretches of the tests been measured.
//!
//! Every test is cut into blocks of equal length. A replicate draws as many blocks again, with replacement (B. Efron,
//! R. Tibshirani (1993), "An introduction to the bootstrap", sections 8.6 and 13.3: blocks, percentiles), and the vector
//! moves to where its errors are least. Near the best vector errors are linear in the values. So this is one step of
//! Newton's method, and costs no simulation. Errors count as in Eq. 8, by their size; about zero, where the size has
//! a corner, by their square up to the median (P. J. Huber (1981), "Robust statistics", section 7.6: the curvature is
//! that of the errors below it).
//!
//! Slopes are differences as wide as the intervals, which average the roughness of the misfit. What makes intervals too
//! narrow all the same: an error that lasts from one block into the next, and another valley that no search found.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::least_absolute::median_size;
use super::objective::LnPrior;
use super::search::{Bounds, Draws};
use super::slopes::{Fit, sides, slopes};
use crate::experiment::misfit::BLOCKS;
use mrbd_files::error::Result;

/// Half-widths of the first differences, as a share of the bounds.
const FIRST_DIFFERENCE: f64 = 0.01;
/// Half-widths of the second, which are standard deviations, are kept within these: below, a burst's roughness shows;
/// above, curvature does.
const DIFFERENCES: [f64; 2] = [0.002, 0.1];

/// What the bootstrap needs to know.
#[derive(Debug)]
pub(super) struct Bootstrap<'a> {
    /// Bounds of the variables.
    pub bounds: &'a [Bounds],
    /// The variables that move.
    pub free: &'a [usize],
    /// Block of each error: those of the first test from 0 to [`BLOCKS`] - 1, of the second from there on, ...
    pub blocks: &'a [usize],
    /// Number of replicates.
    pub replicates: usize,
}

/// Slope and curvature of the misfit from one block's errors.
#[derive(Debug, Clone)]
struct Block {
    slope: DVector<f64>,
    curvature: DMatrix<f64>,
    errors: usize,
}

impl Bootstrap<'_> {
    /// The vector of every replicate; only the variables in `free` differ from the best one.
    ///
    /// # Errors
    /// What the simulation meets.
    pub fn vectors(&self, best: &[f64], draws: &Draws, fit: &mut dyn Fit) -> Result<Vec<Vec<f64>>> {
        let unmoved = vec![best.to_vec(); self.replicates];
        if self.free.is_empty() {
            return Ok(unmoved);
        }
        let first = vec![FIRST_DIFFERENCE; best.len()];
        let Some(vectors) = self.with_differences(0, best, &first, draws, fit)? else { return Ok(unmoved) };
        let deviation = |v: usize| {
            let share = vectors.iter().map(|x| (x[v] - best[v]) / self.bounds[v].width());
            let mean_square = share.map(|x| x * x).sum::<f64>() / vectors.len() as f64;
            mean_square.sqrt().clamp(DIFFERENCES[0], DIFFERENCES[1])
        };
        let second = (0..best.len()).map(deviation).collect::<Vec<_>>();
        Ok(self.with_differences(2, best, &second, draws, fit)?.unwrap_or(vectors))
    }

    /// The replicates by slopes of these half-widths; `None` if the best vector's runs cannot be finished.
    fn with_differences(
        &self,
        generation: u32,
        best: &[f64],
        differences: &[f64],
        draws: &Draws,
        fit: &mut dyn Fit,
    ) -> Result<Option<Vec<Vec<f64>>>> {
        let middle = fit.fitted(generation, &[best.to_vec()])?.pop().flatten();
        let Some(middle) = middle else { return Ok(None) };
        let sides = sides(best, differences, self.bounds);
        let around = fit.fitted(generation + 1, &sides)?;
        let slopes = slopes(best, &sides, &around, &middle, self.bounds).select_columns(self.free);
        let blocks = self.blocks_of(&slopes, &middle.residuals);
        let prior = self.prior(fit.ln_prior(best), &middle.residuals);
        let replicate = |b: usize| {
            let step = self.step(&blocks, &prior, &mut draws.of(0, b as u32, 0));
            let mut values = best.to_vec();
            for (step, &v) in step.iter().zip(self.free) {
                values[v] = self.bounds[v].clamp(best[v] + step * self.bounds[v].width());
            }
            values
        };
        Ok(Some((0..self.replicates).map(replicate).collect()))
    }

    fn blocks_of(&self, slopes: &DMatrix<f64>, residuals: &[f64]) -> Vec<Block> {
        let p = slopes.ncols();
        // Errors that no value moves, those of a wall at rest, tell nothing of the size of the others.
        let moved = (0..residuals.len()).filter(|&k| slopes.row(k).iter().any(|s| *s != 0.0));
        let moved = moved.collect::<Vec<_>>();
        let corner = median_size(&moved.iter().map(|&k| residuals[k]).collect::<Vec<_>>());
        let empty = Block { slope: DVector::zeros(p), curvature: DMatrix::zeros(p, p), errors: 0 };
        let count = self.blocks.iter().max().map_or(0, |last| (last / BLOCKS + 1) * BLOCKS);
        let mut blocks = vec![empty; count];
        for k in moved {
            let block = &mut blocks[self.blocks[k]];
            let slope = slopes.row(k).transpose();
            block.slope += (residuals[k] / corner).clamp(-1.0, 1.0) * &slope;
            if residuals[k].abs() <= corner {
                block.curvature += &slope * slope.transpose() / corner;
            }
            block.errors += 1;
        }
        blocks
    }

    /// What was known beforehand of the variables that move, in the units of the errors' slopes. The cost is the sum
    /// of their sizes times the prior's factor.
    fn prior(&self, ln: LnPrior, residuals: &[f64]) -> LnPrior {
        let cost = residuals.iter().map(|r| r.abs()).sum::<f64>();
        let free = |x: DVector<f64>| cost * x.select_rows(self.free);
        LnPrior { slope: free(ln.slope), curvature: free(ln.curvature), scatter: free(ln.scatter) }
    }

    /// Newton's step for blocks drawn anew in every test, and what was known drawn anew too.
    fn step(&self, blocks: &[Block], prior: &LnPrior, rng: &mut impl Rng) -> DVector<f64> {
        let p = self.free.len();
        let known = prior.scatter.map(|sd| sd * rng.sample::<f64, _>(StandardNormal));
        let mut slope = &prior.slope + known;
        let mut curvature = DMatrix::from_diagonal(&prior.curvature);
        for test in blocks.chunks(BLOCKS) {
            for _ in 0..BLOCKS {
                let block = &test[rng.random_range(0..BLOCKS)];
                slope += &block.slope;
                curvature += &block.curvature;
            }
        }
        // As many degrees of freedom are lost as variables were fitted.
        let told = blocks.iter().filter(|block| block.errors > 0).count() as f64;
        let widened = (told / (told - p as f64).max(1.0)).sqrt();
        // A direction that no error tells goes anywhere, up to the bounds.
        let least = 1e-9 * curvature.diagonal().max();
        let damped = curvature + DMatrix::from_diagonal_element(p, p, least.max(f64::MIN_POSITIVE));
        damped.cholesky().map_or_else(|| DVector::zeros(p), |factors| factors.solve(&(-widened * slope)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::slopes::Fitted;
    use rand_distr::Distribution;

    /// Normal errors about a constant.
    struct Constant(Vec<f64>);

    impl Fit for Constant {
        fn fitted(&mut self, _: u32, candidates: &[Vec<f64>]) -> Result<Vec<Option<Fitted>>> {
            let fitted = |x: &Vec<f64>| {
                let residuals = self.0.iter().map(|noise| noise - x[0]).collect::<Vec<_>>();
                Some(Fitted { cost: residuals.iter().map(|r| r.abs()).sum(), residuals })
            };
            Ok(candidates.iter().map(fitted).collect())
        }
    }

    #[test]
    fn analytic_intervals_of_a_constant_are_as_wide_as_theory_says() {
        let draws = Draws::new(1, "test");
        let noise = (0..2400).map(|k| StandardNormal.sample(&mut draws.of(0, k, 0))).collect();
        let blocks = (0..2400).map(|k| k / 100).collect::<Vec<_>>();
        let bounds = [Bounds { lower: -1.0, upper: 1.0 }];
        let bootstrap = Bootstrap { bounds: &bounds, free: &[0], blocks: &blocks, replicates: 2000 };
        let vectors = bootstrap.vectors(&[0.0], &draws, &mut Constant(noise)).expect("no simulation");
        let values = vectors.iter().map(|x| x[0]).collect::<Vec<_>>();
        let mean = values.iter().sum::<f64>() / 2000.0;
        let deviation = (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 1999.0).sqrt();
        // Huber's estimate with the corner at the median 0.6745 σ: E ψ² = 0.5 + ∫_0^c x²/c² 2φ = 0.657,
        // E ψ' = 0.5 / c, so √0.657 c / 0.5 = 1.09 σ/√n. The spread of 24 blocks is known to 1/√48, some 15 %.
        let expected = 1.09 / 2400.0_f64.sqrt();
        assert!((deviation / expected - 1.0).abs() < 0.4, "{deviation} and {expected}");
    }
}
