//! What a driver answers that reacts to what it sees now instead of planning: one input.
//!
//! Drivers after the intelligent driver model, scripts, records and pedestrians do not look ahead. Among people, who see no plan of theirs,
//! they are asked for an input alone, from their own state and the vehicles around them, and neither for a motion over a horizon nor for
//! its certificate. So their input does not depend on the horizon of the scenario.

use std::sync::Arc;

use crate::plan::diagnostic::Diagnostic;
use crate::{Agent, Bicycle, Input, Plan, PlanEvent, Trajectory};

/// The answer of a reactive driver.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reaction {
    /// The input that it wants to apply.
    pub input: Input,
    /// The lateral position on its route to which it drives, if it changes the lane \[m\].
    pub lateral_m: Option<f64>,
    /// The lane to which it begins to change.
    pub changes_to: Option<usize>,
    /// Numbers that explain the answer.
    pub diagnostics: [Option<Diagnostic>; 3],
    /// The plan of one step from which the input is, of a driver that answers with plans only.
    pub plan: Option<Arc<Plan>>,
}

impl Reaction {
    /// The first input of a plan.
    pub(crate) fn of(plan: Plan) -> Reaction {
        let input = plan.trajectory.inputs.first().copied().unwrap_or_default();
        Reaction { input, plan: Some(Arc::new(plan)), ..Reaction::default() }
    }

    /// The same as a plan of one step \[s\] of the vehicle, for reports and recordings.
    pub fn to_plan(&self, own: &Agent, step_s: f64) -> Arc<Plan> {
        if let Some(plan) = &self.plan {
            return Arc::clone(plan);
        }
        let next = Bicycle::new(&own.body, step_s).step(&own.state, &self.input);
        let trajectory = Trajectory { states: vec![own.state, next], inputs: vec![self.input] };
        let events = self.changes_to.map(|lane| PlanEvent::note(format!("changes to lane {lane}")));
        let diagnostics = self.diagnostics.iter().flatten().copied().collect();
        Arc::new(Plan { trajectory, diagnostics, events: events.into_iter().collect(), ..Plan::default() })
    }
}
