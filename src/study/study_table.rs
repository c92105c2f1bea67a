//! What a pipeline file asks for beside the files it names: the kind of the study and the tables that go with it.

use std::fmt;
use std::path::Path;

use serde::{Deserialize, Deserializer, Serialize};

use super::pipeline::SweepTable;
use super::pipeline::Variant;
use super::plan::Matrix;
use super::sequence::{self, SequenceTable};
use super::variance_table::{Variance, check_variance};
use crate::error::{InputError, Result};
use crate::survey::Configuration;
use crate::survey::sampling::Sampling;
use mrbd_kernel::simulate::Response;
use mrbd_records::ScaledMeasure;

/// The `kind` of a pipeline file, and of the manifest of its results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// One parameter at a time (the source's section 4.2); what a file without a kind is.
    #[default]
    Sweep,
    /// Façades drawn from the survey, under the records as the suite has them.
    MonteCarlo,
    /// The same, each run at a factor drawn for it.
    Cloud,
    /// The same, every record scaled to each of some intensities.
    Stripes,
    /// The same, every record scaled up until the wall reaches a limit.
    Incremental,
    /// Façades of a sweep or drawn ones, under records one after another.
    Sequence,
    /// Points in which all that could be otherwise is drawn, laid out so that shares of the variance can be told.
    Variance,
}

impl Kind {
    /// All seven.
    pub const ALL: [Self; 7] = [
        Self::Sweep,
        Self::MonteCarlo,
        Self::Cloud,
        Self::Stripes,
        Self::Incremental,
        Self::Sequence,
        Self::Variance,
    ];

    /// Name in pipeline files and manifests.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Sweep => "sweep",
            Kind::MonteCarlo => "monte_carlo",
            Kind::Cloud => "cloud",
            Kind::Stripes => "stripes",
            Kind::Incremental => "incremental",
            Kind::Sequence => "sequence",
            Kind::Variance => "variance",
        }
    }

    /// Whether it tells of façades drawn from the survey. Those of sequences may be drawn; what it tells is another thing.
    pub fn is_drawn(self) -> bool {
        !matches!(self, Kind::Sweep | Kind::Sequence)
    }
}

/// Which façades, and how strongly the records shake them.
#[derive(Debug, Clone, PartialEq)]
pub enum Study {
    /// The mean façade, one parameter at a time.
    Sweep(SweepTable),
    /// Façades drawn from the survey.
    Drawn(Drawn),
}

/// Façades drawn from the survey, and how strongly the records shake them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Drawn {
    /// How the floor runs.
    pub configurations: Vec<Configuration>,
    /// How the façades are drawn; both configurations share the draws.
    pub sampling: Sampling,
    /// Factors on the records.
    pub loading: Loading,
}

/// How strongly the records of a suite shake the façades.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Loading {
    /// As the suite has them.
    OwnScale,
    /// At factors drawn for every run.
    Cloud(Cloud),
    /// At chosen intensities.
    Stripes(Stripes),
    /// At growing intensities until a limit is exceeded.
    Incremental(Incremental),
    /// At one factor, each draw once in every matrix of a pick-freeze design.
    Variance(Variance),
}

impl Drawn {
    /// Runs of one draw under one record and one set of assumptions.
    pub fn runs_per_draw(&self) -> usize {
        self.configurations.len() * self.loading.strata()
    }
}

impl Loading {
    /// Intensities, limits or matrices of one draw.
    pub fn strata(&self) -> usize {
        match self {
            Loading::OwnScale | Loading::Cloud(_) => 1,
            Loading::Stripes(stripes) => stripes.levels.len(),
            Loading::Incremental(incremental) => incremental.limits.len(),
            Loading::Variance(variance) => Matrix::of(variance).len(),
        }
    }
}

/// Limits of factors on the suite's records, whose logarithm is drawn uniformly.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cloud {
    /// No factor below it.
    pub from: f64,
    /// No factor above it.
    pub to: f64,
}

/// Intensities that every record is scaled to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stripes {
    /// What is scaled to, in the unit of its name.
    pub measure: ScaledMeasure,
    /// Its values.
    pub levels: Vec<f64>,
}

/// Growing intensities (Vamvatsikos & Cornell 2002): from the first by a factor until the limit is exceeded, then between
/// the last two by halving their logarithm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Incremental {
    /// Limits, each an analysis of its own.
    pub limits: Vec<Limit>,
    /// What grows, in the unit of its name.
    pub measure: ScaledMeasure,
    /// The first intensity; where it exceeds the limit already, intensities fall from it by the same factor.
    pub from: f64,
    /// The last intensity; a wall that stands it without exceeding the limit is known to stand it, and no more.
    pub to: f64,
    /// Each intensity over the one before, above 1.
    pub growth: f64,
    /// The lowest intensity found to exceed the limit over the highest below it found not to, at most.
    pub bracket: f64,
}

/// What a wall may reach at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// It must not collapse.
    Collapse,
    /// Neither θ_1/α_1 nor θ_2/α_2 may exceed this, and it must not collapse.
    Rotation(f64),
}

impl Limit {
    /// Whether a response exceeds it; a collapse does in any case.
    pub fn exceeded_by(&self, response: &Response) -> bool {
        response.collapsed()
            || match self {
                Limit::Collapse => false,
                Limit::Rotation(over_alpha_i) => response.theta_max_over_own_alpha() > *over_alpha_i,
            }
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Limit::Collapse => f.write_str("collapse"),
            Limit::Rotation(over_alpha_i) => write!(f, "{over_alpha_i}"),
        }
    }
}

impl Serialize for Limit {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Limit::Collapse => serializer.serialize_str("collapse"),
            Limit::Rotation(over_alpha_i) => serializer.serialize_f64(*over_alpha_i),
        }
    }
}

impl<'de> Deserialize<'de> for Limit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl serde::de::Visitor<'_> for Visitor {
            type Value = Limit;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"collapse\", or a rotation over α_i")
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Limit, E> {
                match text {
                    "collapse" => Ok(Limit::Collapse),
                    other => Err(E::invalid_value(serde::de::Unexpected::Str(other), &self)),
                }
            }

            fn visit_f64<E>(self, value: f64) -> Result<Limit, E> {
                Ok(Limit::Rotation(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Limit, E> {
                Ok(Limit::Rotation(value as f64))
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

/// The tables of a pipeline file that belong to one kind of study or another.
pub(super) struct StudyTables {
    pub sweep: Option<SweepTable>,
    pub configurations: Option<Vec<Configuration>>,
    pub sampling: Option<Sampling>,
    pub cloud: Option<Cloud>,
    pub stripes: Option<Stripes>,
    pub incremental: Option<Incremental>,
    pub sequence: Vec<SequenceTable>,
    pub variance: Option<Variance>,
}

impl StudyTables {
    /// The study of a kind, its tables checked: those it needs, and no others.
    pub fn study(self, path: &Path, kind: Kind, variants: &[Variant]) -> Result<Study> {
        self.check_keys(path, kind)?;
        sequence::check(path, &self.sequence)?;
        let loading = match (kind, self.cloud, self.stripes, self.incremental, self.variance) {
            (Kind::Cloud, Some(cloud), ..) => Loading::Cloud(checked_cloud(path, cloud)?),
            (Kind::Stripes, _, Some(stripes), ..) => Loading::Stripes(checked_stripes(path, stripes)?),
            (Kind::Incremental, .., Some(incremental), _) => {
                Loading::Incremental(checked_incremental(path, incremental, variants)?)
            }
            (Kind::Variance, .., Some(variance)) => Loading::Variance(variance.checked(path)?),
            _ => Loading::OwnScale,
        };
        match (self.sweep, self.sampling) {
            (Some(sweep), _) => {
                sweep.check(path)?;
                Ok(Study::Sweep(sweep))
            }
            (None, Some(sampling)) => {
                if kind == Kind::Variance {
                    check_variance(path, &sampling, variants)?;
                }
                let configurations = checked_configurations(path, self.configurations)?;
                Ok(Study::Drawn(Drawn { configurations, sampling, loading }))
            }
            (None, None) => Err(lacking(path, kind, "sampling").into()),
        }
    }

    fn check_keys(&self, path: &Path, kind: Kind) -> Result<(), InputError> {
        let drawn = kind.is_drawn();
        let after_another = kind == Kind::Sequence;
        // Of sequences the façades are those of one table or of the other.
        if after_another && self.sweep.is_some() == self.sampling.is_some() {
            let found = "neither or both of [sweep] and [sampling] in a study of kind \"sequence\"";
            return Err(InputError::key(path, "sampling", found, "one of the two, which says what façades"));
        }
        let may_draw = drawn || after_another && self.sampling.is_some();
        // Key, whether it is there, whether the kind needs it, whether the kind may have it.
        let keys = [
            ("sweep", self.sweep.is_some(), kind == Kind::Sweep, !drawn),
            ("sampling", self.sampling.is_some(), drawn, may_draw),
            ("configurations", self.configurations.is_some(), false, may_draw),
            ("cloud", self.cloud.is_some(), kind == Kind::Cloud, kind == Kind::Cloud),
            ("stripes", self.stripes.is_some(), kind == Kind::Stripes, kind == Kind::Stripes),
            ("incremental", self.incremental.is_some(), kind == Kind::Incremental, kind == Kind::Incremental),
            ("sequence", !self.sequence.is_empty(), after_another, after_another),
            ("variance", self.variance.is_some(), kind == Kind::Variance, kind == Kind::Variance),
        ];
        for (key, there, needed, allowed) in keys {
            if needed && !there {
                return Err(lacking(path, kind, key));
            }
            if there && !allowed {
                let found = format!("it in a study of kind {:?}", kind.name());
                return Err(InputError::key(path, key, found, "only in a study of its own kind"));
            }
        }
        Ok(())
    }
}

fn lacking(path: &Path, kind: Kind, key: &str) -> InputError {
    let found = format!("missing field `{key}` of a study of kind {:?}", kind.name());
    InputError::key(path, key, found, "this key must be given")
}

fn checked_configurations(path: &Path, given: Option<Vec<Configuration>>) -> Result<Vec<Configuration>> {
    let Some(configurations) = given else { return Ok(Configuration::ALL.to_vec()) };
    let twice = (1..configurations.len()).any(|i| configurations[..i].contains(&configurations[i]));
    if configurations.is_empty() || twice {
        let found = format!("{:?}", configurations.iter().map(|c| c.name()).collect::<Vec<_>>());
        let allowed = "\"perpendicular\", \"parallel\" or both, each once";
        return Err(InputError::key(path, "configurations", found, allowed).into());
    }
    Ok(configurations)
}

fn checked_cloud(path: &Path, cloud: Cloud) -> Result<Cloud> {
    check_range(path, "cloud", cloud.from, cloud.to)?;
    Ok(cloud)
}

fn checked_stripes(path: &Path, stripes: Stripes) -> Result<Stripes> {
    let possible = |x: &f64| x.is_finite() && *x > 0.0;
    let levels = &stripes.levels;
    if levels.is_empty() || !levels.iter().all(possible) || !levels.is_sorted_by(|a, b| a < b) {
        let allowed = "finite numbers above 0, increasing, each once";
        return Err(InputError::key(path, "stripes.levels", format!("{levels:?}"), allowed).into());
    }
    Ok(stripes)
}

fn checked_incremental(path: &Path, incremental: Incremental, variants: &[Variant]) -> Result<Incremental> {
    check_range(path, "incremental", incremental.from, incremental.to)?;
    for (key, ratio) in [("growth", incremental.growth), ("bracket", incremental.bracket)] {
        // Nearer to 1 an analysis takes thousands of runs; beyond 10 it is no search.
        if !(1.0001..=10.0).contains(&ratio) {
            let key = format!("incremental.{key}");
            return Err(InputError::key(path, key, ratio.to_string(), "1.0001 to 10").into());
        }
    }
    let lowest = variants.iter().map(|v| v.assumptions.collapse_rotation_ratio).fold(f64::INFINITY, f64::min);
    let possible = |limit: &Limit| match limit {
        Limit::Collapse => true,
        Limit::Rotation(over_alpha_i) => *over_alpha_i > 0.0 && *over_alpha_i < lowest,
    };
    let limits = &incremental.limits;
    let twice = (1..limits.len()).any(|i| limits[..i].contains(&limits[i]));
    if limits.is_empty() || twice || !limits.iter().all(possible) {
        let found = format!("{:?}", limits.iter().map(Limit::to_string).collect::<Vec<_>>());
        let allowed =
            format!("\"collapse\" and rotations over α_i, above 0 and below {lowest} where a wall collapses");
        return Err(InputError::key(path, "incremental.limits", found, allowed).into());
    }
    Ok(incremental)
}

fn check_range(path: &Path, table: &str, from: f64, to: f64) -> Result<(), InputError> {
    if from > 0.0 && to > from && to.is_finite() {
        return Ok(());
    }
    let found = format!("from {from} to {to}");
    Err(InputError::key(path, table, found, "finite numbers, 0 < from < to"))
}
