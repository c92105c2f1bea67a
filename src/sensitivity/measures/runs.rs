//! The runs of drawn façades as logarithms of response and intensities, by façade and record.

use std::collections::BTreeMap;
use std::path::Path;

use polars::prelude::PolarsResult;

use super::MEASURES;
use crate::error::{Error, Result};
use crate::store::frame::{Frame, Texts, read};
use crate::study::runs::run_files;
use crate::survey::Configuration;

/// Runs of one floor under the first variant that were finished.
#[derive(Debug, Default)]
pub struct Runs {
    /// ln(θ/α_i) of each; `None` of a wall that collapsed.
    pub ln_response: Vec<Option<f64>>,
    /// ln of each of [`MEASURES`] of each.
    pub ln_measures: Vec<[f64; MEASURES.len()]>,
    /// Number of the façade of each, below [`Runs::facades`].
    pub facade: Vec<usize>,
    /// Number of the record of each, below that of `about`.
    pub record: Vec<usize>,
    /// Façades.
    pub facades: usize,
    /// What is known of each record.
    pub about: Vec<About>,
}

/// What is known of a record beside its intensity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct About {
    /// Moment magnitude.
    pub magnitude: Option<f64>,
    /// ln of the distance in km.
    pub ln_distance: Option<f64>,
    /// ln of the duration from 5 to 95 % of the Arias intensity in s.
    pub ln_duration: Option<f64>,
}

impl Runs {
    /// Those of a study.
    ///
    /// # Errors
    /// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
    pub fn read(folder: &Path, configuration: Configuration) -> Result<Self> {
        let files = run_files(folder)?;
        let mut columns = vec!["run", "variant", "configuration", "record", "draw", "outcome"];
        columns.extend(["theta_max_over_own_alpha", "record_magnitude", "record_distance_km"]);
        columns.extend(MEASURES);
        let read = || Self::of(&read(&files, &columns)?, configuration);
        read().map_err(|e| Error::table(folder, e))
    }

    fn of(frame: &Frame, configuration: Configuration) -> PolarsResult<Self> {
        let (variants, floors) = (frame.texts("variant")?, frame.texts("configuration")?);
        let (outcomes, records, draws) =
            (frame.texts("outcome")?, frame.texts("record")?, frame.counts("draw")?);
        let response = frame.numbers("theta_max_over_own_alpha")?;
        let (magnitude, distance) =
            (frame.numbers("record_magnitude")?, frame.numbers("record_distance_km")?);
        let measures = MEASURES.map(|name| frame.numbers(name));
        let first = first_variant(frame, variants)?;
        let (mut runs, mut facades, mut names) = (Self::default(), BTreeMap::new(), BTreeMap::new());
        for row in 0..frame.height() {
            let finished = matches!(outcomes.get(row), Some("stood" | "collapsed"));
            let (Some(draw), Some(record)) = (draws.get(row), records.get(row)) else { continue };
            if !finished || variants.get(row) != first || floors.get(row) != Some(configuration.name()) {
                continue;
            }
            let mut ln_measures = [f64::NAN; MEASURES.len()];
            for (ln, column) in ln_measures.iter_mut().zip(&measures) {
                *ln = column.as_ref().map_err(Clone::clone)?.get(row).map_or(f64::NAN, f64::ln);
            }
            let next = names.len();
            let number = *names.entry(record).or_insert(next);
            if number == next {
                runs.about.push(About {
                    magnitude: magnitude.get(row),
                    ln_distance: distance.get(row).map(f64::ln).filter(|ln| ln.is_finite()),
                    ln_duration: Some(ln_measures[DURATION]).filter(|ln| ln.is_finite()),
                });
            }
            let next = facades.len();
            runs.facade.push(*facades.entry(draw).or_insert(next));
            runs.record.push(number);
            runs.ln_measures.push(ln_measures);
            let stood = outcomes.get(row) == Some("stood");
            runs.ln_response
                .push(response.get(row).filter(|_| stood).map(f64::ln).filter(|ln| ln.is_finite()));
        }
        runs.facades = facades.len();
        Ok(runs)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.facade.len()
    }

    /// How many of them collapsed. A wall that never moved has no logarithm either, and did not.
    pub fn collapsed(&self) -> usize {
        self.ln_response.iter().filter(|response| response.is_none()).count()
    }
}

/// Place of the duration among [`MEASURES`].
const DURATION: usize = MEASURES.len() - 1;

/// The variant of the first run of the plan.
fn first_variant<'a>(frame: &Frame, variants: Texts<'a>) -> PolarsResult<Option<&'a str>> {
    let runs = frame.counts("run")?;
    let first = (0..frame.height()).min_by_key(|&row| runs.get(row));
    Ok(first.and_then(|row| variants.get(row)))
}
