//! `mrbd simulate`: one wall under one record.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Map, Value, json};

use super::output;
use super::table_args::TableArgs;
use crate::error::{Error, InputError, Result};
use crate::report::{PlotFile, RunPicture, Watch};
use crate::store::write_history;
use mrbd_files::load_wall;
use mrbd_kernel::model::{PATTERN_NAMES, Wall};
use mrbd_kernel::simulate::{Accuracy, Outcome, Response, Shaking, simulate_observed};
use mrbd_records::{Accelerogram, ReadOptions, read};

/// Simulate one wall under one record, or its free release.
///
/// Without --record the wall is released from the rotations of [initial] and
/// moves freely for --tail seconds.
///
/// Examples:
///   mrbd simulate inputs/walls/table_wall.toml --record gilroy.AT2
///   mrbd simulate wall.toml --record east.csv --scale 1.2 --vertical up.csv --json
///   mrbd simulate wall.toml --record record.txt --dt 0.005 --history run.parquet
///   mrbd simulate wall.toml --record logger.csv --columns Time,Acc --unit g --decimal-comma
///   mrbd simulate wall.toml --record record.AT2 --plot run.html
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
    /// Free motion after the record.
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0)]
    tail: f64,
    /// Error allowed in rotations relative to α_i, over a well-conditioned run; 1e-12 to 1e-2.
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
}

/// Runs the command.
///
/// # Errors
/// Bad input; a result that cannot be written; a run that could not be finished.
pub fn execute(args: &SimulateArgs) -> Result<()> {
    let wall = wall(args)?;
    let shaking = shaking(args)?;
    let accuracy = accuracy(args.tolerance)?;
    check_moves(&wall, args)?;
    super::describe::print_questions(&args.wall, &wall);
    let read = [Some(&args.wall), args.record.as_ref(), args.vertical.as_ref()];
    let read = read.into_iter().flatten().map(PathBuf::as_path).collect::<Vec<_>>();
    output::check_apart("--history", args.history.as_deref(), &read)?;
    output::check_apart("--plot", args.plot.as_deref(), &read)?;
    let history = args.history.as_deref().map(write_history).transpose()?;
    let plot = args.plot.as_deref().map(PlotFile::new).transpose()?;
    let mut watch = Watch::new(history_step_s(args, &shaking)?);
    let response = if history.is_some() || plot.is_some() {
        simulate_observed(&wall, &shaking, accuracy, &mut watch)
    } else {
        mrbd_kernel::simulate::simulate(&wall, &shaking, accuracy)
    };
    if let Some(writer) = history {
        writer.finish(&watch.history, &wall.reading())?;
    }
    if let Some(plot) = plot {
        let record_name = args.record.as_deref().map(|path| record_name(path, args.scale));
        plot.write(&RunPicture {
            wall: &wall,
            wall_name: &file_name(&args.wall),
            shaking: &shaking,
            record_name: record_name.as_deref(),
            accuracy,
            watch: &watch,
            response: &response,
        })?;
    }
    output::print(&if args.json {
        format!("{:#}", as_json(&wall, &response))
    } else {
        summary(&wall, &response)
    })?;
    match response.outcome {
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
    let options = ReadOptions { step_s: args.dt, ..args.table.options() };
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
    let record = read(path, options)?;
    Ok(Some(record.accelerogram.scaled(scale)))
}

fn accuracy(tolerance: f64) -> Result<Accuracy> {
    // Below 1e-12 the roundings of a step would be larger than the error it may make.
    let holds = (1e-12..=1e-2).contains(&tolerance);
    Ok(Accuracy { tolerance: number("--tolerance", tolerance, holds, "1e-12 to 1e-2")? })
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

/// The results under the names that scripts rely on.
pub(super) fn as_json(wall: &Wall, response: &Response) -> Value {
    let [theta1, theta2] = response.theta_max_rad;
    let [over_alpha1, over_alpha2] = response.theta_max_over_alpha_i();
    let collapse_time_s = match response.outcome {
        Outcome::Collapsed { time_s } => Some(time_s),
        _ => None,
    };
    let pattern_time_s: Map<String, Value> = PATTERN_NAMES
        .iter()
        .zip(response.pattern_time_s)
        .map(|(name, s)| ((*name).to_owned(), s.into()))
        .collect();
    let mut results = json!({
        "theta1_max_rad": theta1.value.abs(),
        "theta2_max_rad": theta2.value.abs(),
        "theta1_max_over_alpha1": over_alpha1,
        "theta2_max_over_alpha2": over_alpha2,
        "theta1_max_time_s": theta1.time_s,
        "theta2_max_time_s": theta2.time_s,
        "top_displacement_max_m": response.top_displacement_m.value.abs(),
        "collapsed": response.collapsed(),
        "collapse_time_s": collapse_time_s,
        "outcome": response.outcome.name(),
        "end_time_s": response.end_time_s,
        "pattern_time_s": pattern_time_s,
        "impacts": response.impacts.total(),
        "impacts_by_coefficient": response.impacts.table2,
        "openings": response.openings.total(),
        "energy_residual": response.energy.residual(),
        "friction_demand_ground": response.demand[0].friction,
        "friction_demand_crack": wall.is_cracked().then_some(response.demand[1].friction),
        "tensions_ground": response.demand[0].tensions,
        "tensions_crack": wall.is_cracked().then_some(response.demand[1].tensions),
        "steps": response.work.steps,
        "evaluations": response.work.evaluations,
        "effects": wall.parameters().effects,
    });
    let reading = wall.reading();
    if !reading.is_true() {
        // The rotations above are the wall's own; only histories are as read.
        results["sensors"] = json!({ "gain": reading.gain, "offset_rad": reading.offset_rad });
    }
    results
}

/// The results for people, a few lines.
pub(super) fn summary(wall: &Wall, response: &Response) -> String {
    let mut lines = vec![match &response.outcome {
        Outcome::Stood => format!("The wall stood until {:.3} s.", response.end_time_s),
        Outcome::Collapsed { time_s } => format!("The wall collapsed at {time_s:.3} s."),
        Outcome::Failed { time_s, reason } => format!("The run failed at {time_s:.3} s: {reason}."),
    }];
    lines.extend(body_lines(wall, response));
    let top = response.top_displacement_m;
    lines.push(format!("top         largest displacement {:+.5} m at {:.3} s", top.value, top.time_s));
    let patterns = PATTERN_NAMES.iter().zip(response.pattern_time_s).filter(|(_, time_s)| *time_s > 0.0);
    let patterns: Vec<String> = patterns.map(|(name, time_s)| format!("{name} {time_s:.3} s")).collect();
    lines.push(format!("patterns    {}", patterns.join(", ")));
    let (impacts, openings) = (response.impacts.total(), response.openings.total());
    lines.push(format!("events      {impacts} impacts, {openings} openings"));
    let joints = if wall.is_cracked() { &["ground", "crack"][..] } else { &["ground"] };
    lines.extend(joints.iter().zip(response.demand).map(|(name, demand)| {
        format!(
            "friction    {:.3} needed at the {name}; in tension there {} times",
            demand.friction, demand.tensions
        )
    }));
    let restitution = wall.parameters().restitution;
    lines.push(format!(
        "assumed     impact law {}, capture velocity {} rad/s; energy residual {:.1e}",
        restitution.law.name(),
        restitution.capture_velocity_rad_s,
        response.energy.residual()
    ));
    let effects = &wall.parameters().effects;
    if !effects.is_empty() {
        let names: Vec<String> = effects.iter().map(|effect| effect.variant().name()).collect();
        lines.push(format!("effects     {}", names.join(", ")));
    }
    if !wall.reading().is_true() {
        lines.push(
            "sensors     rotations here are the wall's own; those of the history are as read".to_owned(),
        );
    }
    lines.join("\n")
}

fn body_lines(wall: &Wall, response: &Response) -> Vec<String> {
    let bodies = if wall.is_cracked() { &["lower body", "upper body"][..] } else { &["wall"] };
    let ratios = response.theta_max_over_alpha_i();
    let line = |(i, name): (usize, &&str)| {
        let peak = response.theta_max_rad[i];
        format!(
            "{name:<12}largest rotation {:+.6} rad at {:.3} s, {:.4} of its α = {:.5} rad",
            peak.value, peak.time_s, ratios[i], response.alpha_i_rad[i]
        )
    };
    bodies.iter().enumerate().map(line).collect()
}
