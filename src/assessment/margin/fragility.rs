//! The fragility of one wall: a log-normal over the records of the intensities at which it exceeds a limit.

use serde::{Deserialize, Serialize};

use super::capacity::{Capacity, Status};
use crate::fragility::{Bootstrap, Interval, Method, Sample, Settings, analyse};

/// Confidence level of the intervals.
const LEVEL: f64 = 0.95;
/// Replicates behind them, as `mrbd fragility` has it.
const BOOTSTRAP: Bootstrap = Bootstrap { replicates: 2000, seed: 1 };

/// A value of a capacity; `None` where it has none.
type Measure = fn(&Capacity) -> Option<f64>;

/// Measures of intensity, by their names: each is a fragility of its own.
pub const MEASURES: [(&str, Measure); 3] =
    [("scale", |c| c.scale.or(c.stood_scale)), ("pga_g", |c| c.pga_g), ("pgv_m_s", |c| c.pgv_m_s)];

/// A log-normal fragility in a measure of intensity.
///
/// Of largest likelihood (Baker 2015, Eq. 7 and 8): a record under which the wall stood is known to need more than the
/// last factor. Where it exceeded the limit under all, these are mean and standard deviation of ln x, over n.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name of the measure, with its unit.
    pub measure: String,
    /// Median, in the unit of the measure; `None` where the data tell none.
    pub median: Option<f64>,
    /// Its 95 % interval: bias-corrected bootstrap over the records. A bound the data do not set is `None`.
    pub median_interval: [Option<f64>; 2],
    /// Dispersion β, the standard deviation of ln x.
    pub beta: Option<f64>,
    /// Its interval.
    pub beta_interval: [Option<f64>; 2],
    /// Why there is no curve; `None` where there is one.
    pub unknown: Option<String>,
}

/// The fragility in every measure; records whose search failed or found no lower end are left out.
pub fn curves(capacities: &[Capacity]) -> Vec<Curve> {
    MEASURES.iter().map(|(name, measure)| curve(name, *measure, capacities)).collect()
}

fn curve(name: &str, measure: Measure, capacities: &[Capacity]) -> Curve {
    let rows = capacities.iter().filter_map(|capacity| match capacity.status {
        Status::Exceeded => Some((measure(capacity)?, true)),
        Status::Stood => Some((measure(capacity)?, false)),
        Status::Always | Status::Failed => None,
    });
    let settings = Settings { method: Method::Incremental, bootstrap: BOOTSTRAP, level: LEVEL };
    let unknown = |reason: String| Curve {
        measure: name.to_owned(),
        median: None,
        median_interval: [None; 2],
        beta: None,
        beta_interval: [None; 2],
        unknown: Some(reason),
    };
    let sample = match Sample::from_outcomes(rows) {
        Ok(sample) => sample,
        Err(impossible) => return unknown(impossible.to_string()),
    };
    let known = match analyse(&sample, &settings).result {
        Ok(known) => known,
        Err(reason) => return unknown(reason.to_string()),
    };
    let bounds = known.best().map(|(_, bounds)| bounds);
    let ends = |interval: Option<Interval>| interval.map_or([None; 2], |i| [i.lower, i.upper]);
    Curve {
        measure: name.to_owned(),
        median: Some(known.fitted.curve.median()),
        median_interval: ends(bounds.map(|bounds| bounds.median)),
        beta: Some(known.fitted.curve.beta()),
        beta_interval: ends(bounds.map(|bounds| bounds.beta)),
        unknown: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn capacity(scale: f64, exceeded: bool) -> Capacity {
        Capacity {
            record: String::new(),
            status: if exceeded { Status::Exceeded } else { Status::Stood },
            scale: exceeded.then_some(scale),
            stood_scale: Some(scale),
            pga_g: Some(0.1 * scale),
            pgv_m_s: None,
            exceeding_share: None,
            beyond_model: Vec::new(),
            runs: 1,
        }
    }

    #[test]
    fn analytic_capacities_that_are_all_known_give_their_moments() {
        let found = curves(&[1.0, 2.0, 4.0].map(|scale| capacity(scale, true)));
        // ln x is -ln 2, 0, ln 2 about its mean; over n that is √(2/3) ln 2. Newton's method ends to rounding.
        let beta = (2.0_f64 / 3.0).sqrt() * 2.0_f64.ln();
        assert!((found[0].median.expect("a median") - 2.0).abs() < 1e-9);
        assert!((found[0].beta.expect("a dispersion") - beta).abs() < 1e-9);
        assert!((found[1].median.expect("a median") - 0.2).abs() < 1e-9);
        // Without values there is no curve, and a reason.
        assert!(found[2].median.is_none() && found[2].unknown.is_some());
    }

    #[test]
    fn analytic_a_record_that_was_stood_raises_the_median() {
        let all = [1.0, 2.0, 4.0].map(|scale| capacity(scale, true));
        let some = [capacity(1.0, true), capacity(2.0, true), capacity(4.0, false)];
        let median = |capacities: &[Capacity]| curves(capacities)[0].median.expect("a median");
        assert!(median(&some) > median(&all));
    }
}
