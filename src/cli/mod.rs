//! The command line: one file a command, each reads its inputs, calls the library and prints.
//!
//! stdout is for data, stderr for people.

mod aggregate;
mod assess;
mod assess_survey;
mod calibrate;
mod check;
mod check_tolerance;
mod compare_models;
mod describe;
mod diagnose;
mod effects;
mod examples;
mod fragility;
mod init;
mod margin;
mod measures;
mod merge;
mod output;
mod progress;
mod push;
mod records;
mod replay;
mod report;
mod risk;
mod run;
mod shell;
mod simulate;
mod slurm;
mod so_far;
pub mod starter;
mod status;
mod stop;
mod suites;
mod table_args;
mod threads;
mod variance;

pub use aggregate::keep_medians;
pub use assess::AssessCommand;
pub use fragility::{FragilityAnswer, FragilityCommand};
pub use margin::MarginCommand;
pub use output::Answer;
pub use push::PushCommand;
pub use risk::RiskCommand;

use std::sync::LazyLock;

use clap::{Parser, Subcommand};

use crate::error::Result;

/// Multi-rocking-body dynamics of unreinforced masonry walls that may fall out of their plane.
///
/// Begin with:
///   mrbd init first && cd first
///   mrbd simulate wall.toml --record records/generated_4_600ya.csv --scale 3.05 --plot run.html
///   mrbd run pipeline.toml && mrbd report outputs/first
#[derive(Debug, Parser)]
#[command(name = "mrbd", version = version(), arg_required_else_help = true, verbatim_doc_comment)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Init(init::InitCommand),
    Describe(describe::DescribeCommand),
    #[command(after_help = examples::RUN)]
    Run(run::RunCommand),
    #[command(after_help = examples::MERGE)]
    Merge(merge::MergeCommand),
    #[command(after_help = examples::STATUS)]
    Status(status::StatusCommand),
    Replay(replay::ReplayCommand),
    #[command(after_help = examples::SLURM)]
    Slurm(slurm::SlurmCommand),
    #[command(after_help = examples::AGGREGATE)]
    Aggregate(aggregate::AggregateCommand),
    #[command(after_help = examples::CHECK)]
    Check(check::CheckCommand),
    #[command(after_help = examples::CHECK_TOLERANCE)]
    CheckTolerance(check_tolerance::CheckToleranceCommand),
    Fragility(fragility::FragilityCommand),
    Calibrate(calibrate::CalibrateArgs),
    Diagnose(diagnose::DiagnoseArgs),
    Effects(effects::EffectsCommand),
    Records(records::RecordsArgs),
    #[command(after_help = examples::REPORT)]
    Report(report::ReportCommand),
    Suites(suites::SuitesCommand),
    Measures(measures::MeasuresCommand),
    Variance(variance::VarianceCommand),
    Margin(margin::MarginCommand),
    Push(push::PushCommand),
    Assess(assess::AssessCommand),
    AssessSurvey(assess_survey::AssessSurveyCommand),
    Risk(risk::RiskCommand),
    Simulate(simulate::SimulateArgs),
    Completions(shell::CompletionsCommand),
}

/// Version, and the commit where the build knew it.
fn version() -> &'static str {
    static VERSION: LazyLock<String> = LazyLock::new(|| {
        let version = env!("CARGO_PKG_VERSION");
        let commit = option_env!("MRBD_COMMIT").filter(|commit| !commit.is_empty());
        commit.map_or_else(|| version.to_owned(), |commit| format!("{version} ({commit})"))
    });
    &VERSION
}

impl Cli {
    /// Runs the command that was asked for.
    ///
    /// # Errors
    /// Whatever the command meets; [`crate::Error::exit_code`] says how the process should end.
    pub fn execute(self) -> Result<()> {
        match self.command {
            Command::Init(command) => command.execute(),
            Command::Describe(command) => command.execute(),
            Command::Run(command) => command.execute(),
            Command::Merge(command) => command.execute(),
            Command::Status(command) => command.execute(),
            Command::Replay(command) => command.execute(),
            Command::Slurm(command) => command.execute(),
            Command::Aggregate(command) => command.execute(),
            Command::Check(command) => command.execute(),
            Command::CheckTolerance(command) => command.execute(),
            Command::Fragility(command) => command.execute(),
            Command::Calibrate(args) => calibrate::execute(&args),
            Command::Diagnose(args) => diagnose::execute(&args),
            Command::Effects(command) => command.execute(),
            Command::Records(args) => records::execute(&args),
            Command::Report(command) => command.execute(),
            Command::Measures(command) => command.execute(),
            Command::Variance(command) => command.execute(),
            Command::Suites(command) => command.execute(),
            Command::Margin(command) => command.execute(),
            Command::Push(command) => command.execute(),
            Command::Assess(command) => command.execute(),
            Command::AssessSurvey(command) => command.execute(),
            Command::Risk(command) => command.execute(),
            Command::Simulate(args) => simulate::execute(&args),
            Command::Completions(command) => command.execute(),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    /// All commands that do something, those under `records` too.
    fn leaves(command: &clap::Command, all: &mut Vec<clap::Command>) {
        if command.get_subcommands().next().is_none() && command.get_name() != "help" {
            all.push(command.clone());
        }
        command.get_subcommands().for_each(|inner| leaves(inner, all));
    }

    /// Arguments of the commands in an example: up to a comment, a pipe or a redirection.
    fn commands(line: &str) -> impl Iterator<Item = Vec<&str>> {
        let line = line.split(" # ").next().unwrap_or(line);
        line.split(" && ")
            .map(|part| part.split_whitespace().take_while(|word| !["|", ">"].contains(word)).collect())
    }

    #[test]
    fn regress_every_command_has_examples_that_parse() {
        let mut all = Vec::new();
        leaves(&Cli::command(), &mut all);
        assert!(all.len() >= 20, "{} commands", all.len());
        for command in all {
            // Wide enough that no example is wrapped.
            let mut command = command.term_width(500);
            let help = command.render_long_help().to_string();
            let examples = help.split_once("Examples:").unwrap_or_else(|| panic!("{}", command.get_name())).1;
            let lines: Vec<&str> = examples.lines().filter(|line| line.starts_with("  mrbd ")).collect();
            assert!(!lines.is_empty(), "{} has no example", command.get_name());
            for words in lines.iter().flat_map(|line| commands(line)).filter(|words| words[0] == "mrbd") {
                let parsed = Cli::try_parse_from(&words);
                assert!(parsed.is_ok(), "{words:?}: {}", parsed.expect_err("an error"));
            }
        }
    }

    #[test]
    fn regress_the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
