//! Drawn façades and records one after another: distributions of the response, fragilities, draws against the survey.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::file::{first, found_again};
use super::fragility::{LimitFragility, fragilities};
use super::spectra::Spectra;
use super::sweep::run_files;
use crate::aggregate::{Distributions, distributions};
use crate::error::Result;
use crate::fragility::Table;
use crate::study::runs::Manifest;
use crate::survey::sampling::{FacadeSampler, Marginal, Sampling, Variable};
use crate::survey::{Configuration, Survey};
use mrbd_records::Site;

/// A study of drawn façades as its page shows it.
#[derive(Debug)]
pub struct Drawn {
    /// Its manifest.
    pub manifest: Manifest,
    /// Quantiles of the response; there is at least one variant.
    pub distributions: Distributions,
    /// Fragilities of the first variant.
    pub fragilities: Vec<LimitFragility>,
    /// The façades of the first variant.
    pub samples: Samples,
    /// Spectra of the records; `None` where they are gone or other ones now.
    pub spectra: Option<Spectra>,
    /// Run files, from the folder of the results.
    pub run_files: Vec<PathBuf>,
}

impl Drawn {
    /// Reads the study in a folder.
    ///
    /// # Errors
    /// An input error for a folder without results; [`crate::Error::Table`] for files that cannot be read.
    pub fn read(folder: &Path, manifest: Manifest, site: Option<&Site>) -> Result<Self> {
        let distributions = distributions(folder, manifest.kind)?;
        let base = &first(folder, &distributions.variants)?.name;
        Ok(Self {
            fragilities: fragilities(folder, &distributions, base)?,
            samples: Samples::read(folder, &manifest, base)?,
            spectra: Spectra::of(folder, &manifest, site),
            run_files: run_files(folder)?,
            distributions,
            manifest,
        })
    }
}

/// The façades of a study.
#[derive(Debug)]
pub struct Samples {
    /// Whether the survey is still what the study read.
    pub has_survey: bool,
    /// The façades by floor.
    pub floors: Vec<FloorSamples>,
}

/// The façades of one floor.
#[derive(Debug)]
pub struct FloorSamples {
    /// The floor.
    pub configuration: Configuration,
    /// Number of façades.
    pub facades: usize,
    /// Variables that vary.
    pub variables: Vec<DrawnVariable>,
}

/// A variable as it was drawn: its values in SI units, and the survey's distribution where it is at hand.
pub type DrawnVariable = (Variable, Vec<f64>, Option<Marginal>);

impl Samples {
    /// Reads the façades of a variant.
    ///
    /// # Errors
    /// An input error for tables without the columns of a study.
    pub fn read(folder: &Path, manifest: &Manifest, base: &str) -> Result<Self> {
        let names: Vec<&str> = Variable::ALL.iter().map(|variable| variable.name()).collect();
        let columns = [&["variant", "configuration", "draw"][..], &names].concat();
        let table = Table::read(folder, &columns)?;
        let survey = survey(folder, manifest);
        let mut floors = Vec::new();
        for configuration in Configuration::ALL {
            let rows = one_row_a_draw(&table, base, configuration)?;
            if rows.is_empty() {
                continue;
            }
            let sampler = survey
                .as_ref()
                .and_then(|(survey, sampling)| FacadeSampler::new(survey, configuration, sampling).ok());
            let variables = variables(&table, &rows, sampler.as_ref())?;
            floors.push(FloorSamples { configuration, facades: rows.len(), variables });
        }
        Ok(Self { has_survey: survey.is_some(), floors })
    }
}

/// The survey and how it was sampled, if the file is still at hand and still the same.
fn survey(folder: &Path, manifest: &Manifest) -> Option<(Survey, Sampling)> {
    let path = found_again(folder, &manifest.inputs, "survey")?;
    let sampling = serde_json::from_value(manifest.study.get("sampling")?.clone()).ok()?;
    Survey::load(&path).ok().map(|survey| (survey, sampling))
}

/// Rows of a variant, each draw once.
fn one_row_a_draw(table: &Table, base: &str, configuration: Configuration) -> Result<Vec<usize>> {
    let (variants, floors, draws) =
        (table.labels("variant")?, table.labels("configuration")?, table.labels("draw")?);
    let mut seen = BTreeSet::new();
    let own = |&row: &usize| {
        variants[row] == base && floors[row] == configuration.name() && seen.insert(draws[row].as_str())
    };
    Ok((0..table.rows()).filter(own).collect())
}

fn variables(table: &Table, rows: &[usize], sampler: Option<&FacadeSampler>) -> Result<Vec<DrawnVariable>> {
    let mut varying = Vec::new();
    for variable in Variable::ALL {
        let all = table.numbers(variable.name())?;
        let values: Vec<f64> = rows.iter().filter_map(|&row| all[row]).collect();
        if values.iter().any(|value| *value != values[0]) {
            varying.push((variable, values, sampler.map(|sampler| *sampler.marginal(variable))));
        }
    }
    Ok(varying)
}
