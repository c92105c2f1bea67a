//! Blocks on their way to the disk while others are run, and large records put together as their blocks come.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::keep;
use super::shard::{Block, Layout};
use crate::error::Result;
use crate::study::batch::Finished;
use crate::study::runs::{OutputFolder, Part};

/// Stores blocks.
pub(super) struct Storing<'a> {
    folder: &'a OutputFolder,
    layout: &'a Layout,
    /// Blocks on the disk, by position among the blocks of the plan; only of records not yet put together.
    blocks: BTreeMap<u64, PathBuf>,
    /// Whether records are put together while others run: where no other process stores any, and records are too large to be put
    /// together side by side later.
    puts_together: bool,
    /// The files of records that have begun, by position in the suite, each with the block that comes next.
    begun: BTreeMap<usize, (Part, u64)>,
}

impl<'a> Storing<'a> {
    pub fn new(
        folder: &'a OutputFolder,
        layout: &'a Layout,
        blocks: BTreeMap<u64, PathBuf>,
        puts_together: bool,
    ) -> Self {
        Self { folder, layout, blocks, puts_together, begun: BTreeMap::new() }
    }

    /// Stores the runs of a block, and adds what follows now to the file of its record. That one counts once it holds all of them:
    /// whatever happens before, the blocks are there.
    pub fn store(&mut self, block: &Block, runs: &[Finished]) -> Result<()> {
        let name = &self.layout.records()[block.record];
        let (file, rows) = self.folder.write_block(name, block.index, runs)?;
        self.blocks.insert(block.index, file);
        let of_record = self.layout.of_record(block.record);
        if !self.puts_together || !self.blocks.contains_key(&of_record.start) {
            return Ok(());
        }
        let (mut part, mut next) = match self.begun.remove(&block.record) {
            Some(begun) => begun,
            None => (self.folder.begin_part(name)?, of_record.start),
        };
        while next < of_record.end
            && let Some(file) = self.blocks.get(&next)
        {
            match next == block.index {
                true => part.add(&rows)?,
                false => part.add_file(file)?,
            }
            next += 1;
        }
        if next < of_record.end {
            self.begun.insert(block.record, (part, next));
            return Ok(());
        }
        keep(self.folder, name, self.folder.finish_part(name, part)?)
    }
}
