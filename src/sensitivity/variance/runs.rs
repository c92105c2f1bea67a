//! The runs of a study of variance, by point, matrix and record.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use polars::prelude::{PolarsResult, polars_err};

use super::outputs::Ended;
use crate::error::{Error, Result};
use crate::store::frame::{Frame, read};
use crate::study::plan::Matrix;
use crate::study::runs::run_files;
use crate::survey::Configuration;

/// The runs under a floor.
#[derive(Debug)]
pub struct Runs {
    /// How the floor runs.
    pub configuration: Configuration,
    /// Points of which every run ended: first by point, then by matrix, then by record.
    pub ended: Vec<Ended>,
    /// The matrices, A and B first.
    pub matrices: Vec<Matrix>,
    /// Records.
    pub records: usize,
    /// Points left out.
    pub left_out: usize,
}

/// Runs of a point, by matrix and record; `None` of one that failed.
type OfPoint = Vec<Option<Ended>>;

impl Runs {
    /// Those of a study, one a floor that it has.
    ///
    /// # Errors
    /// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
    pub fn read(folder: &Path) -> Result<Vec<Self>> {
        let files = run_files(folder)?;
        let columns = ["configuration", "record", "draw", "matrix", "outcome"];
        let columns = [columns.as_slice(), &THETA].concat();
        let read = || {
            let frame = read(&files, &columns)?;
            let floors = Configuration::ALL.map(|configuration| Self::of(&frame, configuration));
            floors.into_iter().filter_map(Result::transpose).collect::<PolarsResult<Vec<_>>>()
        };
        read().map_err(|e| Error::table(folder, e))
    }

    fn of(frame: &Frame, configuration: Configuration) -> PolarsResult<Option<Self>> {
        let frame = frame.with_texts(&[("configuration", configuration.name())])?;
        let (records, matrices, draws) =
            (frame.texts("record")?, frame.texts("matrix")?, frame.counts("draw")?);
        let mut names = BTreeMap::new();
        for row in 0..frame.height() {
            let next = names.len();
            names.entry(records.get(row)).or_insert(next);
        }
        let there: BTreeSet<_> = (0..frame.height()).map(|row| matrices.get(row)).collect();
        let asked: Vec<Matrix> =
            Matrix::all().filter(|matrix| there.contains(&Some(matrix.name()))).collect();
        let mut points: BTreeMap<u64, OfPoint> = BTreeMap::new();
        for row in 0..frame.height() {
            let matrix = asked.iter().position(|matrix| matrices.get(row) == Some(matrix.name()));
            let (Some(matrix), Some(draw)) = (matrix, draws.get(row)) else {
                return Err(polars_err!(ComputeError: "a run without a matrix that this version knows"));
            };
            let point = points.entry(draw).or_insert_with(|| vec![None; asked.len() * names.len()]);
            point[matrix * names.len() + names[&records.get(row)]] = ended(&frame, row)?;
        }
        let all = points.len();
        let whole: Vec<Vec<Ended>> =
            points.into_values().filter_map(|point| point.into_iter().collect()).collect();
        let left_out = all - whole.len();
        let (ended, records) = (whole.concat(), names.len());
        let runs = Self { configuration, ended, matrices: asked, records, left_out };
        Ok((all > 0).then_some(runs))
    }

    /// Runs of a point.
    pub fn per_point(&self) -> usize {
        self.matrices.len() * self.records
    }

    /// Points of which every run ended.
    pub fn points(&self) -> usize {
        self.ended.len() / self.per_point().max(1)
    }
}

/// Columns of θ_i/α_i.
const THETA: [&str; 2] = ["theta1_max_over_alpha1", "theta2_max_over_alpha2"];

fn ended(frame: &Frame, row: usize) -> PolarsResult<Option<Ended>> {
    Ok(match frame.texts("outcome")?.get(row) {
        Some("collapsed") => Some(Ended::Collapsed),
        Some("stood") => {
            let [one, two] = THETA.map(|name| frame.numbers(name).map(|numbers| numbers.get(row)));
            one?.zip(two?).map(|(one, two)| Ended::Stood([one, two]))
        }
        _ => None,
    })
}
