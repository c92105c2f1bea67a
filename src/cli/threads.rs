//! Threads to run on: the option of every command that takes long, and the pool.

use std::num::NonZero;

use clap::Args;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::InputError;

/// `--threads`.
#[derive(Debug, Args)]
pub struct Threads {
    /// Threads; without it one for each processor. Results do not depend on it.
    #[arg(long = "threads", value_name = "N")]
    count: Option<NonZero<usize>>,
}

impl Threads {
    /// The threads.
    ///
    /// # Errors
    /// An input error if they cannot be had.
    pub fn pool(&self) -> Result<ThreadPool, InputError> {
        let processors = || std::thread::available_parallelism().ok();
        let count = self.count.or_else(processors).map_or(1, NonZero::get);
        let refuse =
            |found: String| InputError::option("--threads", found, "a number of threads the system grants");
        ThreadPoolBuilder::new().num_threads(count).build().map_err(|e| refuse(e.to_string()))
    }
}
