//! `mrbd` from Python: the rooms of the program under the names of its files.
//!
//! Nothing is computed here. Each function turns what Python gives into values of the library, calls it with the
//! interpreter released, and hands arrays and tables on without copies. What is drawn by matplotlib, and other plain
//! Python, stands in `python/mrbd/`.

mod asked;
mod command;
mod errors;
mod fragility;
mod laboratory;
mod many;
mod record;
mod rows;
mod run;
mod study;
mod suites;
mod table;
mod values;
mod wall;
mod work;

use pyo3::prelude::*;

/// The extension module; `mrbd/__init__.py` passes its names on.
#[pymodule]
mod _mrbd {
    #[pymodule_export]
    use super::asked::ask;
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::errors::{Error, InputError, Interrupted, Question};
    #[pymodule_export]
    use super::fragility::fit_fragility;
    #[pymodule_export]
    use super::laboratory::{run_calibration, run_diagnosis};
    #[pymodule_export]
    use super::many::simulate_many;
    #[pymodule_export]
    use super::record::Record;
    #[pymodule_export]
    use super::run::{Run, simulate};
    #[pymodule_export]
    use super::study::{read_parquet, read_runs, run_study, write_page, write_parquet};
    #[pymodule_export]
    use super::suites::{generate_suite, read_suite, select_suite};
    #[pymodule_export]
    use super::table::Table;
    #[pymodule_export]
    use super::wall::{Wall, effects};
}
