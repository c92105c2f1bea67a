//! How a plan is cut into blocks, and which of them a process of a divided study has to do.
//!
//! The size of a plan alone decides, so that every process cuts it the same way.

use std::ops::Range;
use std::str::FromStr;

use crate::error::{InputError, Result};
use crate::study::runs::Manifest;

/// Runs a block at least and at most, if nothing else is asked for: a twentieth of a second of work of one thread to a second of it, on
/// sharp edges; up to twenty times as much on beds.
const BLOCK_RUNS: [u64; 2] = [512, 8192];

/// Blocks of a record before they grow: enough for a divided study, and few files. With half as many a million runs take 30 MiB more.
const BLOCKS_OF_RECORD: u64 = 64;

/// Runs a block of a study, by those of each record, if nothing else is asked for. A power of two: so a record's file has the same pages
/// whichever it is.
pub fn block_runs(runs_per_record: u64) -> u64 {
    let [least, most] = BLOCK_RUNS;
    1 << (runs_per_record / BLOCKS_OF_RECORD).clamp(least, most).ilog2()
}

/// Neighbouring runs of a plan, all under one record, that are stored at once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// Position among the blocks of the plan, from 0.
    pub index: u64,
    /// Position of the record in the suite, or of the sequence in the study.
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
        let records: Vec<String> = manifest.motions().into_iter().map(str::to_owned).collect();
        let runs_per_record = manifest.runs / (records.len() as u64).max(1);
        Self { records, runs_per_record, block_runs: manifest.block_runs.max(1) }
    }

    /// Names of the records, or of their sequences: what the runs are stored by.
    pub fn records(&self) -> &[String] {
        &self.records
    }

    /// Runs of one record.
    pub fn runs_per_record(&self) -> u64 {
        self.runs_per_record
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

/// Pairs of variables in which schedulers give an index and a count, and the lowest index.
const SCHEDULERS: [Scheduler; 2] = [
    // Slurm's job arrays start where the user says: the script `mrbd slurm` writes starts at 1.
    Scheduler {
        index: "SLURM_ARRAY_TASK_ID",
        count: "SLURM_ARRAY_TASK_COUNT",
        first: "SLURM_ARRAY_TASK_MIN",
    },
    // Kubernetes' indexed jobs count from 0; the job has to pass its `completions` on.
    Scheduler { index: "JOB_COMPLETION_INDEX", count: "JOB_COMPLETIONS", first: "" },
];

struct Scheduler {
    index: &'static str,
    count: &'static str,
    first: &'static str,
}

/// Part `index` of `count`, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    count: u64,
}

impl Shard {
    /// The whole study.
    pub const WHOLE: Shard = Shard { index: 1, count: 1 };

    /// Part `index` of `count`.
    ///
    /// # Errors
    /// An input error unless 1 ≤ `index` ≤ `count`.
    pub fn new(index: u64, count: u64) -> Result<Self> {
        match (1..=count).contains(&index) {
            true => Ok(Self { index, count }),
            false => Err(refused(format!("{index}/{count}")).into()),
        }
    }

    /// Whether a block of the plan is this part's: dealt out in turn, since neighbours cost alike.
    pub fn has(self, block: u64) -> bool {
        block % self.count == self.index - 1
    }

    /// The part a scheduler's variables tell, read by `variable`: Slurm's job arrays, Kubernetes' indexed jobs.
    ///
    /// # Errors
    /// An input error where there are none, or they are no part.
    pub fn of_scheduler(variable: impl Fn(&str) -> Option<String>) -> Result<Self> {
        for scheduler in &SCHEDULERS {
            let Some(index) = variable(scheduler.index) else { continue };
            let count = variable(scheduler.count);
            let first = variable(scheduler.first);
            let read = |text: Option<&str>| text.and_then(|text| text.trim().parse::<u64>().ok());
            let found = format!("{}={index}, {}={}", scheduler.index, scheduler.count, shown(&count));
            let first = read(first.as_deref()).unwrap_or(0);
            let (Some(index), Some(count)) = (read(Some(&index)), read(count.as_deref())) else {
                return Err(refused(found).into());
            };
            return match index.checked_sub(first) {
                Some(offset) => Self::new(offset + 1, count),
                None => Err(refused(found).into()),
            };
        }
        let names = SCHEDULERS.map(|s| format!("{} with {}", s.index, s.count)).join(", or ");
        Err(InputError::option("--shard", "auto, without a scheduler's variables", names).into())
    }
}

fn shown(value: &Option<String>) -> &str {
    value.as_deref().unwrap_or("nothing")
}

fn refused(found: String) -> InputError {
    InputError::option("--shard", found, "I/N with 1 ≤ I ≤ N, such as 3/16, or auto")
}

impl FromStr for Shard {
    type Err = crate::error::Error;

    fn from_str(text: &str) -> Result<Self> {
        let number = |text: &str| text.parse::<u64>().map_err(|_| refused(format!("{text:?}")));
        let (index, count) = text.split_once('/').ok_or_else(|| refused(format!("{text:?}")))?;
        Self::new(number(index)?, number(count)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_blocks_grow_with_a_study() {
        let expected = [(1, 512), (2048, 512), (32_768, 512), (142_858, 2048), (10_000_000, 8192)];
        assert!(expected.iter().all(|(runs, block)| block_runs(*runs) == *block));
    }

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

    fn auto(variables: &[(&str, &str)]) -> Result<Shard> {
        let find = |name: &str| variables.iter().find(|(n, _)| *n == name).map(|(_, v)| (*v).to_owned());
        Shard::of_scheduler(find)
    }

    #[test]
    fn analytic_every_block_has_one_shard() {
        for count in 1..7 {
            for block in 0..40 {
                let owners = (1..=count).filter(|&i| Shard::new(i, count).expect("a shard").has(block));
                assert_eq!(owners.count(), 1);
            }
        }
    }

    #[test]
    fn regress_schedulers_count_from_where_they_like() {
        let slurm = |id, min| {
            auto(&[
                ("SLURM_ARRAY_TASK_ID", id),
                ("SLURM_ARRAY_TASK_COUNT", "4"),
                ("SLURM_ARRAY_TASK_MIN", min),
            ])
        };
        assert_eq!(slurm("4", "1").expect("a shard"), Shard { index: 4, count: 4 });
        assert_eq!(slurm("0", "0").expect("a shard"), Shard { index: 1, count: 4 });
        let kubernetes = auto(&[("JOB_COMPLETION_INDEX", "2"), ("JOB_COMPLETIONS", "3")]);
        assert_eq!(kubernetes.expect("a shard"), Shard { index: 3, count: 3 });
    }

    #[test]
    fn rejects_shards_out_of_range() {
        for text in ["0/4", "5/4", "1/0", "a/4", "3", "-1/4", "1/2/3"] {
            let error = text.parse::<Shard>().expect_err("no shard");
            assert_eq!(error.exit_code(), 2, "{text}");
            assert!(error.to_string().contains("--shard"), "{error}");
        }
        assert!(auto(&[]).expect_err("no scheduler").to_string().contains("SLURM_ARRAY_TASK_ID"));
        let beyond = auto(&[("JOB_COMPLETION_INDEX", "3"), ("JOB_COMPLETIONS", "3")]);
        assert!(beyond.expect_err("out of range").to_string().contains("4/3"));
        let alone = auto(&[("JOB_COMPLETION_INDEX", "3")]).expect_err("no count").to_string();
        assert!(alone.contains("JOB_COMPLETIONS=nothing"), "{alone}");
    }
}
