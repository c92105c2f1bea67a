//! Threads to run on, and stopping on request: Ctrl-C, and the signals a scheduler sends before it ends a job.

use std::num::NonZero;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;
use rayon::{ThreadPool, ThreadPoolBuilder};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use signal_hook::iterator::Signals;

use crate::error::{Error, InputError, Result};

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
        ThreadPoolBuilder::new().num_threads(count).build().map_err(|e| refuse(e.to_string()))
    }
}

/// Exit code of a process that was asked to stop twice, as shells count an interrupt: 128 + 2.
const AT_ONCE: i32 = 130;

/// Exit code of a process that was asked to stop: a failure that is no fault of the input, as for a study.
const STOPPED: i32 = 1;

/// Ends the process with these words when it is asked to stop.
///
/// For work that is stored as it goes, or not at all: nothing has to be finished first.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the system has no such signals.
pub(super) fn end_on_signals(last_words: String) -> Result<()> {
    let mut signals = Signals::new([SIGINT, SIGTERM])
        .map_err(|e| Error::io("watch for signals", Path::new("process"), e))?;
    std::thread::spawn(move || {
        if signals.forever().next().is_some() {
            // The line of a bar may stand there.
            eprintln!("\nmrbd: stopped; {last_words}");
            std::process::exit(STOPPED);
        }
    });
    Ok(())
}

/// A flag that is set when the process is asked to stop; asked again, it ends at once.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the system has no such signals.
pub(super) fn on_signals() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // In this order: the first signal finds the flag unset, sets it, and the second ends the process.
        flag::register_conditional_shutdown(signal, AT_ONCE, Arc::clone(&stop))
            .and_then(|_| flag::register(signal, Arc::clone(&stop)))
            .map_err(|e| Error::io("watch for signals", Path::new("process"), e))?;
    }
    Ok(stop)
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
