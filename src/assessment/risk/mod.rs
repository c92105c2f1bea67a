//! Annual rates of limit states: fragilities that mrbd wrote, and a hazard curve.

mod fragilities;
mod hazard_file;
mod nrml;

pub use fragilities::{LimitState, read_fragilities};
pub use hazard_file::{HazardFile, read_hazard};

use serde::{Deserialize, Serialize};

use mrbd_assessment::{Uncertainty, annual_rate, rate_quantiles};
use mrbd_statistics::normal;

/// Level of the intervals, as fragilities have them.
const LEVEL: f64 = 0.95;

/// How often a limit state is reached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Risk {
    /// The limit state.
    pub limit_state: LimitState,
    /// 1/year.
    pub annual_rate: f64,
    /// Its 95 % interval; `None` where nothing is known of what is uncertain.
    pub annual_rate_interval: Option<[f64; 2]>,
    /// 1/annual_rate, years.
    pub return_period_years: f64,
    /// Its interval, years.
    pub return_period_interval_years: Option<[f64; 2]>,
    /// What the interval covers: `fragility` (records, façades), `hazard`.
    pub interval_of: Vec<String>,
    /// Share of the rate from beyond the hazard curve's last point.
    pub above_share: f64,
    /// Share from below its first point, where the rate is no less than taken.
    pub below_share: f64,
}

impl Risk {
    /// Of a limit state under a hazard.
    pub fn of(limit_state: &LimitState, hazard: &HazardFile) -> Self {
        let LimitState { median, beta, .. } = *limit_state;
        let rate = annual_rate(&hazard.curve, median, beta);
        // Half-widths of 95 % intervals of logarithms.
        let z = normal::quantile(0.5 + 0.5 * LEVEL);
        let deviation =
            |ends: Option<[f64; 2]>| ends.map_or(0.0, |[low, high]| (high / low).ln() / (2.0 * z));
        let unknown = Uncertainty {
            ln_median: deviation(limit_state.median_interval),
            ln_beta: deviation(limit_state.beta_interval),
            ln_rate: hazard.ln_rate_deviation.unwrap_or(0.0),
        };
        let of_fragility = unknown.ln_median > 0.0 || unknown.ln_beta > 0.0;
        let parts = [("fragility", of_fragility), ("hazard", unknown.ln_rate > 0.0)];
        let interval_of: Vec<String> =
            parts.into_iter().filter(|(_, known)| *known).map(|(name, _)| name.to_owned()).collect();
        let ends = [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL];
        let interval =
            (!interval_of.is_empty()).then(|| rate_quantiles(&hazard.curve, median, beta, &unknown, ends));
        Self {
            limit_state: limit_state.clone(),
            annual_rate: rate.annual_rate,
            annual_rate_interval: interval,
            return_period_years: 1.0 / rate.annual_rate,
            return_period_interval_years: interval.map(|[low, high]| [1.0 / high, 1.0 / low]),
            interval_of,
            above_share: rate.above_share,
            below_share: rate.below_share,
        }
    }
}
