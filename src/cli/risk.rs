//! `mrbd risk`: how often a limit state is reached in a year.

use std::path::PathBuf;

use clap::Args;

use super::Answer;
use crate::assessment::risk::{Risk, read_fragilities, read_hazard};
use crate::error::{InputError, Result};
use crate::text::aligned;

/// Annual rate and return period of each limit state: fragilities and a hazard curve.
///
/// FRAGILITY is margin.json of `mrbd margin`, the output of `mrbd fragility --json`, or a fragility model in NRML 0.5.
/// The hazard curve is CSV (a first column named by its measure, as pga_g; annual_rate, or poe with --years;
/// annual_rate_16 and annual_rate_84 for its uncertainty), or OpenQuake's NRML of one site. Between two points it is
/// a power law, beyond the last one the same law goes on. Intervals are of 95 %.
///
/// Examples:
///   mrbd risk outputs/margin/margin.json --hazard hazard.csv
///   mrbd risk fragility.json --hazard hazard.csv --years 50 --json
///   mrbd risk fragility.xml --hazard hazard_curve-mean.xml
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct RiskCommand {
    /// File with fragilities.
    fragility: PathBuf,
    /// Hazard curve (.csv, .xml).
    #[arg(long, value_name = "FILE")]
    hazard: PathBuf,
    /// Time that the probabilities of exceedance (poe) of a CSV are for, years.
    #[arg(long, value_name = "YEARS")]
    years: Option<f64>,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
}

/// Shares of a rate beyond the hazard curve that are worth a word.
const MUCH: f64 = 0.05;

impl RiskCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Bad input.
    pub fn execute(self) -> Result<()> {
        self.answer()?.print(self.json)
    }

    /// Computes the rates; nothing is printed.
    ///
    /// # Errors
    /// As [`RiskCommand::execute`].
    pub fn answer(&self) -> Result<Answer> {
        if let Some(years) = self.years.filter(|years| !(years.is_finite() && *years > 0.0)) {
            return Err(InputError::option("--years", years.to_string(), "a number above 0").into());
        }
        let hazard = read_hazard(&self.hazard, self.years)?;
        let states = read_fragilities(&self.fragility, &hazard.measure)?;
        let risks: Vec<Risk> = states.iter().map(|state| Risk::of(state, &hazard)).collect();
        let json = format!("{:#}", serde_json::json!({ "measure": hazard.measure, "limit_states": risks }));
        let mut notes = Vec::new();
        if risks.iter().any(|risk| risk.limit_state.measure.is_none()) {
            let measure = &hazard.measure;
            notes.push(format!(
                "note: the fragilities do not name their measure; it is taken to be {measure}"
            ));
        }
        notes.extend(risks.iter().flat_map(beyond));
        Ok(Answer { json, text: table(&risks), notes, page: None })
    }
}

/// What of a rate lies beyond the hazard curve.
fn beyond(risk: &Risk) -> Vec<String> {
    let mut notes = Vec::new();
    let name = &risk.limit_state.name;
    if risk.above_share > MUCH {
        let percent = 100.0 * risk.above_share;
        notes.push(format!(
            "note: {name}: {percent:.0} % of the rate lies beyond the last point of the hazard curve"
        ));
    }
    if risk.below_share > MUCH {
        let percent = 100.0 * risk.below_share;
        notes.push(format!(
            "note: {name}: {percent:.0} % of the rate lies below its first point: the rate is no less than told"
        ));
    }
    notes
}

fn table(risks: &[Risk]) -> String {
    let head = ["limit state", "annual rate, 1/year", "95 % from", "to", "return period, years", "of"];
    let row = |risk: &Risk| {
        let [low, high] = risk
            .annual_rate_interval
            .map_or(["–".to_owned(), "–".to_owned()], |ends| ends.map(|rate| format!("{rate:.3e}")));
        let (rate, years) = (format!("{:.3e}", risk.annual_rate), format!("{:.0}", risk.return_period_years));
        vec![risk.limit_state.name.clone(), rate, low, high, years, risk.interval_of.join("+")]
    };
    let rows: Vec<Vec<String>> =
        std::iter::once(head.map(str::to_owned).to_vec()).chain(risks.iter().map(row)).collect();
    aligned(&rows)
}
