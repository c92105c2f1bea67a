//! The log-normal fragility of collapse intensities: incremental analyses, some of which ended before collapse.
//!
//! Baker (2015), Eq. 7 and 8 for truncated analyses: every record either collapses at an intensity or is only known
//! to stand at the last one that was run. Olsen's (1978) parameters γ = 1/β, δ = ln θ/β make the likelihood concave.

use super::method::LogNormal;
use super::method::Unknown;
use super::sample::Sample;
use mrbd_statistics::normal;

/// Newton steps before giving up.
const MAX_STEPS: usize = 200;

/// The fragility of largest likelihood of collapse intensities, each row with a weight, and its log-likelihood.
///
/// A failure is a collapse at the row's intensity; a row without one stood at it and was not run higher.
/// The log-likelihood is that of the density of ln x.
///
/// # Errors
/// [`Unknown`] with fewer than two different collapse intensities.
pub fn fit_incremental(sample: &Sample, weights: &[f64]) -> Result<(LogNormal, f64), Unknown> {
    let rows = rows(sample, weights);
    let collapses = || rows.iter().filter(|row| row.collapsed > 0.0);
    let count: f64 = collapses().map(|row| row.collapsed).sum();
    if rows.is_empty() {
        return Err(Unknown::NoData);
    }
    if count == 0.0 {
        return Err(Unknown::NoFailures);
    }
    let mean = collapses().map(|row| row.collapsed * row.x).sum::<f64>() / count;
    let squares = collapses().map(|row| row.collapsed * (row.x - mean).powi(2)).sum::<f64>();
    // Below the rounding of logarithms near 1 the values are one value.
    if squares / count < 1e-24 {
        return Err(Unknown::TooFewCollapses);
    }
    let gamma = (count / squares).sqrt();
    // Around the mean, so that γ and δ are nearly independent.
    let [gamma, delta] = maximise(&rows, mean, [gamma, 0.0]).ok_or(Unknown::NotConverged)?;
    let value = slopes(&rows, mean, [gamma, delta]).0;
    let curve = LogNormal::new(mean + delta / gamma, 1.0 / gamma).ok_or(Unknown::NotConverged)?;
    Ok((curve, value))
}

/// The fragility by the moments of ln x (Baker 2015, Eq. 2 and 3): mean, and standard deviation over n - 1.
///
/// # Errors
/// [`Unknown`] with fewer than two different collapse intensities, or where a record never collapsed.
pub fn fit_moments(collapse_intensity: &[f64]) -> Result<LogNormal, Unknown> {
    let n = collapse_intensity.len() as f64;
    let mean = collapse_intensity.iter().map(|x| x.ln()).sum::<f64>() / n;
    let squares: f64 = collapse_intensity.iter().map(|x| (x.ln() - mean).powi(2)).sum();
    LogNormal::new(mean, (squares / (n - 1.0)).sqrt()).ok_or(Unknown::TooFewCollapses)
}

struct Row {
    x: f64,
    collapsed: f64,
    stood: f64,
}

fn rows(sample: &Sample, weights: &[f64]) -> Vec<Row> {
    let data = sample.ln_intensity().iter().zip(sample.failures()).zip(sample.trials()).zip(weights);
    data.filter(|(_, weight)| **weight > 0.0)
        .map(|(((&x, k), n), w)| Row { x, collapsed: w * k, stood: w * (n - k) })
        .collect()
}

/// Log-likelihood, gradient and negative Hessian (γγ, γδ, δδ), with z = γ (x - mean) - δ.
fn slopes(rows: &[Row], mean: f64, [gamma, delta]: [f64; 2]) -> (f64, [f64; 2], [f64; 3]) {
    let (mut value, mut g, mut h) = (0.0, [0.0; 2], [0.0; 3]);
    for row in rows {
        let x = row.x - mean;
        let z = gamma * x - delta;
        let (ln_stands, mills) = normal::ln_cdf(-z);
        // d/dz of the two parts: -z for a density, -φ/Φ(-z) for a survival.
        let first = -row.collapsed * z - row.stood * mills;
        let second = row.collapsed + row.stood * mills * (mills - z);
        value += row.collapsed * (gamma.ln() + normal::pdf(z).ln()) + row.stood * ln_stands;
        g = [g[0] + first * x + row.collapsed / gamma, g[1] - first];
        let curvature = row.collapsed / (gamma * gamma);
        h = [h[0] + second * x * x + curvature, h[1] - second * x, h[2] + second];
    }
    (value, g, h)
}

fn maximise(rows: &[Row], mean: f64, start: [f64; 2]) -> Option<[f64; 2]> {
    let mut at = start;
    let mut now = slopes(rows, mean, at);
    for _ in 0..MAX_STEPS {
        let (value, g, [aa, ab, bb]) = now;
        let determinant = aa * bb - ab * ab;
        let step = [(bb * g[0] - ab * g[1]) / determinant, (aa * g[1] - ab * g[0]) / determinant];
        let decrement = step[0] * g[0] + step[1] * g[1];
        if decrement < 1e-14 * (1.0 + value.abs()) {
            return Some([at[0] + step[0], at[1] + step[1]]);
        }
        let lengths = std::iter::successors(Some(1.0), |length| Some(0.5 * length)).take(40);
        (at, now) = lengths
            .map(|length| [at[0] + length * step[0], at[1] + length * step[1]])
            .filter(|next| next[0] > 0.0)
            .map(|next| (next, slopes(rows, mean, next)))
            .find(|(_, there)| there.0 >= value - 1e-13 * value.abs())?;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLLAPSES: [f64; 7] = [0.31, 0.44, 0.52, 0.58, 0.73, 0.81, 0.97];

    #[test]
    fn verified_truncated_analyses_against_an_independent_fit() {
        // tests/python/fragility_reference.py, "censored": scipy's Nelder-Mead on scipy's densities.
        let rows = COLLAPSES.map(|x| (x, true)).into_iter().chain([(1.0, false); 3]);
        let sample = Sample::from_outcomes(rows).expect("valid");
        let (curve, value) = fit_incremental(&sample, &sample.unit_weights()).expect("fits");
        // Nelder-Mead cannot tell parameters apart whose likelihoods agree to rounding: 1e-7.
        assert!((curve.median() - 0.758_493_069_722).abs() < 1e-7, "{curve:?}");
        assert!((curve.beta() - 0.518_063_555_743).abs() < 1e-7, "{curve:?}");
        assert!((value + 8.039_863_264_1).abs() < 1e-9, "{value}");
    }

    #[test]
    fn analytic_without_truncation_the_likelihood_gives_the_moments() {
        let sample = Sample::from_outcomes(COLLAPSES.map(|x| (x, true))).expect("valid");
        let (curve, _) = fit_incremental(&sample, &sample.unit_weights()).expect("fits");
        let moments = fit_moments(&COLLAPSES).expect("fits");
        // Maximum likelihood divides by n where the moments divide by n - 1; both end to rounding of Newton's method.
        assert!((curve.median() - moments.median()).abs() < 1e-9);
        assert!((curve.beta() - moments.beta() * (6.0f64 / 7.0).sqrt()).abs() < 1e-9);
    }

    #[test]
    fn rejects_collapses_that_tell_no_scatter() {
        let sample = Sample::from_outcomes([(0.5, true), (0.5, true), (1.0, false)]).expect("valid");
        assert_eq!(fit_incremental(&sample, &sample.unit_weights()), Err(Unknown::TooFewCollapses));
        let sample = Sample::from_outcomes([(0.5, false)]).expect("valid");
        assert_eq!(fit_incremental(&sample, &sample.unit_weights()), Err(Unknown::NoFailures));
        assert_eq!(fit_moments(&[0.5]), Err(Unknown::TooFewCollapses));
    }
}
