//! How a plan is cut into blocks: by its size alone, so that every process cuts it the same way.

use std::ops::Range;

use crate::study::runs::Manifest;

/// Runs a block, if nothing else is asked for: about a second of work of one thread, and few enough files.
pub const BLOCK_RUNS: u64 = 512;

/// Neighbouring runs of a plan, all under one record, that are stored at once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// Position among the blocks of the plan, from 0.
    pub index: u64,
    /// Position of the record in the suite.
    pub record: usize,
    /// Positions of the runs in the plan.
    pub runs: Range<u64>,
}

/// All blocks of a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    records: Vec<String>,
    runs_per_record: u64,
    block_runs: u64,
}

impl Layout {
    /// The blocks of the plan a manifest tells of.
    pub fn of(manifest: &Manifest) -> Self {
        let records: Vec<String> = manifest.suite.records.iter().map(|record| record.name.clone()).collect();
        let runs_per_record = manifest.runs / (records.len() as u64).max(1);
        Self { records, runs_per_record, block_runs: manifest.block_runs.max(1) }
    }

    /// Names of the records.
    pub fn records(&self) -> &[String] {
        &self.records
    }

    /// Blocks of one record.
    pub fn blocks_per_record(&self) -> u64 {
        self.runs_per_record.div_ceil(self.block_runs)
    }

    /// Number of blocks.
    pub fn len(&self) -> u64 {
        self.blocks_per_record() * self.records.len() as u64
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The block at a position below [`Layout::len`].
    pub fn block(&self, index: u64) -> Block {
        let record = index / self.blocks_per_record();
        let first = record * self.runs_per_record + index % self.blocks_per_record() * self.block_runs;
        let end = (first + self.block_runs).min((record + 1) * self.runs_per_record);
        Block { index, record: record as usize, runs: first..end }
    }

    /// All blocks, in the order of the plan.
    pub fn iter(&self) -> impl Iterator<Item = Block> {
        (0..self.len()).map(|index| self.block(index))
    }

    /// The blocks of a record, in the order of the plan.
    pub fn of_record(&self, record: usize) -> Range<u64> {
        let first = record as u64 * self.blocks_per_record();
        first..first + self.blocks_per_record()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_blocks_cover_every_run_once_and_never_two_records() {
        for (runs_per_record, block_runs) in [(36, 5), (36, 36), (36, 100), (1, 1), (1024, 512)] {
            let records = vec!["a".to_owned(), "b".to_owned(), "c".to_owned()];
            let layout = Layout { records, runs_per_record, block_runs };
            let runs: Vec<u64> = layout.iter().flat_map(|block| block.runs).collect();
            assert_eq!(runs, (0..3 * runs_per_record).collect::<Vec<_>>());
            for block in layout.iter() {
                assert_eq!(block.runs.start / runs_per_record, block.record as u64);
                assert_eq!((block.runs.end - 1) / runs_per_record, block.record as u64);
                assert!(layout.of_record(block.record).contains(&block.index));
                assert!(block.runs.end - block.runs.start <= block_runs);
            }
        }
    }
}
