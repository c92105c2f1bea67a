//! A study that may be divided and stopped, and resumed, and ends in the same bits all the same.
//!
//! The plan is cut into blocks of neighbouring runs. A finished block is a file whose name holds its own checksum, so
//! it is whole or not there. The blocks of a record are put together into its one file, which counts when it holds all.
//! That file depends on the blocks alone: not on threads, shards, interruptions or the order they were finished in.
//! What is on the disk, whole or damaged, says which runs are missing; these are run.

mod at_work;
mod shard;
mod storing;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc;

use super::batch::{Finished, Simulate, Tally};
use super::plan::Plan;
use super::runs::OutputFolder;
use crate::error::{InputError, Result};
use at_work::AtWork;
use indicatif::ProgressBar;
use rayon::ThreadPool;
use rayon::prelude::*;
pub use shard::{Block, Layout, Shard, block_runs};
use storing::Storing;

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
    /// Reads and checks every file of a study, on the threads of the pool that this is called in.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the folder cannot be read.
    pub fn of(folder: &OutputFolder, layout: &Layout) -> Result<Self> {
        let records: Vec<(usize, &String)> = layout.records().iter().enumerate().collect();
        let of_record = |(index, name): (usize, &String)| Self::of_record(folder, layout, index, name);
        let each: Vec<Self> = records.into_par_iter().map(of_record).collect::<Result<_>>()?;
        Ok(each.into_iter().fold(Self::default(), |mut all, mut one| {
            all.blocks.append(&mut one.blocks);
            all.parts.append(&mut one.parts);
            all.damaged.append(&mut one.damaged);
            all
        }))
    }

    fn of_record(folder: &OutputFolder, layout: &Layout, index: usize, name: &str) -> Result<Self> {
        let mut standing = Self::default();
        match folder.part(name)? {
            Some(part) if part.is_whole()? => {
                standing.parts.insert(index, part.path);
                return Ok(standing);
            }
            Some(part) => standing.damaged.push(part.path),
            None => {}
        }
        for (block, file) in folder.blocks(name)? {
            match layout.of_record(index).contains(&block) && file.is_whole()? {
                true => _ = standing.blocks.insert(block, file.path),
                false => standing.damaged.push(file.path),
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

/// Blocks that may wait to be stored, for each thread: threads end several at once, and a disk takes its time over one.
const WAITING_PER_THREAD: usize = 4;

/// Runs that are put together at once, of one record or of several: a file keeps its runs in memory until a group of rows is full.
const WRITTEN_AT_ONCE: u64 = 50_000;

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
    let put_together = |(record, name): (usize, &String)| {
        if standing.parts.contains_key(&record) {
            return folder.remove_blocks(name);
        }
        let blocks = layout.of_record(record).filter_map(|block| standing.blocks.get(&block));
        put_together(folder, name, blocks)
    };
    let records: Vec<(usize, &String)> = layout.records().iter().enumerate().collect();
    for some in records.chunks(side_by_side(&layout)) {
        some.par_iter().copied().try_for_each(put_together)?;
    }
    folder.remove_leftovers()
}

/// Records that are put together side by side.
fn side_by_side(layout: &Layout) -> usize {
    (WRITTEN_AT_ONCE / layout.runs_per_record().max(1)).max(1) as usize
}

/// Puts the blocks of a record together.
fn put_together<'a>(
    folder: &OutputFolder,
    record: &str,
    blocks: impl Iterator<Item = &'a PathBuf>,
) -> Result<()> {
    let part = folder.write_part(record, blocks)?;
    keep(folder, record, part)
}

/// Keeps the file of a record, by its checksum, then removes its blocks.
fn keep(folder: &OutputFolder, record: &str, sha256: String) -> Result<()> {
    folder.keep_part(record, sha256)?;
    folder.remove_blocks(record)
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

/// A part of a study to be done.
pub struct Work<'a, S> {
    /// The whole study.
    pub plan: &'a Plan,
    /// Where its runs go.
    pub folder: &'a OutputFolder,
    /// The part to do.
    pub shard: Shard,
    /// Threads to do it on; the result does not depend on them.
    pub pool: &'a ThreadPool,
    /// Runs one wall; a parameter so that a study can be tested without the cost.
    pub simulate: &'a S,
    /// Asks to stop when set: blocks at work are finished and stored, no others begun.
    pub stop: &'a AtomicBool,
    /// Advances by one a run.
    pub progress: &'a ProgressBar,
}

/// Runs the blocks of a shard that are missing and stores each as soon as it is done; `watch` sees its runs. Large
/// records of a study that is not divided are put together as their blocks are done.
///
/// Threads take runs across the ends of blocks, and blocks are stored while others run. Being killed loses the blocks that are not
/// whole, and those that wait to be stored.
///
/// # Errors
/// [`mrbd_files::Error::Io`] or [`crate::Error::Table`] if the disk refuses, which leaves what is stored as it is.
pub fn run_missing<S: Simulate + Sync>(
    work: &Work<S>,
    standing: &Standing,
    mut watch: impl FnMut(&[Finished]),
) -> Result<Tally> {
    let layout = Layout::of(work.folder.manifest());
    let missing: Vec<Block> =
        layout.iter().filter(|block| work.shard.has(block.index) && !standing.has(block)).collect();
    discard_damaged(work.folder, &layout, standing)?;
    let (sender, whole) = mpsc::sync_channel(WAITING_PER_THREAD * work.pool.current_num_threads());
    let at_work = &AtWork::new(&missing, work.stop);
    let puts_together = work.shard == Shard::WHOLE && side_by_side(&layout) == 1;
    let mut storing = Storing::new(work.folder, &layout, standing.blocks.clone(), puts_together);
    let mut tally = Tally::default();
    std::thread::scope(|scope| {
        scope.spawn(move || at_work.run(work, sender));
        for (block, runs) in whole {
            watch(&runs);
            storing.store(&block, &runs).inspect_err(|_| at_work.close())?;
            tally.count(&runs);
        }
        Ok(tally)
    })
}

/// A block that is done again takes the name of its damaged file; a record's file has to be told gone.
fn discard_damaged(folder: &OutputFolder, layout: &Layout, standing: &Standing) -> Result<()> {
    for (index, record) in layout.records().iter().enumerate() {
        if !standing.parts.contains_key(&index) && folder.part(record)?.is_some() {
            folder.discard_part(record)?;
        }
    }
    Ok(())
}
