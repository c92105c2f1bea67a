//! `mrbd variance`: which share of the variance record, façade, coefficients, assumptions and chaos have.

use std::path::{Path, PathBuf};

use clap::Args;

use super::output;
use super::threads::Threads;
use crate::error::{Error, Result};
use crate::sensitivity::variance::{FILES, KIND, Shares, of_folder, print_csv, print_tables, write_table};
use crate::store::{WholeFolder, write_durably};
use mrbd_files::FileNote;

/// Which share of the variance of rotations and collapse each input has: Sobol' indices with intervals.
///
/// The folder is that of a whole study of kind variance. stdout has a table a floor: record, façade, coefficients, assumptions
/// and what no input decides, then their parts.
///
/// Examples:
///   mrbd variance outputs/variance
///   mrbd variance outputs/variance --out outputs/shares --json
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct VarianceCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
    /// Write variance.json, indices.parquet, indices.csv and a page into a folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the results in that folder.
    #[arg(long, requires = "out")]
    force: bool,
    /// Print everything as JSON.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print every index as CSV.
    #[arg(long)]
    csv: bool,
    #[command(flatten)]
    threads: Threads,
}

impl VarianceCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors for a folder without such a study; results that cannot be written.
    pub fn execute(self) -> Result<()> {
        let folder =
            self.out.as_deref().map(|out| WholeFolder::check(out, &FILES, self.force)).transpose()?;
        let shares = self.threads.pool()?.install(|| of_folder(&self.folder))?;
        if let Some(folder) = folder {
            self.write(folder.cleared()?, &shares)?;
        }
        if self.json {
            return output::print(&as_json(&shares, Path::new("stdout"))?);
        }
        output::to_stdout(|out| {
            let printed = if self.csv { print_csv(out, &shares) } else { print_tables(out, &shares) };
            printed.map_err(output::failed)
        })
    }

    fn write(&self, folder: &Path, shares: &Shares) -> Result<()> {
        let [manifest_json, variance_json, indices_parquet, indices_csv] =
            FILES.map(|name| folder.join(name));
        let study = FileNote::of("study", &self.folder.join("manifest.json"))?.seen_from(folder);
        output::write_manifest_of(
            &manifest_json,
            KIND,
            &shares.study,
            vec![study],
            Some((&shares.suite, shares.generated)),
        )?;
        write_durably(&variance_json, as_json(shares, &variance_json)?.as_bytes())?;
        write_table(&indices_parquet, shares)?;
        let mut csv = Vec::new();
        print_csv(&mut csv, shares).map_err(|e| Error::io("write", &indices_csv, e))?;
        write_durably(&indices_csv, &csv)?;
        let page = super::report::write_page(folder, None)?;
        eprintln!("mrbd: {}", page.display());
        Ok(())
    }
}

fn as_json(shares: &Shares, path: &Path) -> Result<String> {
    serde_json::to_string_pretty(shares).map_err(|e| Error::io("write the shares", path, e.into()))
}
