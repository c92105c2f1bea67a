//! Errors of the library as exceptions.

use mrbd_files::{InputError as Fault, Place};
use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;

use crate::table::Table;

create_exception!(
    mrbd,
    InputError,
    PyValueError,
    "Something given is wrong.\n\nAttributes: `file`, `key` and `line` say where (`None` where there is none), `found` what \
     was there, `allowed` what is allowed."
);
create_exception!(
    mrbd,
    Error,
    PyRuntimeError,
    "A failure that is no fault of the input, such as a damaged table of results."
);
create_exception!(mrbd, Question, PyUserWarning, "A number of a wall that few walls have: perhaps a slip.");

create_exception!(
    mrbd,
    Interrupted,
    PyKeyboardInterrupt,
    "Ctrl-C in a long work.\n\nAttribute: `done`, a `Table` of the runs that were done."
);

impl Interrupted {
    /// The exception that hands on what is done; any error but Ctrl-C as it is.
    ///
    /// # Errors
    /// What Python says of a table that cannot be made.
    pub fn with_done(py: Python<'_>, error: PyErr, done: Table) -> PyResult<PyErr> {
        if !error.is_instance_of::<PyKeyboardInterrupt>(py) {
            return Ok(error);
        }
        let interrupted = Self::new_err(format!("stopped; {} runs are in `done`", done.rows()));
        interrupted.value(py).setattr("done", Bound::new(py, done)?)?;
        Ok(interrupted)
    }
}

/// What begins the name of what was given by a call and not in a file.
const CALL: &str = "mrbd.";

/// The name of what was given by a call, as the file of an input error.
pub fn call(name: &str) -> String {
    format!("{CALL}{name}()")
}

/// An argument of a call that is wrong.
pub fn argument(function: &str, key: &str, found: impl Into<String>, allowed: impl Into<String>) -> PyErr {
    let place = Place::Key(key.into());
    input(Fault { origin: call(function), place, found: found.into(), allowed: allowed.into() })
}

/// Any failure of the program.
pub fn raised(error: mrbd::Error) -> PyErr {
    match error {
        mrbd::Error::Files(error) => files(error),
        other => Error::new_err(other.to_string()),
    }
}

/// A failure of reading or writing files.
pub fn files(error: mrbd_files::Error) -> PyErr {
    match error {
        mrbd_files::Error::Input(fault) => input(fault),
        mrbd_files::Error::Io { action, path, source } => match source.raw_os_error() {
            // Three arguments: Python makes the subclass of the number, such as FileNotFoundError.
            Some(number) => {
                let message = format!("cannot {action}: {source}");
                PyOSError::new_err((number, message, path.display().to_string()))
            }
            None => PyOSError::new_err(format!("{}: cannot {action}: {source}", path.display())),
        },
    }
}

/// Something that was given is wrong.
pub fn input(fault: Fault) -> PyErr {
    Python::attach(|py| {
        let given = fault.origin.starts_with(CALL);
        // The lines of what was given by a call are nobody's.
        let (key, line) = match fault.place.clone() {
            Place::Whole => (None, None),
            Place::Line(line) => (None, Some(line)),
            Place::Key(key) => (Some(key), None),
            Place::KeyOnLine(key, line) => (Some(key), Some(line)),
        };
        let line = line.filter(|_| !given);
        let place = match (&key, line) {
            (Some(key), Some(line)) => Place::KeyOnLine(key.clone(), line),
            (Some(key), None) => Place::Key(key.clone()),
            (None, Some(line)) => Place::Line(line),
            (None, None) => Place::Whole,
        };
        let fault = Fault { place, ..fault };
        let error = InputError::new_err(fault.to_string());
        let value = error.value(py);
        let told = value
            .setattr("file", &fault.origin)
            .and_then(|()| value.setattr("key", key))
            .and_then(|()| value.setattr("line", line))
            .and_then(|()| value.setattr("found", &fault.found))
            .and_then(|()| value.setattr("allowed", &fault.allowed));
        match told {
            Ok(()) => error,
            Err(other) => other,
        }
    })
}

/// A failure of a call that took the words of a command: its options are the arguments.
pub fn raised_by(function: &str, error: mrbd::Error) -> PyErr {
    match error {
        mrbd::Error::Files(mrbd_files::Error::Input(fault)) if fault.origin == "command line" => {
            let place = match fault.place {
                Place::Key(option) => Place::Key(option.trim_start_matches('-').replace('-', "_")),
                other => other,
            };
            input(Fault { origin: call(function), place, ..fault })
        }
        other => raised(other),
    }
}
