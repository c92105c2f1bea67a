//! The page of an overturning spectrum: which pulses overturn the wall.

use std::path::Path;

use parquet::file::reader::{FileReader, SerializedFileReader};

use super::chart::{Axis, COLLAPSE, Colour, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::page::{Figure, Key, Link, Number, Page, Section};
use crate::error::{Error, InputError, Result};
use crate::fragility::Table;

/// Pulses that the wall stood: pale, they are the background.
const STOOD: Colour = Colour(0xC4, 0xC4, 0xC4);

/// A pulse.
struct Trial {
    frequency: f64,
    amplitude: f64,
    overturned: bool,
}

/// The page of the spectrum in a folder.
///
/// # Errors
/// Input errors for files that are none of a spectrum; whatever drawing meets.
pub fn page(folder: &Path) -> Result<Page> {
    let trials = trials(&folder.join("trials.parquet"))?;
    let boundaries = boundaries(&folder.join("boundaries.parquet"))?;
    let metadata = metadata(&folder.join("trials.parquet"))?;
    let of = |key: &str| metadata.iter().find(|(k, _)| k == key).map_or("", |(_, value)| value);
    let overturned = trials.iter().filter(|trial| trial.overturned).count();
    Ok(Page {
        title: format!("Overturning spectrum “{}”", of("study")),
        lead: format!(
            "Which pulses of the form “{}” overturn the wall, by frequency and amplitude.",
            of("shape")
        ),
        numbers: vec![Number::new(trials.len(), "pulses"), Number::new(overturned, "overturned the wall")],
        sections: vec![Section {
            id: "spectrum".into(),
            title: "The spectrum".into(),
            figures: vec![figure(&trials, boundaries)],
            ..Section::default()
        }],
        provenance: metadata,
        files: ["trials.parquet", "boundaries.parquet"].map(Link::to).to_vec(),
        ..Page::default()
    })
}

fn figure(trials: &[Trial], boundaries: Vec<Dot>) -> Figure {
    let of = |overturned: bool| {
        let own = trials.iter().filter(|trial| trial.overturned == overturned);
        let dot = |trial: &Trial| {
            let what = if overturned { "overturned" } else { "stood" };
            let tip = format!("ω/p {:.3}, a/αg {:.3}\n{what}", trial.frequency, trial.amplitude);
            Dot { x: trial.frequency, y: trial.amplitude, tip }
        };
        own.map(dot).collect()
    };
    let dots = |colour, mark, size, dots| Layer::Dots { colour, mark, size, hollow: false, dots };
    let range = |value: fn(&Trial) -> f64| {
        let values = trials.iter().map(value);
        values.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (low, high) = range(|trial| trial.frequency);
    let room = 0.02 * (high - low);
    let graph = Graph {
        title: String::new(),
        format: Format::Wide,
        x: Axis::linear("frequency of the pulse over p", low - room, high + room),
        y: Axis::linear("amplitude over αg", 0.0, 1.03 * range(|trial| trial.amplitude).1),
        layers: vec![
            dots(STOOD, Mark::Circle, 5, of(false)),
            dots(COLLAPSE, Mark::Square, 9, of(true)),
            dots(PALETTE[0], Mark::Triangle, 10, boundaries),
        ],
    };
    Figure {
        id: "spectrum-figure".into(),
        title: "Pulses that overturn".into(),
        legend: vec![
            Key::new("overturned", COLLAPSE, Mark::Square),
            Key::new("stood", STOOD, Mark::Circle),
            Key::new("boundary", PALETTE[0], Mark::Triangle),
        ],
        panels: vec![graph.svg()],
        wide: true,
        caption: "p = √(3g/4R), R half the diagonal of the wall. Boundaries are narrowed between neighbours that differ; two of them within one spacing of the amplitudes are not seen.".into(),
        links: vec![Link::to("trials.parquet"), Link::to("boundaries.parquet")],
        ..Figure::default()
    }
}

fn numbers(table: &Table, path: &Path, name: &str) -> Result<Vec<f64>> {
    let numbers = table.numbers(name)?.into_iter().collect::<Option<Vec<f64>>>();
    Ok(numbers
        .ok_or_else(|| InputError::key(path, name, "a row without a value", "a number in every row"))?)
}

fn trials(path: &Path) -> Result<Vec<Trial>> {
    let names = ["frequency_over_p", "amplitude_over_alpha_g", "overturned"];
    let table = Table::read(path, &names)?;
    let [frequency, amplitude, overturned] = names.map(|name| numbers(&table, path, name));
    let rows = frequency?.into_iter().zip(amplitude?).zip(overturned?);
    Ok(rows.map(|((frequency, amplitude), o)| Trial { frequency, amplitude, overturned: o != 0.0 }).collect())
}

fn boundaries(path: &Path) -> Result<Vec<Dot>> {
    let names = ["frequency_over_p", "below_over_alpha_g", "above_over_alpha_g"];
    // A table must have rows; a spectrum need not have a boundary.
    if reader(path)?.metadata().file_metadata().num_rows() == 0 {
        return Ok(Vec::new());
    }
    let table = Table::read(path, &names)?;
    let [frequency, below, above] = names.map(|name| numbers(&table, path, name));
    let rows = frequency?.into_iter().zip(below?).zip(above?);
    let dot = |((x, below), above): ((f64, f64), f64)| Dot {
        x,
        y: (below + above) / 2.0,
        tip: format!("ω/p {x:.3}\nboundary at a/αg {below:.4} to {above:.4}"),
    };
    Ok(rows.map(dot).collect())
}

fn reader(path: &Path) -> Result<SerializedFileReader<std::fs::File>> {
    let file = std::fs::File::open(path).map_err(|e| Error::io("read", path, e))?;
    SerializedFileReader::new(file).map_err(|e| Error::table(path, e))
}

/// What the file says of itself.
fn metadata(path: &Path) -> Result<Vec<(String, String)>> {
    let reader = reader(path)?;
    let pairs = reader.metadata().file_metadata().key_value_metadata().cloned().unwrap_or_default();
    let told = pairs.into_iter().filter(|pair| !pair.key.starts_with("ARROW"));
    Ok(told.map(|pair| (pair.key, pair.value.unwrap_or_default())).collect())
}
