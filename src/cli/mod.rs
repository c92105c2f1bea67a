//! The command line: one file a command, each reads its inputs, calls the library and prints.
//!
//! stdout is for data, stderr for people.

mod aggregate;
mod calibrate;
mod check;
mod compare_models;
mod completions;
mod fragility;
mod init;
mod merge;
mod output;
mod records;
mod replay;
mod report;
mod run;
mod simulate;
mod slurm;
mod status;
mod stop;

use clap::{Parser, Subcommand};

use crate::error::Result;

/// Multi-rocking-body dynamics of unreinforced masonry walls that may fall out of their plane.
///
/// Begin with:
///   mrbd init first && cd first
///   mrbd simulate wall.toml --record records/generated_4_600ya.csv --scale 3.5 --plot run.html
///   mrbd run pipeline.toml && mrbd report outputs/first
#[derive(Debug, Parser)]
#[command(name = "mrbd", version, arg_required_else_help = true, verbatim_doc_comment)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Init(init::InitCommand),
    Run(run::RunCommand),
    Merge(merge::MergeCommand),
    Status(status::StatusCommand),
    Replay(replay::ReplayCommand),
    Slurm(slurm::SlurmCommand),
    Aggregate(aggregate::AggregateCommand),
    Check(check::CheckCommand),
    Fragility(fragility::FragilityCommand),
    Calibrate(calibrate::CalibrateArgs),
    Records(records::RecordsArgs),
    Report(report::ReportCommand),
    Simulate(simulate::SimulateArgs),
    Completions(completions::CompletionsCommand),
}

impl Cli {
    /// Runs the command that was asked for.
    ///
    /// # Errors
    /// Whatever the command meets; [`crate::Error::exit_code`] says how the process should end.
    pub fn execute(self) -> Result<()> {
        match self.command {
            Command::Init(command) => command.execute(),
            Command::Run(command) => command.execute(),
            Command::Merge(command) => command.execute(),
            Command::Status(command) => command.execute(),
            Command::Replay(command) => command.execute(),
            Command::Slurm(command) => command.execute(),
            Command::Aggregate(command) => command.execute(),
            Command::Check(command) => command.execute(),
            Command::Fragility(command) => command.execute(),
            Command::Calibrate(args) => calibrate::execute(&args),
            Command::Records(args) => records::execute(&args),
            Command::Report(command) => command.execute(),
            Command::Simulate(args) => simulate::execute(&args),
            Command::Completions(command) => command.execute(),
        }
    }
}
