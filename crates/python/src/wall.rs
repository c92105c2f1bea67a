//! Walls: a wall file, read, or written by keyword arguments.

use std::path::{Path, PathBuf};

use mrbd::report::wall_svg;
use mrbd_files::description::Description;
use mrbd_files::{parse_wall, slips, toml_file};
use mrbd_kernel::model::{self, EffectKind, WallParameters};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use toml::{Table, Value};

use crate::errors::{Question, call, files};
use crate::values::{self, Reduced};

/// A wall: what a wall file says, checked.
///
/// Numbers are keyword arguments with the keys of `[wall]`, and attributes of the same names; other sections of the file are dictionaries (`corners`,
/// `diaphragm`, `restitution`, `collapse`, `initial`) and `effects` is a list of them.
#[pyclass(frozen, module = "mrbd")]
pub struct Wall {
    /// The file it was read from, or the call.
    pub file: String,
    /// The wall file, as written.
    text: String,
    /// The wall itself.
    pub wall: model::Wall,
}

impl Wall {
    fn parsed(py: Python<'_>, file: String, text: String) -> PyResult<Self> {
        let wall = parse_wall(Path::new(&file), &text).map_err(files)?;
        let class = py.get_type::<Question>();
        for question in slips::questions(&wall) {
            let message = std::ffi::CString::new(format!("{file}: {question}"))?;
            PyErr::warn(py, &class, &message, 1)?;
        }
        Ok(Self { file, text, wall })
    }

    fn of_table(py: Python<'_>, table: &Table) -> PyResult<Self> {
        let text = toml::to_string(table).map_err(|e| crate::errors::Error::new_err(e.to_string()))?;
        Self::parsed(py, call("Wall"), text)
    }

    fn table(&self) -> PyResult<Table> {
        toml_file::parse(Path::new(&self.file), &self.text).map_err(files)
    }

    fn parameters(&self) -> &WallParameters {
        self.wall.parameters()
    }
}

/// Keyword arguments as the sections of a wall file: tables and lists are sections, all else are keys of `[wall]`.
fn sections(keys: Option<&Bound<'_, PyDict>>) -> PyResult<Table> {
    let keys = keys.map(|keys| values::items(keys)).transpose()?.flatten().unwrap_or_default();
    let mut table = Table::new();
    let mut body = Table::new();
    for (key, value) in values::table(keys)? {
        let section = matches!(value, Value::Table(_) | Value::Array(_));
        _ = if section { table.insert(key, value) } else { body.insert(key, value) };
    }
    table.insert("wall".into(), Value::Table(body));
    Ok(table)
}

/// Puts changes over a table: those of a section key by key, a list as a whole.
fn merged(table: &mut Table, changes: Table) {
    for (key, change) in changes {
        match (table.get_mut(&key), change) {
            (Some(Value::Table(section)), Value::Table(changes)) => section.extend(changes),
            (_, change) => _ = table.insert(key, change),
        }
    }
}

#[pymethods]
impl Wall {
    #[new]
    #[pyo3(signature = (**keys))]
    fn new(py: Python<'_>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        Self::of_table(py, &sections(keys)?)
    }

    /// Reads a wall file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let text = toml_file::read(&path).map_err(files)?;
        Self::parsed(py, path.display().to_string(), text)
    }

    /// A wall of the text of a wall file; `file` names it in errors.
    #[staticmethod]
    #[pyo3(signature = (text, file = "wall.toml".to_owned()), text_signature = "(text, file='wall.toml')")]
    fn parse(py: Python<'_>, text: String, file: String) -> PyResult<Self> {
        Self::parsed(py, file, text)
    }

    /// The wall with some keys changed; sections are changed key by key, and `effects` as a whole.
    #[pyo3(signature = (**changes))]
    fn replace(&self, py: Python<'_>, changes: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut table = self.table()?;
        merged(&mut table, sections(changes)?);
        Self::of_table(py, &table)
    }

    /// The wall file, as written.
    #[getter]
    fn toml(&self) -> &str {
        &self.text
    }

    /// The file it was read from.
    #[getter]
    fn file(&self) -> &str {
        &self.file
    }

    /// Writes the wall file.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        mrbd::store::write_durably(&path, self.text.as_bytes()).map_err(crate::errors::raised)
    }

    /// Weights, slenderness, and what it takes for the wall to rock, before any run.
    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        values::python(py, &Description::of(&self.wall))
    }

    /// A drawing of the wall, SVG.
    fn svg(&self) -> String {
        wall_svg(&self.wall, &Description::of(&self.wall))
    }

    fn _repr_html_(&self) -> String {
        self.svg()
    }

    /// Further effects and formulas, as in the wall file.
    #[getter]
    fn effects<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        values::python(py, &self.parameters().further_laws())
    }

    /// What becomes of velocities at impacts: the section `[restitution]` of a wall file.
    #[getter]
    fn restitution<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let r = self.parameters().restitution;
        values::json(
            py,
            &serde_json::json!({
                "coefficients": r.coefficients,
                "law": r.law,
                "capture_velocity_rad_s": r.capture_velocity_rad_s,
            }),
        )
    }

    /// Slenderness angles α_1, α_2 of the bodies, rad.
    #[getter]
    fn alpha_i_rad(&self) -> (f64, f64) {
        self.wall.alpha_i_rad().into()
    }

    /// The quantities by their names in result files.
    fn __getattr__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let p = self.parameters();
        match name {
            "thickness_m" => p.thickness_m.into_bound_py_any(py),
            "height_m" => p.height_m.into_bound_py_any(py),
            "crack_height_m" => p.crack_height_m.into_bound_py_any(py),
            "length_m" => p.length_m.into_bound_py_any(py),
            "mass_kg" => p.mass_kg.into_bound_py_any(py),
            "lower_width_m" => p.lower_width_m.into_bound_py_any(py),
            "upper_width_m" => p.upper_width_m.into_bound_py_any(py),
            "diaphragm_mass_kg" => p.diaphragm_mass_kg.into_bound_py_any(py),
            "carriage_mass_kg" => p.carriage_mass_kg.into_bound_py_any(py),
            "stiffness_n_per_m" => p.stiffness_n_per_m.into_bound_py_any(py),
            "eccentricity_m" => p.eccentricity_m.into_bound_py_any(py),
            "collapse_rotation_ratio" => p.collapse_rotation_ratio.into_bound_py_any(py),
            "initial_theta1_rad" => p.initial_rotation_rad[0].into_bound_py_any(py),
            "initial_theta2_rad" => p.initial_rotation_rad[1].into_bound_py_any(py),
            _ => Err(PyAttributeError::new_err(format!("a wall has no {name:?}"))),
        }
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().parameters() == self.parameters())
    }

    fn __repr__(&self) -> String {
        let p = self.parameters();
        let crack = p.crack_height_m.map_or("not cracked".to_owned(), |m| format!("cracked at {m} m"));
        let effects = match p.further_laws().len() {
            0 => String::new(),
            some => format!(", {some} effects"),
        };
        format!(
            "<mrbd.Wall {} m thick, {} m high, {crack}, {} kg{effects}>",
            p.thickness_m, p.height_m, p.mass_kg
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let wall = slf.get();
        let parse = slf.get_type().getattr("parse")?;
        Ok((parse, PyTuple::new(slf.py(), [&wall.text, &wall.file])?))
    }
}

/// The catalogue of further effects that a wall may have: kind, place, law, parameters with units and bounds.
#[pyfunction]
pub fn effects(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    values::python(py, &EffectKind::ALL.iter().map(|kind| kind.entry()).collect::<Vec<_>>())
}
