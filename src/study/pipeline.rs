//! The pipeline file: which study to run, over which records, under which assumptions.
//!
//! A one-at-a-time sweep has a table of its own: parameters, slendernesses.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::sequence::SequenceTable;
use super::study_table::StudyTables;
pub use super::study_table::{Cloud, Drawn, Incremental, Kind, Limit, Loading, Stripes, Study};
pub use super::variance_table::Variance;
use crate::error::{InputError, Result};
use crate::survey::sampling::Sampling;
use crate::survey::{Assumptions, Changes, Configuration};
use mrbd_files::toml_file;
use mrbd_kernel::simulate::Change;
use mrbd_records::Building;
use serde::{Deserialize, Serialize};

/// A named set of assumptions under which the whole study is run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Variant {
    /// Name in results and tables.
    pub name: String,
    /// What it assumes.
    pub assumptions: Assumptions,
    /// The run of the ensemble of another variant that its runs are; `None` of a variant by itself.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub member: Option<Member>,
}

/// The place of a variant in the ensemble of another: the same runs, changed by what nobody can know.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Member {
    /// Name of the variant whose ensemble it is.
    pub member_of: String,
    /// Number in the ensemble, from 1; the variant itself is 0.
    #[serde(rename = "member")]
    pub number: usize,
}

/// Most members beside a variant: a probability of collapse is then known to some percent.
const MOST_MEMBERS: usize = 100;

impl Variant {
    /// How its runs differ from those as they are planned.
    pub fn change(&self) -> Change {
        Change::of(self.member.as_ref().map_or(0, |member| member.number))
    }
}

/// A pipeline file, checked; its paths are resolved against its folder.
#[derive(Debug, Clone, PartialEq)]
pub struct Pipeline {
    /// The file.
    pub path: PathBuf,
    /// Its text, as read.
    pub text: String,
    /// Name of the study, and of its output folder.
    pub name: String,
    /// Survey of the façades.
    pub survey: PathBuf,
    /// Coefficients C_l.
    pub coefficients: PathBuf,
    /// Suite of records.
    pub suite: PathBuf,
    /// Building on a floor of which the façades stand; `None`: at the ground.
    pub floor: Option<Building>,
    /// Kind of the study.
    pub kind: Kind,
    /// Which façades, and how strongly they are shaken.
    pub study: Study,
    /// Records one after another; empty but in a study of sequences.
    pub sequence: Vec<SequenceTable>,
    /// Assumptions to run it under, the one to compare with first; never empty.
    pub variants: Vec<Variant>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PipelineFile {
    name: String,
    survey: PathBuf,
    coefficients: PathBuf,
    suite: PathBuf,
    floor: Option<Building>,
    #[serde(default)]
    assumptions: Changes,
    variants: Vec<VariantTable>,
    #[serde(default)]
    kind: Kind,
    sweep: Option<SweepTable>,
    configurations: Option<Vec<Configuration>>,
    sampling: Option<Sampling>,
    cloud: Option<Cloud>,
    stripes: Option<Stripes>,
    incremental: Option<Incremental>,
    #[serde(default)]
    sequence: Vec<SequenceTable>,
    variance: Option<Variance>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct VariantTable {
    name: String,
    #[serde(default)]
    set: Changes,
    #[serde(default)]
    members: usize,
}

impl Pipeline {
    /// Reads and checks a pipeline file; the files it names are not opened.
    ///
    /// # Errors
    /// Input errors that name the file, the key, what was found and what is allowed.
    pub fn load(path: &Path) -> Result<Self> {
        Self::parse(path, toml_file::read(path)?)
    }

    /// Checks the text of a pipeline file that came from `path`.
    ///
    /// # Errors
    /// As [`Pipeline::load`].
    pub fn parse(path: &Path, text: String) -> Result<Self> {
        let file: PipelineFile = toml_file::parse(path, &text)?;
        check_name(path, &file.name)?;
        let beside = |name: PathBuf| path.parent().unwrap_or(Path::new("")).join(name);
        let variants = variants(path, file.assumptions, file.variants)?;
        let tables = StudyTables {
            sweep: file.sweep,
            configurations: file.configurations,
            sampling: file.sampling,
            cloud: file.cloud,
            stripes: file.stripes,
            incremental: file.incremental,
            sequence: file.sequence.clone(),
            variance: file.variance,
        };
        let study = tables.study(path, file.kind, &variants)?;
        check_members(path, file.kind, &variants)?;
        file.floor.as_ref().map_or(Ok(()), |floor| floor.check(path, "floor"))?;
        Ok(Self {
            path: path.to_path_buf(),
            text,
            name: file.name,
            survey: beside(file.survey),
            coefficients: beside(file.coefficients),
            suite: beside(file.suite),
            floor: file.floor,
            kind: file.kind,
            study,
            sequence: file.sequence,
            variants,
        })
    }
}

/// Refuses a name that is no folder's.
pub(crate) fn check_name(path: &Path, name: &str) -> Result<()> {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if name.is_empty() || !name.chars().all(plain) {
        let allowed = "letters, digits, - and _: the output folder is named after it";
        return Err(InputError::key(path, "name", format!("{name:?}"), allowed).into());
    }
    Ok(())
}

fn variants(path: &Path, common: Changes, tables: Vec<VariantTable>) -> Result<Vec<Variant>> {
    let common = common.onto(&Assumptions::default());
    common.check(path, "assumptions")?;
    if tables.is_empty() {
        return Err(InputError::key(path, "variants", "an empty list", "at least one variant").into());
    }
    let mut names = BTreeSet::new();
    let mut variants = Vec::with_capacity(tables.len());
    let mut ensembles = Vec::new();
    for (index, table) in tables.into_iter().enumerate() {
        let key = format!("variants[{index}]");
        if table.name.is_empty() || !names.insert(table.name.clone()) {
            let found = format!("{:?}", table.name);
            return Err(InputError::key(path, format!("{key}.name"), found, "a name, each once").into());
        }
        let assumptions = table.set.onto(&common);
        assumptions.check(path, &format!("{key}.set"))?;
        if table.members > MOST_MEMBERS {
            let (found, allowed) = (table.members.to_string(), format!("0 to {MOST_MEMBERS}"));
            return Err(InputError::key(path, format!("{key}.members"), found, allowed).into());
        }
        ensembles.extend((1..=table.members).map(|number| member(&table.name, &assumptions, number)));
        variants.push(Variant { name: table.name, assumptions, member: None });
    }
    match ensembles.iter().find(|member| names.contains(&member.name)) {
        Some(twice) => {
            let found = format!("{:?}, which is a member of the ensemble of another", twice.name);
            Err(InputError::key(path, "variants", found, "a name, each once").into())
        }
        None => Ok([variants, ensembles].concat()),
    }
}

/// Only what a sweep says is judged by ensembles; a study of variance draws a member for each run.
fn check_members(path: &Path, kind: Kind, variants: &[Variant]) -> Result<()> {
    match variants.iter().find_map(|variant| variant.member.as_ref()) {
        Some(Member { member_of, .. }) if kind != Kind::Sweep && kind != Kind::Variance => {
            let found = format!("those of {member_of:?} in a study of kind {:?}", kind.name());
            Err(InputError::key(
                path,
                "variants.members",
                found,
                "members only in a sweep, or in a study of variance",
            )
            .into())
        }
        _ => Ok(()),
    }
}

fn member(of: &str, assumptions: &Assumptions, number: usize) -> Variant {
    let member = Some(Member { member_of: of.to_owned(), number });
    Variant { name: format!("{of} ~{number}"), assumptions: assumptions.clone(), member }
}

/// A parameter of the façade that a sweep takes through its three levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Thickness b.
    Thickness,
    /// Height of the crack h_1 / h_tot.
    CrackHeight,
    /// Compressive strength f.
    Strength,
    /// Stiffness of the floor k_d.
    Stiffness,
    /// Floor mass m_d / m_tot that acts in both directions.
    DiaphragmMass,
    /// Floor mass m_dp / m_tot that acts horizontally only.
    CarriageMass,
    /// All C_l together.
    Restitution,
}

/// A one-at-a-time sweep: every parameter of a configuration at three levels, over slendernesses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepTable {
    /// Slendernesses h_tot / b.
    pub slenderness: Vec<f64>,
    /// Parameters by configuration.
    pub parameters: ParameterLists,
}

/// Parameters by configuration; an empty or absent list leaves the configuration out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterLists {
    /// Parameters of façades whose floor rests on them.
    #[serde(default)]
    pub perpendicular: Vec<Parameter>,
    /// Parameters of façades along which the floor runs.
    #[serde(default)]
    pub parallel: Vec<Parameter>,
}

impl SweepTable {
    /// The parameters of a configuration.
    pub fn parameters(&self, configuration: Configuration) -> &[Parameter] {
        match configuration {
            Configuration::Perpendicular => &self.parameters.perpendicular,
            Configuration::Parallel => &self.parameters.parallel,
        }
    }

    pub(super) fn check(&self, path: &Path) -> Result<()> {
        let refuse =
            |key: &str, found: String, allowed: &str| Err(InputError::key(path, key, found, allowed).into());
        if self.slenderness.is_empty() {
            return refuse("sweep.slenderness", "an empty list".into(), "at least one slenderness");
        }
        if let Some(wrong) = self.slenderness.iter().find(|x| !(x.is_finite() && **x > 0.0)) {
            return refuse("sweep.slenderness", wrong.to_string(), "finite numbers above 0");
        }
        if !self.slenderness.is_sorted_by(|a, b| a < b) {
            let found = format!("{:?}", self.slenderness);
            return refuse("sweep.slenderness", found, "increasing numbers, each once");
        }
        if Configuration::ALL.iter().all(|&c| self.parameters(c).is_empty()) {
            return refuse("sweep.parameters", "no parameters".into(), "at least one parameter");
        }
        for configuration in Configuration::ALL {
            let list = self.parameters(configuration);
            if list.iter().collect::<BTreeSet<_>>().len() < list.len() {
                let key = format!("sweep.parameters.{}", configuration.name());
                return refuse(&key, "a parameter twice".into(), "each parameter once");
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::ImpactLaw;

    const SWEEP: &str = include_str!("../../pipelines/sweep.toml");

    fn parse(text: &str) -> Result<Pipeline> {
        Pipeline::parse(Path::new("pipelines/sweep.toml"), text.to_owned())
    }

    #[test]
    fn published_sweep_has_the_six_parameters_of_both_configurations() {
        let pipeline = parse(SWEEP).expect("the repository's own pipeline");
        let Study::Sweep(sweep) = &pipeline.study else { panic!("a sweep") };
        assert_eq!(sweep.slenderness, (4..=12).map(|i| f64::from(2 * i)).collect::<Vec<_>>());
        assert_eq!(sweep.parameters(Configuration::Perpendicular).len(), 6);
        assert!(sweep.parameters(Configuration::Parallel).contains(&Parameter::CarriageMass));
        assert_eq!(pipeline.survey, Path::new("pipelines/../inputs/survey.toml"));
    }

    #[test]
    fn regress_variants_change_only_the_keys_they_name() {
        let pipeline = parse(SWEEP).expect("the repository's own pipeline");
        let base = &pipeline.variants[0].assumptions;
        assert_eq!(*base, Assumptions::default());
        let contact = &pipeline.variants[1].assumptions;
        assert_eq!(*contact, Assumptions { law: ImpactLaw::Contact, ..base.clone() });
    }

    #[test]
    fn rejects_faults_with_their_key() {
        let refused = |from: &str, to: &str| {
            let text = SWEEP.replacen(from, to, 1);
            assert_ne!(text, SWEEP, "the test must change the file");
            parse(&text).expect_err("must be refused").to_string()
        };
        assert!(refused("name = \"sweep\"", "name = \"../x\"").contains(": name: found \"../x\""));
        assert!(refused("8.0, 10.0", "10.0, 8.0").contains("sweep.slenderness"));
        assert!(refused("\"thickness\", ", "\"thickness\", \"thickness\", ").contains("each parameter once"));
        assert!(refused("\"strength\"", "\"strenght\"").contains("strenght"));
        assert!(refused("length_m = 1.0", "length_m = -1.0").contains("assumptions.length_m: found -1"));
        assert!(refused("length_m = 2.0", "length_m = inf").contains("variants[3].set.length_m: found inf"));
        assert!(refused("name = \"contact\"", "name = \"base\"").contains("variants[1].name"));
        assert!(
            refused("members = 10", "members = 101")
                .contains("variants[0].members: found 101; allowed: 0 to 100")
        );
        assert!(
            refused("name = \"contact\"", "name = \"base ~3\"")
                .contains("variants: found \"base ~3\", which")
        );
        let floor = "name = \"sweep\"\nfloor = { height_ratio = 2.0, period_s = 0.3, storeys = 2 }";
        assert!(refused("name = \"sweep\"", floor).contains("floor.height_ratio: found 2"));
        assert!(refused("tail_s = 5.0", "tail = 5.0").contains("tail"));
        assert!(refused("tolerance = 1e-6", "tolerance = 0.0").contains("assumptions.tolerance"));
    }
}
