//! Experiment files (TOML): the wall, what was known before, the tests, and how to calibrate.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

use super::channel_table::ChannelTable;
pub use super::test_table::{Purpose, Reading, StartTime, TestTable};
use mrbd_files::error::{InputError, Result};
use mrbd_files::toml_file;
use mrbd_formula::Formula;
use mrbd_kernel::model::{FurtherLaw, ImpactLaw};
use mrbd_kernel::simulate::Accuracy;

/// An experiment file as written; its paths are relative to its folder.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExperimentFile {
    /// Wall file.
    pub wall: PathBuf,
    /// Takes the measured files as they are where the wall would come nearer to them with channels swapped or of another sign.
    #[serde(default)]
    pub as_read: bool,
    /// Relative standard deviations of what was known before, by key of the wall file.
    #[serde(default)]
    pub prior: BTreeMap<String, f64>,
    /// How to calibrate.
    #[serde(default)]
    pub calibrate: CalibrateTable,
    /// Transducers of every test that has no `channels` of its own.
    #[serde(default)]
    pub channels: Vec<ChannelTable>,
    /// The tests.
    pub tests: Vec<TestTable>,
    /// Laws of the user's own that a diagnosis tries beside the catalogue.
    #[serde(default)]
    pub hypotheses: Vec<HypothesisTable>,
}

/// `[[hypotheses]]`: a name, and the keys of a formula of a wall file.
#[derive(Debug, Clone, PartialEq)]
pub struct HypothesisTable {
    /// Name in results.
    pub name: String,
    /// The law, with the values from which a fit starts.
    pub formula: Formula,
}

impl<'de> Deserialize<'de> for HypothesisTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut table = toml::Table::deserialize(deserializer)?;
        let name = match table.remove("name") {
            Some(toml::Value::String(name)) if !name.trim().is_empty() => name,
            Some(other) => {
                return Err(D::Error::custom(format!("{other} for `name`, expected a name in quotes")));
            }
            None => return Err(D::Error::missing_field("name")),
        };
        match FurtherLaw::deserialize(table).map_err(|e| D::Error::custom(e.message()))? {
            FurtherLaw::Formula(formula) if formula.parameters().is_empty() => {
                Err(D::Error::custom("a formula without parameters, expected a number to be found"))
            }
            FurtherLaw::Formula(formula) => Ok(Self { name, formula }),
            FurtherLaw::Effect(effect) => {
                let kind = effect.entry().name;
                let allowed = "`formula`: the catalogue is tried anyway";
                Err(D::Error::custom(format!("kind `{kind}` of a hypothesis, expected {allowed}")))
            }
        }
    }
}

/// `[calibrate]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CalibrateTable {
    /// Seed of every random number.
    pub seed: u64,
    /// Impact law; absent: the wall's.
    pub law: Option<ImpactLaw>,
    /// Capture velocity, rad/s; absent: the wall's.
    pub capture_velocity_rad_s: Option<f64>,
    /// Accuracy of the simulations.
    pub tolerance: f64,
    /// File of bounds of C_1 … C_8; absent: Table 2 of the source.
    pub coefficients: Option<PathBuf>,
    /// What to calibrate; absent: C_1 … C_8.
    pub parameters: Vec<ParameterTable>,
    /// Vectors in a generation of the paper's search.
    pub population: usize,
    /// The sum of WME has settled when it falls by less than this share ...
    pub settle_share: f64,
    /// ... over this many generations.
    pub settle_generations: usize,
    /// Generations after which the paper's search ends anyway.
    pub most_generations: u32,
    /// Vectors of a second joint search from another beginning, beyond the comparison at equal numbers of simulations.
    pub refine_vectors: usize,
    /// Capture velocities at which the joint search is repeated, rad/s; empty: none.
    pub capture_study_rad_s: Vec<f64>,
    /// Bootstrap replicates behind the intervals.
    pub replicates: usize,
}

impl Default for CalibrateTable {
    fn default() -> Self {
        Self {
            seed: 1,
            law: None,
            capture_velocity_rad_s: None,
            tolerance: 1e-6,
            coefficients: None,
            parameters: Vec::new(),
            population: 21,
            settle_share: 1e-3,
            settle_generations: 5,
            most_generations: 60,
            refine_vectors: 2500,
            capture_study_rad_s: vec![1e-4, 1e-3, 1e-2],
            replicates: 1000,
        }
    }
}

/// `[[calibrate.parameters]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterTable {
    /// `C_1` … `C_8`, `restitution` for all of them, `corner_widths` for both, or a key of the wall file.
    pub key: String,
    /// Lower bound; absent: Table 2 for C_l, three prior standard deviations for the rest.
    pub lower: Option<f64>,
    /// Upper bound.
    pub upper: Option<f64>,
}

impl ExperimentFile {
    /// Reads and checks an experiment file; the files it names are not opened.
    ///
    /// # Errors
    /// Input errors that name the file, the key, what was found and what is allowed.
    pub fn load(path: &Path) -> Result<Self> {
        Self::parse(path, &toml_file::read(path)?)
    }

    /// Checks the text of an experiment file that came from `path`.
    ///
    /// # Errors
    /// As [`ExperimentFile::load`].
    pub fn parse(path: &Path, text: &str) -> Result<Self> {
        let mut file: Self = toml_file::parse(path, text)?;
        file.share_channels();
        file.check(path)?;
        Ok(file)
    }

    /// Gives the experiment's channels to every test without its own, and tells each where it stands.
    fn share_channels(&mut self) {
        let name = |channels: &mut [ChannelTable], table: &str| {
            channels.iter_mut().enumerate().for_each(|(i, channel)| channel.key = format!("{table}[{i}]"));
        };
        name(&mut self.channels, "channels");
        for (k, test) in self.tests.iter_mut().enumerate() {
            match &mut test.channels {
                Some(own) => name(own, &format!("tests[{k}].channels")),
                None => test.channels = Some(self.channels.clone()),
            }
        }
    }

    /// Every file that an experiment file at `path` reads, itself the first, each with its role.
    pub fn files(&self, path: &Path) -> Vec<(String, PathBuf)> {
        let beside = |name: &Path| path.parent().unwrap_or(Path::new("")).join(name);
        let mut files =
            vec![("experiment".to_owned(), path.to_path_buf()), ("wall".to_owned(), beside(&self.wall))];
        let coefficients = self.calibrate.coefficients.iter();
        files.extend(coefficients.map(|name| ("coefficients".to_owned(), beside(name))));
        for test in &self.tests {
            let record = test.record.iter();
            files.extend(record.map(|name| (format!("record of {}", test.name), beside(name))));
            let vertical = test.vertical.iter();
            files.extend(vertical.map(|name| (format!("vertical of {}", test.name), beside(name))));
            files.push((format!("measured in {}", test.name), beside(&test.measured)));
        }
        files
    }

    fn check(&self, path: &Path) -> Result<(), InputError> {
        let refuse =
            |key: String, found: String, allowed: &str| Err(InputError::key(path, key, found, allowed));
        for (key, sd) in &self.prior {
            if !(sd.is_finite() && *sd > 0.0) {
                return refuse(
                    format!("prior.{key}"),
                    sd.to_string(),
                    "a relative standard deviation above 0",
                );
            }
        }
        if !self.tests.iter().any(|test| test.purpose == Purpose::Fit) {
            return refuse("tests".into(), "no test to fit".into(), "at least one test with use = \"fit\"");
        }
        for (i, test) in self.tests.iter().enumerate() {
            test.check(path, i)?;
            if self.tests[..i].iter().any(|other| other.name == test.name) {
                return refuse(
                    format!("tests[{i}].name"),
                    format!("{:?} again", test.name),
                    "each name once",
                );
            }
        }
        self.calibrate.check(path)
    }
}

impl CalibrateTable {
    fn check(&self, path: &Path) -> Result<(), InputError> {
        let require = |key: &str, found: String, holds: bool, allowed: &str| {
            let error = || InputError::key(path, format!("calibrate.{key}"), found, allowed);
            if holds { Ok(()) } else { Err(error()) }
        };
        let tolerance_holds = Accuracy::TOLERANCES.contains(&self.tolerance);
        require("tolerance", self.tolerance.to_string(), tolerance_holds, Accuracy::ALLOWED)?;
        let population_holds = (5..=10_000).contains(&self.population);
        require("population", self.population.to_string(), population_holds, "5 to 10000")?;
        let share_holds = (0.0..1.0).contains(&self.settle_share);
        require("settle_share", self.settle_share.to_string(), share_holds, "0 or more, below 1")?;
        let generations = self.settle_generations;
        require("settle_generations", generations.to_string(), generations >= 1, "1 or more")?;
        require(
            "most_generations",
            self.most_generations.to_string(),
            self.most_generations >= 1,
            "1 or more",
        )?;
        let replicates_hold = (20..=100_000).contains(&self.replicates);
        require("replicates", self.replicates.to_string(), replicates_hold, "20 to 100000")?;
        let velocity_holds = |v: &f64| v.is_finite() && *v >= 0.0;
        let capture_holds = self.capture_study_rad_s.iter().all(velocity_holds);
        let found = format!("{:?}", self.capture_study_rad_s);
        require("capture_study_rad_s", found, capture_holds, "finite numbers, 0 or more")?;
        let capture = self.capture_velocity_rad_s;
        let found = format!("{capture:?}");
        require(
            "capture_velocity_rad_s",
            found,
            capture.iter().all(velocity_holds),
            "a finite number, 0 or more",
        )
    }
}
