//! The laboratory: measured tests become coefficients, or the effect that the model lacks.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use mrbd::results::{calibration, diagnosis};
use mrbd_lab::calibrate::{Archive, calibrate};
use mrbd_lab::diagnose::{check_data, check_tests, diagnose};
use mrbd_lab::{Progress, calibrate as calibrating, diagnose as diagnosing};
use pyo3::prelude::*;

use crate::errors::raised;
use crate::work::{Shown, Watched, left_alone, pool};

/// Counts what is done, and ends a work that is to stop at the next part: by unwinding, which asks nothing of the searches.
#[derive(Debug)]
pub struct Counted(pub Arc<Watched>);

/// What a work that was stopped unwinds with; the panic hook is not told.
struct Stopped;

impl Progress for Counted {
    fn begin(&self, _what: &str, _parts: usize) {}

    fn advance(&self, parts: usize) {
        self.0.done.fetch_add(parts as u64, Ordering::Relaxed);
        if self.0.stopped() {
            std::panic::resume_unwind(Box::new(Stopped));
        }
    }

    fn note(&self, _text: &str) {}
}

/// Diagnoses an experiment into a folder, as `mrbd diagnose`.
#[pyfunction]
#[pyo3(signature = (experiment, out, threads, progress))]
pub fn run_diagnosis(
    py: Python<'_>,
    experiment: PathBuf,
    out: PathBuf,
    threads: Option<usize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    let experiment = py.detach(|| diagnosing::Experiment::load(&experiment)).map_err(crate::errors::files)?;
    let pool = pool("diagnose", threads)?;
    let names = diagnosis::OutputNames::prepare(&out).map_err(raised)?;
    let told = Arc::new(Watched::default());
    let counted = Counted(Arc::clone(&told));
    left_alone(py, told, &Shown::of(progress, 0), move || -> mrbd::Result<()> {
        let found = pool.install(|| -> mrbd::Result<_> {
            check_data(&experiment)?;
            Ok(diagnose(&experiment, &counted)?)
        })?;
        diagnosis::write_results(&names, &experiment.inputs, &found)
    })?
    .map_err(raised)
}

/// Calibrates a wall to an experiment into a folder, as `mrbd calibrate`.
#[pyfunction]
#[pyo3(signature = (experiment, out, seed, resume, threads, progress))]
pub fn run_calibration(
    py: Python<'_>,
    experiment: PathBuf,
    out: PathBuf,
    seed: Option<u64>,
    resume: bool,
    threads: Option<usize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    let file = experiment;
    let experiment =
        py.detach(|| calibrating::Experiment::load(&file, seed)).map_err(crate::errors::files)?;
    let pool = pool("calibrate", threads)?;
    let told = Arc::new(Watched::default());
    let counted = Box::new(Counted(Arc::clone(&told)));
    left_alone(py, told, &Shown::of(progress, 0), move || -> mrbd::Result<()> {
        pool.install(|| check_tests(&file, &experiment.given()?, &experiment.tests))?;
        if resume && calibration::finished(&out, &experiment)?.is_some() {
            return Ok(());
        }
        let names = calibration::OutputNames::prepare(&out, &experiment, resume)?;
        let archive = Archive::open(&names.journal, &experiment.request, resume, counted)?;
        let found = pool.install(|| calibrate(&experiment, &archive))?;
        let moments = experiment.moments()?;
        calibration::write_results(&names, &experiment, &found, moments.as_ref(), archive)
    })?
    .map_err(raised)
}
