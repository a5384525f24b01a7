//! The plan of a vehicle that is driven from outside.

use interplay_planners::prediction::steadily_along;
use interplay_planners::traffic::applied_input;
use interplay_planners::{Input, Plan, PlanError, Scene, Trajectory};

use crate::state::components::HandedIn;

/// Makes a plan from the caller's input, after which the vehicle keeps its speed, or from the caller's whole plan.
///
/// # Errors
/// [`PlanError::BadInput`] if the caller gave no input.
pub fn plan(handed_in: HandedIn, scene: &Scene) -> Result<Plan, PlanError> {
    let trajectory = match handed_in {
        HandedIn::Input(input) => then_steadily(&input, scene),
        HandedIn::Plan(inputs) => followed(&inputs, scene),
        HandedIn::Awaited | HandedIn::NotExternal => {
            return Err(PlanError::BadInput("no input was handed in".to_owned()));
        }
    };
    Ok(Plan { trajectory, ..Plan::default() })
}

/// One step with an input, then constant speed along the road.
fn then_steadily(input: &Input, scene: &Scene) -> Trajectory {
    let ego = &scene.ego;
    let applied = applied_input(input, &ego.state, &ego.body, &ego.limits, scene.step_s);
    let next = scene.model().step(&ego.state, &applied);
    let later = steadily_along(&ego.route, &ego.body, &next, scene.horizon.saturating_sub(1), scene.step_s);
    Trajectory {
        states: [ego.state].into_iter().chain(later.states).collect(),
        inputs: [applied].into_iter().chain(later.inputs).collect(),
    }
}

/// The motion of a whole plan, each of its inputs within the limits.
fn followed(inputs: &[Input], scene: &Scene) -> Trajectory {
    let (ego, model) = (&scene.ego, scene.model());
    let mut states = vec![ego.state];
    let mut applied = Vec::with_capacity(inputs.len());
    for input in inputs {
        let state = states.last().copied().unwrap_or(ego.state);
        let input = applied_input(input, &state, &ego.body, &ego.limits, scene.step_s);
        states.push(model.step(&state, &input));
        applied.push(input);
    }
    Trajectory { states, inputs: applied }
}
