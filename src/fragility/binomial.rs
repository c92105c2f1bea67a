//! Binomial regression on one variable by maximum likelihood: P = F(a + b x), F probit or logit.
//!
//! The log-likelihood of both links is concave in (a, b), so Newton's method with halved steps finds its only maximum;
//! whether there is one is decided before, from the data (Albert & Anderson 1984, Biometrika 71).

use super::method::Unknown;
use mrbd_statistics::normal;

/// Newton steps before giving up; a well-posed fit takes 5 to 10.
const MAX_STEPS: usize = 100;

/// Newton decrement at which the fit ends: the log-likelihood is then within about 1e-14 of its maximum.
const CONVERGED: f64 = 1e-14;

/// How the linear predictor becomes a probability.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Link {
    /// Φ(η).
    Probit,
    /// 1/(1 + exp(-η)).
    Logit,
}

impl Link {
    /// The probability.
    pub fn probability(self, eta: f64) -> f64 {
        match self {
            Link::Probit => normal::cdf(eta),
            Link::Logit => 1.0 / (1.0 + (-eta).exp()),
        }
    }

    /// ln F(η), its first derivative and the negative of its second.
    fn ln_probability(self, eta: f64) -> [f64; 3] {
        match self {
            Link::Probit => {
                let (value, slope) = normal::ln_cdf(eta);
                [value, slope, slope * (slope + eta)]
            }
            Link::Logit => {
                let p = self.probability(eta);
                // ln p of small p is η - ln(1 + exp η), without the loss of 1 + exp(-η).
                let value = if eta < 0.0 { eta - eta.exp().ln_1p() } else { -(-eta).exp().ln_1p() };
                [value, 1.0 - p, p * (1.0 - p)]
            }
        }
    }
}

/// Counts at values of a variable, each row with a weight; rows of weight 0 are not there.
#[derive(Debug, Clone, Copy)]
pub struct Counts<'a> {
    /// The variable.
    pub x: &'a [f64],
    /// Failures.
    pub failures: &'a [f64],
    /// Trials.
    pub trials: &'a [f64],
    /// Weights, 0 or more.
    pub weights: &'a [f64],
}

/// A maximum of the likelihood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Intercept a.
    pub intercept: f64,
    /// Slope b.
    pub slope: f64,
    /// Log-likelihood, without the binomial coefficients.
    pub log_likelihood: f64,
}

/// Log-likelihood, its gradient and its negative Hessian (aa, ab, bb) by the coefficients of η = a + b (x - centre).
struct Slopes {
    value: f64,
    gradient: [f64; 2],
    information: [f64; 3],
}

impl<'a> Counts<'a> {
    fn rows(&self) -> impl Iterator<Item = (f64, f64, f64)> + 'a {
        let Counts { x, failures, trials, weights } = *self;
        x.iter()
            .zip(failures)
            .zip(trials)
            .zip(weights)
            .filter(|(_, weight)| **weight > 0.0)
            .map(|(((&x, k), n), w)| (x, w * k, w * (n - k)))
    }

    /// Weighted failures and trials.
    pub fn totals(&self) -> (f64, f64) {
        self.rows().fold((0.0, 0.0), |(k, n), (_, failed, stood)| (k + failed, n + failed + stood))
    }

    /// Standard deviations of the value of η at `x0` and of the slope, from the observed information.
    pub fn standard_errors(&self, link: Link, line: &Line, x0: f64) -> [f64; 2] {
        let [aa, ab, bb] = self.slopes(link, [line.intercept + line.slope * x0, line.slope], x0).information;
        let determinant = aa * bb - ab * ab;
        [(bb / determinant).sqrt(), (aa / determinant).sqrt()]
    }

    /// Log-likelihood of the best constant probability; 0 where all or none failed.
    pub fn null_log_likelihood(&self) -> f64 {
        let (k, n) = self.totals();
        let part = |count: f64| if count > 0.0 { count * (count / n).ln() } else { 0.0 };
        part(k) + part(n - k)
    }

    fn slopes(&self, link: Link, [a, b]: [f64; 2], centre: f64) -> Slopes {
        let mut total = Slopes { value: 0.0, gradient: [0.0; 2], information: [0.0; 3] };
        for (x, failed, stood) in self.rows() {
            let x = x - centre;
            let eta = a + b * x;
            // Both links are symmetric: the probability of standing is F(-η).
            for (count, side) in [(failed, 1.0), (stood, -1.0)] {
                if count > 0.0 {
                    let [value, first, second] = link.ln_probability(side * eta);
                    total.value += count * value;
                    total.gradient[0] += side * count * first;
                    total.gradient[1] += side * count * first * x;
                    total.information[0] += count * second;
                    total.information[1] += count * second * x;
                    total.information[2] += count * second * x * x;
                }
            }
        }
        total
    }

    /// Maximises the likelihood over both coefficients.
    ///
    /// # Errors
    /// [`Unknown`] where the maximum does not exist; intensities in it are exp x.
    pub fn fit(&self, link: Link) -> Result<Line, Unknown> {
        self.fit_from(link, None)
    }

    /// The same from a line that is near, such as that of the data for a replicate; where it ends does not depend on it.
    ///
    /// # Errors
    /// As [`Counts::fit`].
    pub fn fit_from(&self, link: Link, near: Option<&Line>) -> Result<Line, Unknown> {
        self.check_overlap()?;
        let (k, n) = self.totals();
        let centre = self.rows().map(|(x, failed, stood)| x * (failed + stood)).sum::<f64>() / n;
        // The constant probability, as a normal quantile for either link: a start that is always on the right side.
        let start = near.map_or([normal::quantile(k / n), 0.0], |line| {
            [line.intercept + line.slope * centre, line.slope]
        });
        // A variable with mean 0 keeps the two coefficients nearly independent.
        let ([a, slope], log_likelihood) = newton(start, [true, true], |c| self.slopes(link, c, centre))?;
        Ok(Line { intercept: a - slope * centre, slope, log_likelihood })
    }

    /// Largest log-likelihood of the lines that are 0 at `x0`, from the slope `start` on.
    ///
    /// # Errors
    /// [`Unknown::NotConverged`].
    pub fn profile_through(&self, link: Link, x0: f64, start: f64) -> Result<f64, Unknown> {
        newton([0.0, start], [false, true], |c| self.slopes(link, c, x0)).map(|(_, value)| value)
    }

    /// Largest log-likelihood of the lines of a given slope, from those that are 0 at `start` on.
    ///
    /// # Errors
    /// [`Unknown::NotConverged`].
    pub fn profile_with_slope(&self, link: Link, slope: f64, start: f64) -> Result<f64, Unknown> {
        newton([0.0, slope], [true, false], |c| self.slopes(link, c, start)).map(|(_, value)| value)
    }

    /// A unique finite maximum exists if and only if the ranges of what failed and of what stood overlap.
    fn check_overlap(&self) -> Result<(), Unknown> {
        const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];
        let widen = |[low, high]: [f64; 2], x: f64| [low.min(x), high.max(x)];
        let (mut failed, mut stood) = (NOTHING, NOTHING);
        for (x, failures, survivals) in self.rows() {
            failed = if failures > 0.0 { widen(failed, x) } else { failed };
            stood = if survivals > 0.0 { widen(stood, x) } else { stood };
        }
        match (failed == NOTHING, stood == NOTHING) {
            (true, true) => return Err(Unknown::NoData),
            (true, false) => return Err(Unknown::NoFailures),
            (false, true) => return Err(Unknown::FailuresOnly),
            (false, false) => {}
        }
        if failed[0].min(stood[0]) == failed[1].max(stood[1]) {
            return Err(Unknown::OneIntensity);
        }
        if stood[1] <= failed[0] {
            return Err(Unknown::Separated { below: stood[1].exp(), above: failed[0].exp() });
        }
        if failed[1] <= stood[0] {
            return Err(Unknown::NotIncreasing);
        }
        Ok(())
    }
}

/// Newton's method on the coefficients marked free: where it ends, and the log-likelihood there.
fn newton(
    start: [f64; 2],
    free: [bool; 2],
    slopes: impl Fn([f64; 2]) -> Slopes,
) -> Result<([f64; 2], f64), Unknown> {
    let mut at = start;
    let mut now = slopes(at);
    for _ in 0..MAX_STEPS {
        let (step, decrement) = direction(&now, free).ok_or(Unknown::NotConverged)?;
        if decrement < CONVERGED * (1.0 + now.value.abs()) {
            // The last step, from so near, only gains.
            return Ok(([at[0] + step[0], at[1] + step[1]], now.value + 0.5 * decrement));
        }
        (at, now) = climb(at, step, &now, &slopes).ok_or(Unknown::NotConverged)?;
    }
    Err(Unknown::NotConverged)
}

/// The Newton step and its decrement gᵀ H⁻¹ g; none where the information is not positive definite.
fn direction(now: &Slopes, free: [bool; 2]) -> Option<([f64; 2], f64)> {
    let ([aa, ab, bb], g) = (now.information, now.gradient);
    let step = match free {
        [true, true] => {
            let determinant = aa * bb - ab * ab;
            [(bb * g[0] - ab * g[1]) / determinant, (aa * g[1] - ab * g[0]) / determinant]
        }
        [true, false] => [g[0] / aa, 0.0],
        [false, _] => [0.0, g[1] / bb],
    };
    let decrement = step[0] * g[0] + step[1] * g[1];
    (decrement.is_finite() && decrement >= 0.0).then_some((step, decrement))
}

/// The longest of the step, its half, its quarter … that does not lower the likelihood.
fn climb(
    at: [f64; 2],
    step: [f64; 2],
    now: &Slopes,
    slopes: &impl Fn([f64; 2]) -> Slopes,
) -> Option<([f64; 2], Slopes)> {
    let mut length = 1.0;
    // 2⁻⁴⁰ of a step is below the rounding of the coefficients.
    for _ in 0..40 {
        let next = [at[0] + length * step[0], at[1] + length * step[1]];
        let there = slopes(next);
        // Equality ends a search at the rounding of the likelihood itself.
        if there.value >= now.value - 1e-13 * now.value.abs() {
            return Some((next, there));
        }
        length *= 0.5;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(x: &[f64], failures: &[f64], trials: &[f64]) -> Result<Line, Unknown> {
        let weights = vec![1.0; x.len()];
        Counts { x, failures, trials, weights: &weights }.fit(Link::Probit)
    }

    #[test]
    fn analytic_two_stripes_are_met_exactly() {
        // Two coefficients, two stripes: Φ(a + b x) = k/n at both, far from the origin to try the centring.
        for centre in [0.0, 50.0] {
            let line = fit(&[centre - 1.0, centre + 1.0], &[10.0, 80.0], &[100.0, 100.0]).expect("fits");
            let eta = |x: f64| line.intercept + line.slope * x;
            // Condition of the intercept 50 away from the data times rounding.
            assert!((normal::cdf(eta(centre - 1.0)) - 0.1).abs() < 1e-10, "{line:?}");
            assert!((normal::cdf(eta(centre + 1.0)) - 0.8).abs() < 1e-10, "{line:?}");
        }
    }

    #[test]
    fn analytic_weights_count_as_repetitions() {
        let x = [0.0, 1.0, 2.0, 3.0];
        let failures = [0.0, 1.0, 0.0, 1.0];
        let ones = [1.0; 4];
        let weights = [2.0, 1.0, 3.0, 0.0];
        let weighted =
            Counts { x: &x, failures: &failures, trials: &ones, weights: &weights }.fit(Link::Logit);
        let x = [0.0, 0.0, 1.0, 2.0, 2.0, 2.0];
        let failures = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        let repeated = Counts { x: &x, failures: &failures, trials: &[1.0; 6], weights: &[1.0; 6] };
        let (weighted, repeated) = (weighted.expect("fits"), repeated.fit(Link::Logit).expect("fits"));
        // The same sum in another order: rounding over the curvature.
        assert!((weighted.slope - repeated.slope).abs() < 1e-9, "{weighted:?} {repeated:?}");
    }

    #[test]
    fn rejects_data_without_a_maximum() {
        let ones = [1.0; 4];
        let x = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(fit(&x, &[0.0; 4], &ones), Err(Unknown::NoFailures));
        assert_eq!(fit(&x, &[1.0; 4], &ones), Err(Unknown::FailuresOnly));
        assert_eq!(fit(&[], &[], &[]), Err(Unknown::NoData));
        assert_eq!(fit(&[1.0, 1.0], &[1.0, 0.0], &[1.0, 1.0]), Err(Unknown::OneIntensity));
        let separated = fit(&x, &[0.0, 0.0, 1.0, 1.0], &ones);
        let limits = Unknown::Separated { below: 1f64.exp(), above: 2f64.exp() };
        assert_eq!(separated, Err(limits));
        // Touching at one point is separation too: the slope grows without end.
        let touching = fit(&[0.0, 1.0, 1.0, 2.0], &[0.0, 0.0, 1.0, 1.0], &ones);
        assert!(matches!(touching, Err(Unknown::Separated { .. })), "{touching:?}");
        assert_eq!(fit(&x, &[1.0, 1.0, 0.0, 0.0], &ones), Err(Unknown::NotIncreasing));
    }
}
