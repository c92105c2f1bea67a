//! `mrbd suites`: sweeps under several suites of records side by side.

use std::path::{Path, PathBuf};

use clap::Args;

use super::threads::Threads;
use super::{output, progress};
use crate::error::{Error, InputError, Result};
use crate::sensitivity::suites::{FILES, KIND, Suites, of_folder, print_table, records_drawn, write_csv};
use crate::store::{WholeFolder, now_unix_s, write_durably};
use crate::study::runs::Manifest;
use mrbd_files::FileNote;
use mrbd_lab::Progress;

/// Sweeps under several suites of records side by side: conclusions, how sure they are, how many records decide them.
///
/// Each folder is that of a sweep, whole. stdout has a row a conclusion and a column a suite.
///
/// Examples:
///   mrbd suites outputs/sweep outputs/measured_sweep
///   mrbd suites outputs/suites/emilia7 outputs/suites/p695 --out outputs/suites/page
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct SuitesCommand {
    /// Output folders of `mrbd run`, each of a sweep.
    #[arg(required = true)]
    folders: Vec<PathBuf>,
    /// Write suites.json, suites.csv and a page into a folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the results in that folder.
    #[arg(long, requires = "out")]
    force: bool,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    threads: Threads,
}

impl SuitesCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors for folders without a whole sweep, and for two of one suite; results that cannot be written.
    pub fn execute(self) -> Result<()> {
        let started_unix_s = now_unix_s();
        let folder =
            self.out.as_deref().map(|out| WholeFolder::check(out, &FILES, self.force)).transpose()?;
        let suites = self.threads.pool()?.install(|| self.read())?;
        self.check_names(&suites)?;
        if let Some(folder) = folder {
            self.write(folder.cleared()?, &suites, started_unix_s)?;
        }
        if self.json {
            return output::print(&as_json(&suites, Path::new("stdout"))?);
        }
        output::to_stdout(|out| print_table(out, &suites).map_err(output::failed))
    }

    fn read(&self) -> Result<Suites> {
        let bar = progress::Bar::of_steps();
        let read = |folder: &PathBuf| {
            let manifest = Manifest::read(&folder.join("manifest.json"))?;
            let records = manifest.map_or(0, |manifest| manifest.suite.records.len());
            bar.begin(&format!("draws of {}", folder.display()), records_drawn(records).len());
            of_folder(folder, || bar.advance(1))
        };
        Ok(Suites { suites: self.folders.iter().map(read).collect::<Result<_>>()? })
    }

    fn check_names(&self, suites: &Suites) -> Result<(), InputError> {
        let names: Vec<&str> = suites.suites.iter().map(|of| of.suite.as_str()).collect();
        match (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
            None => Ok(()),
            Some(twice) => {
                let found = format!("suite {:?} a second time", names[twice]);
                Err(InputError::file(&self.folders[twice], found, "each suite once"))
            }
        }
    }

    fn write(&self, folder: &Path, suites: &Suites, started_unix_s: u64) -> Result<()> {
        let [manifest_json, suites_json, suites_csv] = FILES.map(|name| folder.join(name));
        let note = |sweep: &PathBuf| {
            FileNote::of("sweep", &sweep.join("manifest.json")).map(|note| note.seen_from(folder))
        };
        let inputs = self.folders.iter().map(note).collect::<Result<Vec<_>, _>>()?;
        let manifest = serde_json::json!({
            "kind": KIND,
            "name": "suites",
            "tool_version": env!("CARGO_PKG_VERSION"),
            "generated": suites.suites.iter().all(|of| of.generated),
            "inputs": inputs,
            "started_unix_s": started_unix_s,
        });
        write_durably(&manifest_json, format!("{manifest:#}\n").as_bytes())?;
        write_durably(&suites_json, as_json(suites, &suites_json)?.as_bytes())?;
        write_csv(&suites_csv, suites)?;
        let page = super::report::write_page(folder, None)?;
        eprintln!("mrbd: {}", page.display());
        Ok(())
    }
}

fn as_json(suites: &Suites, path: &Path) -> Result<String> {
    serde_json::to_string_pretty(suites).map_err(|e| Error::io("write the suites", path, e.into()))
}
