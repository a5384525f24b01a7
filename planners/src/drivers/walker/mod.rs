//! A pedestrian, or a cyclist on a path: goes along its route, waits at the kerb, and sees cars.
//!
//! It walks at the speed of its goal, keeps a distance to the pedestrian ahead, and stops before the line that the rules of the road
//! give it. Besides, it looks at each vehicle whose way crosses its own ahead, whichever goes first there. With
//!
//! - `[t_in, t_out]` the time in which it would be in the crossing, walking on,
//! - `t_car` when the vehicle is there if it keeps its speed `v`, at a distance `d`,
//!
//! it goes if the vehicle comes `gap_s` after `t_out` or is past before `t_in`. Where it has the right of way it also goes if the
//! vehicle can stop before with a braking of `v²/2d` below what it trusts in. Otherwise it waits at the kerb. A pedestrian on the street
//! already goes on.

mod settings;

pub use settings::{Settings, WalkerStyle};

use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::prediction::Prediction;
use crate::prediction::steering::{admissible, roll_out, steer};
use crate::road::network::{ConflictKind, Precedence, RouteConflict};
use crate::rules::giving_way::{front_m, stopping_distance_m};
use crate::scene::inferred_futures::InferredFutures;
use crate::scene::trigger::TriggerMemory;
use crate::{Agent, Input, Plan, PlanError, PlanEvent, PlanTime, Scene};
use settings::Caution;

/// Largest share of its limits with which a pedestrian changes the speed.
const COMFORT_SHARE: f64 = 0.6;
/// Distance to the pedestrian ahead, for real people \[m\].
const DISTANCE_M: f64 = 0.8;
/// Vehicles that are further from the crossing in time are not looked at, for real ones \[s\].
const LOOK_S: f64 = 12.0;
/// Who is slower than this counts as standing, for real ones \[m/s\].
const STANDING_MPS: f64 = 0.3;

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "walker"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Walker { settings: self.clone(), trigger: TriggerMemory::default(), waits_for: None })
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime::SIMPLE
    }

    fn prediction(&self) -> Option<Prediction> {
        Some(Prediction::ConstantVelocity)
    }

    fn goes_first(&self) -> bool {
        true
    }

    fn is_vetoed(&self) -> bool {
        false
    }

    fn can_be_asked(&self) -> bool {
        false
    }

    fn can_take_wheel(&self) -> bool {
        false
    }

    /// The vehicle is a person on foot, who has no wheel.
    fn can_be_replaced(&self) -> bool {
        false
    }
}

/// A pedestrian.
#[derive(Clone, Debug)]
pub struct Walker {
    settings: Settings,
    trigger: TriggerMemory,
    /// For whom it waits at the kerb.
    waits_for: Option<String>,
}

impl Drive for Walker {
    /// Plans to walk on, or to stop before the kerb.
    ///
    /// # Errors
    /// Never.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let own = &scene.ego;
        let caution = self.settings.style.caution();
        let has_begun = self.settings.when.as_ref().is_none_or(|trigger| self.trigger.has_fired(trigger, scene));
        let danger = danger(scene, &caution);
        let line_m = danger.as_ref().map(|(line_m, _)| *line_m).into_iter().chain(own.rules.stop_line_m);
        let stands_at_m = if has_begun { line_m.reduce(f64::min) } else { Some(front_m(own)) };
        let room_m = stands_at_m.map(|line_m| line_m - front_m(own)).into_iter().chain(room_behind_m(scene));
        let room_m = room_m.reduce(f64::min);
        let begin_m = own.along_m();
        let across_m = own.route.across(scene.goal.target.position());
        let trajectory = roll_out(scene, |_, state| {
            let left_m = room_m.map(|room_m| room_m - (own.route.along(state.position()) - begin_m));
            Input {
                acceleration_mps2: admissible(
                    own,
                    state,
                    acceleration_mps2(scene, state.speed_mps, left_m),
                    scene.step_s,
                ),
                steering_rad: steer(own, state, across_m),
            }
        });
        let waits_for = danger.map(|(_, name)| name);
        let begins = waits_for.as_ref().filter(|name| self.waits_for.as_ref() != Some(name));
        let events = begins.map(|name| PlanEvent::note(format!("waits at the kerb for {name}"))).into_iter().collect();
        self.waits_for = waits_for;
        Ok(Plan { trajectory, events, ..Plan::default() })
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = settings_of::<Settings>(settings)?.clone();
        Some(Box::new(Walker { settings, ..self.clone() }))
    }
}

/// The acceleration towards the wanted speed, or such that the walker stands before some room has been used.
fn acceleration_mps2(scene: &Scene, speed_mps: f64, room_m: Option<f64>) -> f64 {
    let limits = &scene.ego.limits;
    let [softest, hardest] =
        [COMFORT_SHARE * limits.acceleration_max_mps2, -COMFORT_SHARE * limits.acceleration_min_mps2];
    let wanted_mps = room_m.map_or(scene.goal.target.speed_mps, |room_m| {
        // At this speed, braking in comfort from the next step on ends at the line.
        let reach_m = (room_m - 0.5 * scene.step_s * speed_mps).max(0.0);
        scene.goal.target.speed_mps.min((2.0 * hardest * reach_m).sqrt())
    });
    let needed = (wanted_mps - speed_mps) / scene.step_s;
    needed.clamp(2.0 * -hardest, softest)
}

/// The room to the pedestrian ahead on the same path \[m\].
fn room_behind_m(scene: &Scene) -> Option<f64> {
    let own = &scene.ego;
    let ahead = scene.others.iter().filter(|other| own.shares_lane_with(other) && own.lead_of(other) > 0.0);
    let distance_m = DISTANCE_M * own.body.real_ratio();
    let room = ahead.map(|other| own.lead_of(other) - own.body.front_m - other.body.rear_m - distance_m);
    room.reduce(f64::min).map(|room_m| room_m.max(0.0))
}

/// The nearest kerb at which the walker has to wait \[m\], and the vehicle that it waits for.
fn danger(scene: &Scene, caution: &Caution) -> Option<(f64, String)> {
    let own = &scene.ego;
    let dangers = scene.others.iter().flat_map(|other| {
        let crossings = own.route.conflicts_with(&other.route);
        let crossings = crossings.filter(|at| matches!(at.kind, ConflictKind::Crossing));
        crossings.filter(|at| is_dangerous(scene, other, at, caution)).map(|at| {
            let before_m = stopping_distance_m(own).min(own.body.front_m);
            (at.own_line_m.min(at.own_m[0]) - before_m, other.name.clone())
        })
    });
    dangers.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Whether the walker should not step into a crossing now, since a vehicle comes.
fn is_dangerous(scene: &Scene, other: &Agent, at: &RouteConflict, caution: &Caution) -> bool {
    let own = &scene.ego;
    let times = own.body.real_ratio().sqrt();
    let (own_front_m, their_front_m) = (front_m(own), front_m(other));
    let length_m = other.body.front_m + other.body.rear_m;
    let is_on_street = own_front_m > at.own_m[0].max(at.own_line_m);
    let is_past = their_front_m - length_m > at.their_m[1];
    if is_on_street || is_past {
        return false;
    }
    let (way_m, speed_mps) = (at.their_m[0] - their_front_m, other.state.speed_mps);
    if way_m > 0.0 && speed_mps < STANDING_MPS * times {
        return false;
    }
    let walks_mps = scene.goal.target.speed_mps.max(own.state.speed_mps).max(0.1 * times);
    let in_s = (at.own_m[0] - own_front_m).max(0.0) / walks_mps;
    let out_s = (at.own_m[1] + own.body.rear_m - own_front_m).max(0.0) / walks_mps;
    let [comes_s, leaves_s] = if way_m <= 0.0 {
        [0.0, (at.their_m[1] + length_m - their_front_m).max(0.0) / speed_mps.max(0.1 * times)]
    } else {
        [way_m, at.their_m[1] - their_front_m + length_m].map(|way_m| way_m / speed_mps)
    };
    if comes_s > out_s + caution.gap_s * times || leaves_s < in_s || comes_s > LOOK_S * times {
        return false;
    }
    let trusts = at.precedence == Precedence::Own && way_m > 0.0;
    !(trusts && speed_mps * speed_mps / (2.0 * way_m) < caution.trusted_braking_mps2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, scene};

    #[test]
    fn it_walks_at_its_speed_and_stops_behind_another_pedestrian() {
        let plan = |others: Vec<Agent>| {
            let mut scene = scene(agent(0.0, 0.185, 0.0, 0.4), others);
            scene.goal.target.speed_mps = 0.4;
            Settings::default().driver().plan(&scene, &InferredFutures::default()).expect("a plan").trajectory
        };
        let free = plan(Vec::new());
        assert!(free.states.iter().all(|state| (state.speed_mps - 0.4).abs() < 1e-9));
        let ahead = agent(0.9, 0.185, 0.0, 0.0);
        let end = *plan(vec![ahead.clone()]).states.last().expect("states");
        assert!(end.speed_mps < 0.05 && end.x_m + 0.21 < 0.9 - ahead.body.rear_m, "{end:?}");
    }
}
