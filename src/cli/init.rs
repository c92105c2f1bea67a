//! `mrbd init`: files to begin with.

use std::path::{Path, PathBuf};

use clap::Args;

use super::starter::{Floor, write_starter};
use crate::error::Result;

use super::shell::shell_word;

/// Write a wall, a study and an experiment to begin with, commented, that run as they are.
///
/// Nothing is written over. The ground motions are generated and the "measured"
/// tests simulated, as the files say; put your own in their place.
///
/// Examples:
///   mrbd init
///   mrbd init my-street
///   mrbd init my-street --floor parallel
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct InitCommand {
    /// Folder for the files; it is made where it is not there.
    #[arg(default_value = ".", value_name = "DIR")]
    folder: PathBuf,
    /// Write facade.toml too: a façade with such a floor, at the typical values of docs/typical-values.md.
    #[arg(long, value_enum)]
    floor: Option<Floor>,
}

impl InitCommand {
    /// Runs the command; prints the files.
    ///
    /// # Errors
    /// An input error if a file is there already; [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        let files = write_starter(&self.folder, self.floor)?;
        let names: Vec<String> = files.iter().map(|path| path.display().to_string()).collect();
        super::output::print(&names.join("\n"))?;
        eprint!("{}", next_steps(&self.folder));
        Ok(())
    }
}

fn next_steps(folder: &Path) -> String {
    let here = folder == Path::new(".");
    let enter = if here { String::new() } else { format!("  cd {}\n", shell_word(folder)) };
    format!(
        "\nThese run as they are:\n{enter}\
         \x20 mrbd simulate wall.toml --record records/generated_4_600ya.csv --scale 3.05 --plot run.html   # one wall, in motion\n\
         \x20 mrbd run pipeline.toml && mrbd report outputs/first                                          # many walls, and their page\n\
         \x20 mrbd calibrate experiment.toml --out calibrated                                              # a wall from tests\n"
    )
}
