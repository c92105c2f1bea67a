//! Stopping on request: Ctrl-C, and the signals a scheduler sends before it ends a job.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use signal_hook::iterator::Signals;

use crate::error::{Error, Result};

/// Exit code of a process that was asked to stop twice, as shells count an interrupt: 128 + 2.
const AT_ONCE: i32 = 130;

/// Exit code of a process that was asked to stop: a failure that is no fault of the input, as for a study.
const STOPPED: i32 = 1;

/// Ends the process with these words when it is asked to stop.
///
/// For work that is stored as it goes, or can be as it stands: nothing has to be finished first.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the system has no such signals.
pub(super) fn end_on_signals(last_words: impl FnOnce() -> String + Send + 'static) -> Result<()> {
    let mut signals = Signals::new([SIGINT, SIGTERM])
        .map_err(|e| Error::io("watch for signals", Path::new("process"), e))?;
    std::thread::spawn(move || {
        if signals.forever().next().is_some() {
            // The line of a bar may stand there. Where nobody reads any more, the process ends all the same.
            let _ = writeln!(std::io::stderr(), "\nmrbd: stopped; {}", last_words());
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
