//! The settings table, for stubs and docstrings.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use strandline::{
    Scene,
    settings::{Group, Kind, Row, Table},
};

/// The sections of a scene: for each setting its name, type, sentence, allowed values, and those of its section.
#[pyfunction]
pub fn settings(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    rows(py, &Scene::TABLE)
}

fn rows<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyList>> {
    let described: Vec<_> = table.rows.iter().map(|row| described(py, row)).collect::<PyResult<_>>()?;
    PyList::new(py, described)
}

fn described<'py>(py: Python<'py>, row: &Row) -> PyResult<Bound<'py, PyDict>> {
    let of = PyDict::new(py);
    of.set_item("name", row.name)?;
    of.set_item("doc", row.sentence())?;
    let kind = match row.kind {
        Kind::Flag => "bool",
        Kind::Whole(1) => "int",
        Kind::Number(1) => "float",
        Kind::Whole(_) => "Sequence[int]",
        Kind::Number(_) => "Sequence[float]",
        Kind::NumberOr(_) => "float | str",
        Kind::Words(_) | Kind::Text(_) => "str",
        Kind::Group(_) => "section",
        Kind::List(_) => "list",
    };
    of.set_item("kind", kind)?;
    let (expected, inner) = match row.kind {
        Kind::Group(table) => (String::new(), Some(table)),
        Kind::List(items) => (row.limits(), Some(items.table())),
        _ => (row.expected(), None),
    };
    of.set_item("expected", expected)?;
    if let Some(table) = inner {
        of.set_item("about", table.about())?;
        of.set_item("rows", rows(py, table)?)?;
    }
    Ok(of)
}
