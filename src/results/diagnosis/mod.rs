//! The output folder of a diagnosis: written from what [`mrbd_lab::diagnose::diagnose`] returns, with nothing computed.
//!
//! ```text
//! manifest.json        `kind`: `diagnosis`; program, files that were read; written first
//! *.parquet            what the figures show, see [`tables`]
//! wall.updated.toml    the wall with the effect added, for every other command
//! unfinished.csv       of a diagnosis that was stopped: the hypotheses fitted until then, and no verdict
//! diagnosis.json       the verdict, with everything it rests on; written last: where it is, all is there
//! ```

pub mod tables;
mod unfinished;

use std::path::{Path, PathBuf};

use super::folder::{MANIFEST, Manifest, entries, holds, refuse, remove_all};
use crate::error::{Error, Result};
use crate::store::{now_unix_s, write_durably};
use mrbd_files::FileNote;
use mrbd_lab::diagnose::Diagnosis;
pub use mrbd_lab::diagnose::answer::KIND;
use mrbd_lab::diagnose::answer::Summary;
use tables::TABLES;
pub use unfinished::{UNFINISHED, write_unfinished};

/// Writes a diagnosis and the files it was made from; every file is whole or absent.
///
/// # Errors
/// [`Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub fn write_results(names: &OutputNames, inputs: &[FileNote], diagnosis: &Diagnosis) -> Result<()> {
    names.clear()?;
    Manifest::new(KIND, inputs.to_vec(), names.started_unix_s).write(&names.folder)?;
    tables::write_tables(&names.folder, &diagnosis.tables)?;
    write_durably(&names.wall, diagnosis.updated_wall_toml.as_bytes())?;
    write_durably(&names.diagnosis, json(&names.diagnosis, &diagnosis.summary)?.as_bytes())
}

/// The text of `diagnosis.json`, keys in the order of the alphabet.
fn json(path: &Path, summary: &Summary) -> Result<String> {
    let value = serde_json::to_value(summary).map_err(|e| Error::table(path, e))?;
    serde_json::to_string_pretty(&value).map_err(|e| Error::table(path, e))
}

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
        let entries = entries(folder)?;
        let names = Self {
            folder: folder.to_path_buf(),
            manifest: folder.join(MANIFEST),
            diagnosis: folder.join("diagnosis.json"),
            wall: folder.join("wall.updated.toml"),
            started_unix_s: now_unix_s(),
        };
        let stopped = entries.contains(&folder.join(UNFINISHED));
        let earlier = entries.contains(&names.diagnosis) || holds(folder, KIND) || stopped;
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
        let page = self.folder.join(crate::store::PAGE_NAME);
        remove_all(own.chain([&page, &self.folder.join(UNFINISHED)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_lab::diagnose::Verdict;
    use serde_json::{Value, json};

    /// Every key that scripts of users read, with friction that sets in softly, a class and its next tests.
    fn written() -> Value {
        json!({
            "kind": "diagnosis",
            "verdict": "class",
            "place": "top",
            "effects": [
                {"kind": "coulomb_friction", "name": "coulomb_friction", "place": "top", "parameters": {"force_n": 250.0},
                 "interval": {"force_n": [240.0, 260.0]}, "written_as": "yielding_spring", "sets_in_over_m": 2e-4},
                {"kind": null, "place": "ground", "parameters": {}, "interval": {}},
            ],
            "equivalent": ["coulomb_friction", "viscous_damping"],
            "wall": [{"key": "wall.mass_kg", "unit": "kg", "before": 3614.0, "prior_sd": 36.0, "after": 3604.0, "sd": null}],
            "tests": [{"name": "test 1", "use": "hold-out", "windowed_error": {"before": 4.8, "after": null},
                       "wme": {"before": null, "after": 0.9}, "noise_floor": 1.0, "noise_rad": [3e-5, 2e-5], "read_gain": [1.0, 1.04]}],
            "other_law": {"looks_like": ["gap"], "curve_left": null, "trend_with_amplitude": {"nats": 3.0, "share": 0.01}},
            "windowed_error": {"before": 4.1, "recalibrated": 4.0, "after": 1.0},
            "against": {"before": 2115.0, "recalibrated": 2102.0, "after": 261.0},
            "windows": {"fit": 36, "held_out": 26, "opened": 1},
            "could_hide": [{"kind": "joint_damping", "name": "joint_damping.crack", "parameter": "coefficient_n_m_s_per_rad",
                            "unit": "N m s/rad", "estimate": 1.0, "sd": 5.0, "smallest_detectable": 18.0, "named_from": 88.0,
                            "matters": 17701.0}],
            "confused": [{"effect": "carriage_mass", "imitated_by": "diaphragm.mass_kg", "share": 0.96, "parameter": "mass_kg",
                          "unit": "kg", "told_from_nothing": 3.0, "told_apart": 20.0, "matters": 500.0, "told_by": "a balance"}],
            "rivals": [{"name": "gap + record_gain", "kinds": ["gap", "record_gain"], "place": "top",
                        "parameters": [{"key": "half_width_m", "unit": "m", "value": 0.001, "sd": 1e-4}],
                        "windowed_error": {"fit": 1.0, "held_out": null}, "against": {"fit": 119.0, "held_out": 144.0, "all": 263.0},
                        "wme": {"fit": 0.9, "held_out": null}, "wme_range": {"fit": [0.8, 1.0], "held_out": null}}],
            "missing_force": {"points": 108, "before": {"rms_n": 88.0, "noise_rms_n": 38.0}, "after": {"rms_n": 39.0, "noise_rms_n": 38.0},
                              "median_share_off_top": null, "explained_by": {"displacement_m": -0.3, "velocity_m_s": 0.9,
                              "acceleration_m_s2": null}, "points_with_direction": 0, "arms_of_top_m": [2.191, 1.793]},
            "next_tests": {"rivals": ["coulomb_friction", "viscous_damping"],
                           "shaking": [{"test": "test 1", "scale": 1.5, "outcome": "stood", "error": 1.2, "nats": 40.0, "fitted": true}],
                           "pull": [{"displacement_m": 0.01, "force_n": [370.0, 120.0]}]},
            "program": "mrbd 0.1.0",
            "experiment": "experiment.toml",
        })
    }

    #[test]
    fn regress_the_keys_of_a_diagnosis_are_read_and_written_alike() {
        let summary: Summary = serde_json::from_value(written()).expect("a diagnosis");
        let text = json(Path::new("diagnosis.json"), &summary).expect("JSON");
        assert_eq!(serde_json::from_str::<Value>(&text).expect("JSON"), written());
    }

    #[test]
    fn rejects_a_diagnosis_without_one_of_its_keys() {
        for key in written().as_object().expect("an object").keys() {
            // What may be null may be absent.
            if ["place", "other_law", "next_tests"].contains(&key.as_str()) {
                continue;
            }
            let mut less = written();
            less.as_object_mut().expect("an object").remove(key);
            let error = serde_json::from_value::<Summary>(less).expect_err(key);
            assert!(error.to_string().contains(key), "{error}");
        }
    }

    #[test]
    fn regress_verdicts_are_written_by_their_names() {
        let all = [
            Verdict::None,
            Verdict::Recalibrated,
            Verdict::Named,
            Verdict::Class,
            Verdict::Formula,
            Verdict::FormulaClass,
            Verdict::Curve,
            Verdict::PlaceOnly,
            Verdict::Unknown,
            Verdict::NoPower,
        ];
        for verdict in all {
            assert_eq!(serde_json::to_value(verdict).expect("JSON"), verdict.name());
        }
    }
}
