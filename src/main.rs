//! Parse, dispatch, print the error.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    match mrbd::cli::Cli::parse().execute() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("mrbd: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
