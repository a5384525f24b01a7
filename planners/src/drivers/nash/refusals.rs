//! Who does not play: a vehicle that does nothing of what the equilibria expect of it.
//!
//! An equilibrium is a guess of what the others will do if they share the burden. A driver who does not is not a player but an obstacle
//! on its predicted way, and an ego that goes on to expect an answer from it runs into it. So what each player did since the last
//! equilibrium is compared with what that expected: the share of the expected change of its velocity that it made. After
//! several steps of less than [`PLAYING_SHARE`] in a row it does not play any more.

use std::collections::BTreeMap;

use crate::{Scene, State, Trajectory};

/// An equilibrium that expects a smaller change of velocity a second than this needs no player \[m/s²\].
const LEAST_ASKED_MPS2: f64 = 0.2;
/// A vehicle that makes a smaller share of the expected change of its velocity does not play.
const PLAYING_SHARE: f64 = 0.2;

/// How many steps in a row each vehicle has refused, by its name.
#[derive(Clone, Debug, Default)]
pub(super) struct Refusals(BTreeMap<String, usize>);

impl Refusals {
    /// Looks at what the others did since the last equilibrium, whose trajectories begin where they were then.
    pub(super) fn look(&mut self, scene: &Scene, last: &[(String, Trajectory)], patience_steps: usize) {
        for other in &scene.others {
            let expected = last.iter().find(|(name, _)| *name == other.name);
            let Some([before, then, ..]) = expected.map(|(_, trajectory)| trajectory.states.as_slice()) else {
                continue;
            };
            let count = self.0.entry(other.name.clone()).or_default();
            match share_made(before, then, &other.state, scene.step_s) {
                Some(share) if share < PLAYING_SHARE => *count += 1,
                Some(_) if *count < patience_steps => *count = 0,
                Some(_) | None => {}
            }
        }
    }

    /// Whether a vehicle has refused so often that it does not play.
    pub(super) fn plays(&self, name: &str, patience_steps: usize) -> bool {
        self.0.get(name).is_none_or(|count| *count < patience_steps)
    }
}

/// The share of an expected change of velocity that was made; none where next to nothing was expected.
fn share_made(before: &State, expected: &State, now: &State, step_s: f64) -> Option<f64> {
    let velocity = |state: &State| {
        let (sin, cos) = libm::sincos(state.heading_rad);
        [state.speed_mps * cos, state.speed_mps * sin]
    };
    let from = velocity(before);
    let change = |state: &State| {
        let [x, y] = velocity(state);
        [x - from[0], y - from[1]]
    };
    let (asked, made) = (change(expected), change(now));
    let asked_squared = asked[0] * asked[0] + asked[1] * asked[1];
    let is_asked = asked_squared > (LEAST_ASKED_MPS2 * step_s) * (LEAST_ASKED_MPS2 * step_s);
    is_asked.then(|| (asked[0] * made[0] + asked[1] * made[1]) / asked_squared)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(speed_mps: f64, heading_rad: f64) -> State {
        State { speed_mps, heading_rad, ..State::default() }
    }

    #[test]
    fn the_share_is_that_of_the_expected_change() {
        let share = |expected: State, now: State| share_made(&state(1.0, 0.0), &expected, &now, 0.1);
        assert_eq!(share(state(0.95, 0.0), state(1.0, 0.0)), Some(0.0));
        assert!((share(state(0.9, 0.0), state(0.95, 0.0)).expect("asked") - 0.5).abs() < 1e-12);
        assert!(share(state(0.9, 0.0), state(1.1, 0.0)).expect("asked") < -0.9, "it does the opposite");
        assert!(share(state(1.0, 0.1), state(1.0, 0.1)).expect("asked") > 0.99, "turning is a change, too");
        assert_eq!(share(state(0.99, 0.0), state(0.5, 0.0)), None, "nothing was asked");
    }
}
