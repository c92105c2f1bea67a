//! `mrbd report`: the page of a folder of results.

use std::path::PathBuf;

use clap::Args;

use crate::error::Result;
use crate::ground::Site;

/// Make one HTML page of a folder of results: figures, conclusions, assumptions, provenance.
///
/// The page is DIR/report.html; it needs no network and nothing but itself, its links lead to the files beside it.
#[derive(Debug, Args)]
pub struct ReportCommand {
    /// Folder of results, for example the output folder of `mrbd run`.
    folder: PathBuf,
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
        let page = crate::report::report(&self.folder, site.as_ref())?;
        super::output::print(&page.display().to_string())
    }
}
