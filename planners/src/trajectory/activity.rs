//! Which constraints hold a plan back: at how many of its steps each kind is active.

use crate::diagnostic::{Diagnostic, STEPS_AT_EDGE, STEPS_AT_ELLIPSE, STEPS_AT_INPUT_BOUND, STEPS_AT_SPEED_BOUND};
use crate::trajectory::{Iterate, Participant, Problem};

/// A bound that is closer than this is active (in the unit of what it bounds; `d²` for ellipses).
const TOUCHING: f64 = 1e-4;

/// Numbers of steps at which constraints of one vehicle are active.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Activity {
    /// On the edge of an ellipse that must not be entered.
    pub safety: usize,
    /// A corner on the edge of the road.
    pub edge: usize,
    /// Acceleration or steering at a bound.
    pub input: usize,
    /// Speed at a bound.
    pub speed: usize,
}

impl Activity {
    /// The activity of one participant of a problem.
    pub(crate) fn of(problem: &Problem, iterate: &Iterate, participant: usize) -> Activity {
        let own = &problem.participants[participant];
        let mut activity = Activity::default();
        for t in 1..=problem.horizon {
            activity.safety += usize::from(touches_ellipse(problem, iterate, participant, t));
            let state = &iterate.states[participant][t];
            let mut corners = own.corridor.clearances(&own.body, state).into_iter();
            activity.edge += usize::from(corners.any(|corner| corner.value < TOUCHING));
            let [slowest, fastest] = own.speed_bounds(t);
            activity.speed += usize::from(at_bound(state.speed_mps, slowest, fastest));
            activity.input += usize::from(at_input_bound(own, iterate, participant, t - 1));
        }
        activity
    }

    /// The numbers as diagnostics.
    pub(crate) fn diagnostics(&self) -> [Diagnostic; 4] {
        [
            STEPS_AT_ELLIPSE.is(self.safety as f64),
            STEPS_AT_EDGE.is(self.edge as f64),
            STEPS_AT_INPUT_BOUND.is(self.input as f64),
            STEPS_AT_SPEED_BOUND.is(self.speed as f64),
        ]
    }
}

fn touches_ellipse(problem: &Problem, iterate: &Iterate, participant: usize, t: usize) -> bool {
    let position = |index: usize| iterate.states[index][t].position();
    let hard = problem.participants[participant].keep_outs.iter().filter(|keep_out| keep_out.penalty.linear > 0.0);
    let mut centres =
        hard.map(|out| out.ellipse.oriented(out.heading_rad).distance(position(participant), out.centres[t - 1]));
    let pairs = problem.separations.iter().filter(|pair| [pair.of, pair.from].contains(&participant));
    let mut pairs =
        pairs.map(|pair| pair.ellipse.oriented(pair.heading_rad).distance(position(pair.of), position(pair.from)));
    centres.any(|distance| distance.squared < 1.0 + TOUCHING) || pairs.any(|distance| distance.squared < 1.0 + TOUCHING)
}

fn at_input_bound(own: &Participant, iterate: &Iterate, participant: usize, k: usize) -> bool {
    let (input, limits) = (&iterate.inputs[participant][k], &own.limits);
    at_bound(input.acceleration_mps2, limits.acceleration_min_mps2, limits.acceleration_max_mps2)
        || at_bound(input.steering_rad, -limits.steering_max_rad, limits.steering_max_rad)
}

fn at_bound(value: f64, low: f64, high: f64) -> bool {
    value < low + TOUCHING || value > high - TOUCHING
}
