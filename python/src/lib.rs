//! The engine of the Python package `bankshot`: what needs Rust, and no more. Everything that users
//! see is Python.

mod ask;
mod background;
mod columns;
mod commands;
mod errors;
mod simulate;

use pyo3::prelude::*;

/// The module `bankshot._engine`.
#[pymodule]
mod _engine {
    #[pymodule_export]
    use super::ask::ask;
    #[pymodule_export]
    use super::columns::{arrow_table, column_names};
    #[pymodule_export]
    use super::commands::{Command, main, text_with};
    #[pymodule_export]
    use super::errors::InputError;
    #[pymodule_export]
    use super::simulate::simulate;

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("OUTCOME_KINDS", super::simulate::outcome_kinds())
    }
}
