//! How well a fragility describes outcomes.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::method::Fitted;
use super::outcomes::counts;
use super::sample::Sample;

/// Bins of the Hosmer–Lemeshow check, where the data have so many intensities.
const BINS: usize = 10;

/// Measures of fit of outcomes; each says what it is in its own unit, none is a verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Goodness {
    /// Log-likelihood of the fragility, Σ k ln p + (n - k) ln(1 - p).
    pub log_likelihood: f64,
    /// The same of the best constant probability.
    pub null_log_likelihood: f64,
    /// McFadden's 1 - ln L / ln L_0: 0 no better than a constant, 1 certain; 0.2 to 0.4 is a good fit (McFadden 1979).
    pub mcfadden: f64,
    /// Area under the ROC curve of the intensity: the chance that what failed had a higher intensity than what stood.
    pub auc: f64,
    /// Observed against expected failures in bins; none with fewer than three bins.
    pub binned: Option<BinnedCheck>,
}

/// Hosmer & Lemeshow (1980): χ² of failures in bins of intensity, on two degrees of freedom fewer than bins.
#[derive(Debug, Clone, PartialEq)]
pub struct BinnedCheck {
    /// The bins.
    pub bins: Vec<Bin>,
    /// Σ (O - E)² / (E (1 - E/n)).
    pub statistic: f64,
    /// Chance of a larger statistic if the fragility is right; small values speak against its shape.
    pub p_value: f64,
}

/// Outcomes of neighbouring intensities.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bin {
    /// Highest intensity in it.
    pub up_to: f64,
    /// Trials.
    pub trials: f64,
    /// Failures observed.
    pub observed: f64,
    /// Failures the fragility expects.
    pub expected: f64,
}

/// Measures of fit of `fitted` to the outcomes of `sample`.
pub fn goodness(sample: &Sample, fitted: &Fitted) -> Goodness {
    let weights = sample.unit_weights();
    let null_log_likelihood = counts(sample, &weights).null_log_likelihood();
    let log_likelihood = log_likelihood(sample, fitted);
    Goodness {
        log_likelihood,
        null_log_likelihood,
        mcfadden: 1.0 - log_likelihood / null_log_likelihood,
        auc: area_under_roc(sample),
        binned: binned(sample, fitted),
    }
}

fn log_likelihood(sample: &Sample, fitted: &Fitted) -> f64 {
    let term = |count: f64, p: f64| if count > 0.0 { count * p.ln() } else { 0.0 };
    let rows = sample.ln_intensity().iter().zip(sample.failures()).zip(sample.trials());
    rows.map(|((&x, k), n)| match fitted.cloud {
        None => {
            let z = (x - fitted.curve.ln_median()) / fitted.curve.beta();
            let part = |count: f64, z: f64| {
                if count > 0.0 { count * mrbd_statistics::normal::ln_cdf(z).0 } else { 0.0 }
            };
            part(*k, z) + part(n - k, -z)
        }
        Some(cloud) => {
            let p = cloud.probability_at_ln(x);
            term(*k, p) + term(n - k, 1.0 - p)
        }
    })
    .sum()
}

/// Area under the ROC curve as the Mann–Whitney statistic, ties at one half; NaN unless some failed and some stood.
pub fn area_under_roc(sample: &Sample) -> f64 {
    let (mut below, mut wins) = (0.0, 0.0);
    for [failed, stood] in by_intensity(sample).into_iter().map(|(_, failed, stood)| [failed, stood]) {
        wins += failed * (below + 0.5 * stood);
        below += stood;
    }
    let (failures, trials) = sample.totals();
    wins / (failures * (trials - failures))
}

/// (ln x, failures, survivals) in increasing order, one entry an intensity.
fn by_intensity(sample: &Sample) -> Vec<(f64, f64, f64)> {
    let rows = sample.ln_intensity().iter().zip(sample.failures()).zip(sample.trials());
    let mut sorted: Vec<(f64, f64, f64)> = rows.map(|((&x, &k), &n)| (x, k, n - k)).collect();
    sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    sorted.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
            kept.2 += next.2;
        }
        same
    });
    sorted
}

fn binned(sample: &Sample, fitted: &Fitted) -> Option<BinnedCheck> {
    let bins = bins(sample, fitted);
    let degrees = bins.len().checked_sub(2).filter(|&degrees| degrees > 0)?;
    let statistic = bins
        .iter()
        .map(|bin| (bin.observed - bin.expected).powi(2) / (bin.expected * (1.0 - bin.expected / bin.trials)))
        .sum();
    let chi = ChiSquared::new(degrees as f64).ok()?;
    // A bin in which failure is impossible or certain to rounding has no χ².
    f64::is_finite(statistic).then(|| BinnedCheck { bins, statistic, p_value: chi.sf(statistic) })
}

/// Bins of about equally many trials; an intensity stays in one bin.
fn bins(sample: &Sample, fitted: &Fitted) -> Vec<Bin> {
    let intensities = by_intensity(sample);
    let total: f64 = sample.trials().iter().sum();
    let (mut bins, mut open, mut seen) = (Vec::with_capacity(BINS), Bin::default(), 0.0);
    for (x, failed, stood) in intensities {
        let trials = failed + stood;
        open.up_to = x.exp();
        open.trials += trials;
        open.observed += failed;
        open.expected += trials * fitted.probability_at_ln(x);
        seen += trials;
        if seen * BINS as f64 >= (bins.len() + 1) as f64 * total {
            bins.push(std::mem::take(&mut open));
        }
    }
    if open.trials > 0.0 {
        bins.push(open);
    }
    bins
}

#[cfg(test)]
mod tests {
    use super::super::method::Method;
    use super::*;

    #[test]
    fn analytic_area_counts_pairs_and_half_ties() {
        // Failed at 2 and 3, stood at 1, 2 and 4: of six pairs 1 + ½ + 0 and 1 + 1 + 0 are in order.
        let outcomes = [(2.0, true), (3.0, true), (1.0, false), (2.0, false), (4.0, false)];
        let sample = Sample::from_outcomes(outcomes).expect("valid");
        assert_eq!(area_under_roc(&sample), 3.5 / 6.0);
    }

    #[test]
    fn analytic_two_parameters_leave_two_stripes_without_doubt_and_three_with_one_degree() {
        let stripes = [(0.1, 5, 50), (0.2, 20, 50), (0.4, 42, 50)];
        let fit = |n: usize| {
            let sample = Sample::from_stripes(stripes[..n].to_vec()).expect("valid");
            let fitted = Method::Outcomes.fit(&sample, &sample.unit_weights()).expect("fits");
            goodness(&sample, &fitted)
        };
        assert!(fit(2).binned.is_none());
        let three = fit(3).binned.expect("three bins");
        let expected: f64 = three.bins.iter().map(|bin| bin.expected).sum();
        // The likelihood equations nearly balance the totals; exactly they balance weighted by φ/(Φ(1 - Φ)).
        assert!((expected - 67.0).abs() < 0.5, "{three:?}");
        // 1 - erf(√(χ²/2)) is the tail of one degree of freedom.
        let tail = statrs::function::erf::erfc((0.5 * three.statistic).sqrt());
        assert!((three.p_value - tail).abs() < 1e-10, "series of two special functions");
    }

    #[test]
    fn analytic_a_wrong_shape_is_seen() {
        // Certain below, half between, nothing above would be wrong for any log-normal.
        let stripes = [(0.1, 50, 100), (0.2, 10, 100), (0.3, 50, 100), (0.4, 90, 100)];
        let sample = Sample::from_stripes(stripes).expect("valid");
        let fitted = Method::Outcomes.fit(&sample, &sample.unit_weights()).expect("fits");
        let goodness = goodness(&sample, &fitted);
        assert!(goodness.binned.expect("bins").p_value < 1e-6);
        assert!(goodness.mcfadden > 0.0 && goodness.mcfadden < 0.3, "{}", goodness.mcfadden);
    }
}
