//! Printing results on stdout.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use crate::error::{Error, Result};

/// Prints on stdout; a reader that has seen enough (`| head`) is no error.
///
/// # Errors
/// What `print` meets, unless the reader has gone.
pub fn to_stdout(print: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    match print(&mut io::stdout().lock()) {
        Err(Error::Io { source, .. }) if source.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// An error of a stream as an error of stdout.
pub fn failed(error: io::Error) -> Error {
    Error::io("print the results", Path::new("stdout"), error)
}
