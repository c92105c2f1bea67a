//! Running `mrbd calibrate` on twins, and scoring what it said.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use rayon::prelude::*;

use super::twins::draw::{self, Twin};
use super::twins::row::{self, Row};
use super::twins::{folder, targets};
use super::{Options, cases, diagnose, progress};

/// Makes the twins asked for, calibrates those that have not been, and prints the score of all.
///
/// # Errors
/// Text for people: what cannot be read, made or written.
pub fn go(options: &Options) -> Result<(), String> {
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("outputs/blind").join(&options.set));
    let asked = options.first..options.first + options.cases;
    let recorded = options.recorded.as_ref().map(|path| row::load(path, &options.set)).transpose()?;
    let recorded = recorded.unwrap_or_default().into_iter().filter(|row| asked.contains(&row.number));
    let recorded = recorded.collect::<Vec<_>>();
    let new = asked.filter(|number| recorded.iter().all(|row| row.number != *number));
    let twins = new.map(|number| draw::draw(&options.set, number)).collect::<Vec<_>>();
    let folder = |twin: &Twin| out.join(format!("twin_{:04}", twin.number));
    if !options.score_only {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.jobs).build();
        let pool = pool.map_err(|e| e.to_string())?;
        let motions = cases::tests::motions(&options.set).map_err(|e| e.to_string())?;
        eprintln!("{} twins of the set {} in {}", twins.len(), options.set, out.display());
        let bar = progress(twins.len());
        let one = |twin: &Twin| {
            let done = make_and_calibrate(twin, &motions, &folder(twin), options);
            bar.inc(1);
            done.map_err(|e| format!("twin {}: {e}", twin.number))
        };
        // In the order of their numbers: a run that is stopped leaves the beginning of the set.
        let done: Vec<Result<(), String>> = pool.install(|| twins.iter().par_bridge().map(one).collect());
        bar.finish();
        done.into_iter().filter_map(Result::err).for_each(|e| eprintln!("blind: {e}"));
    }
    if options.make_only {
        return Ok(());
    }
    let rows = twins.iter().filter_map(|twin| Row::of(twin, &folder(twin)).transpose());
    let mut rows = rows.chain(recorded.into_iter().map(Ok)).collect::<Result<Vec<_>, _>>()?;
    rows.sort_by_key(|row| row.number);
    row::save(&out.join("twins.jsonl"), &rows)?;
    println!("{}", targets::table(&rows));
    Ok(())
}

fn make_and_calibrate(
    twin: &Twin,
    motions: &[Vec<f64>],
    folder: &Path,
    options: &Options,
) -> Result<(), String> {
    // The truth is written last: with it a twin is whole.
    if !folder.join("truth.json").is_file() {
        folder::write(twin, motions, folder)?;
    }
    if options.make_only || folder.join("seconds").is_file() {
        return Ok(());
    }
    let told = |e: std::io::Error| format!("{}: {e}", folder.display());
    let blind = tempfile::tempdir().map_err(told)?;
    diagnose::copy_experiment(folder, blind.path()).map_err(told)?;
    copy_records(folder, blind.path()).map_err(told)?;
    let start = Instant::now();
    let run = Command::new(&options.mrbd)
        .arg("calibrate")
        .arg(blind.path().join("experiment.toml"))
        .arg("--out")
        .arg(blind.path().join("calibration"))
        // Twins are calibrated side by side.
        .args(["--threads", "1", "--seed", &twin.number.to_string()])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .output()
        .map_err(|e| format!("{}: {e}", options.mrbd.display()))?;
    if !run.status.success() {
        return Err(String::from_utf8_lossy(&run.stderr).into_owned());
    }
    // Every simulation is kept there too, hundreds of megabytes over a set.
    let result = blind.path().join("calibration/calibration.json");
    std::fs::copy(result, folder.join("calibration.json")).map_err(told)?;
    std::fs::write(folder.join("seconds"), format!("{:.1}\n", start.elapsed().as_secs_f64())).map_err(told)
}

/// The starter's records and tests lie in folders of their own.
fn copy_records(from: &Path, to: &Path) -> std::io::Result<()> {
    for name in ["records", "tests"] {
        let Ok(entries) = std::fs::read_dir(from.join(name)) else { continue };
        std::fs::create_dir_all(to.join(name))?;
        for entry in entries {
            let entry = entry?;
            std::fs::copy(entry.path(), to.join(name).join(entry.file_name()))?;
        }
    }
    Ok(())
}
