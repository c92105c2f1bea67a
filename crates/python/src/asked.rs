//! Questions that a command answers: its options, given by keyword, and what it would print.

use std::sync::Arc;

use clap::Parser;
use mrbd::cli::{Answer, AssessCommand, MarginCommand, PushCommand, RiskCommand};
use mrbd_files::{InputError as Fault, Place};
use pyo3::prelude::*;

use crate::errors::{argument, raised_by};
use crate::laboratory::Counted;
use crate::work::{Shown, Watched, left_alone};

/// The options as words: one door for the commands and for Python.
#[derive(Parser)]
#[command(name = "mrbd", disable_help_flag = true, disable_help_subcommand = true)]
enum Words {
    Push(PushCommand),
    Assess(AssessCommand),
    Margin(MarginCommand),
    Risk(RiskCommand),
}

/// Options whose keyword has a unit in its name.
const WITH_UNITS: [(&str, &str); 2] = [("--bed", "bed_pa_per_m"), ("--tail", "tail_s")];

impl Words {
    fn answer(&self, counted: &Counted) -> mrbd::Result<Answer> {
        match self {
            Self::Push(command) => command.answer(),
            Self::Assess(command) => command.answer(counted),
            Self::Margin(command) => command.answer(counted),
            Self::Risk(command) => command.answer(),
        }
    }
}

/// Asks a command; `words` are its name and its options, in its own words. Its JSON, its lines for people, its notes.
#[pyfunction]
pub fn ask(
    py: Python<'_>,
    words: Vec<String>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(String, String, Vec<String>)> {
    let function = words.first().cloned().unwrap_or_default();
    let all = std::iter::once("mrbd".to_owned()).chain(words);
    let command = Words::try_parse_from(all).map_err(|refused| {
        let message = refused.to_string();
        let first = message.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        argument(&function, "", first, format!("the options of `mrbd {function}`, by keyword"))
    })?;
    let told = Arc::new(Watched::default());
    let counted = Counted(Arc::clone(&told));
    let answer = left_alone(py, told, &Shown::of(progress, 0), move || command.answer(&counted))?;
    let answer = answer.map_err(|error| raised_by(&function, with_unit(error)))?;
    Ok((answer.json, answer.text, answer.notes))
}

/// The error of an option under the name of its keyword.
fn with_unit(error: mrbd::Error) -> mrbd::Error {
    let mrbd::Error::Files(mrbd_files::Error::Input(Fault {
        place: Place::Key(option),
        origin,
        found,
        allowed,
    })) = error
    else {
        return error;
    };
    let keyword =
        WITH_UNITS.iter().find(|(name, _)| *name == option).map(|(_, keyword)| (*keyword).to_owned());
    let place = Place::Key(keyword.unwrap_or(option));
    mrbd::Error::Files(mrbd_files::Error::Input(Fault { place, origin, found, allowed }))
}
