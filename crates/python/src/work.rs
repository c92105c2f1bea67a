//! Long work beside the interpreter: it stays free, shows progress, and hears Ctrl-C.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::{Error, argument};

/// How often Ctrl-C is looked for and progress is shown.
const LOOK: Duration = Duration::from_millis(50);

/// What a work tells of itself, and is told.
#[derive(Debug, Default)]
pub struct Watched {
    /// Set when the work is to stop.
    pub stop: AtomicBool,
    /// Parts that are done.
    pub done: AtomicU64,
}

impl Watched {
    /// Whether the work is to stop.
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Who is shown how many parts are done, of how many.
pub struct Shown<'py> {
    show: Option<Bound<'py, PyAny>>,
    parts: u64,
}

impl<'py> Shown<'py> {
    /// A callable of Python, called with the parts done and all of them.
    pub fn of(show: Option<Bound<'py, PyAny>>, parts: u64) -> Self {
        Self { show, parts }
    }

    fn look(&self, py: Python<'_>, watched: &Watched) -> PyResult<()> {
        py.check_signals()?;
        self.tell(watched)
    }

    fn tell(&self, watched: &Watched) -> PyResult<()> {
        let Some(show) = &self.show else { return Ok(()) };
        show.call1((watched.done.load(Ordering::Relaxed), self.parts)).map(|_| ())
    }
}

/// Does a work on a thread of its own, the interpreter released; what came of it, and what interrupted it.
pub fn watched<T: Send>(
    py: Python<'_>,
    watched: &Watched,
    shown: &Shown<'_>,
    work: impl FnOnce() -> T + Send,
) -> (T, Option<PyErr>) {
    let (send, mut receive) = channel();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            // The receiver lives as long as this scope.
            let _ = send.send(work());
        });
        let mut interrupted = None;
        loop {
            match next(py, &mut receive) {
                Ok(done) => break (done, interrupted.or_else(|| shown.tell(watched).err())),
                Err(RecvTimeoutError::Timeout) => {}
                // The work panicked: leaving the scope passes it on.
                Err(RecvTimeoutError::Disconnected) => panic!("the work ended without a result"),
            }
            if interrupted.is_none() {
                interrupted = shown.look(py, watched).err();
                watched.stop.store(interrupted.is_some(), Ordering::Relaxed);
            }
        }
    })
}

/// As [`watched`], of work that cannot be stopped at once: interrupted, it is left to see that it is to stop.
///
/// # Errors
/// What interrupted it.
pub fn left_alone<T: Send + 'static>(
    py: Python<'_>,
    told: Arc<Watched>,
    shown: &Shown<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (send, mut receive) = channel();
    std::thread::spawn(move || {
        // Nobody receives what was interrupted.
        let _ = send.send(catch_unwind(AssertUnwindSafe(work)));
    });
    loop {
        match next(py, &mut receive) {
            Ok(Ok(done)) => break Ok(done),
            Ok(Err(panic)) => resume_unwind(panic),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                break Err(Error::new_err("the work ended without a result"));
            }
        }
        if let Err(interrupted) = shown.look(py, &told) {
            told.stop.store(true, Ordering::Relaxed);
            break Err(interrupted);
        }
    }
}

/// What was sent, waited for a while with the interpreter released.
fn next<T: Send>(py: Python<'_>, receive: &mut Receiver<T>) -> Result<T, RecvTimeoutError> {
    py.detach(move || receive.recv_timeout(LOOK))
}

/// Threads of a call; `None`: one for each processor. A pool of its own, so that a process that forks has no dead one.
pub fn pool(function: &str, threads: Option<usize>) -> PyResult<ThreadPool> {
    let processors = std::thread::available_parallelism().map_or(1, |count| count.get());
    let count = threads.unwrap_or(processors);
    // As many as the program's --threads.
    let most = 64.max(4 * processors);
    let refuse = |found: String| argument(function, "threads", found, format!("1 to {most}"));
    if !(1..=most).contains(&count) {
        return Err(refuse(count.to_string()));
    }
    ThreadPoolBuilder::new().num_threads(count).build().map_err(|e| refuse(e.to_string()))
}
