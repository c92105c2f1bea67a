//! `mrbd report`: the page of a folder of results.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::error::Result;
use crate::store::{PAGE_NAME, write_durably};
use crate::summary::Summary;
use mrbd_records::Site;

/// Make one HTML page of a folder of results: figures, conclusions, assumptions, provenance.
///
/// For a sweep, drawn façades, a calibration, a diagnosis, a comparison of models, an overturning spectrum, or a history of `mrbd simulate`.
/// The page is DIR/report.html, or FILE.html beside a history; it needs no network and nothing but itself, its links lead to the files beside it.
#[derive(Debug, Args)]
pub struct ReportCommand {
    /// Output folder of `mrbd run`, `mrbd calibrate` or `mrbd diagnose`, or a history file (.csv, .parquet).
    results: PathBuf,
    /// Site file: the records are held against its code spectrum.
    #[arg(long, value_name = "FILE")]
    site: Option<PathBuf>,
}

impl ReportCommand {
    /// Runs the command; prints where the page is.
    ///
    /// # Errors
    /// An input error for a folder without results or with damaged ones; [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        let site = self.site.as_deref().map(Site::load).transpose()?;
        let page = write_page(&self.results, site.as_ref())?;
        super::output::print(&page.display().to_string())
    }
}

/// Writes the page of the results in a folder, or of a history file; gives where it is.
///
/// Records are held against the code of a site.
///
/// # Errors
/// As [`ReportCommand::execute`].
pub fn write_page(results: &Path, site: Option<&Site>) -> Result<PathBuf> {
    let summary = Summary::of(results, site)?;
    super::aggregate::tell_unfinished(summary.completeness());
    summary.write_tables(results)?;
    let path = if results.is_dir() { results.join(PAGE_NAME) } else { page_beside(results) };
    write_durably(&path, crate::report::html(&summary)?.as_bytes())?;
    Ok(path)
}

/// FILE.html for a history FILE: `run.html` beside `run.parquet` may be the page of `mrbd simulate --plot`.
fn page_beside(history: &Path) -> PathBuf {
    let mut name = history.as_os_str().to_owned();
    name.push(".html");
    PathBuf::from(name)
}
