//! The command of the package.

use std::ffi::OsString;

use interplay_scenarios::Registry;
use pyo3::prelude::*;

/// Runs the command with these arguments, of which the first is its name, and returns the exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| interplay::exit_code(Registry::standard(), arguments))
}
