//! Where a study's results come from, written before the first result.
//!
//! A folder is resumed only by the plan it was begun with: how another plan differs is said.

use std::num::NonZero;
use std::path::Path;

use super::schema::{OLDEST_READ, SCHEMA_VERSION};
use crate::error::{Error, InputError, Result};
use crate::store::durable::{folder_of, write_durably, write_durably_if_absent};
use crate::store::now_unix_s;
use crate::study::campaign::{self, Layout};
use crate::study::pipeline::{Kind, Pipeline, Variant};
use crate::study::plan::{Plan, RecordHash};
use crate::study::sequence::{Part, Sequence};
use mrbd_files::FileNote;
use mrbd_kernel::model::G_M_S2;
use mrbd_records::SuiteRecord;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Provenance of an output folder: tool, plan, inputs, assumptions.
///
/// `kind` tells what the runs are; readers choose by it. `sweep`: the mean façade, one parameter at a time. The others are
/// of façades drawn from the survey, with a `draw` for each run and neither `parameter` nor `level`: `monte_carlo` under
/// the records as the suite has them, `cloud` each run at a `factor` of its own, `stripes` at intensities that were chosen
/// (columns `intensity_measure`, `intensity`), `incremental` at the intensity that first exceeds a `limit`
/// (`limit_exceeded`, `stood_intensity`), `variance` in matrices of a pick-freeze design (`matrix`). `sequence`: façades of
/// either sort under records one after another, a row a `part`. What was asked for stands in `study`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the program.
    pub tool_version: String,
    /// Version of the columns.
    pub schema_version: u32,
    /// Kind of the study.
    pub kind: Kind,
    /// Name of the study.
    pub plan: String,
    /// SHA-256 of the list of runs.
    pub plan_sha256: String,
    /// Number of runs.
    pub runs: u64,
    /// Runs stored at once: how the plan is cut into blocks.
    pub block_runs: u64,
    /// Seed of random draws; none where nothing is drawn.
    pub seed: Option<u64>,
    /// What is drawn: configurations, sampling, loading, and the probability that each truncation took; null for a sweep.
    pub study: serde_json::Value,
    /// The records.
    pub suite: SuiteNote,
    /// Records one after another, in the order of the plan; empty where each is run by itself.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sequences: Vec<SequenceNote>,
    /// Files that were read, with their hashes.
    pub inputs: Vec<FileNote>,
    /// Acceleration of gravity, m/s².
    pub gravity_m_s2: f64,
    /// Assumptions, by variant.
    pub variants: serde_json::Value,
    /// When the run began, seconds since 1970.
    pub started_unix_s: u64,
}

/// A sequence of records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SequenceNote {
    /// Its name.
    pub name: String,
    /// Names of its records in order.
    pub records: Vec<String>,
    /// Factor on each.
    pub scale: Vec<f64>,
    /// Rest between them, s.
    pub rest_s: f64,
}

/// A suite of records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SuiteNote {
    /// Its name.
    pub name: String,
    /// Whether its records are generated rather than recorded.
    pub generated: bool,
    /// Its records.
    pub records: Vec<RecordNote>,
}

/// One record as it was run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordNote {
    /// Its name.
    pub name: String,
    /// Its event.
    pub event: String,
    /// Factor it was scaled by.
    pub scale: f64,
    /// SHA-256 of its samples after scaling.
    pub sha256: String,
    /// The same of its vertical component, if it has one.
    pub vertical_sha256: Option<String>,
}

impl Manifest {
    /// The manifest of a plan stored in blocks of so many runs, or of as many as suit its size, begun now; `suite_path` is the suite file
    /// that was read.
    ///
    /// # Errors
    /// Input errors if an input file is gone.
    pub fn of(
        plan: &Plan,
        pipeline: &Pipeline,
        suite_path: &Path,
        block_runs: Option<NonZero<u64>>,
    ) -> Result<Self> {
        let files = [
            ("pipeline", pipeline.path.as_path()),
            ("survey", &pipeline.survey),
            ("coefficients", &pipeline.coefficients),
            ("suite", suite_path),
        ];
        let variants: Vec<&Variant> = plan.variants().collect();
        let mut manifest = Self {
            tool_version: env!("CARGO_PKG_VERSION").to_owned(),
            schema_version: SCHEMA_VERSION,
            kind: plan.kind(),
            plan: plan.name().to_owned(),
            plan_sha256: plan.sha256(),
            runs: plan.len(),
            block_runs: 0,
            seed: plan.drawn().map(|drawn| drawn.sampling.seed),
            study: study_note(plan),
            suite: SuiteNote::of(plan),
            sequences: plan.sequences().map(|sequence| SequenceNote::of(sequence, plan)).collect(),
            inputs: files
                .into_iter()
                .map(|(role, path)| FileNote::of(role, path))
                .collect::<Result<_, _>>()?,
            gravity_m_s2: G_M_S2,
            variants: serde_json::json!(variants),
            started_unix_s: now_unix_s(),
        };
        let suitable = campaign::block_runs(Layout::of(&manifest).runs_per_record());
        manifest.block_runs = block_runs.map_or(suitable, NonZero::get);
        Ok(manifest)
    }

    /// Whether a file is a manifest of this tool, of whatever version; not where there is none.
    ///
    /// # Errors
    /// An input error for a file that is something else.
    pub fn is_any_version(path: &Path) -> Result<bool> {
        let bytes = match std::fs::read(path) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(false),
            read => read.map_err(|e| Error::io("read", path, e))?,
        };
        let manifest = serde_json::from_slice::<serde_json::Value>(&bytes).unwrap_or_default();
        if manifest["plan_sha256"].is_string() && manifest["tool_version"].is_string() {
            return Ok(true);
        }
        Err(InputError::file(path, "no manifest of a study", "the manifest of a study").into())
    }

    /// Reads a manifest; none where there is none.
    ///
    /// # Errors
    /// An input error for a file that is no manifest.
    pub fn read(path: &Path) -> Result<Option<Self>> {
        match std::fs::read(path) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(e) => Err(Error::io("read", path, e)),
            Ok(bytes) => Self::parse(path, &bytes).map(Some),
        }
    }

    fn parse(path: &Path, bytes: &[u8]) -> Result<Self> {
        let refuse = |found: String, allowed: String| InputError::file(path, found, allowed).into();
        let broken = |e: serde_json::Error| refuse(e.to_string(), "the manifest of a study".to_owned());
        let value: serde_json::Value = serde_json::from_slice(bytes).map_err(broken)?;
        let other = |kind: &&str| Kind::ALL.iter().all(|study| study.name() != *kind);
        if let Some(kind) = value["kind"].as_str().filter(other) {
            let kind = if kind == "comparison" { "comparison of models" } else { kind };
            let allowed = "the output folder of a study of many façades, from `mrbd run`; this one is for `mrbd report`";
            return Err(refuse(format!("the results of a {kind}"), allowed.to_owned()));
        }
        match value["schema_version"].as_u64() {
            Some(version) if !(u64::from(OLDEST_READ)..=u64::from(SCHEMA_VERSION)).contains(&version) => {
                let by = value["tool_version"].as_str().unwrap_or("another version");
                let found = format!("results with columns of version {version}, written by mrbd {by}");
                let allowed = format!(
                    "columns of versions {OLDEST_READ} to {SCHEMA_VERSION}: run the study again with --force"
                );
                Err(refuse(found, allowed))
            }
            _ => serde_json::from_value(value).map_err(broken),
        }
    }

    /// Writes it.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn write(&self, path: &Path) -> Result<()> {
        write_durably(path, self.text(path).as_bytes())
    }

    /// Writes it unless another process did first; whether this one wrote.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub(super) fn write_if_absent(&self, path: &Path) -> Result<bool> {
        write_durably_if_absent(path, self.text(path).as_bytes())
    }

    fn text(&self, path: &Path) -> String {
        let folder = folder_of(path);
        let inputs = self.inputs.iter().map(|note| note.clone().seen_from(folder)).collect();
        format!("{:#}\n", serde_json::json!(Manifest { inputs, ..self.clone() }))
    }

    /// Names of what the runs are stored by, in the order of the plan: sequences, or records.
    pub fn motions(&self) -> Vec<&str> {
        match self.sequences.is_empty() {
            true => self.suite.records.iter().map(|record| record.name.as_str()).collect(),
            false => self.sequences.iter().map(|sequence| sequence.name.as_str()).collect(),
        }
    }

    /// What these are: the key in the names of the folders of runs.
    pub fn motion_key(&self) -> &'static str {
        if self.sequences.is_empty() { "record" } else { "sequence" }
    }

    /// What every Parquet file of the study says about itself: no times, so that equal studies give equal bytes.
    pub fn file_metadata(&self) -> Vec<(String, String)> {
        let pair = |key: &str, value: String| (format!("mrbd.{key}"), value);
        vec![
            pair("tool_version", self.tool_version.clone()),
            pair("schema_version", self.schema_version.to_string()),
            pair("kind", self.kind.name().to_owned()),
            pair("plan", self.plan.clone()),
            pair("plan_sha256", self.plan_sha256.clone()),
            pair("seed", self.seed.map_or("none".to_owned(), |seed| seed.to_string())),
            pair("study", self.study.to_string()),
            pair("suite", self.suite.name.clone()),
            pair("suite_generated", self.suite.generated.to_string()),
            pair("gravity_m_s2", self.gravity_m_s2.to_string()),
            pair("variants", self.variants.to_string()),
        ]
    }
}

/// What is drawn, and what truncations took of it.
fn study_note(plan: &Plan) -> serde_json::Value {
    let Some(drawn) = plan.drawn() else { return serde_json::Value::Null };
    let mut note = serde_json::json!(drawn);
    for (configuration, variable, probability) in plan.truncated() {
        note["truncated_probability"][configuration.name()][variable.name()] = probability.into();
    }
    note
}

impl SequenceNote {
    fn of(sequence: &Sequence, plan: &Plan) -> Self {
        let name = |part: &Part| plan.motions().suite.records[part.record_index].name.clone();
        Self {
            name: sequence.name.clone(),
            records: sequence.parts.iter().map(name).collect(),
            scale: sequence.parts.iter().map(|part| part.scale).collect(),
            rest_s: sequence.rest_s,
        }
    }
}

impl SuiteNote {
    fn of(plan: &Plan) -> Self {
        let motions = plan.motions();
        let record = |(record, hash): (&SuiteRecord, &RecordHash)| RecordNote {
            name: record.name.clone(),
            event: record.event.clone(),
            scale: record.scale,
            sha256: hash.horizontal.clone(),
            vertical_sha256: hash.vertical.clone(),
        };
        Self {
            name: motions.suite.name.clone(),
            generated: motions.suite.generated,
            records: motions.suite.records.iter().zip(&motions.hashes).map(record).collect(),
        }
    }
}

/// Differences told; the first ones show what happened.
const TOLD: usize = 6;

/// What decides results and is not the same: key, what is there, what was asked for. Empty for the same study.
pub(super) fn differences(there: &Manifest, now: &Manifest) -> Vec<String> {
    let mut found = Vec::new();
    compare("", &deciding(there), &deciding(now), &mut found);
    let more = found.len().saturating_sub(TOLD);
    found.truncate(TOLD);
    if more > 0 {
        found.push(format!("and {more} more"));
    }
    found
}

/// A manifest without what does not decide: the time, where files lie, and the pipeline's text, whose comments may
/// change; what the pipeline says is in the plan's hash and the variants.
fn deciding(manifest: &Manifest) -> Value {
    let mut same = Manifest { started_unix_s: 0, ..manifest.clone() };
    same.inputs.retain(|input| input.role != "pipeline");
    for input in &mut same.inputs {
        input.path.clear();
        input.path_from_folder = None;
    }
    serde_json::json!(same)
}

fn compare(key: &str, there: &Value, now: &Value, found: &mut Vec<String>) {
    match (there, now) {
        (Value::Object(a), Value::Object(b)) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            for name in names {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                compare(
                    &key,
                    a.get(name).unwrap_or(&Value::Null),
                    b.get(name).unwrap_or(&Value::Null),
                    found,
                );
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                compare(&format!("{key}[{i}]"), a, b, found);
            }
        }
        (Value::Array(a), Value::Array(b)) => {
            found.push(format!("{key}: {} entries, now {}", a.len(), b.len()));
        }
        (a, b) if a != b => found.push(format!("{key}: {a}, now {b}")),
        _ => {}
    }
}
