//! `mrbd margin`: how far a wall is from falling, under each record of a suite.

use std::path::{Path, PathBuf};

use clap::Args;

use super::progress::Bar;
use super::threads::Threads;
use super::{Answer, output};
use crate::assessment::margin::{COLUMNS, Curve, FILES, KIND, Margin, Question, capacities, curves};
use crate::error::{Error, InputError, Result};
use crate::store::{WholeFolder, now_unix_s, print_csv, write_durably, write_table};
use crate::study::ladder::Ladder;
use crate::study::pipeline::Limit;
use mrbd_files::{FileNote, load_wall};
use mrbd_kernel::simulate::Accuracy;
use mrbd_lab::Progress;
use mrbd_records::Suite;

/// The smallest factor on each record of a suite that overturns a wall, and the fragility of this wall.
///
/// Factors grow from --from by --growth until the limit is exceeded; the last step is halved until it is --bracket wide.
/// An ensemble of 16 runs at the factor found says whether the wall exceeds the limit there whatever nobody can know.
/// stdout has one line a record; median and dispersion over the records go to stderr, with 95 % intervals.
///
/// Examples:
///   mrbd margin wall.toml --suite records/suite.toml --out outputs/margin
///   mrbd margin wall.toml --suite records/suite.toml --limit 0.5 --json
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, allow_negative_numbers = true)]
pub struct MarginCommand {
    /// Wall file (TOML).
    wall: PathBuf,
    /// Suite file (TOML).
    #[arg(long, value_name = "FILE")]
    suite: PathBuf,
    /// `collapse`, or a rotation over α_i that may not be exceeded.
    #[arg(long, value_name = "LIMIT", default_value = "collapse")]
    limit: String,
    /// First factor on the records; where it is too much already, factors fall from it.
    #[arg(long, value_name = "X", default_value_t = 0.25)]
    from: f64,
    /// Last factor.
    #[arg(long, value_name = "X", default_value_t = 32.0)]
    to: f64,
    /// Each factor over the one before, 1.0001 to 10. Large steps can pass over a fall.
    #[arg(long, value_name = "X", default_value_t = 1.1)]
    growth: f64,
    /// Factor that exceeds the limit over the one below it that does not, 1.0001 to 10.
    #[arg(long, value_name = "X", default_value_t = 1.01)]
    bracket: f64,
    /// Free motion after a record.
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0)]
    tail: f64,
    /// Error allowed in rotations relative to α_i; 1e-13 to 1e-2.
    #[arg(long, value_name = "X", default_value_t = 1e-6)]
    tolerance: f64,
    /// Write margin.parquet, margin.json and a page into a folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the results in that folder.
    #[arg(long, requires = "out")]
    force: bool,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    threads: Threads,
}

impl MarginCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Bad input; results that cannot be written.
    pub fn execute(self) -> Result<()> {
        self.answer(&Bar::of_counted_runs())?.print(self.json)
    }

    /// Searches the factors and writes what is to be written; nothing is printed.
    ///
    /// # Errors
    /// As [`MarginCommand::execute`].
    pub fn answer(&self, told: &dyn Progress) -> Result<Answer> {
        let started_unix_s = now_unix_s();
        let question = self.question()?;
        let suite = Suite::load(&self.suite)?;
        let folder =
            self.out.as_deref().map(|out| WholeFolder::check(out, &FILES, self.force)).transpose()?;
        let margin = self.margin(&question, &suite, told)?;
        let write = |folder: WholeFolder| self.write(folder.cleared()?, &margin, &suite, started_unix_s);
        let page = folder.map(write).transpose()?;
        let json = as_json(&margin, Path::new("stdout"))?;
        let mut text = Vec::new();
        print_csv(&mut text, COLUMNS.iter(), &margin.records).map_err(output::failed)?;
        let text = String::from_utf8_lossy(&text).into_owned();
        Ok(Answer { json, text, notes: notes(&margin), page })
    }

    fn question(&self) -> Result<Question> {
        let wall = load_wall(&self.wall)?;
        let ratio = wall.parameters().collapse_rotation_ratio;
        let positive = "finite numbers, 0 < from < to";
        let range = [self.from, self.to];
        let ordered = self.from > 0.0 && self.to > self.from && self.to.is_finite();
        require("--from", &format!("from {} to {}", self.from, self.to), ordered, positive)?;
        for (option, factor) in [("--growth", self.growth), ("--bracket", self.bracket)] {
            require(option, &factor.to_string(), (1.0001..=10.0).contains(&factor), "1.0001 to 10")?;
        }
        let tail_holds = self.tail.is_finite() && self.tail >= 0.0;
        require("--tail", &self.tail.to_string(), tail_holds, "a finite number of seconds, 0 or more")?;
        let accurate = Accuracy::TOLERANCES.contains(&self.tolerance);
        require("--tolerance", &self.tolerance.to_string(), accurate, Accuracy::ALLOWED)?;
        Ok(Question {
            limit: limit(&self.limit, ratio)?,
            wall,
            ladder: Ladder { range, growth: self.growth, bracket: self.bracket },
            accuracy: Accuracy { tolerance: self.tolerance },
            tail_s: self.tail,
        })
    }

    fn margin(&self, question: &Question, suite: &Suite, told: &dyn Progress) -> Result<Margin> {
        told.begin("records", suite.records.len());
        let search = || capacities(question, &suite.records, |parts| told.advance(parts));
        let records = self.threads.pool()?.install(search);
        Ok(Margin {
            wall: self.wall.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            suite: suite.name.clone(),
            limit: question.limit.to_string(),
            range: question.ladder.range,
            growth: question.ladder.growth,
            bracket: question.ladder.bracket,
            tolerance: question.accuracy.tolerance,
            tail_s: question.tail_s,
            fragility: curves(&records),
            records,
        })
    }

    fn write(&self, folder: &Path, margin: &Margin, suite: &Suite, started_unix_s: u64) -> Result<PathBuf> {
        let [manifest_json, margin_json, margin_parquet] = FILES.map(|name| folder.join(name));
        let inputs = [("wall", &self.wall), ("suite", &self.suite)];
        let inputs = inputs.map(|(role, path)| FileNote::of(role, path).map(|note| note.seen_from(folder)));
        let [wall, suite_file] = inputs;
        let manifest = serde_json::json!({
            "kind": KIND,
            "name": margin.wall,
            "tool_version": env!("CARGO_PKG_VERSION"),
            "suite": suite.name,
            "generated": suite.generated,
            "inputs": [wall?, suite_file?],
            "started_unix_s": started_unix_s,
        });
        write_durably(&manifest_json, format!("{manifest:#}\n").as_bytes())?;
        write_durably(&margin_json, as_json(margin, &margin_json)?.as_bytes())?;
        let about = [("wall", &margin.wall), ("suite", &margin.suite), ("limit", &margin.limit)];
        let about = about.map(|(key, value)| (key.to_owned(), value.clone()));
        write_table(&margin_parquet, &COLUMNS, &about, &margin.records)?;
        super::report::write_page(folder, None)
    }
}

fn require(option: &str, found: &str, holds: bool, allowed: &str) -> Result<(), InputError> {
    if holds { Ok(()) } else { Err(InputError::option(option, found, allowed)) }
}

fn limit(text: &str, collapse_rotation_ratio: f64) -> Result<Limit, InputError> {
    if text == "collapse" {
        return Ok(Limit::Collapse);
    }
    let rotation = text.parse::<f64>().ok().filter(|x| *x > 0.0 && *x < collapse_rotation_ratio);
    let allowed = || {
        format!(
            "collapse, or a rotation over α_i above 0 and below {collapse_rotation_ratio}, where the wall collapses"
        )
    };
    rotation.map(Limit::Rotation).ok_or_else(|| InputError::option("--limit", format!("{text:?}"), allowed()))
}

fn as_json(margin: &Margin, path: &Path) -> Result<String> {
    serde_json::to_string_pretty(margin).map_err(|e| Error::io("write the margin", path, e.into()))
}

/// What people read: the fragility, and what is not sure.
fn notes(margin: &Margin) -> Vec<String> {
    let mut notes: Vec<String> = margin.fragility.iter().map(sentence).collect();
    let unsure =
        margin.records.iter().filter(|record| record.exceeding_share.is_some_and(|share| share < 1.0));
    notes.extend(unsure.map(|record| {
        let percent = 100.0 * record.exceeding_share.unwrap_or_default();
        format!("{}: at the factor found, {percent:.0} % of the ensemble exceed the limit", record.record)
    }));
    let beyond = margin.records.iter().filter(|record| !record.beyond_model.is_empty());
    notes.extend(beyond.map(|record| {
        format!("{}: the model does not apply: {}", record.record, record.beyond_model.join("; "))
    }));
    notes
}

fn sentence(curve: &Curve) -> String {
    let number = |value: Option<f64>| value.map_or("?".to_owned(), |value| format!("{value:.4}"));
    let ends = |[lower, upper]: [Option<f64>; 2]| format!("[{}, {}]", number(lower), number(upper));
    match &curve.unknown {
        Some(reason) => format!("{}: no fragility: {reason}", curve.measure),
        None => format!(
            "{}: median {} {}, dispersion {} {}",
            curve.measure,
            number(curve.median),
            ends(curve.median_interval),
            number(curve.beta),
            ends(curve.beta_interval)
        ),
    }
}
