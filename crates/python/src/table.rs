//! Tables: rows of named columns, for any library that reads the Arrow C interface.

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, UInt64Type};
use arrow_array::{Array, RecordBatch};
use arrow_schema::{DataType, SchemaRef};
use numpy::IntoPyArray;
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule, PyList};
use pyo3_arrow::PyTable;

use crate::errors::Error;
use crate::values::Reduced;

/// Rows of named columns. polars, pandas, pyarrow and DuckDB read it without a copy: `polars.DataFrame(table)`.
#[pyclass(frozen, module = "mrbd")]
pub struct Table {
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
}

impl Table {
    /// A table of batches of one schema.
    pub fn new(schema: SchemaRef, batches: Vec<RecordBatch>) -> Self {
        Self { schema, batches }
    }

    /// A table of one batch.
    pub fn of(batch: RecordBatch) -> Self {
        Self::new(batch.schema(), vec![batch])
    }

    /// Its columns.
    pub fn schema(&self) -> SchemaRef {
        self.schema.clone()
    }

    /// Its rows.
    pub fn batches(&self) -> &[RecordBatch] {
        &self.batches
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    fn stream(&self) -> PyResult<PyTable> {
        PyTable::try_new(self.batches.clone(), self.schema.clone())
    }
}

/// What Arrow refused: a defect of the program.
fn refused(error: impl std::fmt::Display) -> PyErr {
    Error::new_err(error.to_string())
}

#[pymethods]
impl Table {
    /// Reads any table of the Arrow C interface.
    #[new]
    fn read(table: PyTable) -> Self {
        let (batches, schema) = table.into_inner();
        Self { schema, batches }
    }

    /// The Arrow C interface.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyCapsule>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        Bound::new(py, self.stream()?)?.call_method1("__arrow_c_stream__", (requested_schema,))
    }

    /// Names of the columns.
    #[getter]
    fn columns(&self) -> Vec<&str> {
        self.schema.fields().iter().map(|field| field.name().as_str()).collect()
    }

    /// A column: numbers as an array with NaN where there is none, all else as a list with `None`.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let (index, field) =
            self.schema.column_with_name(name).ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        let arrays = self.batches.iter().map(|batch| batch.column(index).as_ref());
        match field.data_type() {
            DataType::Float64 => {
                let numbers = arrays.flat_map(|a| a.as_primitive::<Float64Type>().iter());
                Ok(numbers
                    .map(|number| number.unwrap_or(f64::NAN))
                    .collect::<Vec<_>>()
                    .into_pyarray(py)
                    .into_any())
            }
            DataType::UInt64 if arrays.clone().all(|array| array.null_count() == 0) => {
                let counts = arrays.flat_map(|a| a.as_primitive::<UInt64Type>().values().iter().copied());
                Ok(counts.collect::<Vec<_>>().into_pyarray(py).into_any())
            }
            DataType::Boolean if arrays.clone().all(|array| array.null_count() == 0) => {
                let flags = arrays.flat_map(|a| a.as_boolean().iter().flatten());
                Ok(flags.collect::<Vec<_>>().into_pyarray(py).into_any())
            }
            _ => {
                let lists = arrays.map(|array| list(py, array)).collect::<PyResult<Vec<_>>>()?;
                let members = lists.iter().flat_map(|list| list.iter());
                Ok(PyList::new(py, members.collect::<Vec<_>>())?.into_any())
            }
        }
    }

    /// A `pandas.DataFrame` of the table.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let table = slf.py().import("pyarrow")?.call_method1("table", (slf,))?;
        table.call_method0("to_pandas")
    }

    /// A `polars.DataFrame` of the table, without a copy.
    fn to_polars<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("polars")?.getattr("DataFrame")?.call1((slf,))
    }

    /// The first rows.
    #[pyo3(signature = (rows = 10))]
    fn head(&self, rows: usize) -> Self {
        let mut left = rows;
        let mut first = |batch: &RecordBatch| {
            let taken = left.min(batch.num_rows());
            left -= taken;
            batch.slice(0, taken)
        };
        Self::new(self.schema.clone(), self.batches.iter().map(&mut first).collect())
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("mrbd._pages")?.call_method1("table", (slf,))
    }

    fn __len__(&self) -> usize {
        self.rows()
    }

    fn __repr__(&self) -> String {
        let names = self.columns();
        let shown = names.iter().take(8).copied().collect::<Vec<_>>().join(", ");
        let more = if names.len() > 8 { ", …" } else { "" };
        format!("<mrbd.Table of {} rows, {} columns: {shown}{more}>", self.rows(), names.len())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let table = slf.get();
        let mut bytes = Vec::new();
        let mut writer =
            arrow_ipc::writer::StreamWriter::try_new(&mut bytes, &table.schema).map_err(refused)?;
        table.batches.iter().try_for_each(|batch| writer.write(batch)).map_err(refused)?;
        writer.finish().map_err(refused)?;
        drop(writer);
        let bytes = PyBytes::new(slf.py(), &bytes);
        Ok((slf.get_type().getattr("_of_bytes")?, (bytes,).into_pyobject(slf.py())?))
    }

    #[staticmethod]
    fn _of_bytes(bytes: &[u8]) -> PyResult<Self> {
        let reader = arrow_ipc::reader::StreamReader::try_new(bytes, None).map_err(refused)?;
        let schema = reader.schema();
        let batches = reader.collect::<Result<_, _>>().map_err(refused)?;
        Ok(Self { schema, batches })
    }
}

/// The values of an array that is no array of numbers alone.
fn list<'py>(py: Python<'py>, array: &dyn Array) -> PyResult<Bound<'py, PyList>> {
    match array.data_type() {
        DataType::Utf8 => PyList::new(py, array.as_string::<i32>()),
        DataType::Boolean => PyList::new(py, array.as_boolean().iter()),
        DataType::UInt64 => PyList::new(py, array.as_primitive::<UInt64Type>()),
        DataType::Dictionary(..) => {
            let dictionary = array.as_any_dictionary();
            let texts = dictionary.values().as_string_opt::<i32>().ok_or_else(|| unknown(array))?;
            if texts.is_empty() {
                return PyList::new(py, vec![None::<&str>; array.len()]);
            }
            let keys = dictionary.normalized_keys().into_iter().enumerate();
            PyList::new(
                py,
                keys.map(|(row, key)| array.is_valid(row).then(|| texts.value(key))).collect::<Vec<_>>(),
            )
        }
        _ => Err(unknown(array)),
    }
}

fn unknown(array: &dyn Array) -> PyErr {
    PyTypeError::new_err(format!(
        "columns of {} are read by polars, pandas, pyarrow or DuckDB",
        array.data_type()
    ))
}
