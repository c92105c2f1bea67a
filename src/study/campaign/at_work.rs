//! The blocks at work: threads take their runs as they come free, across the ends of blocks.
//!
//! So no thread waits at the end of a block for the longest run of another. A block leaves when its last run is done.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::SyncSender;
use std::sync::{Mutex, PoisonError};

use super::Work;
use super::shard::Block;
use crate::study::batch::{Finished, Simulate, run_all};
use crate::study::shared::{Share, run_shared};

/// A block whose runs are all done, in the order of the plan.
pub(super) type Whole = (Block, Vec<Finished>);

/// Blocks that are to be run, in the order of the plan, and those whose runs have begun.
pub(super) struct AtWork<'a> {
    blocks: &'a [Block],
    /// Number of the first run of each block among all that are to be run, and of all.
    first: Vec<usize>,
    /// Asks to begin no other block.
    stop: &'a AtomicBool,
    next: AtomicUsize,
    /// Runs from this number on are not begun.
    closed_from: AtomicUsize,
    /// What is done of blocks that have begun, by their number.
    begun: Mutex<BTreeMap<usize, Begun>>,
}

/// A block that has begun.
struct Begun {
    done: Vec<Option<Finished>>,
    left: usize,
}

impl<'a> AtWork<'a> {
    pub fn new(blocks: &'a [Block], stop: &'a AtomicBool) -> Self {
        let mut first = vec![0];
        first.extend(blocks.iter().scan(0, |all, block| {
            *all += length(block);
            Some(*all)
        }));
        let (next, closed_from) = (AtomicUsize::new(0), AtomicUsize::new(usize::MAX));
        Self { blocks, first, stop, next, closed_from, begun: Mutex::default() }
    }

    /// Runs the blocks, and hands each on as it is whole, until all are, a stop is asked for or they are closed.
    pub fn run<S: Simulate + Sync>(&self, work: &Work<S>, whole: SyncSender<Whole>) {
        let share = Shared { blocks: self, whole };
        if work.plan.sequences().len() > 0 {
            return self.run_sequences(work, &share);
        }
        work.pool.install(|| run_shared(work.plan, &share, work.simulate, work.progress));
    }

    /// The parts of a sequence go one after another on one thread: as many blocks as threads at a time.
    fn run_sequences<S: Simulate + Sync>(&self, work: &Work<S>, share: &Shared) {
        for blocks in self.blocks.chunks(work.pool.current_num_threads()) {
            let numbers = blocks.iter().flat_map(|block| block.runs.clone()).map_while(|_| share.next());
            let (numbers, positions): (Vec<usize>, Vec<u64>) = numbers.unzip();
            let runs = work.pool.install(|| run_all(work.plan, positions, work.simulate, work.progress));
            numbers.into_iter().zip(runs).for_each(|(number, finished)| share.done(number, finished));
        }
    }

    /// Begins no more runs.
    pub fn close(&self) {
        self.closed_from.store(0, Ordering::Relaxed);
    }

    /// The run that is next, and its position in the plan. Where a stop is asked for none of a block that has not begun.
    fn next(&self) -> Option<(usize, u64)> {
        let run = self.next.fetch_add(1, Ordering::Relaxed);
        let block = self.block_of(run);
        let runs = &self.blocks.get(block)?.runs;
        let within = run - self.first[block];
        if within == 0 && self.stop.load(Ordering::Relaxed) {
            self.closed_from.fetch_min(run, Ordering::Relaxed);
        }
        (run < self.closed_from.load(Ordering::Relaxed)).then(|| (run, runs.start + within as u64))
    }

    /// Takes what came of a run; gives its block once that is whole.
    fn done(&self, run: usize, finished: Finished) -> Option<Whole> {
        let block = self.block_of(run);
        let of = &self.blocks[block];
        // Nothing is done under the lock that could leave half a run behind.
        let mut all = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        let begun = all.entry(block).or_insert_with(|| Begun::new(length(of)));
        begun.left -= 1;
        begun.done[run - self.first[block]] = Some(finished);
        let is_whole = begun.left == 0;
        let runs = || all.remove(&block).into_iter().flat_map(|begun| begun.done).flatten().collect();
        is_whole.then(runs).map(|runs| (of.clone(), runs))
    }

    /// Number of the block of a run.
    fn block_of(&self, run: usize) -> usize {
        self.first.partition_point(|first| *first <= run) - 1
    }
}

/// Blocks whose runs threads share, and where they go once they are whole.
struct Shared<'a> {
    blocks: &'a AtWork<'a>,
    whole: SyncSender<Whole>,
}

impl Share for Shared<'_> {
    fn next(&self) -> Option<(usize, u64)> {
        self.blocks.next()
    }

    fn done(&self, run: usize, finished: Finished) {
        if let Some(whole) = self.blocks.done(run, finished) {
            // Nobody receives once a block could not be stored.
            _ = self.whole.send(whole);
        }
    }
}

impl Begun {
    fn new(runs: usize) -> Self {
        Self { done: (0..runs).map(|_| None).collect(), left: runs }
    }
}

/// Runs of a block.
fn length(block: &Block) -> usize {
    (block.runs.end - block.runs.start) as usize
}
