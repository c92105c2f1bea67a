//! Records: one component of ground acceleration.

use std::path::{Path, PathBuf};

use mrbd_kernel::accelerogram::{Accelerogram, InvalidAccelerogram};
use mrbd_records::{
    IntensityMeasures, Motion, ReadOptions, Unit, read, response_spectrum_m_s2, write_two_columns,
};
use numpy::ndarray::ArrayView1;
use numpy::{AllowTypeChange, IntoPyArray, PyArray1, PyArrayLike1, PyArrayMethods, PyReadwriteArrayDyn};
use pyo3::prelude::*;

use crate::errors::{argument, files};
use crate::values::{self, Reduced};

/// A ground acceleration in m/s² at a fixed step, linear between samples.
#[pyclass(frozen, module = "mrbd")]
pub struct Record {
    /// A name, for tables and pictures.
    #[pyo3(get)]
    pub name: String,
    /// The motion.
    pub motion: Accelerogram,
}

impl Record {
    fn made(name: String, motion: Result<Accelerogram, InvalidAccelerogram>) -> PyResult<Self> {
        let motion = motion.map_err(|invalid| {
            let key = match invalid {
                InvalidAccelerogram::Step(_) => "step_s",
                _ => "acceleration_m_s2",
            };
            let message = invalid.to_string();
            let (found, allowed) = message.split_once("; allowed: ").unwrap_or((&message, "a valid record"));
            argument("Record", key, found, allowed)
        })?;
        Ok(Self { name, motion })
    }
}

/// The word of an option, read by the library.
fn word<T: std::str::FromStr<Err: std::fmt::Display>>(
    key: &str,
    text: Option<String>,
) -> PyResult<Option<T>> {
    let read = |text: String| {
        text.parse().map_err(|e: T::Err| {
            let message = e.to_string();
            let (found, allowed) = message.split_once(", expected ").unwrap_or((&text, &message));
            argument("Record.read", key, found, allowed)
        })
    };
    text.map(read).transpose()
}

/// An array that belongs to an object of Rust and shows its samples without a copy, not to be written.
#[allow(unsafe_code)]
fn view<'py>(samples: &[f64], owner: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
    // SAFETY: `owner` is a frozen class that holds `samples` for as long as it lives, and the array keeps it alive.
    let array = unsafe { PyArray1::borrow_from_array(&ArrayView1::from(samples), owner) };
    let writable: PyReadwriteArrayDyn<'py, f64> = array.to_dyn().try_readwrite()?;
    writable.make_nonwriteable();
    Ok(array)
}

#[pymethods]
impl Record {
    #[new]
    #[pyo3(
        signature = (acceleration_m_s2, step_s, name = "record".to_owned()),
        text_signature = "(acceleration_m_s2, step_s, name='record')"
    )]
    fn new(
        acceleration_m_s2: PyArrayLike1<'_, f64, AllowTypeChange>,
        step_s: f64,
        name: String,
    ) -> PyResult<Self> {
        let samples = acceleration_m_s2.as_array().iter().copied().collect();
        Self::made(name, Accelerogram::new(step_s, samples))
    }

    /// Reads a record file of any format that the program knows.
    #[staticmethod]
    #[pyo3(signature = (path, *, step_s = None, unit = None, channel = None, columns = None, decimal_comma = false))]
    fn read(
        py: Python<'_>,
        path: PathBuf,
        step_s: Option<f64>,
        unit: Option<String>,
        channel: Option<String>,
        columns: Option<String>,
        decimal_comma: bool,
    ) -> PyResult<Self> {
        let unit: Option<Unit> = word("unit", unit)?;
        let columns = word("columns", columns)?;
        let options = ReadOptions { step_s, unit, channel, columns, decimal_comma };
        let record = py.detach(|| read(&path, &options)).map_err(files)?;
        Ok(Self { name: record.name, motion: record.accelerogram })
    }

    /// Writes two columns, `time_s,acceleration_m_s2`; read back, the samples are the same to the bit.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        write_two_columns(Path::new(&path), &self.motion).map_err(files)
    }

    /// The samples, m/s²: a view, not a copy.
    #[getter]
    fn acceleration_m_s2<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        view(slf.get().motion.acceleration_m_s2(), slf.clone().into_any())
    }

    /// The times of the samples, s.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let step_s = self.motion.step_s();
        let times = (0..self.motion.acceleration_m_s2().len()).map(|k| k as f64 * step_s);
        times.collect::<Vec<_>>().into_pyarray(py)
    }

    /// Time between samples, s.
    #[getter]
    fn step_s(&self) -> f64 {
        self.motion.step_s()
    }

    /// Time of the last sample, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.motion.duration_s()
    }

    /// Velocity of the ground at the samples, m/s.
    #[getter]
    fn velocity_m_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        Motion::of(&self.motion).velocity_m_s.into_pyarray(py)
    }

    /// Displacement of the ground at the samples, m.
    #[getter]
    fn displacement_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        Motion::of(&self.motion).displacement_m.into_pyarray(py)
    }

    /// The same motion times a factor.
    fn scaled(&self, factor: f64) -> PyResult<Self> {
        if !factor.is_finite() {
            return Err(argument("Record.scaled", "factor", factor.to_string(), "a finite number"));
        }
        Ok(Self { name: format!("{} × {factor}", self.name), motion: self.motion.scaled(factor) })
    }

    /// Intensity measures, by their names in result files.
    fn measures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let measures = py.detach(|| IntensityMeasures::of(&self.motion));
        values::python(py, &measures)
    }

    /// Elastic pseudo-acceleration at periods, m/s².
    #[pyo3(signature = (periods_s, damping = 0.05))]
    fn spectrum_m_s2<'py>(
        &self,
        py: Python<'py>,
        periods_s: PyArrayLike1<'_, f64, AllowTypeChange>,
        damping: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let periods_s: Vec<f64> = periods_s.as_array().iter().copied().collect();
        if let Some(bad) = periods_s.iter().find(|period_s| !(period_s.is_finite() && **period_s > 0.0)) {
            let allowed = "finite numbers of seconds above 0";
            return Err(argument("Record.spectrum_m_s2", "periods_s", bad.to_string(), allowed));
        }
        if !(0.0..1.0).contains(&damping) {
            return Err(argument("Record.spectrum_m_s2", "damping", damping.to_string(), "0 to below 1"));
        }
        let spectrum = py.detach(|| response_spectrum_m_s2(&self.motion, &periods_s, damping));
        Ok(spectrum.into_pyarray(py))
    }

    fn __len__(&self) -> usize {
        self.motion.acceleration_m_s2().len()
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().motion == self.motion)
    }

    fn __repr__(&self) -> String {
        let m = &self.motion;
        format!(
            "<mrbd.Record {:?}: {} samples, {} s apart, peak {:.3} m/s²>",
            self.name,
            m.acceleration_m_s2().len(),
            m.step_s(),
            m.peak_m_s2()
        )
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("mrbd._pages")?.call_method1("record", (slf,))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let record = slf.get();
        let samples = Self::acceleration_m_s2(slf)?;
        let arguments = (samples, record.motion.step_s(), &record.name).into_pyobject(slf.py())?;
        Ok((slf.get_type().into_any(), arguments))
    }
}
