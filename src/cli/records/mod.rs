//! `mrbd records`: accelerograms read, measured, converted, generated and put into suites.

mod check;
mod convert;
mod describe;
mod floor;
mod generate;
mod import;
mod pulse;
mod select;

use std::io::ErrorKind;
use std::path::Path;

use clap::{Args, Subcommand};

use super::output::print;
use super::table_args::TableArgs;
use crate::error::{InputError, Result};
use crate::text::aligned;
use mrbd_records::{ReadOptions, Record, RecordTable, formats_in_words, read};

/// The paper's Table 4, so that the commands work anywhere.
const TABLE_4: &str = include_str!("../../../inputs/table4.toml");
/// What writing to a path fails with where the path is at fault.
const UNWRITABLE: [ErrorKind; 6] = [
    ErrorKind::AlreadyExists,
    ErrorKind::NotFound,
    ErrorKind::PermissionDenied,
    ErrorKind::NotADirectory,
    ErrorKind::IsADirectory,
    ErrorKind::ReadOnlyFilesystem,
];

/// Read, convert, describe, generate and select accelerograms.
#[derive(Debug, Args)]
#[command(arg_required_else_help = true, long_about = long_about())]
pub struct RecordsArgs {
    #[command(subcommand)]
    command: RecordsCommand,
}

fn long_about() -> String {
    format!(
        "Read, convert, describe, generate and select accelerograms.\n\n\
         A file is told apart by its content: {} (give --dt).",
        formats_in_words("or")
    )
}

#[derive(Debug, Subcommand)]
enum RecordsCommand {
    Describe(describe::DescribeArgs),
    Convert(convert::ConvertArgs),
    Check(check::CheckArgs),
    Generate(generate::GenerateArgs),
    Select(select::SelectArgs),
    Import(import::ImportArgs),
    Pulse(pulse::PulseArgs),
    Floor(floor::FloorArgs),
}

/// Runs the chosen command.
///
/// # Errors
/// Those of the command.
pub fn execute(args: &RecordsArgs) -> Result<()> {
    match &args.command {
        RecordsCommand::Describe(args) => describe::execute(args),
        RecordsCommand::Convert(args) => convert::execute(args),
        RecordsCommand::Check(args) => check::execute(args),
        RecordsCommand::Generate(args) => generate::execute(args),
        RecordsCommand::Select(args) => select::execute(args),
        RecordsCommand::Import(args) => import::execute(args),
        RecordsCommand::Pulse(args) => pulse::execute(args),
        RecordsCommand::Floor(args) => floor::execute(args),
    }
}

/// What is known of files that do not state it.
#[derive(Debug, Clone, Args)]
struct ReadArgs {
    /// Time between samples, where files do not state it.
    #[arg(long, value_name = "SECONDS")]
    dt: Option<f64>,
    #[command(flatten)]
    table: TableArgs,
    /// Channel of files of several: its number from 1, or its name.
    #[arg(long)]
    channel: Option<String>,
}

impl ReadArgs {
    fn options(&self) -> ReadOptions {
        ReadOptions { step_s: self.dt, channel: self.channel.clone(), ..self.table.options() }
    }

    fn read(&self, path: &Path) -> Result<Record> {
        Ok(read(path, &self.options())?)
    }
}

/// The table of a `--table`; the paper's Table 4 unless given.
fn table_or_table_4(path: Option<&Path>) -> Result<RecordTable> {
    Ok(match path {
        Some(path) => RecordTable::load(path)?,
        None => RecordTable::parse(Path::new("inputs/table4.toml"), TABLE_4)?,
    })
}

/// A result of writing to the path of `option`: a path where nothing can be written is bad input, a full disk is not.
fn written<T>(option: &str, result: mrbd_files::Result<T>) -> Result<T> {
    match result {
        Err(mrbd_files::Error::Io { path, source, .. }) if UNWRITABLE.contains(&source.kind()) => {
            let found = format!("{}: {source}", path.display());
            Err(InputError::option(option, found, "a path that can be written").into())
        }
        result => Ok(result?),
    }
}

/// Prints rows under a heading, columns aligned to the right but for the first.
fn print_table(heading: &[&str], rows: &[Vec<String>]) -> Result<()> {
    let heading = heading.iter().map(|&head| head.to_owned()).collect();
    print(&aligned(&[&[heading], rows].concat()))
}

/// Prints a value as indented JSON.
fn print_json(value: &impl serde::Serialize) -> Result<()> {
    // Numbers, strings and lists of them always make JSON.
    print(&serde_json::to_string_pretty(value).expect("plain data is valid JSON"))
}
