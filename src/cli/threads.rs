//! Threads to run on.

use std::num::NonZero;

use clap::Args;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use crate::error::{InputError, Result};

/// `--threads`.
#[derive(Debug, Args)]
pub struct Threads {
    /// Threads; without it one for each processor. Results do not depend on it.
    #[arg(long = "threads", value_name = "N")]
    count: Option<NonZero<usize>>,
}

/// Threads a processor that may be had: more only wait for each other, and a request to stop waits for all of them.
const MOST_A_PROCESSOR: usize = 4;
/// As many may be had on any machine, so that a command runs alike on a small one.
const FEW: usize = 64;

impl Threads {
    /// The threads.
    ///
    /// # Errors
    /// An input error if they are too many, or cannot be had.
    pub fn pool(&self) -> Result<ThreadPool, InputError> {
        self.had(ThreadPoolBuilder::build)
    }

    /// Takes the threads for all that follows and does not say on which it runs. Once a program.
    ///
    /// # Errors
    /// As [`Threads::pool`].
    pub fn take(&self) -> Result<(), InputError> {
        self.had(ThreadPoolBuilder::build_global)
    }

    fn had<T>(
        &self,
        build: impl FnOnce(ThreadPoolBuilder) -> Result<T, ThreadPoolBuildError>,
    ) -> Result<T, InputError> {
        let processors = std::thread::available_parallelism().map_or(1, NonZero::get);
        let count = self.count.map_or(processors, NonZero::get);
        let most = FEW.max(MOST_A_PROCESSOR * processors);
        let refuse = |found: String| {
            let allowed = format!("1 to {most} threads on this machine of {processors} processor(s)");
            InputError::option("--threads", found, allowed)
        };
        if count > most {
            return Err(refuse(count.to_string()));
        }
        build(ThreadPoolBuilder::new().num_threads(count)).map_err(|e| refuse(e.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_more_threads_than_processors_can_serve() {
        for count in [5000, 100_000] {
            let message = Threads { count: NonZero::new(count) }.pool().expect_err("too many").to_string();
            let begins = format!("command line: --threads: found {count}; allowed: 1 to ");
            assert!(message.starts_with(&begins), "{message}");
        }
        assert!(Threads { count: NonZero::new(64) }.pool().is_ok());
    }
}
