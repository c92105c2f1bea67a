//! A push that was measured: a table of displacements and forces, held against the model.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::Pushed;
use crate::error::{InputError, Result};

/// Columns that a table may have: displacement and force, each with its unit.
const COLUMNS: [[&str; 2]; 2] =
    [["displacement_m", "force_n"], ["displacement_over_thickness", "force_over_weight"]];
/// [`COLUMNS`] in words.
const ALLOWED: &str =
    "columns displacement_m and force_n, or displacement_over_thickness and force_over_weight";

/// A measured push beside the model's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Name of the file.
    pub file: String,
    /// Its points.
    pub points: Vec<MeasuredPoint>,
    /// Root mean square of what the wall's force differs by, over the weight.
    pub rms_over_weight: f64,
    /// The largest of it.
    pub largest_over_weight: f64,
    /// Root mean square of what the rigid line's force differs by, over the weight.
    pub rigid_rms_over_weight: f64,
}

/// A point of a measured push, and what the model has there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeasuredPoint {
    /// Displacement, m.
    pub displacement_m: f64,
    /// Measured force over the weight.
    pub force_over_weight: f64,
    /// The wall's force there.
    pub model_over_weight: f64,
    /// The rigid line's force there.
    pub rigid_over_weight: f64,
}

impl Measured {
    /// Reads a measured push (CSV) and holds it against a push of the model.
    ///
    /// # Errors
    /// Input errors with the file and the line.
    pub fn read(path: &Path, pushed: &Pushed) -> Result<Self> {
        let points: Vec<MeasuredPoint> = rows(path, pushed)?
            .into_iter()
            .map(|[displacement_m, force_over_weight]| MeasuredPoint {
                displacement_m,
                force_over_weight,
                model_over_weight: pushed.curve.force_over_weight(displacement_m),
                rigid_over_weight: pushed.rigid.force_over_weight(displacement_m),
            })
            .collect();
        // At rest the force may be anything: a joint that is closed carries what it is given.
        let judged: Vec<&MeasuredPoint> = points.iter().filter(|point| point.displacement_m > 0.0).collect();
        if judged.is_empty() {
            return Err(
                InputError::file(path, "no row beyond rest", "at least one displacement above 0").into()
            );
        }
        let rms = |of: fn(&MeasuredPoint) -> f64| {
            let squares: f64 = judged.iter().map(|point| (of(point) - point.force_over_weight).powi(2)).sum();
            (squares / judged.len() as f64).sqrt()
        };
        let largest =
            judged.iter().map(|p| (p.model_over_weight - p.force_over_weight).abs()).fold(0.0, f64::max);
        Ok(Self {
            file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            rms_over_weight: rms(|point| point.model_over_weight),
            largest_over_weight: largest,
            rigid_rms_over_weight: rms(|point| point.rigid_over_weight),
            points,
        })
    }
}

/// Displacements in m and forces over the weight.
fn rows(path: &Path, pushed: &Pushed) -> Result<Vec<[f64; 2]>> {
    let fault = |e: &csv::Error| {
        let line = e.position().map_or(1, csv::Position::line) as usize;
        InputError::line(path, line, e.to_string(), "a CSV table with a header and rows of its length")
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(|e| fault(&e))?;
    let header = reader.headers().map_err(|e| fault(&e))?.clone();
    let place = |name: &str| header.iter().position(|head| head == name);
    let found = COLUMNS.iter().find_map(|[x, y]| Some((place(x)?, place(y)?, *x)));
    let given = header.iter().collect::<Vec<_>>().join(", ");
    let (x, y, name) =
        found.ok_or_else(|| InputError::file(path, format!("the columns {given}"), ALLOWED))?;
    let units = if name == COLUMNS[0][0] { [1.0, 1.0 / pushed.weight_n] } else { [pushed.thickness_m, 1.0] };
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(&e))?;
        let line = record.position().map_or(0, csv::Position::line) as usize;
        let number = |column: usize, unit: f64| {
            let text = record.get(column).unwrap_or_default();
            let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
            value.map(|value| unit * value).ok_or_else(|| {
                InputError::line(path, line, format!("{text:?} for {}", &header[column]), "a finite number")
            })
        };
        rows.push([number(x, units[0])?, number(y, units[1])?]);
    }
    Ok(rows)
}
