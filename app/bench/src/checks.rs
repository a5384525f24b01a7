//! Planners that a benchmark of interaction must rank low: one that waits for all others, one that waits for none, and one that keeps its
//! velocity. They know their route, and of the others only pose, speed and size.

use interplay_planners::drivers::idm;
use interplay_planners::prediction::{Prediction, steady_inputs};
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Agent, Drive, DriverKind, Plan, PlanError, PlanTime, Scene, Trajectory};
use interplay_scenarios::Registry;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::BenchError;

/// The registry with the three checks.
///
/// # Errors
/// If a word of them is taken.
pub fn with_checks(registry: &Registry) -> Result<Registry, BenchError> {
    let registry = registry.clone().with_driver::<Waiter>()?.with_driver::<Pusher>()?;
    Ok(registry.with_driver::<ConstantVelocity>()?)
}

/// How far the waiter looks ahead \[s\], in steps of \[s\].
const LOOKS_S: [f64; 2] = [8.0, 0.5];
/// What is further along the route does not matter \[m\].
const AHEAD_M: f64 = 60.0;
/// Free space beside a vehicle that is passed, and beside one that is waited for \[m\].
const BESIDE_M: [f64; 2] = [0.3, 1.5];
/// Lateral acceleration in curves, and braking before them \[m/s²\].
const IN_CURVES_MPS2: [f64; 2] = [2.0, 1.5];

/// Declares a check: its settings, which are none, its word, and its acceleration in a scene.
macro_rules! check {
    ($(#[$doc:meta])* $Kind:ident, $word:literal, $acceleration:path) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $Kind {}

        impl DriverKind for $Kind {
            fn kind(&self) -> &'static str {
                $word
            }

            fn driver(&self) -> Box<dyn Drive> {
                Box::new(*self)
            }

            fn prediction(&self) -> Option<Prediction> {
                Some(Prediction::ConstantVelocity)
            }

            fn plan_time(&self) -> PlanTime {
                PlanTime::SIMPLE
            }

            fn may_be_refused(&self) -> bool {
                false
            }

            fn is_vetoed(&self) -> bool {
                false
            }
        }

        impl Drive for $Kind {
            fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
                Ok(along_route(scene, $acceleration(scene)))
            }

            fn fork(&self) -> Option<Box<dyn Drive>> {
                Some(Box::new(*self))
            }
        }
    };
}

check!(
    /// Waits until no other can come near its route.
    Waiter,
    "waiter",
    waiting
);
check!(
    /// Follows the vehicle ahead, and gives way to no other.
    Pusher,
    "pusher",
    pushing
);
check!(
    /// Keeps its speed along its route, whatever happens.
    ConstantVelocity,
    "constant-velocity",
    keeping
);

/// The motion along the route with an acceleration.
fn along_route(scene: &Scene, acceleration_mps2: f64) -> Plan {
    let limits = &scene.ego.limits;
    let within = acceleration_mps2.clamp(limits.acceleration_min_mps2, limits.acceleration_max_mps2);
    let inputs = steady_inputs(scene, within);
    let mut states = Vec::new();
    scene.model().roll_out(&scene.ego.state, &inputs, &mut states);
    Plan { trajectory: Trajectory { states, inputs }, ..Plan::default() }
}

fn keeping(_: &Scene) -> f64 {
    0.0
}

fn pushing(scene: &Scene) -> f64 {
    following(scene, in_the_way(scene, 0.0, BESIDE_M[0]))
}

/// As if a vehicle stood wherever another may be on the route within the next seconds.
fn waiting(scene: &Scene) -> f64 {
    let steps = (LOOKS_S[0] / LOOKS_S[1]) as usize;
    let later = (0..=steps).map(|step| in_the_way(scene, LOOKS_S[1] * step as f64, BESIDE_M[1]));
    let nearest = later.flatten().min_by(|a, b| a.0.total_cmp(&b.0));
    following(scene, nearest.map(|(gap_m, _)| (gap_m, 0.0)))
}

/// The acceleration of the intelligent driver model behind a vehicle, given by its gap \[m\] and its speed \[m/s\].
fn following(scene: &Scene, ahead: Option<(f64, f64)>) -> f64 {
    let (ego, along_m) = (&scene.ego, scene.ego.along_m());
    let in_curves = ego.route.curve_speed_mps(along_m, IN_CURVES_MPS2[0], IN_CURVES_MPS2[1]);
    let permitted = ego.route.permitted_speed_mps(along_m, IN_CURVES_MPS2[1]);
    let bounds = [in_curves, permitted].into_iter().flatten();
    let wanted_mps = bounds.fold(scene.goal.target.speed_mps, f64::min);
    idm::Settings::literature().acceleration_behind(ego.state.speed_mps, wanted_mps, ahead)
}

/// The nearest other on the own route after a time at its present velocity: its gap \[m\] and its speed along the route \[m/s\]. Others
/// that are behind on the route now are left out.
fn in_the_way(scene: &Scene, after_s: f64, beside_m: f64) -> Option<(f64, f64)> {
    let (ego, own_m) = (&scene.ego, scene.ego.along_m());
    let gap = |other: &Agent| {
        let (sin, cos) = libm::sincos(other.state.heading_rad);
        let way_m = after_s * other.state.speed_mps;
        let near_m = 0.5 * (ego.body.width_m + other.body.width_m) + beside_m;
        let now = ego.route.locate(other.state.position(), None);
        if now.across_m.abs() < near_m && now.along_m < own_m {
            return None;
        }
        let place = ego.route.locate([other.state.x_m + cos * way_m, other.state.y_m + sin * way_m], None);
        let gap_m = place.along_m - own_m - ego.body.front_m - other.body.rear_m;
        let is_ahead = place.along_m > own_m && gap_m < AHEAD_M && place.across_m.abs() < near_m;
        let speed_mps = other.state.speed_mps * libm::cos(other.state.heading_rad - place.heading_rad);
        is_ahead.then_some((gap_m.max(0.0), speed_mps.max(0.0)))
    };
    scene.others.iter().filter_map(gap).min_by(|a, b| a.0.total_cmp(&b.0))
}
