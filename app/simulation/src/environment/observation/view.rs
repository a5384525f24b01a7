//! Common parts of all views: spaces, inputs and scales.

use std::fmt;
use std::sync::Arc;

use interplay_planners::scene::driver_estimate::DriverEstimate;
use interplay_planners::{Agent, Body, Limits, Scene};

/// The space of a view: its shape, the names on its last axis, and its bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservationSpace {
    /// The view.
    pub kind: &'static str,
    /// Its shape; numbers follow one another with the last axis fastest.
    pub shape: Vec<usize>,
    /// The names of the entries on the last axis; empty if that axis is an index of steps or cells.
    pub names: Vec<String>,
    /// Lower bound of all numbers.
    pub low: f32,
    /// Upper bound of all numbers.
    pub high: f32,
}

impl ObservationSpace {
    /// Number of numbers of an observation.
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether an observation has no numbers.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A space with the bounds −1 and 1, or without bounds if it is not normalised.
    pub(super) fn normalised(kind: &'static str, shape: Vec<usize>, names: Vec<String>, is_normalised: bool) -> Self {
        let high = if is_normalised { 1.0 } else { f32::INFINITY };
        ObservationSpace { kind, shape, names, low: -high, high }
    }
}

pub(crate) struct Seen<'a> {
    pub scene: &'a Scene,
    /// Beliefs about the other drivers; empty unless a view shows them.
    pub beliefs: &'a [DriverEstimate],
}

/// Maximum number of vehicles of a view.
pub(super) const MOST_SEEN: usize = 64;

/// Scales of a vehicle's view: the values that become 1.
#[derive(Clone, Copy)]
pub(super) struct Scales {
    /// Scale of speeds: the agent's largest \[m/s\].
    pub speed_mps: f64,
    /// Scale of distances along the road: the agent's distance in five seconds of a real car at that speed \[m\].
    pub along_m: f64,
    /// Scale of distances across the road: three lanes of a real road \[m\].
    pub across_m: f64,
}

/// Range along the road, in time at the largest speed of a real car \[s\].
const SIGHT_S: f64 = 5.0;
/// Range across a real road \[m\].
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

/// The other vehicles, the nearest first; equally near ones in the scenario's order.
pub(super) fn nearest_first(scene: &Scene) -> Vec<&Agent> {
    let away = |other: &Agent| {
        let [x, y] = other.state.position();
        libm::hypot(x - scene.ego.state.x_m, y - scene.ego.state.y_m)
    };
    let mut others: Vec<&Agent> = scene.others.iter().collect();
    others.sort_by(|a, b| away(a).total_cmp(&away(b)));
    others
}

/// A value relative to a scale, clipped to −1 and 1.
pub(super) fn share(value: f64, scale: f64) -> f32 {
    (value / scale).clamp(-1.0, 1.0) as f32
}

pub(super) fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// A view of a scene that another crate provides.
pub trait ObservationKind: fmt::Debug + Send + Sync {
    /// The space of the view for a vehicle with a horizon.
    fn space(&self, horizon: usize) -> ObservationSpace;

    /// The fault of the settings, if there is one.
    fn fault(&self) -> Option<String> {
        None
    }

    /// Whether the view shows beliefs about the other drivers, which must then be inferred.
    fn shows_beliefs(&self) -> bool {
        false
    }

    /// Writes the view of a scene, as many numbers as its space has; `beliefs` is empty unless the view shows them.
    fn write(&self, scene: &Scene, beliefs: &[DriverEstimate], out: &mut [f32]);
}

/// A view of another crate among the views of an agent. It is stated only in code: settings read from a text do not name it.
#[derive(Clone, Debug)]
pub struct ForeignView(Arc<dyn ObservationKind>);

impl ForeignView {
    /// Wraps a view of another crate.
    pub fn new(view: impl ObservationKind + 'static) -> ForeignView {
        ForeignView(Arc::new(view))
    }

    pub(super) fn view(&self) -> &dyn ObservationKind {
        &*self.0
    }
}

/// A view equals only its own copies.
impl PartialEq for ForeignView {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
