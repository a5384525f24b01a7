//! Interplay in Python: the native half of the package `interplay`.
//!
//! Values other than numbers and arrays are passed as JSON, with the keys of the command's own `--json`; the package
//! converts them to objects. Every call that takes time lets other Python threads run.

mod arrays;
mod batch;
mod building;
mod command;
mod environment;
mod errors;
mod frames;
mod policy;
mod run;
mod scenario;
mod simulation;
mod sweep;
mod threads;

use pyo3::prelude::*;

/// The native half of the package `interplay`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    errors::register(module)?;
    module.add_class::<scenario::PyScenario>()?;
    module.add_class::<simulation::PySimulation>()?;
    module.add_class::<simulation::PySnapshot>()?;
    module.add_class::<environment::PyEnvironment>()?;
    module.add_class::<environment::PyPlanner>()?;
    module.add_class::<batch::PyBatch>()?;
    module.add_class::<policy::PyNetwork>()?;
    module.add_class::<run::PyRecordedRun>()?;
    module.add_function(wrap_pyfunction!(command::main, module)?)?;
    module.add_function(wrap_pyfunction!(scenario::list_scenarios, module)?)?;
    module.add_function(wrap_pyfunction!(scenario::scenario_names, module)?)?;
    module.add_function(wrap_pyfunction!(scenario::driver_kinds, module)?)?;
    module.add_function(wrap_pyfunction!(run::run, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::sweep, module)?)?;
    module.add_function(wrap_pyfunction!(building::identify, module)?)?;
    module.add_function(wrap_pyfunction!(policy::register_policy, module)?)?;
    module.add_function(wrap_pyfunction!(policy::remove_policy, module)?)?;
    Ok(())
}
