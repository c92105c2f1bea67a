//! Putting the blocks of a record together into its one file.

use super::layout::Layout;
use super::standing::Standing;
use crate::error::{InputError, Result};
use crate::study::runs::OutputFolder;

/// Puts the blocks of every record together; records that are together already stay as they are.
///
/// The blocks go in the order of the plan and by the same steps however they came about, so equal blocks give
/// equal files. Blocks are removed only when the file that holds their runs is on the disk with its checksum.
///
/// # Errors
/// An input error if runs are missing; [`mrbd_files::Error::Io`] or [`crate::Error::Table`] if the disk refuses, which
/// leaves every run in a whole file.
pub fn compact(folder: &OutputFolder, standing: &Standing) -> Result<()> {
    let layout = Layout::of(folder.manifest());
    check_complete(folder, &layout, standing)?;
    for (record, name) in layout.records().iter().enumerate() {
        if !standing.parts.contains_key(&record) {
            let blocks = layout.of_record(record).filter_map(|block| standing.blocks.get(&block));
            folder.write_part(name, blocks)?;
        }
        folder.remove_blocks(name)?;
    }
    folder.remove_leftovers()
}

fn check_complete(folder: &OutputFolder, layout: &Layout, standing: &Standing) -> Result<()> {
    let (done, all) = (standing.runs(layout), folder.manifest().runs);
    if done == all {
        return Ok(());
    }
    let damaged = match standing.damaged.len() {
        0 => String::new(),
        some => format!(" ({some} damaged files)"),
    };
    let found = format!("{done} of {all} runs{damaged}");
    let allowed =
        "all runs: `mrbd run PIPELINE --out DIR --resume` does what is missing, all of it or a --shard";
    Err(InputError::file(folder.path(), found, allowed).into())
}
