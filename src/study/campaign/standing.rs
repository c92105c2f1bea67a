//! What of a study is on the disk, whole, and what is damaged.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::layout::{Block, Layout};
use crate::error::Result;
use crate::study::runs::OutputFolder;

/// What is done. Everything counted here was read and agrees with its checksum.
#[derive(Debug, Default)]
pub struct Standing {
    /// Files of blocks, by position among the blocks of the plan; only of records not yet put together.
    pub blocks: BTreeMap<u64, PathBuf>,
    /// Files of records that were put together, by position in the suite.
    pub parts: BTreeMap<usize, PathBuf>,
    /// Files that are not what was written; they count as missing.
    pub damaged: Vec<PathBuf>,
}

impl Standing {
    /// Reads and checks every file of a study.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the folder cannot be read.
    pub fn of(folder: &OutputFolder, layout: &Layout) -> Result<Self> {
        let mut standing = Self::default();
        for (index, record) in layout.records().iter().enumerate() {
            match folder.part(record)? {
                Some(part) if part.is_whole()? => {
                    standing.parts.insert(index, part.path);
                    continue;
                }
                Some(part) => standing.damaged.push(part.path),
                None => {}
            }
            for (block, file) in folder.blocks(record)? {
                match layout.of_record(index).contains(&block) && file.is_whole()? {
                    true => _ = standing.blocks.insert(block, file.path),
                    false => standing.damaged.push(file.path),
                }
            }
        }
        Ok(standing)
    }

    /// Whether the runs of a block are stored.
    pub fn has(&self, block: &Block) -> bool {
        self.parts.contains_key(&block.record) || self.blocks.contains_key(&block.index)
    }

    /// Runs that are stored.
    pub fn runs(&self, layout: &Layout) -> u64 {
        layout.iter().filter(|block| self.has(block)).map(|block| block.runs.end - block.runs.start).sum()
    }

    /// The files that hold the runs, in the order of the plan.
    pub fn files(&self) -> Vec<PathBuf> {
        self.parts.values().chain(self.blocks.values()).cloned().collect()
    }
}
