//! The exception of a faulty input.

use pyo3::create_exception;
use pyo3::exceptions::PyValueError;

create_exception!(
    bankshot,
    InputError,
    PyValueError,
    "An input that cannot be used: the message has the place, the value and what is allowed."
);
