//! `mrbd replay`: one run of a study again, by itself, with its history.

use std::path::{Path, PathBuf};

use clap::Args;

use super::output;
use crate::aggregate::stored_numbers;
use crate::error::{Error, InputError, Result};
use crate::results::RunResults;
use crate::store::{Read, write_history};
use crate::study::batch::{Finished, SideBySide, run_one};
use crate::study::pipeline::Pipeline;
use crate::study::plan::{Plan, Run};
use crate::study::runs::{COLUMNS, Manifest, OutputFolder};
use mrbd_files::file_sha256;
use mrbd_kernel::simulate::{Ensemble, FREE_RELEASE_STEP_S, History, Simulator, Start, following};

/// Results that are compared with what is stored, bit by bit: each depends on the whole run.
const COMPARED: [&str; 4] = ["theta1_max_rad", "theta2_max_rad", "end_time_s", "energy_residual"];

/// Run one run of a study again from the plan in its folder, print it and compare it with what is stored.
///
/// The survey, coefficients and records are looked for where they were, and as far from the folder as they were.
///
/// Examples:
///   mrbd replay outputs/sweep 1234 --history run_1234.csv
///   mrbd replay outputs/sweep 6a5179caaf0f4f2b --json
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct ReplayCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
    /// Position of the run in the plan (column `run`), or its id.
    run: String,
    /// Write the rotations at every sample to a .csv or .parquet file.
    #[arg(long, value_name = "FILE")]
    history: Option<PathBuf>,
    /// Print the results as JSON.
    #[arg(long)]
    json: bool,
}

impl ReplayCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors for a folder without a study, inputs that changed since, or a run the study has not;
    /// [`Error::Differs`] if other bits come out than are stored; [`Error::Run`] if the run fails.
    pub fn execute(self) -> Result<()> {
        let folder = OutputFolder::look(&self.folder)?;
        let plan = plan_of(&folder)?;
        let run = self.find(&plan)?;
        let position = run.position;
        let finished = self.rerun(run)?;
        if let (Ok(wall), Some(response)) = (&finished.run.wall, &finished.response) {
            let alone = Ensemble { run: response.clone(), others: Vec::new() };
            let results = RunResults::new(wall, &finished.run.shaking(), &alone);
            output::print(&if self.json { format!("{:#}", results.json()) } else { results.text() })?;
        }
        match finished.failure {
            Some(reason) => {
                let time_s = finished.response.map_or(0.0, |response| response.end_time_s);
                Err(Error::Run { time_s, reason })
            }
            None => compare(folder.path(), position, &finished),
        }
    }

    fn find(&self, plan: &Plan) -> Result<Run> {
        // An id has 16 digits, more than any position.
        if let (true, Ok(position)) = (self.run.len() < 16, self.run.parse::<u64>())
            && position < plan.len()
        {
            return Ok(plan.run(position));
        }
        if let Some(run) = (0..plan.len()).map(|position| plan.run(position)).find(|run| run.id == self.run) {
            return Ok(run);
        }
        let allowed = format!("a position from 0 to {}, or an id of the study", plan.len() - 1);
        Err(InputError::option("RUN", format!("{:?}", self.run), allowed).into())
    }

    /// The run again, and its history; that of an incremental analysis is the one of the run it ended with.
    fn rerun(&self, run: Run) -> Result<Finished> {
        let planned = run.clone();
        let finished = run_one(run, &SideBySide);
        if let Some(part) = finished.fell_in {
            eprintln!("mrbd: the wall had fallen in part {}; there is nothing to run", part + 1);
            return Ok(finished);
        }
        if let (Some(path), Ok(wall)) = (&self.history, &finished.run.wall) {
            let (run, writer) = (&finished.run, write_history(path)?);
            let shaking = run.shaking();
            let step_s = shaking.horizontal.as_ref().map_or(FREE_RELEASE_STEP_S, |motion| motion.step_s());
            let mut history = History::new(step_s);
            let simulator = Simulator::new(wall, &shaking, run.accuracy());
            let start = start_after(&planned).unwrap_or_else(|| simulator.release());
            simulator.run_from(&start, simulator.end_s(), &mut history);
            writer.finish(&history, &wall.reading())?;
        }
        Ok(finished)
    }
}

/// Where the part before left the wall; none of a run that none goes before.
fn start_after(planned: &Run) -> Option<Start> {
    let before = planned.parts_before().checked_sub(1)?;
    run_one(planned.part_before(before), &SideBySide).usable().and_then(following)
}

/// The plan of a study, from the copy of its pipeline and the inputs that the manifest names.
///
/// # Errors
/// Input errors for inputs that are gone or changed since.
pub(super) fn plan_of(folder: &OutputFolder) -> Result<Plan> {
    let manifest = folder.manifest();
    let path = folder.path().join("plan.toml");
    let text = std::fs::read_to_string(&path)
        .map_err(|e| InputError::file(&path, e.to_string(), "the pipeline of the study"))?;
    let mut pipeline = Pipeline::parse(&path, text)?;
    pipeline.survey = find_input(folder, "survey")?;
    pipeline.coefficients = find_input(folder, "coefficients")?;
    pipeline.suite = find_input(folder, "suite")?;
    let plan = Plan::load(&pipeline, None)?;
    let sha256 = plan.sha256();
    if sha256 == manifest.plan_sha256 {
        return Ok(plan);
    }
    let version = env!("CARGO_PKG_VERSION");
    let (found, allowed) = match changed_records(manifest, &plan) {
        names if names.is_empty() => {
            let allowed = format!("the plan {} of version {}", manifest.plan_sha256, manifest.tool_version);
            (format!("the plan {sha256} by version {version}"), allowed)
        }
        names => {
            (format!("records that changed: {}", names.join(", ")), "the records of the study".to_owned())
        }
    };
    Err(InputError::file(&pipeline.suite, found, allowed).into())
}

/// Names of the records whose samples are not those of the study.
fn changed_records(manifest: &Manifest, plan: &Plan) -> Vec<String> {
    let notes = manifest.suite.records.iter().zip(&plan.motions().hashes);
    let changed =
        notes.filter(|(note, hash)| note.sha256 != hash.horizontal || note.vertical_sha256 != hash.vertical);
    changed.map(|(note, _)| note.name.clone()).collect()
}

/// Where an input lies that is still what the study read: where it was, or as far from the folder as it was.
fn find_input(folder: &OutputFolder, role: &str) -> Result<PathBuf> {
    let Some(note) = folder.manifest().inputs.iter().find(|note| note.role == role) else {
        let found = format!("a manifest without {role}");
        return Err(InputError::option("DIR", found, "one of `mrbd run`").into());
    };
    let beside = note.path_from_folder.as_ref().map(|path| folder.path().join(path));
    let mut faults = Vec::new();
    for path in [Some(PathBuf::from(&note.path)), beside].into_iter().flatten() {
        let fault = match (path.is_file(), file_sha256(&path)) {
            (true, Ok(found)) if found == note.sha256 => return Ok(path),
            (true, Ok(found)) => format!("{} has changed (SHA-256 {found})", path.display()),
            (true, Err(e)) => e.to_string(),
            (false, _) => format!("there is no {}", path.display()),
        };
        faults.push(fault);
    }
    let allowed = format!("in one of these places the {role} that the study read, SHA-256 {}", note.sha256);
    Err(InputError::file(folder.path(), faults.join(" and "), allowed).into())
}

/// Says whether the run gave the bits that are stored; a run that is not stored yet has none.
fn compare(folder: &Path, position: u64, finished: &Finished) -> Result<()> {
    let Some(stored) = stored_numbers(folder, position, COMPARED)? else {
        eprintln!("mrbd: run {position} ({}) is not stored yet", finished.run.id);
        return Ok(());
    };
    for (name, stored) in COMPARED.into_iter().zip(stored) {
        let column = COLUMNS.iter().find(|column| column.name == name);
        let now = column.and_then(|column| match column.read {
            Read::Number(read) => read(finished),
            _ => None,
        });
        if now.map(f64::to_bits) != stored.map(f64::to_bits) {
            return Err(Error::Differs { position, column: name, stored, now });
        }
    }
    eprintln!("mrbd: run {position} ({}): the same bits as stored", finished.run.id);
    Ok(())
}
