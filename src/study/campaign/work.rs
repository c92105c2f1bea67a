//! Running what is missing of a study.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::ScopedJoinHandle;

use indicatif::ProgressBar;
use rayon::ThreadPool;

use super::layout::{Block, Layout};
use super::shard::Shard;
use super::standing::Standing;
use crate::error::Result;
use crate::study::batch::{Finished, Simulate, Tally, run_all};
use crate::study::plan::Plan;
use crate::study::runs::OutputFolder;

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

/// Runs the blocks of a shard that are missing and stores each as soon as it is done; `watch` sees its runs.
///
/// As many blocks as threads are at work at once, so that threads seldom wait for each other, and as many are being stored;
/// being killed loses these alone.
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
    let mut tally = Tally::default();
    let store = |blocks: &[Block], runs: Vec<Finished>| -> Result<()> {
        let mut runs = runs.into_iter();
        for block in blocks {
            let runs: Vec<Finished> =
                runs.by_ref().take((block.runs.end - block.runs.start) as usize).collect();
            work.folder.write_block(&layout.records()[block.record], block.index, &runs)?;
        }
        Ok(())
    };
    std::thread::scope(|scope| -> Result<()> {
        // Blocks are stored while the next ones run.
        let mut storing = None;
        for blocks in missing.chunks(work.pool.current_num_threads()) {
            if work.stop.load(Ordering::Relaxed) {
                break;
            }
            let positions = blocks.iter().flat_map(|block| block.runs.clone()).collect();
            let runs = work.pool.install(|| run_all(work.plan, positions, work.simulate, work.progress));
            watch(&runs);
            finished(storing.take())?;
            tally.count(&runs);
            storing = Some(scope.spawn(|| store(blocks, runs)));
        }
        finished(storing.take())
    })?;
    Ok(tally)
}

/// Waits until blocks are stored.
fn finished(storing: Option<ScopedJoinHandle<'_, Result<()>>>) -> Result<()> {
    match storing.map(ScopedJoinHandle::join) {
        None => Ok(()),
        Some(Ok(stored)) => stored,
        Some(Err(panic)) => std::panic::resume_unwind(panic),
    }
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
