//! An experiment, read whole for a diagnosis.

use std::path::{Path, PathBuf};

use crate::diagnose::hypothesis::{ACTING, Nuisance, Scales, WALL_NUMBERS, wall_number};
use crate::experiment::file::{ExperimentFile, TestTable};
use crate::experiment::{Test, TestData, load_tests};
use mrbd_files::FileNote;
use mrbd_files::error::{InputError, Result};
use mrbd_files::{load_wall, toml_file};
use mrbd_kernel::model::{Wall, WallParameters};
use mrbd_kernel::simulate::Accuracy;

/// Wall, what was known of it, tests.
#[derive(Debug)]
pub struct Experiment {
    /// The experiment file.
    pub path: PathBuf,
    /// The wall file.
    pub wall_path: PathBuf,
    /// The wall before the diagnosis.
    pub wall: Wall,
    /// The wall file as written, to be written again with what is found.
    pub wall_table: toml::Table,
    /// What was uncertain of it.
    pub nuisances: Vec<Nuisance>,
    /// What was measured.
    pub tests: Vec<TestData>,
    /// The same tests, for the error over whole runs (Eq. 8).
    pub whole: Vec<Test>,
    /// Sizes that matter.
    pub scales: Scales,
    /// The files that were read.
    pub inputs: Vec<FileNote>,
}

impl Experiment {
    /// Reads an experiment and every file it names.
    ///
    /// # Errors
    /// Input errors with file, key or line, what was found and what is allowed.
    pub fn load(path: &Path) -> Result<Self> {
        let file = ExperimentFile::load(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let wall_path = folder.join(&file.wall);
        let wall = load_wall(&wall_path)?;
        let wall_table = toml_file::load(&wall_path)?;
        if !wall.is_cracked() {
            let allowed = "a wall of two bodies: wall.crack_height_m given";
            return Err(InputError::key(&wall_path, "wall.crack_height_m", "no crack", allowed).into());
        }
        let nuisances = nuisances(path, &file, wall.parameters())?;
        let whole = load_tests(path, &file, &wall, Accuracy::default())?;
        let data = |(test, table): (&Test, &TestTable)| {
            TestData::new(test, &folder.join(&table.measured), table, &wall)
        };
        let tests = whole.iter().zip(&file.tests).map(data).collect::<Result<Vec<_>, _>>()?;
        let scales = Scales::of(&wall, &tests);
        let note = |(role, file): (String, PathBuf)| FileNote::of(&role, &file);
        let read = file.files(path).into_iter().filter(|(role, _)| role != "coefficients");
        let inputs = read.map(note).collect::<Result<_>>()?;
        Ok(Self {
            path: path.to_path_buf(),
            wall_path,
            wall,
            wall_table,
            nuisances,
            tests,
            whole,
            scales,
            inputs,
        })
    }
}

fn nuisances(path: &Path, file: &ExperimentFile, wall: &WallParameters) -> Result<Vec<Nuisance>, InputError> {
    let mut found = Vec::new();
    for (key, &sd) in &file.prior {
        let number = |key: &str| wall_number(key).map(|n| Nuisance::Number(n, sd));
        match key.as_str() {
            "restitution" => found.extend((0..ACTING).map(|l| Nuisance::Coefficient(l, sd))),
            "corner_widths" => {
                found.extend(["lower_width_m", "upper_width_m"].iter().filter_map(|k| number(k)))
            }
            key => found.push(number(key).ok_or_else(|| {
                let known = WALL_NUMBERS.iter().map(|n| n.key).collect::<Vec<_>>().join(", ");
                let allowed =
                    format!("restitution, corner_widths, {known}, with or without the table's name");
                InputError::key(
                    path,
                    format!("prior.{key}"),
                    "no number of a wall that can be uncertain",
                    allowed,
                )
            })?),
        }
        // A relative standard deviation says nothing of a number that is zero.
        if found.iter().any(|nuisance| nuisance.value(wall) == 0.0) {
            let told = "a prior of a number that is 0 in the wall file";
            let allowed = "priors of numbers that are not: they are shares; leave it out";
            return Err(InputError::key(path, format!("prior.{key}"), told, allowed));
        }
    }
    Ok(found)
}
