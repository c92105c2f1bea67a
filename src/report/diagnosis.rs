//! The page of a diagnosis: where model and tests part, where a force is missing and of what shape, what explains it, what
//! else might, and what that is worth on tests held out.

mod candidates;
mod columns;
mod could_hide;
mod force;
mod histories;
mod jumps;
mod next_tests;
mod place;
mod shape;
mod window_errors;
mod words;

use std::path::Path;

use super::chart::{Colour, Mark, PALETTE};
use super::page::{Key, Link, Number, Page, Section};
use super::provenance::{Note, read_json};
use crate::error::Result;
use crate::results::diagnosis::tables::TABLES;
use mrbd_lab::diagnose::answer::{Summary, WallFit};
use mrbd_lab::experiment_file::Purpose;
pub use words::{number, numbers_of, round_exponents};
use words::{unit_of, with_sd};

/// Measured: dark grey.
const MEASURED: Colour = PALETTE[6];
/// The wall as given: vermilion; and as updated: blue.
const BEFORE: Colour = PALETTE[1];
const AFTER: Colour = PALETTE[0];

/// The page of the diagnosis in a folder; made of what is in the folder alone.
///
/// # Errors
/// Input errors for files that are none of a diagnosis; whatever drawing meets.
pub fn page(folder: &Path) -> Result<Page> {
    let path = folder.join("diagnosis.json");
    let summary: Summary = read_json(&path, "results as `mrbd diagnose` writes them, finished")?;
    let note = Note::read(&folder.join("manifest.json"))?;
    let windows = window_errors::Windows::read(&folder.join("windows.parquet"))?;
    let force = force::Points::read(folder)?;
    let histories = histories::Histories::read(&folder.join("histories.parquet"))?;
    let sections = vec![
        histories::measured_section(&histories, &summary)?,
        window_section(folder, &windows, &summary)?,
        place::place_section(&force, &histories, &summary)?,
        shape::shape_section(&force, &summary)?,
        candidates::section(&summary)?,
        candidates::rivals_section(&summary)?,
        histories::held_out_section(&histories, &summary)?,
        could_hide::section(&summary)?,
        next_tests::section(&summary),
    ];
    let mut files = vec!["manifest.json", "diagnosis.json", "wall.updated.toml"];
    files.extend(TABLES);
    Ok(Page {
        title: "Diagnosis".into(),
        lead: words::lead(&summary),
        unfinished: None,
        numbers: numbers(&summary),
        notes: notes(&summary),
        sections,
        provenance: note.pairs(),
        files: files.into_iter().map(Link::to).collect(),
        ..Page::default()
    })
}

fn window_section(folder: &Path, windows: &window_errors::Windows, summary: &Summary) -> Result<Section> {
    let mut section = window_errors::section(windows, summary)?;
    section.figures.extend(jumps::figure(&folder.join("jumps.parquet"), summary)?);
    Ok(section)
}

fn numbers(summary: &Summary) -> Vec<Number> {
    let of = |value: String, meaning: &str| Number { value, meaning: meaning.to_owned() };
    let error = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
    let mut numbers = Vec::new();
    for effect in summary.effects.iter().filter(|e| e.parameters.len() <= 2) {
        for (key, value) in &effect.parameters {
            let law = effect.formula.as_deref().or(effect.name.as_deref());
            let meaning = format!("{key}, {}", law.unwrap_or_default());
            numbers.push(of(number(*value) + &unit_of(effect, key), &meaning));
        }
    }
    numbers.push(of(error(summary.windowed_error.before), "times the noise: error of the wall as given"));
    numbers.push(of(error(summary.windowed_error.recalibrated), "with its own numbers recalibrated"));
    if summary.has_names() || summary.has_formula() {
        numbers.push(of(error(summary.windowed_error.after), "with what was found"));
    }
    numbers
}

fn notes(summary: &Summary) -> Vec<String> {
    let mut notes = vec![
        "Errors are over windows of about half a second, each started from a fitted state, in standard deviations of the measured noise: 1 is a perfect model. Over whole tests a rocking wall forgets its past; WME (Eq. 8) is told beside them.".to_owned(),
    ];
    let moved = |n: &&WallFit| n.prior_sd.is_some_and(|sd| (n.after - n.before).abs() > sd);
    for n in summary.wall.iter().filter(moved) {
        let text = format!("{} moved from {} to {}", n.key, number(n.before), with_sd(n.after, n.sd));
        notes.push(format!("{text} {}: more than one standard deviation of what was known.", n.unit));
    }
    if let Some(test) = summary.tests.iter().find(|test| test.read_gain != [1.0; 2]) {
        let [lower, upper] = test.read_gain.map(number);
        notes.push(format!(
            "Patterns were read without the gains of the sensors: θ₁ times {lower}, θ₂ times {upper}."
        ));
    }
    if summary.windows.opened > 0 {
        notes.push(format!("{} windows start with a joint open by less than the noise: it reads as closed, but so no wall followed them.", summary.windows.opened));
    }
    if !summary.tests.iter().any(|test| test.purpose == Purpose::HoldOut) {
        notes.push("No test was held out: nothing here was judged by data that the fit had not seen.".into());
    }
    notes
}

fn key(label: &str, colour: Colour, mark: Mark) -> Key {
    Key::new(label, colour, mark)
}
