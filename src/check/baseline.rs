//! The baseline file: read, made from a study, written.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::tolerance::{reruns, told, with_tolerances};
use crate::aggregate::{
    CAPACITY, Distribution, Distributions, Measure, Median, Medians, Middle, VariantNote,
};
use crate::error::{Error, InputError, Result};
use crate::store::write_durably;
use crate::study::pipeline::Kind;

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
    /// Parameter off its mean; empty for drawn façades.
    pub parameter: String,
    /// Its level; of drawn façades the stripe or limit.
    pub level: String,
    /// h_tot / b; none for drawn façades.
    pub slenderness: Option<f64>,
    /// Record; empty over all of them.
    #[serde(default)]
    pub record: String,
    /// Normalised largest rotation, a column of the run files; or `capacity`.
    pub measure: String,
    /// Runs.
    pub runs: u64,
    /// Runs that failed.
    pub failed: u64,
    /// Runs that collapsed.
    pub collapsed: u64,
    /// How far that number may move.
    pub collapsed_tolerance: u64,
    /// Median; none where it is a collapse, or a limit never exceeded.
    pub median: Option<f64>,
    /// How far it may move; endless where a rounding decides between standing and collapse.
    pub tolerance: f64,
}

/// What tells an entry apart, and the entries of different variants together.
pub(super) type Key<'a> = (&'a str, &'a str, &'a str, &'a str, Option<u64>, &'a str, &'a str);

impl Entry {
    pub(super) fn key(&self) -> Key<'_> {
        let bits = self.slenderness.map(f64::to_bits);
        let Self { variant, configuration, parameter, level, record, measure, .. } = self;
        (variant, configuration, parameter, level, bits, record, measure)
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
    /// The medians of the first variant of a study, from `figures` of all its variants; `folder` is named in errors.
    ///
    /// # Errors
    /// An input error for a study without a variant that differs by a tighter tolerance alone: the tolerances of the
    /// baseline come from such variants.
    pub fn of(variants: &[VariantNote], figures: Vec<Entry>, folder: &Path) -> Result<Self> {
        let reruns = reruns(variants);
        let (Some(base), false) = (variants.first(), reruns.is_empty()) else {
            let names: Vec<String> = variants.iter().map(|variant| format!("{:?}", variant.name)).collect();
            let found = format!(
                "variants {}, none of which differs from the first by a tighter tolerance alone",
                names.join(", ")
            );
            let allowed = "a study with such a variant, for the tolerances of medians come from it: `[[variants]]`, \
                           `name = \"tighter\"` and `set = { tolerance = 1e-8 }` in its pipeline";
            return Err(InputError::file(folder, found, allowed).into());
        };
        let (bases, mut others): (Vec<Entry>, Vec<Entry>) =
            figures.into_iter().partition(|entry| entry.variant == base.name);
        others.retain(|entry| reruns.iter().any(|rerun| rerun.name == entry.variant));
        let entries = with_tolerances(bases, &others);
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
    /// [`mrbd_files::Error::Io`] if the disk refuses.
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

/// The medians of θ_i/α_i of a sweep.
pub fn figures_of_sweep(medians: &Medians) -> Vec<Entry> {
    let rows = medians.rows().iter().filter(|row| Measure::BODIES.contains(&row.measure));
    rows.map(of_median).collect()
}

/// The medians of a study of drawn façades: θ_i/α_i, or the intensities at which limits are exceeded.
pub fn figures_of_drawn(study: &Distributions) -> Vec<Entry> {
    let quantities: &[&str] = match study.kind {
        Kind::Incremental => &[CAPACITY],
        _ => &["theta1_max_over_alpha1", "theta2_max_over_alpha2"],
    };
    let rows = study.rows.iter().filter(|row| quantities.contains(&row.quantity));
    rows.map(|row| of_distribution(row, study.measure.as_deref())).collect()
}

fn of_median(row: &Median) -> Entry {
    let median = match row.middle() {
        Some(Middle::Rotation(value)) => Some(value),
        _ => None,
    };
    Entry {
        variant: row.case.variant.clone(),
        configuration: row.case.configuration.name().to_owned(),
        parameter: row.case.parameter.name().to_owned(),
        level: row.case.level.name(row.case.parameter).to_owned(),
        slenderness: Some(row.case.slenderness),
        record: String::new(),
        measure: row.measure.column().to_owned(),
        runs: row.runs,
        failed: row.failed,
        collapsed: row.collapsed,
        collapsed_tolerance: 0,
        median,
        tolerance: 0.0,
    }
}

fn of_distribution(row: &Distribution, measure: Option<&str>) -> Entry {
    Entry {
        variant: row.variant.clone(),
        configuration: row.configuration.clone(),
        parameter: String::new(),
        level: row.stratum(measure),
        slenderness: None,
        record: row.record.clone().unwrap_or_default(),
        measure: row.quantity.to_owned(),
        runs: row.runs,
        failed: row.failed,
        collapsed: row.beyond,
        collapsed_tolerance: 0,
        median: row.median(),
        tolerance: 0.0,
    }
}
