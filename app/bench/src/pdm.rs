//! PDM-Closed, written from its paper (Dauner et al., *Parting with Misconceptions about Learning-based Vehicle Motion Planning*, 2023):
//! the winner of nuPlan's challenge of 2023, and the rule that learned planners are compared with.
//!
//! Proposals follow the route at three lateral offsets with the intelligent driver model at five shares of the wanted speed, behind others that
//! are forecast at constant velocity. Each is driven for 4 s by the bicycle, and scored like the challenge: multiplied by contact at fault
//! and leaving the road, and a weighted mean of progress (5), time to collision (5) and comfort (2). The best is driven. If even it
//! touches another within 2 s, the vehicle brakes as hard as it can. It knows no right of way.

use interplay_planners::drivers::idm;
use interplay_planners::prediction::{Prediction, steady_inputs};
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Agent, Drive, DriverKind, Input, Plan, PlanError, PlanTime, Scene, State, Trajectory};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shares of the wanted speed.
const SPEED_SHARES: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];
/// Lateral offsets from the middle of the route \[m\].
const OFFSETS_M: [f64; 3] = [-1.0, 0.0, 1.0];
/// Simulated time of a proposal \[s\].
const PROPOSAL_S: f64 = 4.0;
/// A contact sooner than this brakes \[s\].
const EMERGENCY_S: f64 = 2.0;
/// A contact sooner than this, at constant velocity from any moment of a proposal, counts against it \[s\].
const TIME_TO_COLLISION_S: f64 = 0.9;
/// Weights of progress, time to collision and comfort.
const WEIGHTS: [f64; 3] = [5.0, 5.0, 2.0];
/// Comfortable magnitudes of acceleration \[m/s²\] and of its change from stage to stage \[m/s³\].
const COMFORTABLE: [f64; 2] = [4.0, 8.0];
/// The point that the steering aims at is so far ahead in time \[s\], and at least so far \[m\].
const AIM: [f64; 2] = [0.8, 4.0];

/// PDM-Closed; it has no settings.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pdm {}

impl DriverKind for Pdm {
    fn kind(&self) -> &'static str {
        "pdm"
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

impl Drive for Pdm {
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let stages = (PROPOSAL_S / scene.step_s).round() as usize;
        let proposals = OFFSETS_M.iter().flat_map(|offset_m| SPEED_SHARES.map(|share| (*offset_m, share)));
        let driven: Vec<Proposal> =
            proposals.map(|(offset, share)| Proposal::new(scene, offset, share, stages)).collect();
        let farthest_m = driven.iter().filter(|one| one.safety > 0.0).map(|one| one.progress_m).fold(5.0, f64::max);
        let score = |one: &Proposal| one.score(farthest_m);
        // Of equal scores the first counts: the order is that of the list.
        let best = driven.iter().reduce(|best, one| if score(one) > score(best) { one } else { best });
        let Some(best) = best.filter(|best| best.contact_s.is_none_or(|contact_s| contact_s > EMERGENCY_S)) else {
            return Ok(plan_of(scene, steady_inputs(scene, scene.ego.limits.acceleration_min_mps2)));
        };
        let mut inputs = best.inputs.clone();
        inputs.resize(scene.horizon, Input { acceleration_mps2: 0.0, ..inputs.last().copied().unwrap_or_default() });
        Ok(plan_of(scene, inputs))
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(*self))
    }
}

fn plan_of(scene: &Scene, inputs: Vec<Input>) -> Plan {
    let mut states = Vec::new();
    scene.model().roll_out(&scene.ego.state, &inputs, &mut states);
    Plan { trajectory: Trajectory { states, inputs }, ..Plan::default() }
}

/// A proposal that was driven.
struct Proposal {
    inputs: Vec<Input>,
    progress_m: f64,
    /// When it first touches another \[s\].
    contact_s: Option<f64>,
    /// 0 for a contact at fault or leaving the road, otherwise 1.
    safety: f64,
    keeps_time_to_collision: bool,
    is_comfortable: bool,
}

impl Proposal {
    fn new(scene: &Scene, offset_m: f64, share: f64, stages: usize) -> Proposal {
        let (ego, step_s) = (&scene.ego, scene.step_s);
        let (mut state, mut last) = (ego.state, ego.previous_input);
        let begin_m = ego.along_m();
        let (mut along_m, mut contact_s) = (begin_m, None);
        let (mut at_fault, mut is_off, mut keeps_time_to_collision, mut is_comfortable) = (false, false, true, true);
        let mut inputs = Vec::with_capacity(stages);
        for stage in 0..stages {
            let (time_s, now) = (step_s * stage as f64, ego.route.locate(state.position(), Some(along_m)));
            along_m = now.along_m;
            let input = followed(scene, &state, [along_m, offset_m, share * wanted_mps(scene, along_m)], time_s, last);
            state = scene.model().step(&state, &input);
            is_comfortable &= input.acceleration_mps2.abs() < COMFORTABLE[0]
                && (stage == 0 || (input.acceleration_mps2 - last.acceleration_mps2).abs() < COMFORTABLE[1] * step_s);
            let later_s = time_s + step_s;
            if let Some(other) = scene.others.iter().find(|other| touches(ego, &state, other, later_s)) {
                at_fault |= contact_s.is_none() && state.speed_mps > 0.1 && is_ahead(&state, &forecast(other, later_s));
                contact_s = contact_s.or(Some(later_s));
            }
            let coasting = moved(&state, TIME_TO_COLLISION_S);
            keeps_time_to_collision &=
                !scene.others.iter().any(|other| touches(ego, &coasting, other, later_s + TIME_TO_COLLISION_S));
            is_off |= is_off_road(ego, &state, along_m);
            inputs.push(input);
            last = input;
        }
        let safety = if at_fault || is_off { 0.0 } else { 1.0 };
        let progress_m = ego.route.locate(state.position(), Some(along_m)).along_m - begin_m;
        Proposal { inputs, progress_m, contact_s, safety, keeps_time_to_collision, is_comfortable }
    }

    fn score(&self, farthest_m: f64) -> f64 {
        let parts = [
            (self.progress_m / farthest_m).clamp(0.0, 1.0),
            f64::from(self.keeps_time_to_collision),
            f64::from(self.is_comfortable),
        ];
        let weighted: f64 = WEIGHTS.iter().zip(parts).map(|(weight, part)| weight * part).sum();
        self.safety * weighted / WEIGHTS.iter().sum::<f64>()
    }
}

/// The speed that the vehicle wants at a place of its route \[m/s\].
fn wanted_mps(scene: &Scene, along_m: f64) -> f64 {
    let route = &scene.ego.route;
    let bounds = [route.permitted_speed_mps(along_m, 1.5), route.curve_speed_mps(along_m, 2.5, 1.5)];
    bounds.into_iter().flatten().fold(scene.goal.target.speed_mps, f64::min)
}

/// The input that follows the route at an offset, behind the nearest other on it.
fn followed(
    scene: &Scene,
    state: &State,
    [along_m, offset_m, wanted_mps]: [f64; 3],
    time_s: f64,
    last: Input,
) -> Input {
    let ego = &scene.ego;
    let ahead = |other: &Agent| {
        let place = ego.route.locate(forecast(other, time_s).position(), None);
        let near_m = 0.5 * (ego.body.width_m + other.body.width_m);
        let gap_m = place.along_m - along_m - ego.body.front_m - other.body.rear_m;
        let is_leader = place.along_m > along_m && (place.across_m - offset_m).abs() < near_m;
        let speed_mps = other.state.speed_mps * libm::cos(other.state.heading_rad - place.heading_rad);
        is_leader.then_some((gap_m.max(0.1), speed_mps.max(0.0)))
    };
    let leader = scene.others.iter().filter_map(ahead).min_by(|a, b| a.0.total_cmp(&b.0));
    let follows = idm::Settings::literature().acceleration_behind(state.speed_mps, wanted_mps, leader);
    let limits = &ego.limits;
    let acceleration_mps2 = follows.clamp(limits.acceleration_min_mps2, limits.acceleration_max_mps2);
    let [x_m, y_m] = ego.route.position(along_m + AIM[1].max(AIM[0] * state.speed_mps), offset_m);
    let (dx, dy) = (x_m - state.x_m, y_m - state.y_m);
    let angle_rad = libm::atan2(dy, dx) - state.heading_rad;
    let wanted_rad = libm::atan(2.0 * ego.body.wheelbase_m() * libm::sin(angle_rad) / libm::hypot(dx, dy).max(1.0));
    let most_rad = limits.steering_max_at_rad(&ego.body, state.speed_mps);
    let steering_rad =
        limits.steering_towards_rad(last.steering_rad, wanted_rad.clamp(-most_rad, most_rad), scene.step_s);
    Input { acceleration_mps2, steering_rad }
}

fn moved(state: &State, time_s: f64) -> State {
    let (sin, cos) = libm::sincos(state.heading_rad);
    let way_m = time_s * state.speed_mps;
    State { x_m: state.x_m + cos * way_m, y_m: state.y_m + sin * way_m, ..*state }
}

/// Another vehicle after a time at constant velocity.
fn forecast(other: &Agent, time_s: f64) -> State {
    moved(&other.state, time_s)
}

/// Whether the other is in the half before the vehicle, so that a contact is its own fault.
fn is_ahead(own: &State, other: &State) -> bool {
    let (sin, cos) = libm::sincos(own.heading_rad);
    cos * (other.x_m - own.x_m) + sin * (other.y_m - own.y_m) > 0.0
}

/// Whether footprints overlap: by the axes of both rectangles.
fn touches(ego: &Agent, own: &State, other: &Agent, time_s: f64) -> bool {
    let theirs = forecast(other, time_s);
    let reach_m = ego.body.front_m + ego.body.rear_m + other.body.front_m + other.body.rear_m;
    if libm::hypot(theirs.x_m - own.x_m, theirs.y_m - own.y_m) > reach_m {
        return false;
    }
    let corners = [ego.body.corners(own), other.body.corners(&theirs)];
    let headings_rad = [own.heading_rad, theirs.heading_rad];
    headings_rad.iter().flat_map(|heading_rad| [*heading_rad, heading_rad + std::f64::consts::FRAC_PI_2]).all(
        |axis_rad| {
            let (sin, cos) = libm::sincos(axis_rad);
            let spans = corners.map(|corners| {
                let along = corners.map(|[x_m, y_m]| cos * x_m + sin * y_m);
                [along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max)]
            });
            spans[0][0] <= spans[1][1] && spans[1][0] <= spans[0][1]
        },
    )
}

fn is_off_road(ego: &Agent, state: &State, near_m: f64) -> bool {
    ego.body.corners(state).into_iter().any(|corner| {
        let at = ego.route.locate(corner, Some(near_m));
        at.across_m > ego.route.left.value(at.along_m) + 0.1 || at.across_m < ego.route.right.value(at.along_m) - 0.1
    })
}
