//! Variance components of a demand: records, façades and the rest, crossed and unbalanced.
//!
//! Y = μ + record + façade + rest. Sums of squares within records, within façades and over all have expectations that
//! are linear in the three variances (Henderson's method I; in this form Gao & Owen 2017, "Efficient moment
//! calculations for variance components in large unbalanced crossed random effects models", Electron. J. Statist. 11).
//! The estimates are unbiased, need one pass, and may be negative where a variance is small.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::sample::Clusters;
use super::shares::Share;

/// Estimated variances.
#[derive(Debug, Clone, PartialEq)]
pub struct Components {
    /// By kind of cluster, in the order given.
    pub of_clusters: Vec<f64>,
    /// What no cluster explains.
    pub rest: f64,
}

impl Components {
    /// Shares of the total; negative estimates count as 0.
    pub fn shares(&self, kinds: &[Clusters]) -> Vec<Share> {
        let total: f64 = self.of_clusters.iter().chain([&self.rest]).map(|v| v.max(0.0)).sum();
        let share = |(kind, variance): (&Clusters, &f64)| Share {
            name: kind.name.clone(),
            share: variance.max(0.0) / total,
        };
        kinds.iter().zip(&self.of_clusters).map(share).collect()
    }
}

/// Variances of `values`, the value of row `rows[i]`, by kinds of clusters; none where the rows cannot tell them apart.
pub fn components(rows: &[usize], values: &[f64], kinds: &[Clusters]) -> Option<Components> {
    let labels: Vec<Vec<u32>> =
        kinds.iter().map(|kind| rows.iter().map(|&row| kind.of[row]).collect()).collect();
    let n = values.len() as f64;
    // One equation a kind from the sum of squares within its clusters, and one from the total sum of squares.
    let mut equations: Vec<(f64, Vec<f64>)> = labels.iter().map(|by| equation(by, values, &labels)).collect();
    equations.push(equation(&vec![0; values.len()], values, &labels));
    let size = equations.len();
    let matrix = DMatrix::from_fn(size, size, |i, j| equations[i].1[j] / n);
    let right = DVector::from_fn(size, |i, _| equations[i].0 / n);
    // A matrix of a design that cannot tell its parts apart is singular to rounding.
    let solution = matrix.clone().lu().solve(&right).filter(|_| matrix.rank(1e-9) == size)?;
    Some(Components { of_clusters: solution.as_slice()[..size - 1].to_vec(), rest: solution[size - 1] })
}

/// Sum of squares within the groups `by`, and how often its expectation contains each variance (the rest last).
///
/// Σ_g Σ_i (Y - Ȳ_g)² contains the variance of a kind N - Σ_g Σ_c n_gc²/n_g times, n_gc being the rows of group g in
/// cluster c; for the rest every row is its own cluster: N minus the number of groups.
fn equation(by: &[u32], values: &[f64], labels: &[Vec<u32>]) -> (f64, Vec<f64>) {
    let sizes = tally(by.iter().copied());
    let mut sums: BTreeMap<u32, f64> = BTreeMap::new();
    by.iter().zip(values).for_each(|(&g, value)| *sums.entry(g).or_default() += value);
    let squares = by.iter().zip(values).map(|(g, value)| (value - sums[g] / sizes[g]).powi(2)).sum();
    let n = values.len() as f64;
    let mut factors: Vec<f64> = labels
        .iter()
        .map(|kind| {
            let cells = tally(by.iter().copied().zip(kind.iter().copied()));
            n - cells.iter().map(|((g, _), count)| count * count / sizes[g]).sum::<f64>()
        })
        .collect();
    factors.push(n - sizes.len() as f64);
    (squares, factors)
}

/// In the order of the labels, so that sums over them are the same to the bit.
fn tally<T: Ord>(labels: impl Iterator<Item = T>) -> BTreeMap<T, f64> {
    let mut counts = BTreeMap::new();
    labels.for_each(|label| *counts.entry(label).or_insert(0.0) += 1.0);
    counts
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    #[test]
    fn analytic_balanced_data_give_the_textbook_analysis_of_variance() {
        // Two rows by three columns: mean squares of rows 6, columns 4, rest 0.
        let values = [1.0, 2.0, 4.0, 3.0, 4.0, 6.0];
        let kinds = [Clusters::new("row", [0, 0, 0, 1, 1, 1]), Clusters::new("column", [0, 1, 2, 0, 1, 2])];
        let found = components(&[0, 1, 2, 3, 4, 5], &values, &kinds).expect("solvable");
        // σ²_row = (6 - 0)/3, σ²_column = (14/3 - 0)/2.
        // Rounding of sums near 10.
        assert!((found.of_clusters[0] - 2.0).abs() < 1e-12, "{found:?}");
        assert!((found.of_clusters[1] - 7.0 / 3.0).abs() < 1e-12, "{found:?}");
        assert!(found.rest.abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn analytic_unbalanced_data_are_unbiased() {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let trials = 400;
        let mut mean = [0.0; 3];
        for _ in 0..trials {
            let record: Vec<f64> = (0..12).map(|_| 1.0 * normal()).collect();
            let facade: Vec<f64> = (0..15).map(|_| 0.5 * normal()).collect();
            let cells: Vec<(usize, usize)> = (0..12)
                .flat_map(|r| (0..15).map(move |f| (r, f)))
                .filter(|(r, f)| (r * f) % 3 != 1 && (r + f) % 4 != 2)
                .collect();
            let values: Vec<f64> =
                cells.iter().map(|&(r, f)| record[r] + facade[f] + 0.7 * normal()).collect();
            let kinds = [
                Clusters::new("record", cells.iter().map(|cell| cell.0)),
                Clusters::new("facade", cells.iter().map(|cell| cell.1)),
            ];
            let rows: Vec<usize> = (0..cells.len()).collect();
            let found = components(&rows, &values, &kinds).expect("solvable");
            mean[0] += found.of_clusters[0] / f64::from(trials);
            mean[1] += found.of_clusters[1] / f64::from(trials);
            mean[2] += found.rest / f64::from(trials);
        }
        // Variances of 12 and 15 effects scatter by √(2/11) = 43 % and 40 %, means of 400 by 2 %; with the noise of the
        // rest on top: three times 0.025, 0.008 and 0.004.
        assert!((mean[0] - 1.0).abs() < 0.075, "{mean:?}");
        assert!((mean[1] - 0.25).abs() < 0.024, "{mean:?}");
        assert!((mean[2] - 0.49).abs() < 0.012, "{mean:?}");
    }

    #[test]
    fn rejects_designs_that_cannot_tell_their_parts_apart() {
        // Each record met one façade only.
        let kinds = [Clusters::new("record", [0, 0, 1, 1]), Clusters::new("facade", [0, 0, 1, 1])];
        assert_eq!(components(&[0, 1, 2, 3], &[1.0, 2.0, 3.0, 5.0], &kinds), None);
    }
}
