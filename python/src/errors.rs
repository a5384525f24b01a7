//! The exceptions of the package, and the library errors that raise each of them.

use interplay_scenarios::LoadError;
use interplay_simulation::environment::EnvironmentError;
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    interplay,
    ScenarioError,
    PyValueError,
    "A scenario, a plan or a mapping is refused; it says where and why."
);
create_exception!(
    interplay,
    RunError,
    PyRuntimeError,
    "A run could not be finished, or a result could not be written."
);

/// Adds the exceptions to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    // An error without a place in a text has none of these attributes.
    for attribute in ["file", "line", "column", "key"] {
        py.get_type::<ScenarioError>().setattr(attribute, py.None())?;
    }
    py.get_type::<ScenarioError>().setattr("faults", Vec::<String>::new())?;
    module.add("ScenarioError", py.get_type::<ScenarioError>())?;
    module.add("RunError", py.get_type::<RunError>())
}

/// The exception for a refused scenario, with the place of each fault; its text is that of the command.
pub fn refused(error: LoadError) -> PyErr {
    let faults: Vec<(Option<String>, Option<(usize, usize)>, String, Option<String>)> = error
        .faults()
        .iter()
        .map(|fault| {
            let file = fault.file().map(str::to_owned);
            (file, fault.line_and_column(), fault.message().to_owned(), fault.hint().map(str::to_owned))
        })
        .collect();
    let keys: Vec<Option<String>> = error.faults().iter().map(|fault| fault.key().map(str::to_owned)).collect();
    let text = located(&error);
    Python::attach(|py| {
        let raised = ScenarioError::new_err(text);
        let value = raised.value(py);
        let (file, place, _, _) = faults.first().cloned().unwrap_or_default();
        let attributes = (|| {
            value.setattr("file", file)?;
            value.setattr("line", place.map(|(line, _)| line))?;
            value.setattr("column", place.map(|(_, column)| column))?;
            value.setattr("key", keys.first().cloned().flatten())?;
            value.setattr("faults", faults)
        })();
        attributes.err().unwrap_or(raised)
    })
}

/// The exception for a refusal that is known only as a text, which begins with file and line if they are known.
pub fn refused_text(text: &str) -> PyErr {
    Python::attach(|py| {
        let raised = ScenarioError::new_err(text.to_owned());
        let mut parts = text.splitn(3, ':');
        let place = parts.next().zip(parts.next().and_then(|line| line.parse::<usize>().ok()));
        let located = place.map_or(Ok(()), |(file, line)| {
            let value = raised.value(py);
            value.setattr("file", file).and_then(|()| value.setattr("line", line))
        });
        located.err().unwrap_or(raised)
    })
}

/// Every fault in a line of its own, with its place and what would work.
fn located(error: &LoadError) -> String {
    let line = |fault: &interplay_scenarios::Fault| {
        let place = match (fault.file(), fault.line_and_column()) {
            (Some(file), Some((line, column))) => format!("{file}:{line}:{column}: "),
            (Some(file), None) => format!("{file}: "),
            _ => String::new(),
        };
        let hint = fault.hint().map(|hint| format!(" ({hint})")).unwrap_or_default();
        format!("{place}{}{hint}", fault.message())
    };
    error.faults().iter().map(line).collect::<Vec<_>>().join("\n")
}

pub fn unfinished(error: interplay_simulation::run::RunError) -> PyErr {
    use interplay_simulation::run::RunError as Reason;
    let text = error.to_string();
    match error {
        Reason::NoVehicle { .. }
        | Reason::NotExternal { .. }
        | Reason::NotFinite { .. }
        | Reason::WrongPlan { .. }
        | Reason::WrongHeats { .. }
        | Reason::NoBuilding => PyValueError::new_err(text),
        _ => RunError::new_err(text),
    }
}

pub fn of_environment(error: EnvironmentError) -> PyErr {
    match error {
        EnvironmentError::Run(error) => unfinished(error),
        EnvironmentError::Over | EnvironmentError::OtherEpisode => RunError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}

/// The exception for a text that should be JSON but is not.
pub fn bad_json(what: &str, error: &serde_json::Error) -> PyErr {
    // The package made the text, so its lines and columns mean nothing to the caller.
    let message = error.to_string();
    let message = message.split(" at line ").next().unwrap_or_default();
    PyValueError::new_err(format!("{what}: {message}"))
}
