//! What all views have in common: their spaces, what they are made of, and by what numbers are divided.

use interplay_planners::scene::driver_estimate::DriverEstimate;
use interplay_planners::{Agent, Body, Limits, Scene};

/// The numbers of a view: its shape, what its last axis is called, and between which values they lie.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservationSpace {
    /// The view.
    pub kind: &'static str,
    /// Its shape; numbers follow one another with the last axis fastest.
    pub shape: Vec<usize>,
    /// What the entries of the last axis are; empty where that is a number of a step or cell.
    pub names: Vec<String>,
    /// No number is below it.
    pub low: f32,
    /// No number is above it.
    pub high: f32,
}

impl ObservationSpace {
    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Numbers from −1 to 1, or any where they are not normalised.
    pub(super) fn normalised(kind: &'static str, shape: Vec<usize>, names: Vec<String>, is_normalised: bool) -> Self {
        let high = if is_normalised { 1.0 } else { f32::INFINITY };
        ObservationSpace { kind, shape, names, low: -high, high }
    }
}

/// What a view is made of.
pub(crate) struct Seen<'a> {
    pub scene: &'a Scene,
    /// What is believed of the others; empty unless a view shows it.
    pub beliefs: &'a [DriverEstimate],
}

/// Most vehicles of a view.
pub(super) const MOST_SEEN: usize = 64;

/// What numbers of a vehicle's view are divided by: what is 1 afterwards.
#[derive(Clone, Copy)]
pub(super) struct Scales {
    /// Speeds: the agent's largest \[m/s\].
    pub speed_mps: f64,
    /// Distances along the road: what it drives in five seconds of a real car at that speed \[m\].
    pub along_m: f64,
    /// Distances across the road: three lanes of a real road \[m\].
    pub across_m: f64,
}

/// Distances along the road that are seen, in time at the largest speed of a real car \[s\].
const SIGHT_S: f64 = 5.0;
/// Distances across a real road that are seen \[m\].
const ACROSS_M: f64 = 11.1;

impl Scales {
    pub fn of(body: &Body, limits: &Limits) -> Scales {
        let speed_mps = limits.speed_max_mps;
        let real = body.real_ratio();
        Scales { speed_mps, along_m: SIGHT_S * real.sqrt() * speed_mps, across_m: ACROSS_M * real }
    }

    pub fn of_ego(scene: &Scene) -> Scales {
        Scales::of(&scene.ego.body, &scene.ego.limits)
    }
}

/// The others, the nearest first; equally near ones as the scenario has them.
pub(super) fn nearest_first(scene: &Scene) -> Vec<&Agent> {
    let away = |other: &Agent| {
        let [x, y] = other.state.position();
        libm::hypot(x - scene.ego.state.x_m, y - scene.ego.state.y_m)
    };
    let mut others: Vec<&Agent> = scene.others.iter().collect();
    others.sort_by(|a, b| away(a).total_cmp(&away(b)));
    others
}

/// A number that is 1 at a scale, cut off there.
pub(super) fn share(value: f64, scale: f64) -> f32 {
    (value / scale).clamp(-1.0, 1.0) as f32
}

pub(super) fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}
