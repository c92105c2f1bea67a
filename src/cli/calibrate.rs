//! `mrbd calibrate`: coefficients and other numbers of a wall from measured tests.

use std::io::BufRead;
use std::path::{Path, PathBuf};

use clap::Args;

use super::progress::Bar;
use super::shell::shell_word;
use super::threads::Threads;
use super::{output, stop};
use crate::error::{InputError, Result};
use crate::results::calibration::{OutputNames, finished, write_results};
use mrbd_lab::calibrate::{Archive, Calibration, Experiment, calibrate, print_parameters, simulate, summary};
use mrbd_lab::diagnose::check_tests;

/// Calibrate a wall to measured tests.
///
/// Finds C_1 to C_8 (or any other number of the wall file) that minimise the
/// weighted mean error between measured and simulated rotations: by the
/// differential evolution of the paper for each test and cosine similarity for
/// all tests, and beside it by Gauss-Newton and CMA-ES, for each test and for all
/// tests jointly, with no more simulations. Says which of them the tests can tell.
///
/// Examples:
///   mrbd calibrate experiment.toml --out calibrated
///   mrbd simulate calibrated/wall.calibrated.toml --record record.csv
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct CalibrateArgs {
    /// Experiment file (TOML): wall, tests, what to calibrate.
    experiment: PathBuf,
    /// Folder for the results; must be empty or not exist.
    #[arg(long, value_name = "DIR", required_unless_present = "evaluate")]
    out: Option<PathBuf>,
    /// Seed of every random number, instead of the file's.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Go on with a calibration that was stopped; the result is the same as without the stop. Of one that is finished,
    /// print the result again.
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    threads: Threads,
    /// Calibrate nothing: read vectors from stdin, one a line, and print the WME of each in every test, so that
    /// another optimiser can be used.
    #[arg(long, conflicts_with_all = ["out", "resume"])]
    evaluate: bool,
}

/// Runs the command.
///
/// # Errors
/// Input errors of the experiment and what it names, and of the output folder; failures to write.
pub fn execute(args: &CalibrateArgs) -> Result<()> {
    let experiment = Experiment::load(&args.experiment, args.seed)?;
    let pool = args.threads.pool()?;
    pool.install(|| check_tests(&args.experiment, &experiment.given()?, &experiment.tests))?;
    print_lost(&experiment);
    print_unused(&experiment);
    let Some(out) = args.out.as_ref().filter(|_| !args.evaluate) else { return evaluate(&experiment) };
    if args.resume
        && let Some(stored) = finished(out, &experiment)?
    {
        return print(&stored);
    }
    let names = OutputNames::prepare(out, &experiment, args.resume)?;
    let last_words = format!("what was simulated is stored; to go on: {}", again(args, out));
    stop::end_on_signals(|| last_words)?;
    let progress = Box::new(Bar::of_simulations());
    let archive = Archive::open(&names.journal, &experiment.request, args.resume, progress)?;
    let calibration = pool.install(|| calibrate(&experiment, &archive))?;
    let moments = experiment.moments()?;
    write_results(&names, &experiment, &calibration, moments.as_ref(), archive)?;
    print(&calibration)
}

/// The command that goes on where this one was stopped.
fn again(args: &CalibrateArgs, out: &Path) -> String {
    let seed = args.seed.map_or_else(String::new, |seed| format!(" --seed {seed}"));
    format!("mrbd calibrate {} --out {}{seed} --resume", shell_word(&args.experiment), shell_word(out))
}

/// Says which channels are lost, and what their files have instead.
fn print_lost(experiment: &Experiment) {
    for test in &experiment.tests {
        let names = ["theta1_rad", "theta2_rad"].into_iter().zip(&test.measured.theta_rad);
        for (name, _) in names.filter(|(_, theta)| theta.is_none()) {
            let columns = test.measured.columns.join(", ");
            eprintln!("mrbd: note: test {:?} has no {name}: columns {columns}", test.name);
        }
    }
}

/// Says what is known beforehand and goes into no calibration.
fn print_unused(experiment: &Experiment) {
    if experiment.knows_sensor_gain {
        eprintln!(
            "mrbd: note: prior.sensor_gain is not used here: gains of sensors are for `mrbd diagnose` to find"
        );
    }
}

/// The summary for people, the parameters for programs.
fn print(calibration: &Calibration) -> Result<()> {
    eprintln!("{}", summary(calibration));
    output::to_stdout(|out| print_parameters(out, calibration).map_err(output::failed))
}

/// Answers vectors from stdin with their WME in every test, one line each, as they come.
fn evaluate(experiment: &Experiment) -> Result<()> {
    let count = experiment.space.parameters.len();
    for (number, line) in std::io::stdin().lock().lines().enumerate() {
        let line = line.map_err(output::failed)?;
        let values = line.split([',', ' ', '\t']).filter(|x| !x.is_empty()).map(str::parse::<f64>);
        let values = values.collect::<std::result::Result<Vec<_>, _>>().ok();
        let Some(values) = values.filter(|v| v.len() == count && v.iter().all(|x| x.is_finite())) else {
            let path = Path::new("stdin");
            let allowed = format!("{count} numbers, parted by commas or spaces");
            return Err(InputError::line(path, number + 1, format!("{line:?}"), allowed).into());
        };
        let wme = experiment.tests.iter().map(|test| {
            let run = simulate(&experiment.space, test, &values, experiment.accuracy());
            run.and_then(|run| run.wme).map_or_else(|| "nan".to_owned(), |wme| format!("{wme:?}"))
        });
        let wme = wme.collect::<Vec<_>>();
        if wme.iter().any(|wme| wme == "nan") {
            eprintln!("mrbd: note: line {}: no wall has these values, or a run failed: nan", number + 1);
        }
        let wme = wme.join(",");
        output::to_stdout(|out| writeln!(out, "{wme}").and_then(|()| out.flush()).map_err(output::failed))?;
    }
    Ok(())
}
