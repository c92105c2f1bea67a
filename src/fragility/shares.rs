//! How much of β² comes from records and how much from façades, told from outcomes alone.
//!
//! With ln capacity = ln θ + β u and u the sum of independent normal parts of record, façade and rest, the outcomes of
//! two runs that share a record fail together with probability Φ₂(η, η'; ρ), and ρ is the record's share of β². The
//! share is the ρ at which the residuals' products over all such pairs have their expectation:
//!
//! Σ (y - p)(y' - p') = Σ [Φ₂(η, η'; ρ) - p p'],   p = Φ(η), η = ln(x/θ)/β
//!
//! (a moment estimator; consistent as clusters become many). The tetrachoric series
//! Φ₂ - p p' = Σ_n ρⁿ/n g_{n-1}(η) g_{n-1}(η'), g_m = φ He_m/√m!, makes the sum over pairs a sum over rows.

use super::sample::{Clusters, Sample};
use mrbd_statistics::normal;

/// Terms of the series: at the largest share what is left out is below 0.98⁴⁰⁰/400 < 1e-6 of a probability.
const TERMS: usize = 400;

/// Largest share that is told apart from 1.
const LARGEST: f64 = 0.98;

/// Share of the variance of ln capacity that each kind of cluster explains.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// The kind of cluster.
    pub name: String,
    /// Its share of the variance, 0 to 1; 0 where the pairs agree less often than by chance.
    pub share: f64,
}

/// Shares of β² by kind of cluster, from single outcomes and the ln θ and β fitted to them.
///
/// None where rows hold more than one trial, or where no two rows share a cluster of one kind and not the other.
pub fn outcome_shares(sample: &Sample, ln_median: f64, beta: f64) -> Option<Vec<Share>> {
    if sample.trials().iter().any(|&n| n != 1.0) {
        return None;
    }
    let eta: Vec<f64> = sample.ln_intensity().iter().map(|x| (x - ln_median) / beta).collect();
    let shares = sample.clusters().iter().enumerate().map(|(kind, clusters)| {
        let pairs = PairSums::over(sample, &eta, kind)?;
        Some(Share { name: clusters.name.clone(), share: pairs.share() })
    });
    shares.collect()
}

/// Sums over the pairs of rows that share a cluster of one kind but no other.
struct PairSums {
    residuals: f64,
    /// Σ g_m(η) g_m(η').
    series: Vec<f64>,
}

impl PairSums {
    fn over(sample: &Sample, eta: &[f64], kind: usize) -> Option<Self> {
        let cells = cells(sample.clusters(), kind);
        let mut sums = Self { residuals: 0.0, series: vec![0.0; TERMS] };
        let mut pairs = 0.0;
        for cluster in cells.chunk_by(|a, b| a.0 == b.0) {
            let (mut whole, mut size) = ([0.0; TERMS + 1], 0.0);
            for cell in cluster.chunk_by(|a, b| a.1 == b.1) {
                let mut part = [0.0; TERMS + 1];
                cell.iter().for_each(|&(_, _, row)| add_row(&mut part, eta[row], sample.failures()[row]));
                sums.add_squares(&part, -0.5);
                whole.iter_mut().zip(part).for_each(|(whole, part)| *whole += part);
                pairs -= 0.5 * (cell.len() as f64).powi(2);
                size += cell.len() as f64;
            }
            sums.add_squares(&whole, 0.5);
            pairs += 0.5 * size * size;
        }
        (pairs > 0.0).then_some(sums)
    }

    fn add_squares(&mut self, row: &[f64; TERMS + 1], factor: f64) {
        self.residuals += factor * row[TERMS] * row[TERMS];
        self.series.iter_mut().zip(row).for_each(|(sum, value)| *sum += factor * value * value);
    }

    /// Expected sum of products at a share.
    fn expected(&self, share: f64) -> f64 {
        let mut power = 1.0;
        let terms = self.series.iter().zip(1..).map(|(sum, n)| {
            power *= share;
            power / f64::from(n) * sum
        });
        terms.sum()
    }

    /// The share at which the expectation is met; it grows with the share.
    fn share(&self) -> f64 {
        let (mut low, mut high) = (0.0, LARGEST);
        // 50 halvings: to rounding.
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.expected(middle) < self.residuals {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

/// (cluster, cell, row) sorted; rows of one cell share the clusters of every kind, or are one row where there is one kind.
fn cells(kinds: &[Clusters], kind: usize) -> Vec<(u32, u64, usize)> {
    let other = kinds.iter().enumerate().find(|(i, _)| *i != kind).map(|(_, clusters)| clusters);
    let cell = |row: usize| other.map_or(row as u64, |clusters| u64::from(clusters.of[row]));
    let rows = kinds[kind].of.iter().enumerate();
    let mut cells: Vec<(u32, u64, usize)> = rows.map(|(row, &cluster)| (cluster, cell(row), row)).collect();
    cells.sort_unstable();
    cells
}

/// Adds g_0 … of a row and, last, its residual.
fn add_row(sums: &mut [f64; TERMS + 1], eta: f64, failed: f64) {
    // He_{m+1} = η He_m - m He_{m-1}, divided by √(m+1)! each.
    let (mut before, mut now) = (0.0, normal::pdf(eta));
    for (m, sum) in sums[..TERMS].iter_mut().enumerate() {
        *sum += now;
        let m = m as f64;
        let next = (eta * now - m.sqrt() * before) / (m + 1.0).sqrt();
        (before, now) = (now, next);
    }
    sums[TERMS] += failed - normal::cdf(eta);
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    #[test]
    fn verified_the_series_is_the_bivariate_normal() {
        // tests/python/fragility_reference.py, "joint": multivariate_normal of scipy at 1e-12.
        for (h, k, share, expected) in
            [(0.3, -0.7, 0.4, 0.046_012_243_595_1), (-1.5, 0.2, 0.9, 0.028_106_003_751_9)]
        {
            let mut sums = PairSums { residuals: 0.0, series: vec![0.0; TERMS] };
            let [mut first, mut second, mut both] = [[0.0; TERMS + 1]; 3];
            add_row(&mut first, h, 1.0);
            add_row(&mut second, k, 1.0);
            add_row(&mut both, h, 1.0);
            add_row(&mut both, k, 1.0);
            sums.add_squares(&both, 0.5);
            sums.add_squares(&first, -0.5);
            sums.add_squares(&second, -0.5);
            // The reference is printed with 12 digits; the series has converged.
            assert!((sums.expected(share) - expected).abs() < 1e-12, "{}", sums.expected(share));
        }
    }

    /// Crossed outcomes whose ln capacity has these shares of record and façade.
    fn crossed(seed: u64, records: usize, facades: usize, shares: [f64; 2]) -> Sample {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let record: Vec<f64> = (0..records).map(|_| shares[0].sqrt() * normal()).collect();
        let facade: Vec<f64> = (0..facades).map(|_| shares[1].sqrt() * normal()).collect();
        let rest = (1.0 - shares[0] - shares[1]).sqrt();
        let mut rows = Vec::new();
        let mut labels = [Vec::new(), Vec::new()];
        for (r, record) in record.iter().enumerate() {
            for (f, facade) in facade.iter().enumerate() {
                let x = (0.8 * normal()).exp();
                let capacity = 0.5 * (record + facade + rest * normal());
                rows.push((x, x.ln() > capacity));
                labels[0].push(r);
                labels[1].push(f);
            }
        }
        let [record, facade] = labels;
        let sample = Sample::from_outcomes(rows).expect("valid");
        sample.with_clusters(Clusters::new("record", record)).with_clusters(Clusters::new("facade", facade))
    }

    #[test]
    fn analytic_shares_of_known_parts_are_found() {
        let trials = 12;
        let mut mean = [0.0; 2];
        for seed in 0..trials {
            let sample = crossed(seed, 80, 80, [0.5, 0.2]);
            let fit = super::super::outcomes::fit_outcomes(&sample).expect("fits");
            let shares = outcome_shares(&sample, fit.curve.ln_median(), fit.curve.beta()).expect("pairs");
            mean.iter_mut().zip(shares).for_each(|(mean, share)| *mean += share.share / trials as f64);
        }
        // The variance of 80 normal effects scatters by √(2/80) = 16 %, so a share of ½ by 0.5 · 0.5 · 0.16 = 0.04 (the
        // total moves with it) and a mean of 12 by 0.012; three of these, and 0.02 for the bias of few clusters.
        assert!((mean[0] - 0.5).abs() < 0.055 && (mean[1] - 0.2).abs() < 0.055, "{mean:?}");
    }

    #[test]
    fn analytic_independent_outcomes_have_no_shares() {
        let sample = crossed(5, 40, 40, [0.0, 0.0]);
        let fit = super::super::outcomes::fit_outcomes(&sample).expect("fits");
        let shares = outcome_shares(&sample, fit.curve.ln_median(), fit.curve.beta()).expect("pairs");
        // 40 clusters of 40: the intraclass correlation scatters by about 1/40 · √(2/40) = 0.006 on the outcome and
        // about twice as much on the latent scale; four of these.
        assert!(shares.iter().all(|share| share.share < 0.05), "{shares:?}");
    }

    #[test]
    fn rejects_shares_without_pairs() {
        let sample = Sample::from_outcomes([(1.0, true), (2.0, false)]).expect("valid");
        let alone = sample.with_clusters(Clusters::new("record", ["a", "b"]));
        assert_eq!(outcome_shares(&alone, 0.0, 0.5), None);
    }
}
