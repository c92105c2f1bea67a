//! The bootstrap over clusters: whole records, whole façades, or both at once.
//!
//! Outcomes under one record fail together, and so do those of one façade; a bootstrap that drew outcomes one by one
//! would promise too narrow an interval. Here clusters are drawn with replacement, and with two kinds of clusters a
//! row's weight is the product of how often each of its clusters was drawn: the pigeonhole bootstrap
//! (Owen 2007, "The pigeonhole bootstrap", Annals of Applied Statistics 1(2)), which never promises too little scatter.
//!
//! A draw depends on the seed and the number of the replicate alone, so threads change nothing.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::method::{Fitted, Method};
use super::sample::{Clusters, Sample};

/// Most clusters left out one by one for the acceleration; more are left out in this many groups.
const JACKKNIFE_GROUPS: usize = 200;

/// How often and from which seed to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bootstrap {
    /// Number of replicates.
    pub replicates: u32,
    /// Seed of all draws.
    pub seed: u64,
}

/// Replicates where no number is given: the ends of a 95 % interval are then quantiles among some fifty of them.
pub const REPLICATES: u32 = 2000;

impl Default for Bootstrap {
    fn default() -> Self {
        Self { replicates: REPLICATES, seed: 1 }
    }
}

impl Bootstrap {
    /// The fragility of every replicate, in order; none where a replicate tells none.
    pub fn run(&self, method: Method, sample: &Sample) -> Vec<Option<Fitted>> {
        let sample = &split_stripes(sample);
        let near = method.fit(sample, &sample.unit_weights()).ok();
        (0..self.replicates)
            .into_par_iter()
            .map(|replicate| method.fit_from(sample, &self.weights(sample, replicate), near.as_ref()).ok())
            .collect()
    }

    /// Weights of the rows in one replicate.
    pub fn weights(&self, sample: &Sample, replicate: u32) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(u64::from(replicate));
        if sample.clusters().is_empty() {
            return draw_trials(&mut rng, sample.trials());
        }
        let mut weights = sample.unit_weights();
        for clusters in sample.clusters() {
            let drawn = draw_counts(&mut rng, clusters.count);
            weights.iter_mut().zip(&clusters.of).for_each(|(weight, &i)| *weight *= drawn[i as usize]);
        }
        weights
    }
}

/// How often each of `count` is drawn in `count` draws with replacement.
fn draw_counts(rng: &mut ChaCha8Rng, count: usize) -> Vec<f64> {
    let mut drawn = vec![0.0; count];
    for _ in 0..count {
        drawn[rng.random_range(0..count)] += 1.0;
    }
    drawn
}

/// Draws trials with replacement, row by row as many as it has; a weight is draws over trials.
fn draw_trials(rng: &mut ChaCha8Rng, trials: &[f64]) -> Vec<f64> {
    let ends: Vec<u64> = trials
        .iter()
        .scan(0, |end, &n| {
            *end += n as u64;
            Some(*end)
        })
        .collect();
    let total = ends.last().copied().unwrap_or(0);
    let mut weights = vec![0.0; trials.len()];
    for _ in 0..total {
        let drawn = rng.random_range(0..total);
        let row = ends.partition_point(|&end| end <= drawn);
        weights[row] += 1.0 / trials[row];
    }
    weights
}

/// Rows that hold only failures or only survivals, so that a draw of trials is a weight; clustered rows stay whole.
fn split_stripes(sample: &Sample) -> Sample {
    if sample.clusters().is_empty() { sample.split() } else { sample.clone() }
}

/// The median's and β's values with each cluster (or row) left out, by kind of cluster: (ln θ, β).
pub fn left_out(method: Method, sample: &Sample) -> [Vec<Vec<Option<f64>>>; 2] {
    let sample = &split_stripes(sample);
    let fits: Vec<Vec<Option<Fitted>>> = match sample.clusters() {
        [] => vec![leave_out(method, sample, sample.len(), |row| row)],
        kinds => kinds
            .iter()
            .map(|Clusters { of, count, .. }| leave_out(method, sample, *count, |row| of[row] as usize))
            .collect(),
    };
    let values = |f: fn(&Fitted) -> f64| {
        fits.iter().map(|kind| kind.iter().map(|fit| fit.as_ref().map(f)).collect()).collect()
    };
    [values(|fit| fit.curve.ln_median()), values(|fit| fit.curve.beta())]
}

fn leave_out(
    method: Method,
    sample: &Sample,
    count: usize,
    cluster: impl Fn(usize) -> usize + Sync,
) -> Vec<Option<Fitted>> {
    let groups = count.min(JACKKNIFE_GROUPS);
    let near = method.fit(sample, &sample.unit_weights()).ok();
    (0..groups)
        .into_par_iter()
        .map(|group| {
            let kept = |row: usize| if cluster(row) % groups == group { 0.0 } else { 1.0 };
            let weights: Vec<f64> = (0..sample.len()).map(kept).collect();
            method.fit_from(sample, &weights, near.as_ref()).ok()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossed(records: u32, facades: u32) -> Sample {
        let cells = || (0..records).flat_map(move |r| (0..facades).map(move |f| (r, f)));
        let sample = Sample::from_outcomes(cells().map(|(r, f)| (1.0 + f64::from(r + f), r > f)));
        sample
            .expect("valid")
            .with_clusters(Clusters::new("record", cells().map(|(r, _)| r)))
            .with_clusters(Clusters::new("facade", cells().map(|(_, f)| f)))
    }

    #[test]
    fn analytic_a_weight_is_the_product_of_the_clusters_counts() {
        let sample = crossed(6, 5);
        let weights = Bootstrap { replicates: 1, seed: 3 }.weights(&sample, 0);
        let row = |r: usize| weights[5 * r..5 * r + 5].iter().sum::<f64>();
        let column = |f: usize| (0..6).map(|r| weights[5 * r + f]).sum::<f64>();
        let total: f64 = weights.iter().sum();
        // 6 records and 5 façades are drawn: the weights are an outer product of counts with these sums.
        assert_eq!(total, 30.0);
        for (r, f) in [(0, 0), (2, 4), (5, 1)] {
            assert_eq!(weights[5 * r + f] * total, row(r) * column(f));
        }
    }

    #[test]
    fn regress_a_draw_depends_on_seed_and_replicate_alone() {
        let sample = crossed(8, 8);
        let (few, many) = (Bootstrap { replicates: 3, seed: 9 }, Bootstrap { replicates: 200, seed: 9 });
        let (few, many) = (few.run(Method::Outcomes, &sample), many.run(Method::Outcomes, &sample));
        assert_eq!(few[..], many[..3]);
        let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        let again =
            one_thread.install(|| Bootstrap { replicates: 200, seed: 9 }.run(Method::Outcomes, &sample));
        assert_eq!(many, again);
        let other = Bootstrap { replicates: 3, seed: 10 }.run(Method::Outcomes, &sample);
        assert_ne!(few, other);
    }

    #[test]
    fn analytic_stripes_are_drawn_trial_by_trial() {
        let sample = Sample::from_stripes([(0.1, 2, 30), (0.2, 10, 20)]).expect("valid").split();
        let weights = Bootstrap { replicates: 1, seed: 1 }.weights(&sample, 0);
        let drawn: f64 = weights.iter().zip(sample.trials()).map(|(w, n)| w * n).sum();
        // Sums of thirtieths and twentieths.
        assert!((drawn - 50.0).abs() < 1e-12, "{drawn}");
        assert_eq!(sample.len(), 4);
    }

    #[test]
    fn analytic_leaving_out_a_cluster_is_fitting_without_it() {
        let sample = crossed(6, 5);
        let [ln_median, _] = left_out(Method::Outcomes, &sample);
        let weights: Vec<f64> = (0..30).map(|row| if row / 5 == 2 { 0.0 } else { 1.0 }).collect();
        let fit = Method::Outcomes.fit(&sample, &weights).expect("fits");
        // The two start from elsewhere and end at the same maximum, to the rounding of the last step.
        let left_out = ln_median[0][2].expect("a fragility");
        assert!((left_out - fit.curve.ln_median()).abs() < 1e-12, "{left_out} {fit:?}");
        assert_eq!((ln_median[0].len(), ln_median[1].len()), (6, 5));
    }
}
