//! Values of Python as values of files, and back.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList, PyString, PyTuple};
use serde::Serialize;
use toml::{Table, Value};

use crate::errors::Error;

/// A value of a TOML file: texts, truth values, numbers, lists, and tables from dictionaries and dataclasses.
///
/// # Errors
/// `TypeError` for anything else.
pub fn value(object: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(flag) = object.cast::<PyBool>() {
        return Ok(Value::Boolean(flag.is_true()));
    }
    if let Ok(text) = object.cast::<PyString>() {
        return Ok(Value::String(text.to_string()));
    }
    if let Some(items) = items(object)? {
        return Ok(Value::Table(table(items)?));
    }
    if let Ok(whole) = object.extract::<i64>() {
        return Ok(Value::Integer(whole));
    }
    if let Ok(number) = object.extract::<f64>() {
        return Ok(Value::Float(number));
    }
    let Ok(members) = object.try_iter() else {
        let kind = object.get_type().name()?;
        let allowed = "a number, a text, a truth value, a list or a dictionary";
        return Err(PyTypeError::new_err(format!("found {object} of type {kind}; allowed: {allowed}")));
    };
    members.map(|member| value(&member?)).collect::<PyResult<Vec<_>>>().map(Value::Array)
}

/// A table of what is not `None`.
///
/// # Errors
/// As [`value`].
pub fn table<'py>(items: impl IntoIterator<Item = (String, Bound<'py, PyAny>)>) -> PyResult<Table> {
    let given = items.into_iter().filter(|(_, item)| !item.is_none());
    given.map(|(key, item)| Ok((key, value(&item)?))).collect()
}

/// Names and values.
pub type Items<'py> = Vec<(String, Bound<'py, PyAny>)>;

/// Names and values of a dictionary or a dataclass; none of anything else.
pub fn items<'py>(object: &Bound<'py, PyAny>) -> PyResult<Option<Items<'py>>> {
    if let Ok(dictionary) = object.cast::<PyDict>() {
        let item = |(key, item): (Bound<'py, PyAny>, _)| Ok((key.extract()?, item));
        return dictionary.iter().map(item).collect::<PyResult<_>>().map(Some);
    }
    let Some(fields) = object.getattr_opt("__dataclass_fields__")? else { return Ok(None) };
    let field = |key: Bound<'py, PyAny>| {
        let name: String = key.extract()?;
        let item = object.getattr(name.as_str())?;
        Ok((name, item))
    };
    fields.try_iter()?.map(|key| field(key?)).collect::<PyResult<_>>().map(Some)
}

/// Anything that the program writes as JSON, as dictionaries, lists, numbers and texts.
///
/// # Errors
/// [`Error`] for what JSON cannot hold.
pub fn python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let value = serde_json::to_value(value).map_err(|e| Error::new_err(e.to_string()))?;
    json(py, &value)
}

/// JSON, as dictionaries, lists, numbers and texts.
pub fn json<'py>(py: Python<'py>, value: &serde_json::Value) -> PyResult<Bound<'py, PyAny>> {
    use serde_json::Value as Json;
    Ok(match value {
        Json::Null => py.None().into_bound(py),
        Json::Bool(flag) => PyBool::new(py, *flag).to_owned().into_any(),
        Json::Number(number) => match (number.as_u64(), number.as_i64()) {
            (Some(count), _) => count.into_pyobject(py)?.into_any(),
            (_, Some(whole)) => whole.into_pyobject(py)?.into_any(),
            _ => number.as_f64().into_pyobject(py)?.into_any(),
        },
        Json::String(text) => PyString::new(py, text).into_any(),
        Json::Array(members) => {
            let members = members.iter().map(|member| json(py, member)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, members)?.into_any()
        }
        Json::Object(items) => {
            let dictionary = PyDict::new(py);
            items.iter().try_for_each(|(key, item)| dictionary.set_item(key, json(py, item)?))?;
            dictionary.into_any()
        }
    })
}

/// What pickle makes an object from: a callable and its arguments.
pub type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);
