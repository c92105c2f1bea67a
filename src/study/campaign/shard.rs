//! Which part of a divided study a process has to do.

use std::str::FromStr;

use crate::error::{InputError, Result};

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
