//! The output folder of a diagnosis.
//!
//! ```text
//! manifest.json        `kind`: `diagnosis`; program, files that were read; written first
//! *.parquet            what the figures show, see [`super::tables`]
//! wall.updated.toml    the wall with the effect added, for every other command
//! diagnosis.json       the verdict, with everything it rests on; written last: where it is, all is there
//! ```

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use rayon::prelude::*;
use serde_json::{Value, json};

use super::confused::confused;
use super::ensemble::ensemble;
use super::experiment::Experiment;
use super::flow::Diagnosis;
use super::friction::{FRICTION, giving_friction};
use super::hypothesis::Unknown;
use super::interval::intervals;
use super::manifest::write_manifest;
use super::next_tests::next_tests;
use super::score::windowed_error;
use super::search::{Data, Tried};
use super::tables::{TABLES, Tables, kept};
use super::updated_wall::updated_wall;
use super::verdict::{Verdict, against, detectable, joint_error, names};
use super::window_fit::WindowFit;
use super::windows::Window;
use crate::calibrate::Test;
use crate::error::{Error, InputError, Result};
use crate::input::experiment::Purpose;
use crate::model::Wall;
use crate::simulate::Accuracy;
use crate::store::write_durably;

/// Kind of the folder in its manifest and its report.
pub const KIND: &str = "diagnosis";

/// Where things go in the output folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputNames {
    /// The folder.
    pub folder: PathBuf,
    /// Kind and provenance.
    pub manifest: PathBuf,
    /// The verdict.
    pub diagnosis: PathBuf,
    /// The wall with the effect added.
    pub wall: PathBuf,
    /// When the diagnosis began, seconds since 1970.
    started_unix_s: u64,
}

impl OutputNames {
    /// Makes a folder ready: it must be empty, not exist, or hold an earlier diagnosis only.
    ///
    /// # Errors
    /// Input errors for a folder that cannot be written or holds other files.
    pub fn prepare(folder: &Path) -> Result<Self> {
        let refuse = |found: String, allowed: &str| InputError::option("--out", found, allowed);
        std::fs::create_dir_all(folder)
            .map_err(|e| refuse(format!("{}: {e}", folder.display()), "a folder that can be written"))?;
        let names = Self {
            folder: folder.to_path_buf(),
            manifest: folder.join("manifest.json"),
            diagnosis: folder.join("diagnosis.json"),
            wall: folder.join("wall.updated.toml"),
            started_unix_s: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
        };
        let entries = std::fs::read_dir(folder).map_err(|e| Error::io("read", folder, e))?;
        let entries =
            entries.filter_map(std::result::Result::ok).map(|entry| entry.path()).collect::<Vec<_>>();
        let earlier = entries.contains(&names.diagnosis) || is_diagnosis(&names.manifest);
        if !entries.is_empty() && !earlier {
            let found = format!("{}, which holds other files", folder.display());
            return Err(refuse(found, "an empty folder, or one of an earlier diagnosis").into());
        }
        Ok(names)
    }

    /// Removes what an earlier diagnosis left, the verdict first, so that nothing of it is taken for this one's.
    fn clear(&self) -> Result<()> {
        let tables = TABLES.map(|name| self.folder.join(name));
        let own = [&self.diagnosis, &self.wall, &self.manifest].into_iter().chain(&tables);
        let page = self.folder.join(crate::report::PAGE_NAME);
        own.chain([&page]).try_for_each(|path| match std::fs::remove_file(path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                Err(Error::io("remove earlier results", path, e))
            }
            _ => Ok(()),
        })
    }
}

/// Whether a manifest is there and says that its folder holds a diagnosis.
fn is_diagnosis(manifest: &Path) -> bool {
    let text = std::fs::read(manifest).unwrap_or_default();
    serde_json::from_slice::<Value>(&text).is_ok_and(|value| value["kind"] == KIND)
}

/// Writes what a diagnosis found; the files are whole or absent.
///
/// # Errors
/// [`Error::Io`] if the disk refuses; input errors of a wall file that changed meanwhile.
pub fn write_results(names: &OutputNames, experiment: &Experiment, diagnosis: &Diagnosis) -> Result<Value> {
    let mut summary = summary(experiment, diagnosis);
    let no_wall = || InputError::file(&experiment.wall_path, "a diagnosis that is no wall", "a wall");
    let tables = Tables::new(experiment, diagnosis).ok_or_else(no_wall)?;
    summary["missing_force"] = tables.summary();
    summary["next_tests"] = json!(next_tests(experiment, diagnosis));
    let wall = updated_wall(experiment, kept(diagnosis))?;
    names.clear()?;
    write_manifest(&names.manifest, experiment, names.started_unix_s)?;
    tables.write(&names.folder)?;
    write_durably(&names.wall, wall.as_bytes())?;
    let text = serde_json::to_string_pretty(&summary).map_err(|e| Error::table(&names.diagnosis, e))?;
    write_durably(&names.diagnosis, text.as_bytes())?;
    Ok(summary)
}

/// Everything the verdict rests on.
fn summary(experiment: &Experiment, diagnosis: &Diagnosis) -> Value {
    let data = diagnosis.data(experiment);
    let answered = matches!(diagnosis.verdict, Verdict::Named | Verdict::Class);
    let effects = if answered { effects(&data, &diagnosis.after) } else { Vec::new() };
    let unknown = json!({"kind": null, "place": diagnosis.place, "parameters": {}, "interval": {}});
    let effects = if diagnosis.verdict == Verdict::PlaceOnly { vec![unknown] } else { effects };
    let rivals = diagnosis.tried.iter().map(|tried| rival(experiment, &data, tried)).collect::<Vec<_>>();
    json!({
        "kind": KIND,
        "verdict": diagnosis.verdict,
        "place": diagnosis.place.or(answered.then(|| diagnosis.after.hypothesis.additions[0].place())),
        "effects": effects,
        "equivalent": diagnosis.equivalent,
        "wall": numbers(&diagnosis.after, 0..diagnosis.after.hypothesis.nuisances),
        "tests": tests(experiment, diagnosis),
        "other_law": diagnosis.other_law,
        "windowed_error": {
            "before": joint_error(&diagnosis.before),
            "recalibrated": joint_error(&diagnosis.recalibrated),
            "after": joint_error(&diagnosis.after),
        },
        "against": {
            "before": against(&data, &diagnosis.before),
            "recalibrated": against(&data, &diagnosis.recalibrated),
            "after": against(&data, &diagnosis.after),
        },
        "windows": {
            "fit": data.fit.windows.len(),
            "held_out": data.held_out.windows.len(),
            "opened": diagnosis.windows.iter().flatten().filter(|window| window.opened).count(),
        },
        "could_hide": could_hide(diagnosis),
        "confused": confused(&data, &diagnosis.recalibrated, &diagnosis.tried),
        "rivals": rivals,
        "program": concat!("mrbd ", env!("CARGO_PKG_VERSION")),
        "experiment": experiment.path,
    })
}

/// The effects of an answer with their numbers and 90 % intervals.
fn effects(data: &Data, after: &Tried) -> Vec<Value> {
    let h = &after.hypothesis;
    let intervals = intervals(data, after);
    let mut from = h.nuisances;
    let mut all = Vec::new();
    for (index, addition) in h.additions.iter().enumerate() {
        let count = h.unknowns.iter().filter(|u| u.belongs_to(index)).count();
        let range = from..from + count;
        from += count;
        if let Some(friction) = giving_friction(h, &after.fit.values, index) {
            all.push(json!({
                "kind": FRICTION,
                "name": FRICTION,
                "place": addition.place(),
                "parameters": {"force_n": after.fit.values[friction.force]},
                "interval": {"force_n": intervals[friction.force]},
                "written_as": addition.name(),
                "sets_in_over_m": friction.onset_m,
            }));
            continue;
        }
        let of = |f: &dyn Fn(usize) -> Value| {
            range.clone().map(|i| (h.unknowns[i].key.clone(), f(i))).collect::<serde_json::Map<_, _>>()
        };
        all.push(json!({
            "kind": addition.kind(),
            "name": addition.name(),
            "place": addition.place(),
            "parameters": of(&|i| json!(after.fit.values[i])),
            "interval": of(&|i| json!(intervals[i])),
        }));
    }
    all
}

/// Fitted numbers of the wall with their standard deviations, and what they were.
fn numbers(tried: &Tried, range: std::ops::Range<usize>) -> Vec<Value> {
    let h = &tried.hypothesis;
    range
        .map(|i| {
            let Unknown { key, unit, start, prior_sd, .. } = &h.unknowns[i];
            json!({"key": key, "unit": unit, "before": start, "prior_sd": prior_sd,
                   "after": tried.fit.values[i], "sd": sd(tried, i)})
        })
        .collect()
}

fn sd(tried: &Tried, i: usize) -> Option<f64> {
    tried.fit.covariance.as_ref().map(|c| c[(i, i)].max(0.0).sqrt())
}

/// One hypothesis that was tried, with the figures of every other.
fn rival(experiment: &Experiment, data: &Data, tried: &Tried) -> Value {
    let h = &tried.hypothesis;
    let added = h.nuisances..h.unknowns.len();
    let [fit, held_out] = tried.errors();
    let [against_fit, against_held_out] = tried.against(data);
    let walls = ensemble(tried).unwrap_or_default();
    let wme = |purpose| walls.par_iter().map(|wall| mean_wme(experiment, wall, purpose)).collect::<Vec<_>>();
    let [wme_fit, wme_held_out] = [Purpose::Fit, Purpose::HoldOut].map(wme);
    let fitted = |all: &[Option<f64>]| all.first().copied().flatten();
    json!({
        "name": h.additions.iter().map(|a| a.name()).collect::<Vec<_>>().join(" + "),
        "kinds": names(tried),
        "place": h.additions.first().map(|a| a.place()),
        "parameters": added.map(|i| json!({"key": h.unknowns[i].key, "unit": h.unknowns[i].unit,
            "value": tried.fit.values[i], "sd": sd(tried, i)})).collect::<Vec<_>>(),
        "windowed_error": {"fit": fit, "held_out": held_out},
        "against": {"fit": against_fit, "held_out": against_held_out, "all": against(data, tried)},
        "wme": {"fit": fitted(&wme_fit), "held_out": fitted(&wme_held_out)},
        "wme_range": {"fit": range(&wme_fit), "held_out": range(&wme_held_out)},
    })
}

/// Least and largest of the errors of an ensemble; none where there are less than two.
fn range(errors: &[Option<f64>]) -> Option<[f64; 2]> {
    let told = errors.iter().flatten().copied().collect::<Vec<_>>();
    (told.len() > 1).then(|| {
        let most = told.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x));
        [told.iter().fold(f64::INFINITY, |m, x| m.min(*x)), most]
    })
}

/// Mean of Eq. 8 over whole runs of the tests of a purpose; none if a run failed or there is no such test.
fn mean_wme(experiment: &Experiment, wall: &Wall, purpose: Purpose) -> Option<f64> {
    let of = |test: &&Test| test.purpose == purpose;
    let all = experiment.whole.iter().filter(of).map(|t| whole_wme(t, wall)).collect::<Option<Vec<_>>>()?;
    (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
}

fn whole_wme(test: &Test, wall: &Wall) -> Option<f64> {
    test.simulate(wall, Accuracy::default()).wme
}

/// Every test: errors before and after, and the noise.
fn tests(experiment: &Experiment, diagnosis: &Diagnosis) -> Vec<Value> {
    let walls =
        [&diagnosis.before, &diagnosis.after].map(|t| t.hypothesis.physics(&t.fit.values).map(|p| p.wall));
    let one = |(index, test): (usize, &super::test_data::TestData)| {
        let error = |tried: &Tried| test_error(&diagnosis.windows, tried, index);
        let wme = |wall: &Option<Wall>| wall.as_ref().and_then(|w| whole_wme(&experiment.whole[index], w));
        json!({
            "name": test.name,
            "use": test.purpose.name(),
            "windowed_error": {"before": error(&diagnosis.before), "after": error(&diagnosis.after)},
            "wme": {"before": wme(&walls[0]), "after": wme(&walls[1])},
            "noise_floor": 1.0,
            "noise_rad": test.noise_rad,
            "read_gain": test.read_gain,
        })
    };
    experiment.tests.iter().enumerate().map(one).collect()
}

fn test_error(windows: &[Vec<Window>; 2], tried: &Tried, test: usize) -> Option<f64> {
    let both = windows.iter().zip([&tried.fit.windows, &tried.held_out.windows]);
    let own = both.flat_map(|(w, f)| w.iter().zip(f)).filter(|(w, _)| w.test == test);
    windowed_error(&own.map(|(_, fit)| fit.clone()).collect::<Vec<WindowFit>>())
}

/// For each kind, the smallest size that would have been told from nothing, and the size at which it would matter.
fn could_hide(diagnosis: &Diagnosis) -> Vec<Value> {
    let singles = diagnosis.tried.iter().filter(|t| t.hypothesis.additions.len() == 1);
    let row = |tried: &Tried| {
        let (smallest, matters) = detectable(tried)?;
        let h = &tried.hypothesis;
        let unknown = &h.unknowns[h.nuisances];
        let estimate = tried.fit.values[h.nuisances] - unknown.start;
        let sd = sd(tried, h.nuisances)?;
        Some(json!({
            "kind": h.additions[0].kind()?, "name": h.additions[0].name(),
            "parameter": unknown.key, "unit": unknown.unit,
            "estimate": estimate, "sd": sd, "smallest_detectable": smallest, "matters": matters,
        }))
    };
    singles.filter_map(row).collect()
}
