//! Remarks on keys that are allowed but probably not intended.

use std::fmt;

use crate::text::error::Fault;

/// The remarks on a loaded scenario. They do not distinguish scenarios: all are equal.
#[derive(Clone, Debug, Default)]
pub struct ScenarioRemarks(pub(crate) Vec<ScenarioRemark>);

/// A remark on a key that is allowed but probably not intended.
#[derive(Clone, Debug)]
pub struct ScenarioRemark(pub(crate) Fault);

impl PartialEq for ScenarioRemarks {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl ScenarioRemarks {
    /// The remarks, in the order of the checks.
    pub fn iter(&self) -> impl Iterator<Item = &ScenarioRemark> {
        self.0.iter()
    }
}

impl ScenarioRemark {
    /// The remark itself, as a diagnostic.
    pub fn fault(&self) -> &Fault {
        &self.0
    }
}

/// On one line: what, where, and what would work.
impl fmt::Display for ScenarioRemark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.message())?;
        match (self.0.file(), self.0.line_and_column()) {
            (Some(file), Some((line, _))) => write!(f, " ({file}:{line})")?,
            (Some(key), None) => write!(f, " ({key})")?,
            (None, _) => {}
        }
        if let Some(help) = self.0.hint() {
            write!(f, "; {help}")?;
        }
        Ok(())
    }
}
