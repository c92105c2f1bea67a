//! Fragility: the options of `mrbd fragility`, given by keyword, and its answer.

use clap::Parser;
use mrbd::cli::FragilityCommand;
use pyo3::prelude::*;

use crate::errors::{Error, argument, raised_by};
use crate::values;

/// The options as words: one door for the command and for Python.
#[derive(Parser)]
#[command(name = "mrbd.fragility", disable_help_flag = true)]
struct Words {
    #[command(flatten)]
    command: FragilityCommand,
}

/// What `mrbd fragility` answers: its JSON, its lines for people, its curves as CSV, and its notes.
type Answer<'py> = (Bound<'py, PyAny>, String, String, Vec<String>);

/// Fits fragilities; `words` are the options of the command, in its own words.
#[pyfunction]
pub fn fit_fragility(py: Python<'_>, words: Vec<String>) -> PyResult<Answer<'_>> {
    let words = Words::try_parse_from(words).map_err(|refused| {
        let message = refused.to_string();
        let first = message.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        argument("fragility", "", first, "the options of `mrbd fragility`, by keyword")
    })?;
    let answer = py.detach(|| words.command.answer()).map_err(|e| raised_by("fragility", e))?;
    let mut curves = Vec::new();
    answer.curves(&mut curves).map_err(|e| Error::new_err(e.to_string()))?;
    let curves = String::from_utf8(curves)?;
    let notes = answer.warnings();
    Ok((values::json(py, &answer.json())?, answer.table(), curves, notes))
}
