//! `mrbd diagnose`: where model and measurement disagree, and which effect would make them agree.

use std::path::PathBuf;

use clap::Args;
use serde_json::Value;

use super::output;
use super::progress::Bar;
use super::report::write_page;
use super::threads::Threads;
use crate::error::Result;
use crate::results::diagnosis::{OutputNames, write_results};
use mrbd_lab::diagnose::{Experiment, check_data, diagnose};

/// Find where model and measurement disagree, and name the missing effect.
///
/// Cuts the tests into short windows, simulates each from a fitted state, and
/// tries every effect of the catalogue (mrbd effects) and their pairs within
/// what was known of the wall ([prior] of the experiment). Judged on tests with
/// use = "hold-out". Answers none, recalibrated, named, class, place_only,
/// unknown or no_power.
///
/// Examples:
///   mrbd diagnose experiment.toml --out diagnosed
///   mrbd simulate diagnosed/wall.updated.toml --record record.csv
///   mrbd report diagnosed          # its page once more; the first time it is made here
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct DiagnoseArgs {
    /// Experiment file (TOML): wall, what was known of it, tests.
    experiment: PathBuf,
    /// Folder for the results; empty, or of an earlier diagnosis.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    threads: Threads,
}

/// Runs the command.
///
/// # Errors
/// Input errors of the experiment and what it names, and of the output folder; failures to write.
pub fn execute(args: &DiagnoseArgs) -> Result<()> {
    let mut experiment = Experiment::load(&args.experiment)?;
    let pool = args.threads.pool()?;
    let names = OutputNames::prepare(&args.out)?;
    let bar = Bar::of_steps();
    let summary = pool.install(|| -> Result<Value> {
        check_data(&experiment)?;
        let diagnosis = diagnose(&mut experiment, &bar)?;
        write_results(&names, &experiment, &diagnosis)
    })?;
    drop(bar);
    eprintln!("{}", told(&summary));
    let page = write_page(&args.out, None)?;
    eprintln!("its page, to be opened in a browser: {}", page.display());
    output::to_stdout(|out| writeln!(out, "{}", names.diagnosis.display()).map_err(output::failed))
}

/// The answer in a few lines.
fn told(summary: &Value) -> String {
    let mut lines = vec![format!("verdict: {}", summary["verdict"].as_str().unwrap_or("?"))];
    for effect in summary["effects"].as_array().into_iter().flatten() {
        let name = effect["name"].as_str().unwrap_or("a law outside the catalogue");
        lines.push(format!("  {name} at {}", effect["place"].as_str().unwrap_or("?")));
        for (key, value) in effect["parameters"].as_object().into_iter().flatten() {
            let interval = &effect["interval"][key];
            let [value, low, high] =
                [value, &interval[0], &interval[1]].map(|v| v.as_f64().unwrap_or(f64::NAN));
            lines.push(format!("    {key} = {value:.5} (90 %: {low:.5} to {high:.5})"));
        }
    }
    let equivalent = summary["equivalent"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let equivalent = equivalent.collect::<Vec<_>>();
    if !equivalent.is_empty() {
        lines.push(format!("  these tests cannot tell apart: {}", equivalent.join(", ")));
    }
    let error = |when: &str| summary["windowed_error"][when].as_f64();
    lines.push(match ["before", "recalibrated", "after"].map(error) {
        [Some(before), Some(recalibrated), Some(after)] => {
            format!("windowed error, in noise: {before:.2} before, {recalibrated:.2} recalibrated, {after:.2} after")
        }
        _ => "windowed error: no window in which the wall moves".to_owned(),
    });
    lines.join("\n")
}
