//! One run: a wall under a record, what came of it, and its history.

use std::path::PathBuf;
use std::sync::OnceLock;

use mrbd::report::{PlotFile, RunPicture, Watch};
use mrbd::results::RunResults;
use mrbd::store::history_table;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{self, PATTERN_NAMES};
use mrbd_kernel::simulate::{
    Accuracy, Ensemble, FREE_RELEASE_STEP_S, MEMBERS, MEMBERS_IN_CHAOS, Outcome, Response, Shaking,
    simulate_ensemble, simulate_members, simulate_observed,
};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use serde::{Deserialize, Serialize};

use crate::errors::{Error, argument, raised};
use crate::record::Record;
use crate::table::Table;
use crate::values;
use crate::wall::Wall;

/// The arguments of a run, beside its wall and its records.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Settings {
    scale: f64,
    vertical_scale: f64,
    tail_s: f64,
    tolerance: f64,
    step_s: f64,
}

/// Arrays of a history, made when they are first asked for.
struct Arrays {
    time_s: Py<PyArray1<f64>>,
    theta_rad: [Py<PyArray1<f64>>; 2],
    pattern: Py<PyArray1<u8>>,
}

/// A run and what came of it: what `mrbd simulate` tells, and the history of the wall.
///
/// The history is made when it is first asked for, by the same run once more, which gives the same bits.
#[pyclass(frozen, module = "mrbd")]
pub struct Run {
    /// The wall.
    #[pyo3(get)]
    wall: Py<Wall>,
    /// The record; `None` of a free release.
    #[pyo3(get)]
    record: Option<Py<Record>>,
    /// The vertical record.
    #[pyo3(get)]
    vertical: Option<Py<Record>>,
    settings: Settings,
    shaking: Shaking,
    ensemble: Ensemble,
    watch: OnceLock<Watch>,
    arrays: PyOnceLock<Arrays>,
}

/// Runs one wall under one record, or its free release.
#[pyfunction]
#[pyo3(signature = (
    wall, record = None, *, vertical = None, scale = 1.0, vertical_scale = 1.0, tail_s = 5.0, tolerance = 1e-6,
    step_s = FREE_RELEASE_STEP_S, members = Members::Alone
), text_signature = "(wall, record=None, *, vertical=None, scale=1.0, vertical_scale=1.0, tail_s=5.0, tolerance=1e-06, \
step_s=0.005, members=1)")]
#[allow(clippy::too_many_arguments)]
pub fn simulate(
    py: Python<'_>,
    wall: Py<Wall>,
    record: Option<Py<Record>>,
    vertical: Option<Py<Record>>,
    scale: f64,
    vertical_scale: f64,
    tail_s: f64,
    tolerance: f64,
    step_s: f64,
    members: Members,
) -> PyResult<Run> {
    let settings = Settings { scale, vertical_scale, tail_s, tolerance, step_s };
    settings.check()?;
    let shaking = settings.shaking(record.as_ref().map(|r| r.get()), vertical.as_ref().map(|r| r.get()))?;
    check_moves(wall.get(), &shaking)?;
    let ensemble = py.detach(|| members.run(&wall.get().wall, &shaking, settings.accuracy()));
    if let Outcome::Failed { time_s, reason } = &ensemble.run.outcome {
        return Err(Error::new_err(format!("the run failed at {time_s} s: {reason}")));
    }
    Ok(Run {
        wall,
        record,
        vertical,
        settings,
        shaking,
        ensemble,
        watch: OnceLock::new(),
        arrays: PyOnceLock::new(),
    })
}

/// Runs that go beside a run and differ from it by what nobody can know.
#[derive(Debug, Clone, Copy)]
pub enum Members {
    /// None.
    Alone,
    /// So many, the run itself counted.
    Count(usize),
    /// As many as `mrbd simulate` takes.
    Auto,
}

impl<'py> FromPyObject<'_, 'py> for Members {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let refuse = |found: String| {
            let allowed = format!("1, the run alone, to {MEMBERS_IN_CHAOS}; or \"auto\"");
            argument("simulate", "members", found, allowed)
        };
        if let Ok(word) = given.extract::<String>() {
            return if word == "auto" { Ok(Self::Auto) } else { Err(refuse(format!("{word:?}"))) };
        }
        match given.extract::<usize>() {
            Ok(1) => Ok(Self::Alone),
            Ok(count) if (2..=MEMBERS_IN_CHAOS).contains(&count) => Ok(Self::Count(count)),
            _ => Err(refuse(given.str()?.to_string())),
        }
    }
}

impl Members {
    fn run(self, wall: &model::Wall, shaking: &Shaking, accuracy: Accuracy) -> Ensemble {
        match self {
            Self::Alone => {
                Ensemble { run: mrbd_kernel::simulate::simulate(wall, shaking, accuracy), others: Vec::new() }
            }
            Self::Count(count) => simulate_ensemble(wall, shaking, accuracy, count),
            Self::Auto => {
                let few = simulate_ensemble(wall, shaking, accuracy, MEMBERS);
                if !few.needs_more() {
                    return few;
                }
                few.with(simulate_members(wall, shaking, accuracy, MEMBERS..MEMBERS_IN_CHAOS))
            }
        }
    }
}

/// A wall at rest without a record would stay there.
fn check_moves(wall: &Wall, shaking: &Shaking) -> PyResult<()> {
    if shaking.horizontal.is_none() && wall.wall.parameters().initial_rotation_rad == [0.0, 0.0] {
        let allowed = "a record, or rotations to be released from in `initial` of the wall";
        return Err(argument("simulate", "record", "no record and a wall at rest", allowed));
    }
    if shaking.horizontal.is_none() && shaking.vertical.is_some() {
        return Err(argument(
            "simulate",
            "vertical",
            "no record beside it",
            "a record and its vertical component",
        ));
    }
    Ok(())
}

impl Settings {
    fn check(&self) -> PyResult<()> {
        let finite = "a finite number";
        let seconds = "a finite number of seconds";
        let Self { scale, vertical_scale, tail_s, tolerance, step_s } = *self;
        number("scale", scale, true, finite)?;
        number("vertical_scale", vertical_scale, true, finite)?;
        number("tail_s", tail_s, tail_s >= 0.0, &format!("{seconds}, 0 or more"))?;
        number("step_s", step_s, step_s > 0.0, &format!("{seconds} above 0"))?;
        number("tolerance", tolerance, Accuracy::TOLERANCES.contains(&tolerance), Accuracy::ALLOWED)
    }

    fn accuracy(&self) -> Accuracy {
        Accuracy { tolerance: self.tolerance }
    }

    fn shaking(&self, record: Option<&Record>, vertical: Option<&Record>) -> PyResult<Shaking> {
        if let (Some(h), Some(v)) = (record, vertical)
            && h.motion.step_s() != v.motion.step_s()
        {
            let allowed = format!("the step of the horizontal record, {} s", h.motion.step_s());
            let found = format!("a step of {} s", v.motion.step_s());
            return Err(argument("simulate", "vertical", found, allowed));
        }
        let horizontal = record.map(|r| scaled(&r.motion, self.scale));
        let vertical = vertical.map(|r| scaled(&r.motion, self.vertical_scale));
        Ok(Shaking { horizontal, vertical, tail_s: self.tail_s })
    }
}

/// A motion times a factor, its samples shared where it is 1.
pub fn scaled(motion: &Accelerogram, factor: f64) -> Accelerogram {
    if factor == 1.0 { motion.clone() } else { motion.scaled(factor) }
}

fn number(key: &str, value: f64, holds: bool, allowed: &str) -> PyResult<()> {
    match value.is_finite() && holds {
        true => Ok(()),
        false => Err(argument("simulate", key, value.to_string(), allowed)),
    }
}

impl Run {
    fn response(&self) -> &Response {
        &self.ensemble.run
    }

    /// The run once more, watched; the same bits, unless another version of the program made it.
    fn watch(&self, py: Python<'_>) -> PyResult<&Watch> {
        if let Some(watch) = self.watch.get() {
            return Ok(watch);
        }
        let step_s = self.shaking.horizontal.as_ref().map_or(self.settings.step_s, Accelerogram::step_s);
        let wall = &self.wall.get().wall;
        let (watch, response) = py.detach(|| {
            let mut watch = Watch::new(step_s);
            let response = simulate_observed(wall, &self.shaking, self.settings.accuracy(), &mut watch);
            (watch, response)
        });
        // Where a run left the wall is not pickled.
        let known = Response { left: response.left, ..self.response().clone() };
        if response != known {
            return Err(Error::new_err(
                "the run comes out otherwise: another version of the program made it",
            ));
        }
        Ok(self.watch.get_or_init(|| watch))
    }

    fn arrays(&self, py: Python<'_>) -> PyResult<&Arrays> {
        let watch = self.watch(py)?;
        self.arrays.get_or_try_init(py, || {
            let rows = &watch.history.rows;
            let reading = self.wall.get().wall.reading();
            let theta_rad =
                [0, 1].map(|body| rows.iter().map(|row| reading.of(row.theta_rad)[body]).collect::<Vec<_>>());
            // Times without the roundings of a product, as in the files of histories.
            let time_s: Vec<f64> = rows.iter().map(|row| (row.time_s * 1e9).round() / 1e9).collect();
            let pattern: Vec<u8> = rows.iter().map(|row| row.contact.index() as u8).collect();
            Ok(Arrays {
                time_s: time_s.into_pyarray(py).unbind(),
                theta_rad: theta_rad.map(|values| values.into_pyarray(py).unbind()),
                pattern: pattern.into_pyarray(py).unbind(),
            })
        })
    }

    fn results(&self) -> RunResults<'_> {
        RunResults::new(&self.wall.get().wall, &self.shaking, &self.ensemble)
    }

    fn picture<T>(&self, py: Python<'_>, draw: impl FnOnce(&RunPicture<'_>) -> T + Send) -> PyResult<T>
    where
        T: Send,
    {
        let watch = self.watch(py)?;
        let wall = self.wall.get();
        let factor = self.settings.scale;
        let record_name = self.record.as_ref().map(|record| match factor {
            1.0 => record.get().name.clone(),
            factor => format!("{} × {factor}", record.get().name),
        });
        let wall_name = std::path::Path::new(&wall.file).file_name().unwrap_or_default().to_string_lossy();
        let picture = RunPicture {
            wall: &wall.wall,
            wall_name: if wall.file.starts_with("mrbd.") { "Wall" } else { &wall_name },
            shaking: &self.shaking,
            record_name: record_name.as_deref(),
            accuracy: self.settings.accuracy(),
            watch,
            response: self.response(),
            ensemble: &self.ensemble,
            remarks: &self.results().remarks(),
            parts: &[],
        };
        Ok(py.detach(|| draw(&picture)))
    }
}

#[pymethods]
impl Run {
    /// Times of the history, s.
    #[getter]
    fn time_s(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        Ok(self.arrays(py)?.time_s.clone_ref(py))
    }

    /// Rotation of the lower body, rad; as its sensor reads it.
    #[getter]
    fn theta1_rad(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        Ok(self.arrays(py)?.theta_rad[0].clone_ref(py))
    }

    /// Rotation of the upper body, rad; as its sensor reads it.
    #[getter]
    fn theta2_rad(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        Ok(self.arrays(py)?.theta_rad[1].clone_ref(py))
    }

    /// Pattern of contact at each time, as its position in `mrbd.PATTERNS`.
    #[getter]
    fn pattern_index(&self, py: Python<'_>) -> PyResult<Py<PyArray1<u8>>> {
        Ok(self.arrays(py)?.pattern.clone_ref(py))
    }

    /// Pattern of contact at each time, by its name.
    #[getter]
    fn pattern<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let names = py.import("numpy")?.call_method1("array", (PATTERN_NAMES,))?;
        names.get_item(self.pattern_index(py)?)
    }

    /// What `mrbd simulate --json` prints.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        values::json(py, &self.results().json())
    }

    /// Whether a body passed its collapse rotation.
    #[getter]
    fn collapsed(&self) -> bool {
        self.response().collapsed()
    }

    /// How sure the outcome is, and whether the model applies, each a sentence.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.results().remarks()
    }

    /// The history as a table, with the columns of `mrbd simulate --history`.
    fn table(&self, py: Python<'_>) -> PyResult<Table> {
        let watch = self.watch(py)?;
        let batch = history_table(&watch.history, &self.wall.get().wall.reading());
        batch.map(Table::of).map_err(|e| Error::new_err(e.to_string()))
    }

    /// Draws the histories of rotation with matplotlib, into axes where they are given; the axes.
    #[pyo3(signature = (ax = None))]
    fn plot<'py>(slf: &Bound<'py, Self>, ax: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("mrbd._plots")?.call_method1("history", (slf, ax))
    }

    /// The page of the run: the wall in motion, histories, numbers.
    fn html(&self, py: Python<'_>) -> PyResult<String> {
        self.picture(py, |picture| picture.html())?.map_err(raised)
    }

    /// The histories as one drawing, SVG.
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        self.picture(py, |picture| picture.svg())
    }

    /// Draws the run into a .svg, .png or .html file, as `mrbd simulate --plot`.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let file = PlotFile::new(&path).map_err(raised)?;
        self.picture(py, |picture| file.write(picture))?.map_err(raised)
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("mrbd._pages")?.call_method1("frame", (self.html(py)?,))
    }

    fn __repr__(&self) -> String {
        let r = self.response();
        let [lower, upper] = r.theta_max_over_alpha_i();
        let end = match r.outcome {
            Outcome::Collapsed { time_s } => format!("collapsed at {time_s:.3} s"),
            _ => format!("stood until {:.3} s", r.end_time_s),
        };
        format!(
            "<mrbd.Run {end}, largest |θ₁|/α₁ {lower:.4}, |θ₂|/α₂ {upper:.4}, {} impacts>",
            r.impacts.total()
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<values::Reduced<'py>> {
        let (run, py) = (slf.get(), slf.py());
        let text =
            |value: Result<String, serde_json::Error>| value.map_err(|e| Error::new_err(e.to_string()));
        let settings = text(serde_json::to_string(&run.settings))?;
        let responses = text(serde_json::to_string(&run.ensemble.members().collect::<Vec<_>>()))?;
        let copied = |record: &Option<Py<Record>>| record.as_ref().map(|record| record.clone_ref(py));
        let arguments =
            (run.wall.clone_ref(py), copied(&run.record), copied(&run.vertical), settings, responses);
        Ok((slf.get_type().getattr("_of_parts")?, arguments.into_pyobject(py)?))
    }

    #[staticmethod]
    fn _of_parts(
        wall: Py<Wall>,
        record: Option<Py<Record>>,
        vertical: Option<Py<Record>>,
        settings: &str,
        responses: &str,
    ) -> PyResult<Self> {
        let failed = |e: serde_json::Error| Error::new_err(format!("not a pickled run: {e}"));
        let settings: Settings = serde_json::from_str(settings).map_err(failed)?;
        let mut others: Vec<Response> = serde_json::from_str(responses).map_err(failed)?;
        let shaking =
            settings.shaking(record.as_ref().map(|r| r.get()), vertical.as_ref().map(|r| r.get()))?;
        let ensemble = Ensemble { run: others.remove(0), others };
        let (watch, arrays) = (OnceLock::new(), PyOnceLock::new());
        Ok(Self { wall, record, vertical, settings, shaking, ensemble, watch, arrays })
    }
}
