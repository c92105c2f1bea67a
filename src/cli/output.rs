//! Printing results on stdout.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use crate::error::{Error, InputError, Result};

/// Prints on stdout; a reader that has seen enough (`| head`) is no error.
///
/// # Errors
/// What `print` meets, unless the reader has gone.
pub fn to_stdout(print: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    match print(&mut io::stdout().lock()) {
        Err(Error::Files(mrbd_files::Error::Io { source, .. })) if source.kind() == ErrorKind::BrokenPipe => {
            Ok(())
        }
        result => result,
    }
}

/// Prints a text and a line end on stdout.
///
/// # Errors
/// What the system says, unless the reader has gone.
pub fn print(text: &str) -> Result<()> {
    to_stdout(|stdout| writeln!(stdout, "{text}").and_then(|()| stdout.flush()).map_err(failed))
}

/// Refuses to write over a file that is read.
///
/// # Errors
/// An input error that names the option.
pub fn check_apart(option: &str, written: Option<&Path>, read: &[&Path]) -> Result<(), InputError> {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let Some(path) = written else { return Ok(()) };
    match real(path) {
        Some(file) if read.iter().any(|path| real(path).as_ref() == Some(&file)) => {
            let found = format!("{}, which is read", path.display());
            Err(InputError::option(option, found, "a file that is no input of this command"))
        }
        _ => Ok(()),
    }
}

/// An error of a stream as an error of stdout.
pub fn failed(error: io::Error) -> Error {
    Error::io("print the results", Path::new("stdout"), error)
}
