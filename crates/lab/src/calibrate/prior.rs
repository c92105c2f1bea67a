//! What was known beforehand, as it counts in the cost.

use nalgebra::DVector;

use super::parameter::Parameter;

/// exp(½ Σ z² / n), z in standard deviations known beforehand, n independent samples.
///
/// With absolute errors after Laplace, of unknown size, -ln likelihood is n ln WME; adding ½ Σ z² for the prior and
/// taking the n-th root gives this factor. One when nothing was known.
pub fn prior_factor(parameters: &[Parameter], values: &[f64], independent_samples: f64) -> f64 {
    let z = |(p, x): (&Parameter, &f64)| p.prior_sd.map_or(0.0, |sd| (x - p.nominal) / sd);
    let squares = parameters.iter().zip(values).map(|pair| z(pair).powi(2)).sum::<f64>();
    (0.5 * squares / independent_samples).exp()
}

/// The first two derivatives of ln f, by which a cost is raised for what was known beforehand, over shares of the bounds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LnPrior {
    pub slope: DVector<f64>,
    /// Of each variable by itself.
    pub curvature: DVector<f64>,
    /// How much the slope would differ had what was known been drawn anew: its standard deviation.
    pub scatter: DVector<f64>,
}

impl LnPrior {
    /// Nothing was known.
    pub fn flat(variables: usize) -> Self {
        let zero = DVector::zeros(variables);
        Self { slope: zero.clone(), curvature: zero.clone(), scatter: zero }
    }
}

/// ln [`prior_factor`] about a vector.
pub(super) fn ln_prior(parameters: &[Parameter], values: &[f64], independent_samples: f64) -> LnPrior {
    // The bounds' width in standard deviations; none where nothing was known.
    let width = |p: &Parameter| p.prior_sd.map_or(0.0, |sd| p.bounds.width() / sd);
    let z = |p: &Parameter, x: f64| p.prior_sd.map_or(0.0, |sd| (x - p.nominal) / sd);
    let of = |f: &dyn Fn(&Parameter, f64) -> f64| {
        let all = parameters.iter().zip(values).map(|(p, x)| f(p, *x) / independent_samples);
        DVector::from_iterator(parameters.len(), all)
    };
    LnPrior {
        slope: of(&|p, x| width(p) * z(p, x)),
        curvature: of(&|p, _| width(p).powi(2)),
        scatter: of(&|p, _| width(p)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::{Bounds, Target};

    #[test]
    fn analytic_the_prior_of_gauss_newton_is_that_of_the_cost() {
        let parameter = |name: &str, nominal: f64, prior_sd: Option<f64>| Parameter {
            name: name.into(),
            target: Target::Key(vec![name.into()]),
            bounds: Bounds { lower: 0.8 * nominal, upper: 1.3 * nominal },
            nominal,
            prior_sd,
        };
        let parameters = [parameter("k", 37e3, Some(1e3)), parameter("m", 180.0, None)];
        let ln = |share: f64| {
            let values = parameters.clone().map(|p| p.bounds.at(share));
            prior_factor(&parameters, &values, 40.0).ln()
        };
        let values = parameters.clone().map(|p| p.bounds.at(0.7));
        let prior = ln_prior(&parameters, &values, 40.0);
        let slope = (ln(0.701) - ln(0.699)) / 0.002;
        let curvature = (ln(0.701) - 2.0 * ln(0.7) + ln(0.699)) / 1e-6;
        // ln f is quadratic: what is left are roundings of numbers near ten over the squared difference.
        assert!((prior.slope.sum() / slope - 1.0).abs() < 1e-9, "{prior:?} {slope}");
        assert!((prior.curvature.sum() / curvature - 1.0).abs() < 1e-6, "{prior:?} {curvature}");
        assert_eq!((prior.slope[1], prior.curvature[1]), (0.0, 0.0));
    }
}
