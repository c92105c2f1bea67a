//! Files to begin with: a wall, a study and an experiment that run as they are, with comments on every number.
//!
//! Ground motions are the shipped generated suite; the "measured" tests of the experiment are simulated here with the
//! coefficients of the wall and made noisy, and say so.

mod facade;
mod made_up;

use std::path::{Path, PathBuf};

use crate::error::{Error, InputError, Result};
use crate::store::write_durably;

pub use facade::Floor;

/// A file and what stands in it.
type StarterFile = (&'static str, &'static str);

const WALL: StarterFile = ("wall.toml", include_str!("wall.toml"));
const EXPERIMENT: StarterFile = ("experiment.toml", include_str!("experiment.toml"));

macro_rules! record {
    ($name:literal) => {
        (concat!("records/", $name), include_str!(concat!("../../../inputs/records/emilia7/", $name)))
    };
}

/// Name of the façade with a floor.
const FACADE: &str = "facade.toml";

const FILES: [StarterFile; 13] = [
    WALL,
    ("pipeline.toml", include_str!("pipeline.toml")),
    EXPERIMENT,
    ("survey.toml", include_str!("../../../inputs/survey.toml")),
    ("coefficients.toml", include_str!("../../../inputs/coefficients.toml")),
    record!("suite.toml"),
    record!("generated_1_879xa.csv"),
    record!("generated_2_879ya.csv"),
    record!("generated_3_602ya.csv"),
    record!("generated_4_600ya.csv"),
    record!("generated_5_335ya.csv"),
    record!("generated_6_170xa.csv"),
    record!("generated_7_151ya.csv"),
];

/// Writes the files into a folder, which is made where it is not there; gives their paths in order. A floor adds a
/// façade with it.
///
/// # Errors
/// An input error if one of the files is there already, before anything is written; [`mrbd_files::Error::Io`] if the disk refuses.
pub fn write_starter(folder: &Path, floor: Option<Floor>) -> Result<Vec<PathBuf>> {
    let made_up = made_up::tests()?;
    let facade = floor.map(|floor| (FACADE.to_owned(), floor.wall_file()));
    let files =
        FILES.iter().map(|&(name, text)| (name.to_owned(), text.to_owned())).chain(made_up).chain(facade);
    let files: Vec<(PathBuf, String)> = files.map(|(name, text)| (folder.join(name), text)).collect();
    if let Some((there, _)) = files.iter().find(|(path, _)| path.exists()) {
        let allowed = "a folder without it: nothing is written over";
        return Err(InputError::file(there, "a file that is there already", allowed).into());
    }
    for inner in ["records", "tests"] {
        let inner = folder.join(inner);
        std::fs::create_dir_all(&inner).map_err(|e| Error::io("make the folder", &inner, e))?;
    }
    for (path, text) in &files {
        write_durably(path, text.as_bytes())?;
    }
    Ok(files.into_iter().map(|(path, _)| path).collect())
}
