//! `mrbd records check`: a suite against the code spectrum of a site.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::{print, print_json, print_table};
use crate::error::{Error, InputError, Result};
use crate::text::signed_percent;
use mrbd_records::{COMPATIBLE_DEVIATION, COMPATIBLE_PERIODS_S, Site, Suite, SuiteCheck};

/// Check the mean spectrum of a suite against the Italian code spectrum (NTC 2018) of a site.
///
/// Examples:
///   mrbd records check inputs/records/emilia7/suite.toml --site inputs/site_mirandola.toml
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct CheckArgs {
    /// Suite file.
    suite: PathBuf,
    /// Site file: `[site]` with ag_g, f0, tc_star_s, soil, topography and damping.
    #[arg(long, value_name = "FILE")]
    site: PathBuf,
    #[command(flatten)]
    band: PeriodArgs,
    /// Print JSON, with the spectra.
    #[arg(long)]
    json: bool,
}

/// Periods and deviations that make a suite compatible.
#[derive(Debug, Clone, Args)]
pub(super) struct PeriodArgs {
    /// Shortest period.
    #[arg(long, value_name = "SECONDS", default_value_t = COMPATIBLE_PERIODS_S.0)]
    from: f64,
    /// Longest period.
    #[arg(long, value_name = "SECONDS", default_value_t = COMPATIBLE_PERIODS_S.1)]
    to: f64,
    /// Deviation allowed below the code, relative.
    #[arg(long, value_name = "X", default_value_t = COMPATIBLE_DEVIATION.0, allow_negative_numbers = true)]
    below: f64,
    /// Deviation allowed above the code, relative.
    #[arg(long, value_name = "X", default_value_t = COMPATIBLE_DEVIATION.1)]
    above: f64,
}

impl PeriodArgs {
    /// Shortest and longest period, and deviations below and above, once they make sense.
    pub(super) fn checked(&self) -> Result<[(f64, f64); 2], InputError> {
        if !(self.from >= 0.0 && self.from < self.to && self.to <= 10.0) {
            let found = format!("{} to {} s", self.from, self.to);
            return Err(InputError::option("--from and --to", found, "0 <= from < to <= 10 s"));
        }
        if !(self.below <= 0.0 && self.above >= 0.0) {
            let found = format!("{} and {}", self.below, self.above);
            return Err(InputError::option("--below and --above", found, "a number <= 0 and a number >= 0"));
        }
        Ok([(self.from, self.to), (self.below, self.above)])
    }
}

pub(super) fn execute(args: &CheckArgs) -> Result<()> {
    let [periods, deviation] = args.band.checked()?;
    let site = Site::load(&args.site)?;
    let suite = Suite::load(&args.suite)?;
    let check = SuiteCheck::of(&suite, &site, periods);
    let is_compatible = check.is_within(deviation);
    let range =
        format!("{} to {}", signed_percent(check.lowest_deviation), signed_percent(check.highest_deviation));
    let allowed = format!("{} to {}", signed_percent(deviation.0), signed_percent(deviation.1));
    if args.json {
        let facts = json!({ "suite": suite.name, "generated": suite.generated, "compatible": is_compatible, "check": check });
        print_json(&facts)?;
        return judged(&suite, is_compatible, &range, &allowed);
    }
    let every_tenth = (0..check.period_s.len()).step_by(10);
    let rows: Vec<Vec<String>> = every_tenth.map(|i| row(&check, i)).collect();
    print_table(&["period s", "code m/s2", "mean m/s2", "deviation"], &rows)?;
    let verdict = if is_compatible { "compatible" } else { "not compatible" };
    print(&format!(
        "{}: {range} over {} to {} s, {verdict} (allowed {allowed})",
        suite.name, periods.0, periods.1
    ))?;
    judged(&suite, is_compatible, &range, &allowed)
}

/// What a script learns from the exit code.
fn judged(suite: &Suite, is_compatible: bool, found: &str, allowed: &str) -> Result<()> {
    let [found, allowed] = [found, allowed].map(str::to_owned);
    if is_compatible {
        Ok(())
    } else {
        Err(Error::Incompatible { suite: suite.name.clone(), found, allowed })
    }
}

fn row(check: &SuiteCheck, i: usize) -> Vec<String> {
    let (code, mean) = (check.code_m_s2[i], check.mean_m_s2[i]);
    vec![
        format!("{:.2}", check.period_s[i]),
        format!("{code:.3}"),
        format!("{mean:.3}"),
        signed_percent(mean / code - 1.0),
    ]
}
