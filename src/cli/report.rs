//! `mrbd report`: the page of a folder of results.

use std::path::PathBuf;

use clap::Args;

use crate::error::Result;
use mrbd_records::Site;

/// Make one HTML page of a folder of results: figures, conclusions, assumptions, provenance.
///
/// For a sweep, drawn façades, a calibration, a comparison of models, an overturning spectrum, or a history of `mrbd simulate`.
/// The page is DIR/report.html, or FILE.html beside a history; it needs no network and nothing but itself, its links lead to the files beside it.
#[derive(Debug, Args)]
pub struct ReportCommand {
    /// Output folder of `mrbd run` or `mrbd calibrate`, or a history file (.csv, .parquet).
    results: PathBuf,
    /// Site file: the records are held against its code spectrum.
    #[arg(long, value_name = "FILE")]
    site: Option<PathBuf>,
}

impl ReportCommand {
    /// Runs the command; prints where the page is.
    ///
    /// # Errors
    /// An input error for a folder without results or with damaged ones; [`crate::Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        let site = self.site.as_deref().map(Site::load).transpose()?;
        let page = crate::report::report(&self.results, site.as_ref())?;
        super::output::print(&page.display().to_string())
    }
}
