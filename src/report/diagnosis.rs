//! The page of a diagnosis: where model and tests part, where a force is missing and of what shape, what explains it, what
//! else might, and what that is worth on tests held out.

mod candidates;
mod force;
mod hide;
mod histories;
mod jumps;
mod next;
mod parting;
mod place;
mod shape;
mod stored;
mod words;

use std::path::Path;

use super::chart::{Colour, Mark, PALETTE};
use super::page::{Key, Link, Number, Page, Section};
use super::provenance::Note;
use crate::error::Result;
use crate::results::diagnosis::tables::TABLES;
use stored::Stored;
use words::{number, with_sd};

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
    let stored = Stored::read(&folder.join("diagnosis.json"))?;
    let note = Note::read(&folder.join("manifest.json"))?;
    let windows = parting::Windows::read(&folder.join("windows.parquet"))?;
    let force = force::Points::read(folder)?;
    let histories = histories::Histories::read(&folder.join("histories.parquet"))?;
    let sections = vec![
        histories::measured_section(&histories, &stored)?,
        parting_section(folder, &windows, &stored)?,
        place::place_section(&force, &histories, &stored)?,
        shape::shape_section(&force, &stored)?,
        candidates::section(&stored)?,
        candidates::rivals_section(&stored)?,
        histories::held_out_section(&histories, &stored)?,
        hide::section(&stored)?,
        next::section(&stored),
    ];
    let mut files = vec!["manifest.json", "diagnosis.json", "wall.updated.toml"];
    files.extend(TABLES);
    Ok(Page {
        title: "Diagnosis".into(),
        lead: words::lead(&stored),
        numbers: numbers(&stored),
        notes: notes(&stored),
        sections,
        provenance: note.pairs(),
        files: files.into_iter().map(Link::to).collect(),
    })
}

fn parting_section(folder: &Path, windows: &parting::Windows, stored: &Stored) -> Result<Section> {
    let mut section = parting::section(windows, stored)?;
    section.figures.extend(jumps::figure(&folder.join("jumps.parquet"), stored)?);
    Ok(section)
}

fn numbers(stored: &Stored) -> Vec<Number> {
    let of = |value: String, meaning: &str| Number { value, meaning: meaning.to_owned() };
    let error = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
    let mut numbers = Vec::new();
    for effect in stored.effects.iter().filter(|e| e.parameters.len() <= 2) {
        for (key, value) in &effect.parameters {
            let meaning = format!("{key}, {}", effect.name.as_deref().unwrap_or_default());
            numbers.push(of(number(*value), &meaning));
        }
    }
    numbers.push(of(error(stored.windowed_error.before), "times the noise: error of the wall as given"));
    numbers.push(of(error(stored.windowed_error.recalibrated), "with its own numbers recalibrated"));
    if stored.is_answered() {
        numbers.push(of(error(stored.windowed_error.after), "with what was found"));
    }
    numbers
}

fn notes(stored: &Stored) -> Vec<String> {
    let mut notes = vec![
        "Errors are over windows of about half a second, each started from a fitted state, in standard deviations of the measured noise: 1 is a perfect model. Over whole tests a rocking wall forgets its past; WME (Eq. 8) is told beside them.".to_owned(),
    ];
    let moved = |n: &&stored::StoredNumber| n.prior_sd.is_some_and(|sd| (n.after - n.before).abs() > sd);
    for n in stored.wall.iter().filter(moved) {
        let text = format!("{} moved from {} to {}", n.key, number(n.before), with_sd(n.after, n.sd));
        notes.push(format!("{text} {}: more than one standard deviation of what was known.", n.unit));
    }
    if let Some(test) = stored.tests.iter().find(|test| test.read_gain != [1.0; 2]) {
        let [lower, upper] = test.read_gain.map(number);
        notes.push(format!(
            "Patterns were read without the gains of the sensors: θ₁ times {lower}, θ₂ times {upper}."
        ));
    }
    if stored.windows.opened > 0 {
        notes.push(format!("{} windows start with a joint open by less than the noise: it reads as closed, but so no wall followed them.", stored.windows.opened));
    }
    if !stored.tests.iter().any(|test| test.purpose == "hold-out") {
        notes.push("No test was held out: nothing here was judged by data that the fit had not seen.".into());
    }
    notes
}

fn key(label: &str, colour: Colour, mark: Mark) -> Key {
    Key::new(label, colour, mark)
}
