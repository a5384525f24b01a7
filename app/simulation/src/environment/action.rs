//! Actions of an agent, as numbers, and their effect on its vehicle.

use interplay_planners::drivers::lanes::{RoadLanes, towards};
use interplay_planners::{Agent, Body, Input, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::state::components::HandedIn;

/// The kind of action of an agent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Action {
    /// Acceleration and steering, each from −1 to 1, relative to the strongest braking or acceleration and to the largest steering angle to
    /// the right or left.
    #[default]
    Continuous,
    /// One of five: 0 lane left, 1 idle, 2 lane right, 3 faster, 4 slower. The vehicle then steers to that lane and approaches that speed.
    DiscreteMeta,
    /// A whole plan, like those of our planners: acceleration and steering for every step of the horizon. The other vehicles know it.
    Plan,
}

/// The form of an action's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionSpace {
    /// Rows of acceleration and steering from −1 to 1, this many.
    Rows(usize),
    /// An integer below this number.
    OneOf(usize),
}

impl ActionSpace {
    /// Number of numbers of an action.
    pub fn len(self) -> usize {
        match self {
            ActionSpace::Rows(rows) => 2 * rows,
            ActionSpace::OneOf(_) => 1,
        }
    }

    /// Whether an action has no numbers.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// The fault of an action, if it has one.
    pub(super) fn fault(self, action: &[f32]) -> Option<String> {
        match self {
            _ if action.len() != self.len() => {
                Some(format!("has {} numbers, and {} are needed", action.len(), self.len()))
            }
            _ if !action.iter().all(|number| number.is_finite()) => Some("is not finite".to_owned()),
            ActionSpace::Rows(_) => None,
            ActionSpace::OneOf(count) => {
                let is_one = action[0].fract() == 0.0 && (0.0..count as f32).contains(&action[0]);
                (!is_one).then(|| format!("is {}, and is one of 0 to {}", action[0], count - 1))
            }
        }
    }
}

/// Default duration of a meta-action of a real car \[s\].
const META_S: f64 = 0.5;

impl Action {
    /// Number of plans from one decision of a vehicle to the next, with decisions at the stated interval \[s\] or at the default one.
    pub fn plans_per_decision(self, decision_s: Option<f64>, body: &Body, plan_s: f64) -> usize {
        let usual_s = match self {
            Action::DiscreteMeta => META_S * body.real_ratio().sqrt(),
            Action::Continuous | Action::Plan => plan_s,
        };
        (decision_s.unwrap_or(usual_s) / plan_s).round().max(1.0) as usize
    }

    /// The space of an action for a vehicle with a horizon.
    pub fn space(self, horizon: usize) -> ActionSpace {
        match self {
            Action::Continuous => ActionSpace::Rows(1),
            Action::DiscreteMeta => ActionSpace::OneOf(DiscreteMeta::COUNT),
            Action::Plan => ActionSpace::Rows(horizon),
        }
    }
}

/// A meta-action, numbered as in HighwayEnv.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiscreteMeta {
    /// Change to the left lane.
    LaneLeft,
    /// Keep lane and speed.
    Idle,
    /// Change to the right lane.
    LaneRight,
    /// Increase the desired speed by a step.
    Faster,
    /// Decrease the desired speed by a step.
    Slower,
}

impl DiscreteMeta {
    /// Number of meta-actions.
    pub const COUNT: usize = 5;

    /// All meta-actions, by number.
    pub const ALL: [DiscreteMeta; Self::COUNT] = [
        DiscreteMeta::LaneLeft,
        DiscreteMeta::Idle,
        DiscreteMeta::LaneRight,
        DiscreteMeta::Faster,
        DiscreteMeta::Slower,
    ];
}

/// A step of the desired speed, as a share of the goal's.
const SPEED_STEP: f64 = 0.25;

/// The target lane and speed after the meta-actions so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MetaTarget {
    /// Lateral position of the lane's centre on the route \[m\].
    pub lane_m: f64,
    pub speed_mps: f64,
}

impl MetaTarget {
    /// The current lane and speed of a vehicle.
    pub fn of(scene: &Scene) -> MetaTarget {
        let lanes = RoadLanes::of_road(scene, None);
        let now_m = scene.ego.route.across(scene.ego.state.position());
        MetaTarget { lane_m: lanes.centre_m(lanes.at(now_m)), speed_mps: scene.ego.state.speed_mps }
    }

    /// The lane and speed after a meta-action; `None` if it is impossible.
    pub fn after(self, action: DiscreteMeta, scene: &Scene) -> Option<MetaTarget> {
        let lanes = RoadLanes::of_road(scene, None);
        let now = lanes.at(self.lane_m);
        let lane = |lane: Option<usize>| {
            let lane = lane.filter(|lane| *lane < lanes.count())?;
            Some(MetaTarget { lane_m: lanes.centre_m(lane), ..self })
        };
        let (limits, wanted_mps) = (&scene.ego.limits, scene.goal.target.speed_mps);
        let step_mps = SPEED_STEP * if wanted_mps > 0.0 { wanted_mps } else { limits.speed_max_mps };
        let speed = |speed_mps: f64| {
            let speed_mps = speed_mps.max(limits.speed_min_mps).min(limits.speed_max_mps);
            (speed_mps != self.speed_mps).then_some(MetaTarget { speed_mps, ..self })
        };
        match action {
            DiscreteMeta::LaneLeft => lane(Some(now + 1)),
            DiscreteMeta::Idle => Some(self),
            DiscreteMeta::LaneRight => lane(now.checked_sub(1)),
            DiscreteMeta::Faster => speed(self.speed_mps + step_mps),
            DiscreteMeta::Slower => speed(self.speed_mps - step_mps),
        }
    }

    /// The input with which the vehicle approaches the target.
    pub fn input(self, scene: &Scene) -> Input {
        towards(scene, self.lane_m, self.speed_mps)
    }

    /// The meta-action nearest to a planned motion: a lane change if the motion ends in another lane, otherwise a change of speed.
    pub fn nearest(self, scene: &Scene, end: &interplay_planners::State) -> DiscreteMeta {
        let lanes = RoadLanes::of_road(scene, None);
        let [now, then] = [self.lane_m, scene.ego.route.across(end.position())].map(|across_m| lanes.at(across_m));
        let faster = |action| self.after(action, scene).map(|target| target.speed_mps);
        let nearer = |speed_mps: f64| (speed_mps - end.speed_mps).abs() < (self.speed_mps - end.speed_mps).abs();
        match then.cmp(&now) {
            std::cmp::Ordering::Greater => DiscreteMeta::LaneLeft,
            std::cmp::Ordering::Less => DiscreteMeta::LaneRight,
            std::cmp::Ordering::Equal if faster(DiscreteMeta::Faster).is_some_and(nearer) => DiscreteMeta::Faster,
            std::cmp::Ordering::Equal if faster(DiscreteMeta::Slower).is_some_and(nearer) => DiscreteMeta::Slower,
            std::cmp::Ordering::Equal => DiscreteMeta::Idle,
        }
    }
}

/// The input of a row of numbers, which are clipped to −1 and 1.
pub(super) fn input_of(row: &[f32], agent: &Agent) -> Input {
    let [acceleration, steering] = [row[0], row[1]].map(|number| f64::from(number).clamp(-1.0, 1.0));
    let limits = &agent.limits;
    let strongest_mps2 = limits.strongest_mps2(acceleration);
    Input { acceleration_mps2: acceleration * strongest_mps2, steering_rad: steering * limits.steering_max_rad }
}

/// The row of numbers of an input.
pub(super) fn row_of(input: &Input, agent: &Agent) -> [f32; 2] {
    let limits = &agent.limits;
    let acceleration = input.acceleration_mps2;
    [(acceleration / limits.strongest_mps2(acceleration)) as f32, (input.steering_rad / limits.steering_max_rad) as f32]
}

/// The input or plan of an action's numbers.
pub(super) fn handed_in(action: Action, numbers: &[f32], agent: &Agent) -> HandedIn {
    match action {
        Action::Plan => HandedIn::Plan(numbers.chunks_exact(2).map(|row| input_of(row, agent)).collect()),
        Action::Continuous | Action::DiscreteMeta => HandedIn::Input(input_of(numbers, agent)),
    }
}
