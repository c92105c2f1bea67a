//! `mrbd fragility`: fragilities of a table of outcomes, or of a study of drawn façades.

mod asked;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use self::asked::{Asked, State};
use super::output::check_apart;
use crate::error::{Error, InputError, Result};
use crate::fragility::report::{self, GroupAnalysis};
use crate::fragility::{
    Bootstrap, EXPRESSION_ALLOWED, Expression, IntensityMeasure, LogNormal, Method, REPLICATES, Settings,
    analyse, nrml_document, read_groups,
};
use crate::store::write_durably;
use crate::study::runs::Completeness;

/// Fit log-normal fragilities to outcomes at known intensities.
///
/// FILE is a table (.csv, .parquet) or the output folder of a study. Rows without an outcome are counted, not used.
/// Name what outcomes share with --cluster: outcomes under one record, or of one façade, are not independent, and
/// intervals that take them so are too narrow. Intervals are bias-corrected bootstrap intervals over the clusters,
/// percentile intervals where the correction does not exist, and `?` where the data set no bound.
///
/// Of a study of drawn façades (kinds monte_carlo, cloud, stripes, incremental) only the intensity need be named, and that
/// only where the study was not scaled to one: the outcome is collapse, and each --threshold; groups are variant and
/// configuration, clusters record and draw, unless others are named.
///
/// Examples:
///   mrbd fragility outputs/fragility --threshold 0.1 --threshold 0.5 --out curves.csv
///   mrbd fragility outputs/monte_carlo --intensity pgv_m_s --nrml collapse.xml --imt PGV
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
    intensity: Option<String>,
    /// Outcome: 0 or 1, false or true, stood or collapsed; empty or `failed` is no outcome.
    #[arg(long, value_name = "COLUMN")]
    outcome: Option<String>,
    /// Of a study of drawn façades: a rotation over α_i that is a limit too, beside collapse; may be given more than once.
    #[arg(long, value_name = "X", conflicts_with = "outcome", allow_negative_numbers = true)]
    threshold: Vec<f64>,
    /// The outcome is a number, and one above X is a failure.
    #[arg(
        long,
        value_name = "X",
        conflicts_with = "trials",
        allow_negative_numbers = true,
        requires = "outcome"
    )]
    exceeds: Option<f64>,
    /// The outcome is a number of failures, out of the number in this column.
    #[arg(long, value_name = "COLUMN", requires = "outcome")]
    trials: Option<String>,
    /// Fit each value of this column apart; may be given more than once.
    #[arg(long, value_name = "COLUMN")]
    group: Vec<String>,
    /// What outcomes share: record, façade; may be given twice.
    #[arg(long, value_name = "COLUMN")]
    cluster: Vec<String>,
    /// outcomes: failures at given intensities; incremental: the intensity of collapse, or the highest that was stood;
    /// cloud: demands against a limit, the outcome being collapse. Without it incremental for a study of that kind, and
    /// outcomes for all else.
    #[arg(long, value_enum)]
    method: Option<MethodName>,
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
    #[arg(long, value_name = "N", default_value_t = REPLICATES)]
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
    /// Input errors of the options and the table; [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        check_apart("--out", self.out.as_deref(), &[&self.file])?;
        check_apart("--nrml", self.nrml.as_deref(), &[&self.file])?;
        let asked = self.asked()?;
        let measure = self.measure(asked.intensity())?;
        let answer = self.answer_to(&asked)?;
        super::aggregate::tell_unfinished(answer.study);
        answer.notes.iter().for_each(|note| eprintln!("mrbd: note: {note}"));
        if let Some(path) = &self.out {
            write_curves(path, &answer)?;
        }
        if let (Some(path), Some(measure)) = (&self.nrml, &measure) {
            let (states, functions) = self.functions(&asked, &answer.groups);
            let note = answer.study.and_then(|study| study.note());
            let text = nrml_document(measure, &states, &functions, note.as_deref());
            write_durably(path, text.as_bytes())?;
        }
        super::output::print(&if self.json { format!("{:#}", answer.json()) } else { answer.table() })
    }

    /// The fragilities that are asked for; nothing is printed or written.
    ///
    /// # Errors
    /// Input errors of the options and the table.
    pub fn answer(&self) -> Result<FragilityAnswer> {
        self.answer_to(&self.asked()?)
    }

    fn answer_to(&self, asked: &Asked) -> Result<FragilityAnswer> {
        let study = if self.file.is_dir() { Completeness::of(&self.file)? } else { None };
        let settings = self.settings(asked.incremental)?;
        let mut groups = Vec::new();
        for state in &asked.states {
            groups.extend(self.analysed(state, &settings)?);
        }
        let notes = self.notes(asked, &groups);
        Ok(FragilityAnswer { columns: asked.columns.clone(), groups, settings, study, notes })
    }

    /// The groups of a limit state; its name comes last in their keys.
    fn analysed(&self, state: &State, settings: &Settings) -> Result<Vec<GroupAnalysis>> {
        let groups = read_groups(&self.file, &state.columns)?.into_iter().map(|group| GroupAnalysis {
            analysis: analyse(&group.sample, settings),
            key: group.key.into_iter().chain(state.name.clone()).collect(),
            without_outcome: group.without_outcome,
        });
        Ok(groups.collect())
    }

    fn expression(&self, given: &str) -> Result<Expression> {
        let refuse = |e: crate::fragility::NotAnExpression| {
            InputError::option("--intensity", e.to_string(), EXPRESSION_ALLOWED)
        };
        Ok(Expression::parse(given).map_err(refuse)?)
    }

    fn settings(&self, incremental: bool) -> Result<Settings> {
        let within = self.level > 0.0 && self.level < 1.0;
        if !within {
            return Err(InputError::option("--level", self.level.to_string(), "above 0 and below 1").into());
        }
        // The outermost rank of n replicates is 1/(n + 1) from the end: fewer promise too narrow an interval.
        let least = (2.0 / (1.0 - self.level)).round() - 1.0;
        if self.replicates > 0 && f64::from(self.replicates) < least {
            let allowed =
                format!("0 for intervals of the profile likelihood, or {least} or more at this --level");
            return Err(InputError::option("--replicates", self.replicates.to_string(), allowed).into());
        }
        let bootstrap = Bootstrap { replicates: self.replicates, seed: self.seed };
        Ok(Settings { method: self.method(incremental)?, bootstrap, level: self.level })
    }

    fn method(&self, incremental: bool) -> Result<Method> {
        let default = if incremental { MethodName::Incremental } else { MethodName::Outcomes };
        let method = self.method.unwrap_or(default);
        if method == MethodName::Cloud && self.trials.is_some() {
            let found = "numbers of failures with --method cloud";
            return Err(InputError::option("--trials", found, "a demand and an outcome a row").into());
        }
        match (method, &self.demand, self.limit) {
            (MethodName::Outcomes, None, None) => Ok(Method::Outcomes),
            (MethodName::Incremental, None, None) => Ok(Method::Incremental),
            (MethodName::Cloud, Some(_), Some(limit)) if limit > 0.0 && limit.is_finite() => {
                Ok(Method::Cloud { limit })
            }
            (MethodName::Cloud, demand, limit) => {
                let demand =
                    demand.as_ref().map_or("no --demand".to_owned(), |column| format!("--demand {column}"));
                let limit = limit.map_or("no --limit".to_owned(), |limit| format!("--limit {limit}"));
                let found = format!("{demand} and {limit}");
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

    /// Limit states, and the curves of the groups that have one for each of them.
    fn functions(
        &self,
        asked: &Asked,
        groups: &[GroupAnalysis],
    ) -> (Vec<String>, Vec<(String, Vec<LogNormal>)>) {
        let keys = asked.columns.len() - usize::from(asked.has_limits);
        let mut states: Vec<String> = Vec::new();
        let mut functions: Vec<(String, Vec<Option<LogNormal>>)> = Vec::new();
        for group in groups {
            let name = report::name_of(&asked.columns[..keys], &group.key[..keys]);
            let state =
                group.key.get(keys).map_or(self.limit_state.clone(), |limit| asked::state_name(limit));
            let state = states.iter().position(|known| *known == state).unwrap_or_else(|| {
                states.push(state);
                states.len() - 1
            });
            let curve = group.analysis.result.as_ref().ok().map(|known| known.fitted.curve);
            let at = functions.iter().position(|(known, _)| *known == name).unwrap_or_else(|| {
                functions.push((name, Vec::new()));
                functions.len() - 1
            });
            let curves = &mut functions[at].1;
            curves.resize(curves.len().max(state + 1), None);
            curves[state] = curve;
        }
        let complete = |(name, curves): (String, Vec<Option<LogNormal>>)| {
            let all = curves.len() == states.len();
            Some((name, curves.into_iter().collect::<Option<Vec<_>>>().filter(|_| all)?))
        };
        let functions = functions.into_iter().filter_map(complete).collect();
        (states, functions)
    }

    /// What a reader of the numbers should know, each a sentence.
    fn notes(&self, asked: &Asked, groups: &[GroupAnalysis]) -> Vec<String> {
        let mut notes = Vec::new();
        let lost: usize = groups.iter().map(|group| group.without_outcome).sum();
        if lost > 0 {
            notes.push(format!("{lost} rows without an outcome were not used"));
        }
        let unknown = groups.iter().filter(|group| group.analysis.result.is_err()).count();
        if unknown > 0 && (self.out.is_some() || self.nrml.is_some()) {
            notes.push(format!("{unknown} of {} groups tell no fragility and are in no file", groups.len()));
            if asked.has_limits && self.nrml.is_some() {
                notes.push("a fragility model holds only what tells one for every limit".into());
            }
        }
        let beyond = groups.iter().filter(|group| group.analysis.extrapolates()).count();
        if beyond > 0 {
            notes.push(format!(
                "{beyond} medians lie outside the intensities observed: they are extrapolated"
            ));
        }
        if asked.lies_above() {
            notes.push(LIES_ABOVE.into());
        }
        let open = groups.iter().filter(|group| group.analysis.has_open_ends()).count();
        if open > 0 {
            notes.push(format!("{open} {OPEN_ENDS}"));
        }
        if asked.clusters().is_empty() {
            notes.push("without --cluster, outcomes are taken as independent".into());
        }
        notes
    }
}

const LIES_ABOVE: &str =
    "intensities are those at the upper end of each bracket; of the study's own measure the middle is taken";
const OPEN_ENDS: &str = "intervals have an end `?`: so many replicates drew outcomes that tell no fragility that they reach \
    past it; more façades or records close it, and `--replicates 0` gives intervals of the profile likelihood, which take \
    outcomes as independent";

/// Fragilities, and what a reader of them should know.
#[derive(Debug, Clone)]
pub struct FragilityAnswer {
    /// Names of the parts of a group's key.
    columns: Vec<String>,
    groups: Vec<GroupAnalysis>,
    settings: Settings,
    /// Of a study's folder, how much of it is there.
    study: Option<Completeness>,
    /// What a reader of the numbers should know, each a sentence.
    notes: Vec<String>,
}

impl FragilityAnswer {
    /// Names of the parts of a group's key: the first columns of [`FragilityAnswer::curves`].
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// What a reader of the numbers should know, each a sentence: that the study is unfinished comes first.
    pub fn warnings(&self) -> Vec<String> {
        self.study.and_then(|study| study.note()).into_iter().chain(self.notes.iter().cloned()).collect()
    }

    /// Everything, as `--json` prints it.
    pub fn json(&self) -> serde_json::Value {
        report::as_json(&self.columns, &self.groups, &self.settings, self.study)
    }

    /// One line a group, for people.
    pub fn table(&self) -> String {
        report::table(&self.columns, &self.groups, &self.settings, self.study)
    }

    /// The curves with their intervals as CSV.
    ///
    /// # Errors
    /// What the writer says.
    pub fn curves(&self, out: impl std::io::Write) -> csv::Result<()> {
        report::write_curves(out, &self.columns, &self.groups, self.study)
    }
}

fn finite(option: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(InputError::option(option, value.to_string(), "a finite number").into())
}

fn write_curves(path: &Path, answer: &FragilityAnswer) -> Result<()> {
    let mut text = Vec::new();
    answer.curves(&mut text).map_err(|e| Error::table(path, e))?;
    write_durably(path, &text)
}
