//! What a driver expects of the others who does not see them as they are now.
//!
//! A observation holds the others as they were at an earlier tick. *Continued* to the present, each vehicle has kept the
//! heading and the speed that it had then, and of its plan of then the part that is left is known, at its end at
//! constant velocity. Two kinds of memory hold observations:
//!
//! - [`Perception`]: a driver who reacts late sees the others as they were `reaction_s` ago. Before it has seen them
//!   that long, it sees them as they were at its first plan.
//! - [`Decision`]: a driver who hesitates expects of the others what it expected when it decided last, and decides anew
//!   every `hesitation_s`, for the first time with its first plan.
//!
//! Both times are rounded to ticks. At 0 nothing is remembered and the scene is used as it is.

use std::sync::Arc;

use std::borrow::Cow;
use std::collections::VecDeque;

use crate::prediction::steadily_along;
use crate::{Agent, Scene};

/// The others as they were at a tick.
#[derive(Clone, Debug)]
struct PastObservation {
    tick: usize,
    others: Vec<Agent>,
}

impl PastObservation {
    fn of(scene: &Scene) -> PastObservation {
        PastObservation { tick: scene.tick, others: scene.others.clone() }
    }

    /// How many ticks ago it was.
    fn age(&self, scene: &Scene) -> usize {
        scene.tick.saturating_sub(self.tick)
    }

    /// The others of `scene`, in its order, as this observation continues; a vehicle that is not in it is seen as it is.
    fn continued(&self, scene: &Scene) -> Vec<Agent> {
        let age = self.age(scene);
        let seen = |other: &Agent| {
            let then = self.others.iter().find(|then| then.name == other.name);
            then.map_or_else(|| other.clone(), |then| later(then, age, scene.step_s))
        };
        scene.others.iter().map(seen).collect()
    }
}

/// A vehicle some ticks later: its state at constant velocity, and what is left of its plan.
fn later(then: &Agent, ticks: usize, step_s: f64) -> Agent {
    let state = steadily_along(&then.route, &then.body, &then.state, ticks, step_s)
        .states
        .last()
        .copied()
        .unwrap_or(then.state);
    let mut prediction = (0..ticks).fold((*then.prediction).clone(), |plan, _| plan.shifted());
    if let Some(first) = prediction.states.first_mut() {
        *first = state;
    }
    Agent { state, prediction: Arc::new(prediction), ..then.clone() }
}

/// How many ticks a duration lasts.
fn ticks(duration_s: f64, step_s: f64) -> usize {
    (duration_s / step_s).round().max(0.0) as usize
}

/// What a driver sees who reacts late.
#[derive(Clone, Debug, Default)]
pub(super) struct Perception {
    /// From the one that is seen now to the latest.
    observations: VecDeque<PastObservation>,
}

impl Perception {
    /// The scene with the others as the driver sees them, `reaction_s` late.
    pub(super) fn perceive<'a>(&mut self, scene: &'a Scene, reaction_s: f64) -> Cow<'a, Scene> {
        let delay = ticks(reaction_s, scene.step_s);
        if delay == 0 {
            return Cow::Borrowed(scene);
        }
        self.observations.push_back(PastObservation::of(scene));
        while self.observations.get(1).is_some_and(|next| next.age(scene) >= delay) {
            self.observations.pop_front();
        }
        match self.observations.front() {
            Some(seen) => Cow::Owned(Scene { others: seen.continued(scene), ..scene.clone() }),
            None => Cow::Borrowed(scene),
        }
    }
}

/// What a driver expects who hesitates.
#[derive(Clone, Debug, Default)]
pub(super) struct Decision {
    basis: Option<PastObservation>,
}

impl Decision {
    /// The scene with the others as the driver expected them when it decided last, at most `hesitation_s` ago.
    pub(super) fn hold<'a>(&mut self, scene: &'a Scene, hesitation_s: f64) -> Cow<'a, Scene> {
        let pause = ticks(hesitation_s, scene.step_s);
        match &self.basis {
            _ if pause == 0 => Cow::Borrowed(scene),
            Some(basis) if basis.age(scene) < pause => {
                Cow::Owned(Scene { others: basis.continued(scene), ..scene.clone() })
            }
            _ => {
                self.basis = Some(PastObservation::of(scene));
                Cow::Borrowed(scene)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::State;
    use crate::fixture::{agent, scene};

    /// A scene at a tick with another vehicle that stands until tick 5 and has 1 m/s from then on.
    fn at(tick: usize) -> Scene {
        let moved_m = 0.1 * tick.saturating_sub(5) as f64;
        let other = Agent { name: "other".to_owned(), ..agent(moved_m, 0.5, 0.0, f64::from(u8::from(tick >= 5))) };
        Scene { tick, ..scene(agent(-1.0, 0.0, 0.0, 1.0), vec![other]) }
    }

    fn seen(scene: &Scene) -> State {
        scene.others[0].state
    }

    #[test]
    fn a_late_driver_sees_a_change_after_its_reaction_time_and_then_where_it_leads() {
        let mut perception = Perception::default();
        for tick in 0..20 {
            let scene = at(tick);
            let perceived = perception.perceive(&scene, 0.3);
            let expected = if tick < 8 { State { y_m: 0.5, ..State::default() } } else { seen(&scene) };
            assert!((seen(&perceived).x_m - expected.x_m).abs() < 1e-12, "tick {tick}");
            assert_eq!(seen(&perceived).speed_mps, expected.speed_mps, "tick {tick}");
            assert_eq!(perceived.others[0].prediction.states[0], seen(&perceived));
            assert_eq!(perceived.ego, scene.ego, "its own state is the present one");
        }
        assert_eq!(perception.observations.len(), 4, "older observations are forgotten");
    }

    #[test]
    fn of_a_late_plan_the_part_that_is_left_is_known() {
        let mut perception = Perception::default();
        let mut planned = at(0);
        for (t, state) in Arc::make_mut(&mut planned.others[0].prediction).states.iter_mut().enumerate() {
            state.y_m = 0.1 * t as f64;
        }
        perception.perceive(&planned, 0.4);
        for tick in 1..=4 {
            let scene = at(tick);
            let perceived = perception.perceive(&scene, 0.4);
            let left = &perceived.others[0].prediction;
            assert_eq!(left.states.len(), 31);
            for (t, state) in left.states.iter().enumerate().skip(1) {
                assert!((state.y_m - 0.1 * (t + tick) as f64).abs() < 1e-9, "tick {tick}, step {t}: {}", state.y_m);
            }
        }
    }

    #[test]
    fn a_hesitant_driver_expects_what_it_expected_until_it_decides_anew() {
        let mut decision = Decision::default();
        let speeds = (0..12).map(|tick| seen(&decision.hold(&at(tick), 0.4)).speed_mps);
        let expected = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(speeds.collect::<Vec<_>>(), expected, "it decides at ticks 0, 4 and 8");
    }

    #[test]
    fn without_delay_the_scene_is_passed_on() {
        for duration_s in [0.0, 0.04, -1.0, f64::NAN] {
            let scene = at(3);
            assert!(matches!(Perception::default().perceive(&scene, duration_s), Cow::Borrowed(_)));
            assert!(matches!(Decision::default().hold(&scene, duration_s), Cow::Borrowed(_)));
        }
    }

    #[test]
    fn a_vehicle_that_appears_later_is_seen_in_its_present_state() {
        let (mut perception, mut decision) = (Perception::default(), Decision::default());
        let alone = Scene { others: Vec::new(), ..at(0) };
        perception.perceive(&alone, 1.0);
        decision.hold(&alone, 1.0);
        assert_eq!(perception.perceive(&at(6), 1.0).others, at(6).others);
        assert_eq!(decision.hold(&at(6), 1.0).others, at(6).others);
    }
}
