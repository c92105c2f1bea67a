//! `mrbd merge`: the parts of a divided study put together.

use std::path::PathBuf;

use clap::Args;

use crate::error::Result;
use crate::study::campaign::{Layout, Standing, compact};
use crate::study::runs::OutputFolder;

/// Put the parts of a study that was run with --shard together; the same files as of an undivided study come out.
#[derive(Debug, Args)]
pub struct MergeCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
}

impl MergeCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors for a folder without a study, with runs missing or with a process at work in it;
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        merge_and_print(&OutputFolder::take(&self.folder)?)
    }
}

/// Puts the blocks of a study together and prints its medians and what they decide.
///
/// # Errors
/// As [`MergeCommand::execute`].
pub(super) fn merge_and_print(folder: &OutputFolder) -> Result<()> {
    let standing = Standing::of(folder, &Layout::of(folder.manifest()))?;
    compact(folder, &standing)?;
    super::aggregate::aggregate_and_print(folder.path())
}
