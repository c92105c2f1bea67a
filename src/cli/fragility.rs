//! `mrbd fragility`: fragilities of a table of outcomes.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::error::{Error, InputError, Result};
use crate::fragility::report::{self, GroupAnalysis};
use crate::fragility::{
    Bootstrap, Columns, EXPRESSION_ALLOWED, Expression, IntensityMeasure, LogNormal, Method, Outcomes,
    Settings, analyse, nrml_document, read_groups,
};
use crate::store::write_durably;

/// Fit log-normal fragilities to outcomes at known intensities.
///
/// FILE is a table (.csv, .parquet) or the output folder of a study. Rows without an outcome are counted, not used.
/// Name what outcomes share with --cluster: outcomes under one record, or of one façade, are not independent, and
/// intervals that take them so are too narrow. Intervals are bias-corrected bootstrap intervals over the clusters,
/// percentile intervals where the correction does not exist, and `?` where the data set no bound.
///
/// Examples:
///   mrbd fragility results --intensity pgv_m_s --outcome outcome --group configuration --cluster record
///   mrbd fragility runs.csv --intensity 'pga_g*9.80665*pgv_over_pga_s' --outcome overturned --json
///   mrbd fragility runs.csv --intensity sa_g --outcome theta1_max_over_alpha1 --exceeds 0.5 --out curves.csv
///   mrbd fragility stripes.csv --intensity sa_g --outcome collapses --trials analyses --nrml f.xml --imt 'SA(0.5)'
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct FragilityCommand {
    /// Table or folder with the outcomes.
    file: PathBuf,
    /// Intensity: a column, or columns and constants joined by * and /.
    #[arg(long, value_name = "EXPRESSION")]
    intensity: String,
    /// Outcome: 0 or 1, false or true, stood or collapsed; empty or `failed` is no outcome.
    #[arg(long, value_name = "COLUMN")]
    outcome: String,
    /// The outcome is a number, and one above X is a failure.
    #[arg(long, value_name = "X", conflicts_with = "trials", allow_negative_numbers = true)]
    exceeds: Option<f64>,
    /// The outcome is a number of failures, out of the number in this column.
    #[arg(long, value_name = "COLUMN")]
    trials: Option<String>,
    /// Fit each value of this column apart; may be given more than once.
    #[arg(long, value_name = "COLUMN")]
    group: Vec<String>,
    /// What outcomes share: record, façade; may be given twice.
    #[arg(long, value_name = "COLUMN")]
    cluster: Vec<String>,
    /// outcomes: failures at given intensities; incremental: the intensity of collapse, or the highest that was stood;
    /// cloud: demands against a limit, the outcome being collapse.
    #[arg(long, value_enum, default_value_t = MethodName::Outcomes)]
    method: MethodName,
    /// Demands of a cloud.
    #[arg(long, value_name = "COLUMN")]
    demand: Option<String>,
    /// Limit of the demands of a cloud.
    #[arg(long, value_name = "X")]
    limit: Option<f64>,
    /// Confidence level of the intervals.
    #[arg(long, value_name = "X", default_value_t = 0.95)]
    level: f64,
    /// Bootstrap replicates; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 2000)]
    replicates: u32,
    /// Seed of the bootstrap.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
    /// Write the curves with their intervals as CSV.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write the fragilities as an OpenQuake fragility model (NRML 0.5).
    #[arg(long, value_name = "FILE", requires = "imt")]
    nrml: Option<PathBuf>,
    /// Intensity measure in OpenQuake's words: PGA, PGV, PGD, SA(T).
    #[arg(long, value_name = "NAME", requires = "nrml")]
    imt: Option<String>,
    /// Factor from the intensity to OpenQuake's unit (g, cm/s, cm), where the column's name does not tell it.
    #[arg(long, value_name = "X", requires = "nrml")]
    imt_factor: Option<f64>,
    /// Name of the limit state in the fragility model.
    #[arg(long, value_name = "NAME", default_value = "collapse")]
    limit_state: String,
}

/// Names of [`Method`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MethodName {
    Outcomes,
    Incremental,
    Cloud,
}

impl FragilityCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors of the options and the table; [`Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        let columns = self.columns()?;
        let settings = self.settings()?;
        let measure = self.measure(&columns.intensity)?;
        let groups: Vec<GroupAnalysis> = read_groups(&self.file, &columns)?
            .into_iter()
            .map(|group| GroupAnalysis {
                analysis: analyse(&group.sample, &settings),
                key: group.key,
                without_outcome: group.without_outcome,
            })
            .collect();
        self.notes(&groups);
        if let Some(path) = &self.out {
            write_curves(path, &self.group, &groups)?;
        }
        if let (Some(path), Some(measure)) = (&self.nrml, &measure) {
            write_durably(path, nrml_document(measure, &self.limit_state, &self.curves(&groups)).as_bytes())?;
        }
        super::output::print(&if self.json {
            format!("{:#}", report::as_json(&self.group, &groups, &settings))
        } else {
            report::table(&self.group, &groups, &settings)
        })
    }

    fn columns(&self) -> Result<Columns> {
        let intensity = Expression::parse(&self.intensity)
            .map_err(|e| InputError::option("--intensity", e.to_string(), EXPRESSION_ALLOWED))?;
        if self.cluster.len() > 2 {
            let found = format!("{} columns", self.cluster.len());
            return Err(InputError::option("--cluster", found, "at most two columns").into());
        }
        let outcome = match (&self.exceeds, &self.trials) {
            (Some(limit), _) => Outcomes::Above(self.outcome.clone(), finite("--exceeds", *limit)?),
            (None, Some(trials)) => Outcomes::Counts(self.outcome.clone(), trials.clone()),
            (None, None) => Outcomes::Words(self.outcome.clone()),
        };
        let (groups, clusters) = (self.group.clone(), self.cluster.clone());
        Ok(Columns { intensity, outcome, demand: self.demand.clone(), groups, clusters })
    }

    fn settings(&self) -> Result<Settings> {
        let within = self.level > 0.0 && self.level < 1.0;
        if !within {
            return Err(InputError::option("--level", self.level.to_string(), "above 0 and below 1").into());
        }
        let bootstrap = Bootstrap { replicates: self.replicates, seed: self.seed };
        Ok(Settings { method: self.method()?, bootstrap, level: self.level })
    }

    fn method(&self) -> Result<Method> {
        if self.method == MethodName::Cloud && self.trials.is_some() {
            let found = "numbers of failures with --method cloud";
            return Err(InputError::option("--trials", found, "a demand and an outcome a row").into());
        }
        match (self.method, &self.demand, self.limit) {
            (MethodName::Outcomes, None, None) => Ok(Method::Outcomes),
            (MethodName::Incremental, None, None) => Ok(Method::Incremental),
            (MethodName::Cloud, Some(_), Some(limit)) if limit > 0.0 && limit.is_finite() => {
                Ok(Method::Cloud { limit })
            }
            (MethodName::Cloud, demand, limit) => {
                let found = format!("--demand {demand:?} and --limit {limit:?}");
                let allowed = "for a cloud, --demand COLUMN and --limit X above 0";
                Err(InputError::option("--method", found, allowed).into())
            }
            _ => Err(InputError::option("--demand", "demands or a limit", "only with --method cloud").into()),
        }
    }

    fn measure(&self, intensity: &Expression) -> Result<Option<IntensityMeasure>> {
        let Some(name) = &self.imt else { return Ok(None) };
        if let Some(factor) = self.imt_factor.filter(|f| !(f.is_finite() && *f > 0.0)) {
            return Err(InputError::option("--imt-factor", factor.to_string(), "a number above 0").into());
        }
        let name_like = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if self.limit_state.is_empty() || !self.limit_state.chars().all(name_like) {
            let allowed = "letters, digits, _ and -";
            return Err(
                InputError::option("--limit-state", format!("{:?}", self.limit_state), allowed).into()
            );
        }
        let measure = IntensityMeasure::new(name, self.imt_factor, intensity.as_column());
        Ok(Some(measure.map_err(|e| {
            let message = e.to_string();
            let (found, allowed) = message.split_once("; allowed: ").unwrap_or((&message, ""));
            InputError::option("--imt", found, allowed)
        })?))
    }

    /// Curves that exist, by group.
    fn curves(&self, groups: &[GroupAnalysis]) -> Vec<(String, LogNormal)> {
        let known = groups.iter().filter_map(|group| {
            let curve = group.analysis.result.as_ref().ok()?.fitted.curve;
            Some((report::name_of(&self.group, &group.key), curve))
        });
        known.collect()
    }

    /// What a reader of the numbers should know.
    fn notes(&self, groups: &[GroupAnalysis]) {
        let lost: usize = groups.iter().map(|group| group.without_outcome).sum();
        if lost > 0 {
            eprintln!("mrbd: note: {lost} rows without an outcome were not used");
        }
        let unknown = groups.iter().filter(|group| group.analysis.result.is_err()).count();
        if unknown > 0 && (self.out.is_some() || self.nrml.is_some()) {
            eprintln!(
                "mrbd: note: {unknown} of {} groups tell no fragility and are in no file",
                groups.len()
            );
        }
        let beyond = groups.iter().filter(|group| group.analysis.extrapolates()).count();
        if beyond > 0 {
            eprintln!(
                "mrbd: note: {beyond} medians lie outside the intensities observed: they are extrapolated"
            );
        }
        if self.cluster.is_empty() {
            eprintln!("mrbd: note: without --cluster, outcomes are taken as independent");
        }
    }
}

fn finite(option: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(InputError::option(option, value.to_string(), "a finite number").into())
}

fn write_curves(path: &Path, columns: &[String], groups: &[GroupAnalysis]) -> Result<()> {
    let mut text = Vec::new();
    report::write_curves(&mut text, columns, groups).map_err(|e| Error::table(path, e))?;
    write_durably(path, &text)
}
