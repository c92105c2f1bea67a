//! Many runs at once: every wall under every record, or pair by pair, one row a run.

use std::sync::Arc;

use arrow_array::builder::StringDictionaryBuilder;
use arrow_array::types::Int32Type;
use arrow_array::{ArrayRef, Float64Array, RecordBatch, UInt64Array};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use mrbd::study::batch::Finished;
use mrbd::study::cases::{Case, run_cases};
use mrbd::study::runs::RESULTS;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::simulate::{Accuracy, Shaking};
use numpy::{AllowTypeChange, PyArrayLike1};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::errors::{Error, Interrupted, argument};
use crate::record::Record;
use crate::rows::Rows;
use crate::run::scaled;
use crate::table::Table;
use crate::wall::Wall;
use crate::work::{Shown, Watched, pool, watched};

/// Runs whose results are held until they become columns: a block of the table.
const BLOCK_RUNS: usize = 1 << 16;

/// The walls of a call.
enum Walls {
    Given(Vec<mrbd_kernel::model::Wall>),
    /// Each row of a table is one.
    Rows(Box<Rows>),
}

/// What is to be run: walls, records and factors, all with all or pair by pair.
struct Cases {
    walls: Walls,
    names: Vec<String>,
    /// Motions of the records, horizontal and vertical.
    motions: Vec<(Accelerogram, Option<Accelerogram>)>,
    scales: Vec<f64>,
    matched: bool,
    /// Of all with all: the shaking of every record at every scale, so that walls share its samples.
    shakings: Vec<Shaking>,
    tail_s: f64,
    accuracy: Accuracy,
}

/// Where a run stands among walls, records and scales.
#[derive(Clone, Copy)]
struct Place {
    wall: usize,
    record: usize,
    scale: usize,
}

impl Walls {
    fn of(walls: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(wall) = walls.cast::<Wall>() {
            return Ok(Self::Given(vec![wall.get().wall.clone()]));
        }
        if walls.hasattr("__arrow_c_stream__")? {
            return Ok(Self::Rows(Box::new(Rows::of(walls)?)));
        }
        let wall = |wall: Bound<'_, PyAny>| Ok(wall.cast::<Wall>()?.get().wall.clone());
        walls.try_iter()?.map(|each| wall(each?)).collect::<PyResult<_>>().map(Self::Given)
    }

    fn len(&self) -> usize {
        match self {
            Self::Given(walls) => walls.len(),
            Self::Rows(rows) => rows.len(),
        }
    }

    fn wall(&self, number: usize) -> Result<mrbd_kernel::model::Wall, String> {
        match self {
            Self::Given(walls) => Ok(walls[number].clone()),
            Self::Rows(rows) => rows.wall(number),
        }
    }
}

/// One object of a class of ours, or a sequence of them.
fn records(objects: &Bound<'_, PyAny>) -> PyResult<Vec<Py<Record>>> {
    if let Ok(record) = objects.cast::<Record>() {
        return Ok(vec![record.clone().unbind()]);
    }
    let record = |each: Bound<'_, PyAny>| match each.cast_into::<Record>() {
        Ok(record) => Ok(record.unbind()),
        Err(_) => Err(PyTypeError::new_err("records: a Record, or a sequence of them")),
    };
    objects.try_iter()?.map(|each| record(each?)).collect()
}

impl Cases {
    fn len(&self) -> usize {
        match self.matched {
            true => self.walls.len(),
            false => self.walls.len() * self.motions.len() * self.scales.len(),
        }
    }

    /// The wall varies fastest, so that neighbours share the samples of a record.
    fn place(&self, number: usize) -> Place {
        if self.matched {
            let or_only = |count: usize| if count == 1 { 0 } else { number };
            return Place {
                wall: number,
                record: or_only(self.motions.len()),
                scale: or_only(self.scales.len()),
            };
        }
        let (walls, scales) = (self.walls.len(), self.scales.len());
        Place { wall: number % walls, scale: number / walls % scales, record: number / walls / scales }
    }

    fn case(&self, number: usize) -> Case {
        let place = self.place(number);
        let shaking = match self.shakings.get(place.record * self.scales.len() + place.scale) {
            Some(shaking) => shaking.clone(),
            None => self.shaking(place),
        };
        Case { wall: self.walls.wall(place.wall), shaking, accuracy: self.accuracy }
    }

    fn shaking(&self, place: Place) -> Shaking {
        let factor = self.scales[place.scale];
        let (horizontal, vertical) = &self.motions[place.record];
        Shaking {
            horizontal: Some(scaled(horizontal, factor)),
            vertical: vertical.as_ref().map(|vertical| scaled(vertical, factor)),
            tail_s: self.tail_s,
        }
    }

    fn all_shakings(&self) -> Vec<Shaking> {
        let places = (0..self.motions.len() * self.scales.len()).map(|i| Place {
            wall: 0,
            record: i / self.scales.len(),
            scale: i % self.scales.len(),
        });
        places.map(|place| self.shaking(place)).collect()
    }

    fn check(&self) -> PyResult<()> {
        let lengths = [("records", self.motions.len()), ("scales", self.scales.len())];
        for (key, length) in [("walls", self.walls.len())].into_iter().chain(lengths) {
            if length == 0 {
                return Err(argument("simulate_many", key, "none", "at least one"));
            }
        }
        let unlike = |(_, length): &&(&str, usize)| ![1, self.walls.len()].contains(length);
        if let Some((key, length)) = lengths.iter().find(unlike).filter(|_| self.matched) {
            let allowed = format!("1 or {}, one for each wall, with pairs = \"matched\"", self.walls.len());
            return Err(argument("simulate_many", key, length.to_string(), allowed));
        }
        match self.scales.iter().find(|scale| !scale.is_finite()) {
            Some(bad) => Err(argument("simulate_many", "scales", bad.to_string(), "finite numbers")),
            None => Ok(()),
        }
    }

    fn schema() -> SchemaRef {
        let text = DataType::Dictionary(Box::new(DataType::Int32), Box::new(DataType::Utf8));
        let inputs = [
            Field::new("wall", DataType::UInt64, false),
            Field::new("record", text, false),
            Field::new("record_scale", DataType::Float64, false),
        ];
        let results = RESULTS.iter().map(|column| column.field());
        Arc::new(Schema::new(inputs.into_iter().chain(results).collect::<Vec<_>>()))
    }

    fn batch(&self, ended: &[Finished<usize>]) -> PyResult<RecordBatch> {
        let places: Vec<Place> = ended.iter().map(|finished| self.place(finished.run)).collect();
        let mut names = StringDictionaryBuilder::<Int32Type>::new();
        places.iter().for_each(|place| names.append_value(&self.names[place.record]));
        let inputs: [ArrayRef; 3] = [
            Arc::new(places.iter().map(|place| Some(place.wall as u64)).collect::<UInt64Array>()),
            Arc::new(names.finish()),
            Arc::new(places.iter().map(|place| Some(self.scales[place.scale])).collect::<Float64Array>()),
        ];
        let results = RESULTS.iter().map(|column| column.array(ended));
        let arrays = inputs.into_iter().chain(results).collect();
        RecordBatch::try_new(Self::schema(), arrays).map_err(|e| Error::new_err(e.to_string()))
    }

    /// All runs, block by block; after a stop those that are done.
    fn run(&self, watched: &Watched) -> PyResult<Vec<RecordBatch>> {
        let mut batches = Vec::new();
        let mut begin = 0;
        while begin < self.len() && !watched.stopped() {
            let end = (begin + BLOCK_RUNS).min(self.len());
            let ended = run_cases(begin..end, &|number| self.case(number), &watched.stop, &watched.done);
            batches.push(self.batch(&ended)?);
            begin = end;
        }
        Ok(batches)
    }
}

/// Runs many walls under many records, on all threads; one row a run, with the columns of result files.
#[pyfunction]
#[pyo3(signature = (
    walls, records, *, scales = None, verticals = None, pairs = "all", tail_s = 5.0, tolerance = 1e-6, threads = None,
    progress = None
))]
#[allow(clippy::too_many_arguments)]
pub fn simulate_many(
    py: Python<'_>,
    walls: &Bound<'_, PyAny>,
    records: &Bound<'_, PyAny>,
    scales: Option<PyArrayLike1<'_, f64, AllowTypeChange>>,
    verticals: Option<&Bound<'_, PyAny>>,
    pairs: &str,
    tail_s: f64,
    tolerance: f64,
    threads: Option<usize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Table> {
    let matched = match pairs {
        "all" => false,
        "matched" => true,
        other => {
            return Err(argument("simulate_many", "pairs", format!("{other:?}"), "\"all\" or \"matched\""));
        }
    };
    if !(tail_s.is_finite() && tail_s >= 0.0) {
        return Err(argument("simulate_many", "tail_s", tail_s.to_string(), "a finite number, 0 or more"));
    }
    if !Accuracy::TOLERANCES.contains(&tolerance) {
        return Err(argument("simulate_many", "tolerance", tolerance.to_string(), Accuracy::ALLOWED));
    }
    let scales = scales.map_or(vec![1.0], |scales| scales.as_array().iter().copied().collect());
    let (names, motions) = motions(records, verticals)?;
    let (walls, accuracy) = (Walls::of(walls)?, Accuracy { tolerance });
    let mut cases = Cases { walls, names, motions, scales, matched, shakings: Vec::new(), tail_s, accuracy };
    cases.check()?;
    if !matched {
        cases.shakings = cases.all_shakings();
    }
    let pool = pool("simulate_many", threads)?;
    let told = Watched::default();
    let shown = Shown::of(progress, cases.len() as u64);
    let (batches, interrupted) = watched(py, &told, &shown, || pool.install(|| cases.run(&told)));
    let table = Table::new(Cases::schema(), batches?);
    match interrupted {
        None => Ok(table),
        Some(error) => Err(Interrupted::with_done(py, error, table)?),
    }
}

type Motions = (Vec<String>, Vec<(Accelerogram, Option<Accelerogram>)>);

fn motions(horizontal: &Bound<'_, PyAny>, verticals: Option<&Bound<'_, PyAny>>) -> PyResult<Motions> {
    let horizontal = records(horizontal)?;
    let verticals = verticals.map(records).transpose()?;
    if let Some(verticals) = verticals.as_ref().filter(|verticals| verticals.len() != horizontal.len()) {
        let allowed = format!("{}, one for each record", horizontal.len());
        return Err(argument("simulate_many", "verticals", verticals.len().to_string(), allowed));
    }
    let vertical = |i: usize| verticals.as_ref().map(|verticals| verticals[i].get().motion.clone());
    let both: Vec<_> =
        horizontal.iter().enumerate().map(|(i, record)| (record.get().motion.clone(), vertical(i))).collect();
    let unlike =
        |(h, v): &&(Accelerogram, Option<Accelerogram>)| v.as_ref().is_some_and(|v| v.step_s() != h.step_s());
    if let Some((h, _)) = both.iter().find(unlike) {
        let allowed = format!("the step of the horizontal record, {} s", h.step_s());
        return Err(argument("simulate_many", "verticals", "another step", allowed));
    }
    Ok((horizontal.iter().map(|record| record.get().name.clone()).collect(), both))
}
