//! An observation of one's own: the time to the vehicle ahead.

// shown from here
use interplay_planners::Scene;
use interplay_planners::scene::driver_estimate::DriverEstimate;
use interplay_simulation::environment::{ObservationKind, ObservationSpace};

/// No time is longer than this \[s\].
const MAX_HEADWAY_S: f64 = 10.0;

/// The time headway to the vehicle ahead in the agent's lane, as a share of 10 s; 1 without one.
#[derive(Clone, Copy, Debug)]
pub struct Headway;

impl ObservationKind for Headway {
    fn space(&self, _: usize) -> ObservationSpace {
        ObservationSpace { kind: "Headway", shape: vec![1], names: vec!["headway".to_owned()], low: 0.0, high: 1.0 }
    }

    fn write(&self, scene: &Scene, _: &[DriverEstimate], out: &mut [f32]) {
        let ego = &scene.ego;
        let ahead = scene.others.iter().filter(|other| ego.shares_lane_with(other) && ego.lead_of(other) > 0.0);
        let gaps_m = ahead.map(|other| ego.lead_of(other) - ego.body.front_m - other.body.rear_m);
        let headway_s = gaps_m.fold(f64::INFINITY, f64::min).max(0.0) / ego.state.speed_mps.max(0.1);
        out.fill((headway_s / MAX_HEADWAY_S).min(1.0) as f32);
    }
}
// shown until here
