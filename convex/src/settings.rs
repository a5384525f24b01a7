//! Accuracy and iteration limit of the solver.

use crate::ProblemError;

/// Accuracy and limits. There is deliberately no time limit: a result must not depend on the machine's load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverSettings {
    /// Tolerance of the duality gap, of feasibility and of infeasibility certificates. Default 1e-8.
    pub tolerance: f64,
    /// Tolerance at which a result that the solver itself calls "almost" is still accepted, provided that
    /// its residuals, recomputed from the problem's data ([`crate::kkt`]), stay below it. Default 1e-6.
    pub accepted_tolerance: f64,
    /// Maximum number of interior-point iterations. Default 200.
    pub iteration_limit: u32,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self { tolerance: 1e-8, accepted_tolerance: 1e-6, iteration_limit: 200 }
    }
}

impl SolverSettings {
    /// Refuses settings with which no problem can be solved.
    pub(crate) fn check(&self) -> Result<(), ProblemError> {
        let tolerances = [("tolerance", self.tolerance), ("accepted_tolerance", self.accepted_tolerance)];
        for (name, value) in tolerances {
            if !(value > 0.0 && value < 1.0) {
                let wanted = "between 0 and 1";
                return Err(ProblemError::Setting { name, value, wanted });
            }
        }
        if self.iteration_limit == 0 {
            return Err(ProblemError::Setting { name: "iteration_limit", value: 0.0, wanted: "at least 1" });
        }
        Ok(())
    }
}
