//! Which intensity measure to ask for: how well each foretells the response of drawn façades, and what it leaves to others.
//!
//! Efficiency is the scatter that remains at a known intensity, and sufficiency that nothing else of the earthquake
//! explains what remains (Luco & Cornell 2007, "Structure-specific scalar intensity measures for near-source and ordinary
//! earthquake ground motions", Earthquake Spectra 23(2)). Every façade is compared with itself under other records, so
//! that how façades differ counts neither for a measure nor against it.

mod efficiency;
mod runs;
mod sufficiency;

use std::path::Path;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::aggregate::{DRAWS, FEWEST_RECORDS};
use crate::error::{InputError, Result};
use crate::study::pipeline::Kind;
use crate::study::runs::{Completeness, Manifest};
use crate::survey::Configuration;
use efficiency::{Draw, concordance};
use runs::Runs;
use sufficiency::sufficiency;

/// What a manifest says such results are.
pub const KIND: &str = "measures";

/// What is written beside the page.
pub const FILES: [&str; 2] = ["manifest.json", "measures.json"];

/// Columns of the run files that are compared.
pub const MEASURES: [&str; 9] = [
    "pga_m_s2",
    "pgv_m_s",
    "pgd_m",
    "sa_0p5s_m_s2",
    "sa_1p0s_m_s2",
    "sa_average_m_s2",
    "arias_m_s",
    "cav_m_s",
    "duration_5_95_s",
];

/// The measures of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// Name of the study.
    pub study: String,
    /// Name of the suite.
    pub suite: String,
    /// Whether it is generated rather than measured.
    pub generated: bool,
    /// Its records.
    pub records: usize,
    /// One a floor.
    pub floors: Vec<OfFloor>,
}

/// The measures under a floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OfFloor {
    /// How the floor runs.
    pub configuration: Configuration,
    /// Runs that were finished.
    pub runs: usize,
    /// Of these, those that collapsed: they have no largest rotation, and count in the concordance alone.
    pub collapsed: usize,
    /// One for each of [`MEASURES`] that varies, the most efficient first.
    pub measures: Vec<OfMeasure>,
}

/// What a measure foretells of the largest rotation, ln(θ/α_i) = a_façade + b ln IM + ε.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OfMeasure {
    /// Column of the run files.
    pub measure: String,
    /// b.
    pub slope: f64,
    /// Standard deviation of ε, over walls that stood.
    pub efficiency: f64,
    /// Its 90 % interval over draws of the records.
    pub efficiency_interval: [f64; 2],
    /// Share of the draws in which no other measure is more efficient.
    pub best_share: f64,
    /// Standard deviation of ε over b: the scatter in ln IM (Padgett et al. 2008); `None` where b is not above 0.
    pub proficiency: Option<f64>,
    /// Share of the pairs of runs of a façade, one of which collapsed, in which that one had the larger intensity.
    pub concordance: Option<f64>,
    /// What else of the earthquakes explains ε, each with its p value; small ones speak against the measure.
    pub sufficiency: Sufficiency,
}

/// p values of the slopes of a record's mean ε over what else is known of it (Student's t); `None` where nobody knows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sufficiency {
    /// Over the magnitude.
    pub magnitude_p: Option<f64>,
    /// Over the logarithm of the distance.
    pub distance_p: Option<f64>,
    /// Over the logarithm of the duration from 5 to 95 % of the Arias intensity.
    pub duration_p: Option<f64>,
}

/// The measures of the study of drawn façades in a folder, under its first variant.
///
/// # Errors
/// Input errors for a folder without a whole study of this kind, or of too few records.
pub fn of_folder(folder: &Path) -> Result<Measures> {
    let path = folder.join("manifest.json");
    let allowed = "the folder of a study of kind monte_carlo, cloud or stripes by `mrbd run`";
    let manifest = Manifest::read(&path)?
        .filter(|manifest| matches!(manifest.kind, Kind::MonteCarlo | Kind::Cloud | Kind::Stripes))
        .ok_or_else(|| InputError::file(&path, "no manifest of such a study", allowed))?;
    if let Some(note) = Completeness::of(folder)?.and_then(|study| study.note()) {
        let allowed = "a whole study: `mrbd run … --resume` does the rest";
        return Err(InputError::file(folder, note, allowed).into());
    }
    let records = manifest.suite.records.len();
    if records < FEWEST_RECORDS {
        let allowed = format!("{FEWEST_RECORDS} or more, or scatter between records is not told");
        return Err(InputError::file(folder, format!("a study of {records} records"), allowed).into());
    }
    let floors = Configuration::ALL.into_iter().map(|floor| of_floor(folder, floor));
    let floors: Vec<OfFloor> = floors.collect::<Result<Vec<_>>>()?.into_iter().flatten().collect();
    Ok(Measures {
        study: manifest.plan.clone(),
        suite: manifest.suite.name.clone(),
        generated: manifest.suite.generated,
        records,
        floors,
    })
}

/// `None` for a floor that the study has not, or under which no wall stood.
fn of_floor(folder: &Path, configuration: Configuration) -> Result<Option<OfFloor>> {
    let runs = Runs::read(folder, configuration)?;
    let at_hand = Draw::as_they_are(&runs);
    let columns: Vec<usize> = (0..MEASURES.len()).filter(|&k| at_hand.fit(&runs, k).is_some()).collect();
    if columns.is_empty() {
        return Ok(None);
    }
    // By draw the scatter of each measure; one that no longer varies in a draw is left out of it.
    let drawn: Vec<Vec<Option<f64>>> = (0..DRAWS)
        .into_par_iter()
        .map(|number| {
            let draw = Draw::new(&runs, number);
            columns.iter().map(|&k| draw.fit(&runs, k).map(|fit| fit.scatter)).collect()
        })
        .collect();
    let measures =
        columns.iter().enumerate().filter_map(|(place, &k)| of_measure(&runs, &at_hand, k, place, &drawn));
    let mut measures: Vec<OfMeasure> = measures.collect();
    measures.sort_by(|a, b| a.efficiency.total_cmp(&b.efficiency));
    Ok(Some(OfFloor { configuration, runs: runs.len(), collapsed: runs.collapsed(), measures }))
}

fn of_measure(
    runs: &Runs,
    at_hand: &Draw,
    k: usize,
    place: usize,
    drawn: &[Vec<Option<f64>>],
) -> Option<OfMeasure> {
    let fit = at_hand.fit(runs, k)?;
    let scatters: Vec<f64> = drawn.iter().filter_map(|draw| draw[place]).collect();
    let least = |draw: &&Vec<Option<f64>>| {
        let least = draw.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        draw[place] == Some(least)
    };
    Some(OfMeasure {
        measure: MEASURES[k].to_owned(),
        slope: fit.slope,
        efficiency: fit.scatter,
        efficiency_interval: [0.05, 0.95]
            .map(|share| mrbd_statistics::quantile(&scatters, share).unwrap_or(fit.scatter)),
        best_share: drawn.iter().filter(least).count() as f64 / drawn.len() as f64,
        proficiency: (fit.slope > 0.0).then(|| fit.scatter / fit.slope),
        concordance: concordance(runs, k),
        sufficiency: sufficiency(runs, &fit.residual_of_records),
    })
}
