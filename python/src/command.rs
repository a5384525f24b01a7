//! The command of the package.

use std::ffi::OsString;

use interplay_scenarios::Registry;
use pyo3::prelude::*;

/// Does what the arguments of the command say, the first of which is its name, and returns the exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| interplay::exit_code(Registry::standard(), arguments))
}
