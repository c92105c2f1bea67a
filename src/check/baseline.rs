//! The baseline file: read, made from a study, written.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::tolerance::{middle, reruns, told, tolerances};
use crate::aggregate::{Measure, Medians};
use crate::error::{Error, InputError, Result};
use crate::store::write_durably;

/// How the lines begin that say why medians were accepted.
const ACCEPTED: &str = "# accepted: ";

/// The median of one measure of one case, and how far it may move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Set of assumptions.
    pub variant: String,
    /// How the floor runs.
    pub configuration: String,
    /// Parameter off its mean.
    pub parameter: String,
    /// Its level.
    pub level: String,
    /// h_tot / b.
    pub slenderness: f64,
    /// Normalised largest rotation, a column of the run files.
    pub measure: String,
    /// Runs.
    pub runs: u64,
    /// Runs that failed.
    pub failed: u64,
    /// Runs that collapsed.
    pub collapsed: u64,
    /// How far that number may move.
    pub collapsed_tolerance: u64,
    /// Median; none where it is a collapse.
    pub median: Option<f64>,
    /// How far it may move; endless where a rounding decides between standing and collapse.
    pub tolerance: f64,
}

/// What tells an entry apart.
pub(super) type Key<'a> = (&'a str, &'a str, &'a str, &'a str, u64, &'a str);

impl Entry {
    pub(super) fn key(&self) -> Key<'_> {
        let bits = self.slenderness.to_bits();
        (&self.variant, &self.configuration, &self.parameter, &self.level, bits, &self.measure)
    }
}

/// Accepted medians.
#[derive(Debug, Clone, PartialEq)]
pub struct Baseline {
    /// Why they were accepted, the earliest first.
    pub accepted: Vec<String>,
    /// Where the tolerances come from.
    pub tolerance_source: String,
    /// The medians, in the order of the plan.
    pub entries: Vec<Entry>,
}

impl Baseline {
    /// The medians of the first variant of a study; `folder` is named in errors.
    ///
    /// # Errors
    /// An input error for a study without a variant that differs by a tighter tolerance alone: the tolerances of the
    /// baseline come from such variants.
    pub fn of(medians: &Medians, folder: &Path) -> Result<Self> {
        let reruns = reruns(&medians.variants);
        let (Some(base), false) = (medians.variants.first(), reruns.is_empty()) else {
            let allowed = "a study whose pipeline has a variant that sets a tighter `tolerance` alone";
            return Err(InputError::file(folder, "no such variant", allowed).into());
        };
        let rows = medians.rows().iter();
        let rows = rows.filter(|row| row.case.variant == base.name && Measure::BODIES.contains(&row.measure));
        let entries = rows.map(|row| {
            let (tolerance, collapsed_tolerance) = tolerances(medians, &reruns, row);
            Entry {
                variant: row.case.variant.clone(),
                configuration: row.case.configuration.name().to_owned(),
                parameter: row.case.parameter.name().to_owned(),
                level: row.case.level.name(row.case.parameter).to_owned(),
                slenderness: row.case.slenderness,
                measure: row.measure.column().to_owned(),
                runs: row.runs,
                failed: row.failed,
                collapsed: row.collapsed,
                collapsed_tolerance,
                median: middle(row),
                tolerance,
            }
        });
        let entries = entries.collect();
        Ok(Self { accepted: Vec::new(), tolerance_source: told(&reruns), entries })
    }

    /// Reads a baseline file.
    ///
    /// # Errors
    /// Input errors that name the file and the line.
    pub fn load(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .map_err(|e| InputError::file(path, e.to_string(), "a baseline of `mrbd check --accept`"))?;
        let after = |start: &'static str| text.lines().filter_map(move |line| line.strip_prefix(start));
        let mut csv = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
        let entries: Result<Vec<Entry>, csv::Error> = csv.deserialize().collect();
        let entries = entries.map_err(|e| {
            let line = e.position().map_or(1, |position| position.line() as usize);
            InputError::line(path, line, e.to_string(), "an entry of a baseline")
        })?;
        if entries.is_empty() {
            return Err(InputError::file(path, "no entries", "a baseline of `mrbd check --accept`").into());
        }
        Ok(Self {
            accepted: after(ACCEPTED).map(str::to_owned).collect(),
            tolerance_source: after("# tolerance: ").next().unwrap_or("not told").to_owned(),
            entries,
        })
    }

    /// Writes it.
    ///
    /// # Errors
    /// [`Error::Io`] if the disk refuses.
    pub fn write(&self, path: &Path) -> Result<()> {
        let mut text = format!("# tolerance: {}\n", self.tolerance_source);
        self.accepted.iter().for_each(|why| text += &format!("{ACCEPTED}{why}\n"));
        let mut csv = csv::Writer::from_writer(text.into_bytes());
        let failed = |e: csv::Error| Error::io("write", path, std::io::Error::other(e));
        self.entries.iter().try_for_each(|entry| csv.serialize(entry)).map_err(failed)?;
        let bytes = csv.into_inner().map_err(|e| Error::io("write", path, e.into_error()))?;
        write_durably(path, &bytes)
    }
}
