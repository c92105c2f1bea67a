//! The command line inside the extension module: the wheel carries the program without a second binary.

use clap::Parser;
use clap::error::ErrorKind;
use mrbd::cli::Cli;
use pyo3::prelude::*;

/// Runs the command line with these words, the program's name first; the exit code of the program.
///
/// The caller gives the signals back to the system first: the commands handle them as the program does.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<String>) -> u8 {
    py.detach(|| match Cli::try_parse_from(words) {
        Ok(cli) => cli.execute().map_or_else(
            |error| {
                eprintln!("mrbd: {error}");
                error.exit_code()
            },
            |()| 0,
        ),
        Err(refused) => {
            // A stream that is closed has nobody to tell.
            let _ = refused.print();
            let asked = matches!(refused.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
            if asked { 0 } else { refused.exit_code() as u8 }
        }
    })
}
