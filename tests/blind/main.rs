//! Blind cases for `mrbd diagnose`: made, diagnosed and scored (`make blind`).
//!
//! ```text
//! set, number ── cases ──> an experiment, its answer kept beside it
//!                             │ mrbd diagnose, in processes
//!                             └─ score ──> targets, confusion, one row a case
//! ```
//!
//! Half of the cases come from the library's own simulator, half from one of another formulation ([`compliant`]), so that
//! a diagnosis is not judged by inverting its own model alone. Tune on the set `tune`; freeze; report on `report`.

mod calibrate;
mod cases;
mod compliant;
mod diagnose;
mod laws;
mod score;
mod twins;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

/// Make blind cases, run `mrbd diagnose` on each, and score what it says.
#[derive(Debug, Parser)]
#[command(name = "make blind")]
struct Options {
    /// Name of the set: `tune` to tune on, `report` to report; any other name is another set.
    #[arg(long, default_value = "tune")]
    set: String,
    /// Cases of laws that no catalogue has, told as formulas.
    #[arg(long)]
    laws: bool,
    /// Cases of walls whose joints give.
    #[arg(long, conflicts_with = "laws")]
    beds: bool,
    /// Cases with nothing hidden, of every formulation.
    #[arg(long, conflicts_with_all = ["laws", "beds"])]
    nulls: bool,
    /// Cases of free bodies on stiff corners.
    #[arg(long, conflicts_with_all = ["laws", "beds", "nulls"])]
    corners: bool,
    /// Cases of impacts that keep the less the faster they are.
    #[arg(long, conflicts_with_all = ["laws", "beds", "nulls", "corners"])]
    impacts: bool,
    /// How many cases.
    #[arg(long, default_value_t = 40)]
    cases: u64,
    /// Number of the first case.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Only cases whose kind contains this.
    #[arg(long)]
    only: Option<String>,
    /// Only cases of these formulations: own, compliant, corners, springs [default: all].
    #[arg(long)]
    formulation: Vec<String>,
    /// Cases of the set that were scored before: those asked for count, and are not diagnosed again.
    #[arg(long)]
    recorded: Option<PathBuf>,
    /// Folder of the set [default: outputs/blind/SET].
    #[arg(long)]
    out: Option<PathBuf>,
    /// Processes at a time.
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// The program to judge.
    #[arg(long, default_value = env!("CARGO_BIN_EXE_mrbd"))]
    mrbd: PathBuf,
    /// Make the cases and stop.
    #[arg(long)]
    make_only: bool,
    /// Calibrate twins, and score their intervals, instead of diagnosing cases.
    #[arg(long)]
    calibrations: bool,
    /// Find out what laws show at all that were diagnosed and not told: the same cases with the law in the wall file.
    #[arg(long, requires = "laws", conflicts_with_all = ["make_only", "score_only"])]
    visible: bool,
    /// Score what has been diagnosed and stop.
    #[arg(long, conflicts_with = "make_only")]
    score_only: bool,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let done = if options.calibrations { calibrate::go(&options) } else { go(&options) };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("blind: {message}");
            ExitCode::FAILURE
        }
    }
}

fn go(options: &Options) -> Result<(), String> {
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("outputs/blind").join(&options.set));
    let is_asked = |case: &cases::draw::Case| {
        options.only.as_ref().is_none_or(|part| case.kind.name().contains(part))
            && (options.formulation.is_empty()
                || options.formulation.iter().any(|name| name == case.formulation()))
    };
    let draw = options.draw();
    let drawn = options.numbers().map(|number| draw(&options.set, number));
    let known = options.recorded_numbers()?;
    let is_new = |case: &cases::draw::Case| !known.contains(&case.number);
    let chosen: Vec<cases::draw::Case> = drawn.filter(|case| is_asked(case) && is_new(case)).collect();
    let folder = |case: &cases::draw::Case| out.join(format!("case_{:04}", case.number));
    if !options.score_only {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.jobs).build();
        let pool = pool.map_err(|e| e.to_string())?;
        let motions = cases::tests::motions(&options.set).map_err(|e| e.to_string())?;
        eprintln!("{} cases of the set {} in {}", chosen.len(), options.set, out.display());
        let program = (!options.make_only).then(|| diagnose::Program::new(&options.mrbd)).transpose()?;
        let bar = progress(chosen.len());
        let done: Vec<Result<(), String>> = pool.install(|| {
            let one = |case: &cases::draw::Case| {
                let done = match program.as_ref().filter(|_| options.visible) {
                    Some(program) => laws::visible::with_the_law(case, &folder(case), program),
                    None => make_and_diagnose(case, &motions, &folder(case), program.as_ref()),
                };
                bar.inc(1);
                done.map_err(|e| format!("case {}, {}: {e}", case.number, case.kind.name()))
            };
            // In the order of their numbers: a run that is stopped leaves the beginning of the set.
            chosen.iter().par_bridge().map(one).collect()
        });
        bar.finish();
        done.into_iter().filter_map(Result::err).for_each(|e| eprintln!("blind: {e}"));
    }
    if options.make_only {
        return Ok(());
    }
    let folders: Vec<PathBuf> = chosen.iter().map(folder).collect();
    if options.laws {
        laws::targets::report(&folders, options.recorded()?, &out)
    } else {
        score::report(&folders, options.recorded()?, &out)
    }
}

impl Options {
    /// How the cases asked for are drawn.
    fn draw(&self) -> fn(&str, u64) -> cases::draw::Case {
        match self {
            Self { laws: true, .. } => laws::draw::draw,
            Self { beds: true, .. } => cases::beds::draw,
            Self { nulls: true, .. } => cases::nulls::draw,
            Self { corners: true, .. } => cases::corners::draw,
            Self { impacts: true, .. } => cases::impacts::draw,
            _ => cases::draw::draw,
        }
    }

    fn numbers(&self) -> std::ops::Range<u64> {
        self.first..self.first + self.cases
    }

    /// Those asked for of the cases that were scored before.
    fn recorded<R: score::recorded::Recorded>(&self) -> Result<Vec<R>, String> {
        let rows =
            self.recorded.as_ref().map(|path| score::recorded::load::<R>(path, &self.set)).transpose()?;
        let asked = |row: &R| self.numbers().contains(&row.case().1);
        Ok(rows.unwrap_or_default().into_iter().filter(asked).collect())
    }

    fn recorded_numbers(&self) -> Result<Vec<u64>, String> {
        if self.laws {
            return Ok(self.recorded::<laws::LawRow>()?.iter().map(|row| row.number).collect());
        }
        Ok(self.recorded::<score::Row>()?.iter().map(|row| row.number).collect())
    }
}

/// Makes a case unless it is there, and diagnoses it if there is a program to.
fn make_and_diagnose(
    case: &cases::draw::Case,
    motions: &[Vec<f64>],
    folder: &Path,
    program: Option<&diagnose::Program>,
) -> Result<(), String> {
    // The answer is written last: with it a case is whole.
    let answer = folder.join("answer.json");
    if answer.is_file() {
        cases::folder::is_this(case, &answer)?;
    } else {
        cases::folder::write(case, motions, folder)?;
    }
    program.map_or(Ok(()), |program| program.diagnose(folder))
}

fn progress(count: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} cases, {elapsed} gone, {eta} to go");
    ProgressBar::new(count as u64).with_style(style.expect("a valid template"))
}
