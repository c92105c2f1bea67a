//! `mrbd simulate`: one wall under one record, or one after another.

mod then;

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::output;
use super::table_args::TableArgs;
use crate::error::{Error, InputError, Result};
use crate::report::{PlotFile, RunPicture, Watch};
use crate::results::RunResults;
use crate::store::{HistoryWriter, write_history};
use clap::Args;
use mrbd_files::load_wall;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{
    Accuracy, Ensemble, MEMBERS, MEMBERS_IN_CHAOS, Outcome, Shaking, simulate, simulate_members,
    simulate_observed,
};
use mrbd_records::{Accelerogram, ReadOptions, read};
use then::{Sequence, ThenArgs, WatchedParts};

/// Simulate one wall under one record, records one after another, or its free release.
///
/// Without --record the wall is released from the rotations of [initial] and
/// moves freely for --tail seconds.
///
/// Three more runs go beside it, on two threads: the ground motion and the rotations of a release times
/// 1 - 1e-6 and 1 + 1e-6, and the tolerance times 0.1. Nobody can know these differences. Where all four end
/// alike and fewer than two digits of the largest rotations hold, the run is chaotic, and eight more follow.
/// Numbers are printed with the digits that hold; JSON has all digits of the run itself and the spread.
///
/// Examples:
///   mrbd simulate inputs/walls/table_wall.toml --record gilroy.AT2
///   mrbd simulate wall.toml --record east.csv --scale 1.2 --vertical up.csv --json
///   mrbd simulate wall.toml --record record.txt --dt 0.005 --history run.parquet
///   mrbd simulate wall.toml --record logger.csv --columns Time,Acc --unit g --decimal-comma
///   mrbd simulate wall.toml --record record.AT2 --plot run.html
///   mrbd simulate wall.toml --record 20_may.csv --then 29_may.csv --rest 60
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, allow_negative_numbers = true)]
pub struct SimulateArgs {
    /// Wall file (TOML).
    wall: PathBuf,
    /// Horizontal accelerogram; its format is told by its content.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Time between samples, for records that do not tell it; the step of the history of a free release.
    #[arg(long, value_name = "SECONDS")]
    dt: Option<f64>,
    #[command(flatten)]
    table: TableArgs,
    /// Factor on the horizontal record.
    #[arg(long, value_name = "X", default_value_t = 1.0)]
    scale: f64,
    /// Vertical accelerogram, at the same step; zero after its end.
    #[arg(long, value_name = "FILE", requires = "record")]
    vertical: Option<PathBuf>,
    /// Factor on the vertical record.
    #[arg(
        long,
        value_name = "X",
        default_value_t = 1.0,
        requires = "vertical",
        allow_negative_numbers = true
    )]
    vertical_scale: f64,
    #[command(flatten)]
    then: ThenArgs,
    /// Free motion after the record.
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0)]
    tail: f64,
    /// Error allowed in rotations relative to α_i, over a well-conditioned run; 1e-13 to 1e-2.
    #[arg(long, value_name = "X", default_value_t = 1e-6)]
    tolerance: f64,
    /// Capture velocity, instead of the wall file's.
    #[arg(long, value_name = "RAD_S")]
    capture_velocity: Option<f64>,
    /// Write the rotations at every sample to a .csv or .parquet file.
    #[arg(long, value_name = "FILE")]
    history: Option<PathBuf>,
    /// Draw the run into a .svg, .png or .html file; the page shows the wall in motion too.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Print the results as JSON.
    #[arg(long)]
    json: bool,
    /// The run alone: without those beside it, and with all digits.
    #[arg(long)]
    alone: bool,
}

impl SimulateArgs {
    fn read_options(&self) -> ReadOptions {
        ReadOptions { step_s: self.dt, ..self.table.options() }
    }
}

/// Runs the command.
///
/// # Errors
/// Bad input; a result that cannot be written; a run that could not be finished.
pub fn execute(args: &SimulateArgs) -> Result<()> {
    let wall = wall(args)?;
    let mut shaking = shaking(args)?;
    let record_name = args.record.as_deref().map(|path| record_name(path, args.scale));
    let mut sequence = args.then.follow(&mut shaking, record_name.as_deref(), &args.read_options())?;
    let accuracy = accuracy(args.tolerance)?;
    check_moves(&wall, args)?;
    super::describe::print_questions(&args.wall, &wall);
    let (history, plot) = outputs(args)?;
    let mut watch = Watch::new(history_step_s(args, &shaking)?);
    let watched = WatchedParts {
        watch: (history.is_some() || plot.is_some()).then_some(&mut watch),
        peaks: sequence.as_mut().map(Sequence::peaks),
    };
    let ensemble = ensemble(&wall, &shaking, accuracy, (watched, args.alone));
    let of_parts = |sequence: &Sequence| sequence.results(&wall, accuracy, &ensemble.run, shaking.tail_s);
    let parts = sequence.as_ref().map_or(Vec::new(), of_parts);
    let results = RunResults::new(&wall, &shaking, &ensemble).with_parts(&parts);
    if let Some(writer) = history {
        writer.finish(&watch.history, &wall.reading())?;
    }
    if let Some(plot) = plot {
        let record_name = sequence.as_ref().map(Sequence::name).or(record_name);
        plot.write(&RunPicture {
            wall: &wall,
            wall_name: &file_name(&args.wall),
            shaking: &shaking,
            record_name: record_name.as_deref(),
            accuracy,
            watch: &watch,
            response: &ensemble.run,
            ensemble: &ensemble,
            remarks: &results.remarks(),
            parts: &parts,
        })?;
    }
    output::print(&if args.json { format!("{:#}", results.json()) } else { results.text() })?;
    finished(ensemble)
}

/// The history and the picture that are asked for, checked before the run.
fn outputs(args: &SimulateArgs) -> Result<(Option<HistoryWriter>, Option<PlotFile>)> {
    let read = [Some(&args.wall), args.record.as_ref(), args.vertical.as_ref()];
    let read = read.into_iter().flatten().chain(&args.then.then).map(PathBuf::as_path).collect::<Vec<_>>();
    output::check_apart("--history", args.history.as_deref(), &read)?;
    output::check_apart("--plot", args.plot.as_deref(), &read)?;
    let history = args.history.as_deref().map(write_history).transpose()?;
    Ok((history, args.plot.as_deref().map(PlotFile::new).transpose()?))
}

/// The run and those beside it, each half on a thread; more of them where these part.
fn ensemble(
    wall: &Wall,
    shaking: &Shaking,
    accuracy: Accuracy,
    (mut watched, alone): (WatchedParts, bool),
) -> Ensemble {
    let members = |of: Range<usize>| simulate_members(wall, shaking, accuracy, of);
    let beside = |of: Range<usize>| if alone { Vec::new() } else { members(of) };
    let is_watched = watched.watch.is_some() || watched.peaks.is_some();
    let observed = || vec![simulate_observed(wall, shaking, accuracy, &mut watched)];
    let (mut first, rest) = match is_watched {
        true => rayon::join(observed, || beside(1..MEMBERS)),
        false if alone => (vec![simulate(wall, shaking, accuracy)], Vec::new()),
        false => rayon::join(|| members(0..MEMBERS / 2), || members(MEMBERS / 2..MEMBERS)),
    };
    let run = first.remove(0);
    let ensemble = Ensemble { run, others: first }.with(rest);
    if alone || !ensemble.needs_more() {
        return ensemble;
    }
    let middle = usize::midpoint(MEMBERS, MEMBERS_IN_CHAOS);
    let (some, others) = rayon::join(|| members(MEMBERS..middle), || members(middle..MEMBERS_IN_CHAOS));
    ensemble.with(some).with(others)
}

/// A run that could not be finished is an error, after what it gave has been printed.
fn finished(ensemble: Ensemble) -> Result<()> {
    match ensemble.run.outcome {
        Outcome::Failed { time_s, reason } => Err(Error::Run { time_s, reason }),
        _ => Ok(()),
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn record_name(path: &Path, scale: f64) -> String {
    let name = file_name(path);
    if scale == 1.0 { name } else { format!("{name} × {scale}") }
}

fn wall(args: &SimulateArgs) -> Result<Wall> {
    let wall = load_wall(&args.wall)?;
    let Some(capture_velocity_rad_s) = args.capture_velocity else { return Ok(wall) };
    let mut parameters = wall.parameters().clone();
    parameters.restitution.capture_velocity_rad_s = capture_velocity_rad_s;
    Ok(Wall::new(parameters).map_err(|e| InputError::option("--capture-velocity", e.found, e.allowed))?)
}

fn shaking(args: &SimulateArgs) -> Result<Shaking> {
    let tail_s = number("--tail", args.tail, args.tail >= 0.0, "a finite number of seconds, 0 or more")?;
    let any = "a finite number";
    let scale = number("--scale", args.scale, true, any)?;
    let vertical_scale = number("--vertical-scale", args.vertical_scale, true, any)?;
    let options = args.read_options();
    let horizontal = load(args.record.as_deref(), &options, scale)?;
    let vertical = load(args.vertical.as_deref(), &options, vertical_scale)?;
    if let (Some(h), Some(v), Some(path)) = (&horizontal, &vertical, &args.vertical)
        && h.step_s() != v.step_s()
    {
        let allowed = format!("the step of the horizontal record, {} s", h.step_s());
        return Err(InputError::file(path, format!("a step of {} s", v.step_s()), allowed).into());
    }
    Ok(Shaking { horizontal, vertical, tail_s })
}

fn load(path: Option<&Path>, options: &ReadOptions, scale: f64) -> Result<Option<Accelerogram>> {
    let Some(path) = path else { return Ok(None) };
    let accelerogram = read(path, options)?.accelerogram.scaled(scale);
    if let Some(question) = question_of_peak(accelerogram.peak_m_s2()) {
        eprintln!("mrbd: note: {}: {question}", path.display());
    }
    Ok(Some(accelerogram))
}

/// Peak ground accelerations above are questioned, m/s²: the largest on record is near 4 g (Aoi and others 2008, Science 322).
const MOST_PEAK_M_S2: f64 = 50.0;

/// What to ask of a peak ground acceleration that no earthquake has had.
fn question_of_peak(peak_m_s2: f64) -> Option<String> {
    (peak_m_s2 > MOST_PEAK_M_S2).then(|| {
        format!("a peak of {peak_m_s2} m/s2; the largest on record is near 40 m/s2; is the record in cm/s2?")
    })
}

fn accuracy(tolerance: f64) -> Result<Accuracy> {
    let holds = Accuracy::TOLERANCES.contains(&tolerance);
    Ok(Accuracy { tolerance: number("--tolerance", tolerance, holds, Accuracy::ALLOWED)? })
}

fn number(option: &str, value: f64, holds: bool, allowed: &str) -> Result<f64, InputError> {
    if value.is_finite() && holds {
        Ok(value)
    } else {
        Err(InputError::option(option, value.to_string(), allowed))
    }
}

/// A wall at rest without a record would stay there: more likely a forgotten option than a question.
fn check_moves(wall: &Wall, args: &SimulateArgs) -> Result<()> {
    if args.record.is_none() && wall.parameters().initial_rotation_rad == [0.0, 0.0] {
        let allowed = "--record FILE, or rotations to be released from in [initial] of the wall file";
        return Err(InputError::option("--record", "no record and a wall at rest", allowed).into());
    }
    if args.record.is_none() && args.scale != 1.0 {
        eprintln!("mrbd: note: no record, so --scale has nothing to act on");
    }
    Ok(())
}

/// Time between rows of the history: the record's, or for a free release what was asked for.
fn history_step_s(args: &SimulateArgs, shaking: &Shaking) -> Result<f64> {
    let asked_s = args.dt.unwrap_or(mrbd_kernel::simulate::FREE_RELEASE_STEP_S);
    let asked_s = number("--dt", asked_s, asked_s > 0.0, "a finite number of seconds above 0")?;
    Ok(shaking.horizontal.as_ref().map_or(asked_s, Accelerogram::step_s))
}
