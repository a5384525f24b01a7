//! The human driver: model-predictive control with a safety weight.
//!
//! At each step the driver of the source minimises the sum of these terms over the inputs `u_0…u_{N−1}`, and of no others.
//!
//! ```text
//! tracking       Σ_{t=1…N} ‖x_t − x_des‖²_Q                            eq. 6.6
//! comfort        Σ_{t=0…N−1} ‖u_t − u_{t−1}‖²_R                        eq. 6.6
//! road edges     Σ 2·10³ (q + q²), q how far a corner is off the road    eq. 6.7, soft
//! stop line      Σ 2·10³ (q + q²), q how far the front is beyond it      while the driver must wait at a line
//! yielding       w Σ_{t=1…N} max(0, 1 − d²(p_t, q_t))²                 per vehicle that might cut in or cross
//! following      w_f Σ_{t=1…N} max(0, 1 − d²(p_t, l_t))²               the vehicle ahead in the same lane
//! firm wall      Σ_{t=1…N} 10³ (q + q²), q = max(0, 1 − d_f²(p_t, l_t))  the same vehicle
//! ```
//!
//! Inputs and speed have hard bounds (eq. 6.8). `p` is the driver's position.
//!
//! - **Yielding.** `w` is the safety weight; `q` is the other's position at constant velocity *with its present
//!   heading*, so that a nudge of the steering wheel is seen; `d` is the elliptical distance along the other's road.
//!   The hinge is sharp: a driver yields only to what threatens to enter its ellipse. Where roads cross the term stands
//!   twice, for the ellipse along the other's road and for the one along the driver's own. This is our choice: with one
//!   of them drivers and planners disagree about which vehicle is in the way of which. Vehicles behind in the same lane are ignored.
//! - **Following.** `l` is the *planned* position of the vehicle ahead: the driver knows its plan. The weight is
//!   `w_f = max(w, following_weight)`, whatever the style.
//! - **Firm wall.** `d_f` belongs to an ellipse 0.7 times as long and 4 times as wide, with the exact penalty of the
//!   planners' safety constraints. So the driver brakes for the vehicle ahead rather than run into it or swerve around
//!   it.
//!
//! So a tough driver is not one without safety terms. `w = 0` removes yielding only: a vehicle ahead in its lane makes
//! it brake, with knowledge of that vehicle's plan. The source only says that nice drivers have a higher safety weight
//! (section 6.5); it mentions neither following nor the wall, without which tough drivers run into vehicles that have merged.
//!
//! Going first and yielding are two homotopy classes, which the optimiser compares (`passing_orders`).
//!
//! On a network of lanes every driver keeps to the right of way, whatever its style (module `right_of_way`). While it must
//! wait at a line, its desired speed is at most that of a comfortable approach.
//!
//! A driver who knows comfort ([`ComfortLimits`](crate::ComfortLimits)), as people on real roads do, differs in what is around others
//! (module `clearance`): the ellipses of following and of the firm wall grow with the speed, an exact one keeps it from pulling into a
//! short gap, and oncoming vehicles are passed side by side. If it keeps the rules of the road, it passes what stands in its way (module
//! `obstacle`), beside an exact ellipse around the body.
//!
//! Drivers differ from this one by their settings:
//!
//! - A driver who **closes gaps** (`closing_mps`, module `gap_closing`) wants to be faster while a vehicle is about to cut
//!   in ahead.
//! - A driver who **reacts late** (`reaction_s`) sees all others as they were that long ago, continued to the present
//!   (module `past_observation`). Its own state is the present one. All terms use what it sees, those of the vehicle ahead too.
//! - A driver who **hesitates** (`hesitation_s`) decides only that often how it reacts to vehicles that might cut in or cross.
//!   Until the next decision it expects of them what it expected at the last one (module `past_observation`). Its plan is
//!   renewed at every step for its own state and for the vehicle ahead, which it watches all the time.
//! - A driver who **adapts to the flow** (`adapts_to_leaders`, `adapts_to_lane`, module `flow`) wants a speed between that of its goal
//!   and those of the vehicles in its lane.
//! - A driver of the style **`measured`** is a member of a population that is spread like recorded people (module `population`).
//! - A driver who **reads plans** (`prediction = "plan"`) yields to what others plan, before it shows in their motion.

pub mod diagnostics;
mod flow;
mod gap_closing;
mod past_observation;
mod population;
mod settings;

use std::sync::Arc;

pub use crate::problem::clearance::safety_weight_keeping;
pub use settings::{REACTION_S, Settings, Style};

use std::borrow::Cow;

use serde_json::{Map, Value as Json, json};

use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::prediction::steady_inputs;
use crate::problem::clearance::ellipses;
use crate::rules::obstacle::ObstacleMemory;
use crate::rules::right_of_way::ArrivalMemory;
use crate::scene::inferred_futures::InferredFutures;
use crate::scene::road_rules::Obstacle;
use crate::trajectory::terms::KeepOut;
use crate::trajectory::{Optimiser, Penalty, Problem, Robust, Term};
use crate::{Agent, Input, Plan, PlanError, PlanTime, SafetyEllipse, Scene, Trajectory};
use past_observation::{Decision, Perception};

/// The very first guess brakes with this share of the strongest braking.
const FIRST_BRAKING_RATIO: f64 = 0.3;
/// Length of the ellipse around the car ahead that is not entered while brakes can help, as a share of the safety ellipse. A
/// hinge alone does not exclude a collision where the wanted speed weighs more.
const LEADER_LENGTH_RATIO: f64 = 0.7;
/// Width of the same ellipse as a multiple of the safety ellipse: the driver stops behind rather than swerve into a lane where
/// it does not yield.
const LEADER_WIDTH_RATIO: f64 = 4.0;
/// How long the most patient driver follows a slow vehicle before it overtakes, for 1/10 scale cars \[s\]: 8 s of a real one.
const PATIENCE_S: f64 = 2.53;

/// A human driver with its last plan and what it remembers of the other vehicles.
#[derive(Clone, Debug)]
pub struct Human {
    settings: Settings,
    perception: Perception,
    decision: Decision,
    arrivals: ArrivalMemory,
    obstacles: ObstacleMemory,
    optimiser: Optimiser<Robust>,
    last: Option<Trajectory>,
}

impl Human {
    /// A driver who has not planned yet.
    pub fn new(settings: Settings) -> Self {
        let settings = settings.driven();
        let mut optimiser = Optimiser::receding_horizon(Robust::default()).searching(settings.passing_orders);
        // Discomfort begins without a slope, so that two classes often cost nearly the same; and small problems are solved soon.
        optimiser.tolerances.exploration_share = 0.0;
        Human {
            settings,
            perception: Perception::default(),
            decision: Decision::default(),
            arrivals: ArrivalMemory::default(),
            obstacles: ObstacleMemory::default(),
            optimiser,
            last: None,
        }
    }

    /// The same with a limit of the work of a descent, beyond which it hands out what it has come to.
    pub(crate) fn limited_to(mut self, work_limit: usize) -> Self {
        self.optimiser.tolerances.work_limit = work_limit;
        self
    }

    /// A driver of another safety weight who remembers the same.
    pub(crate) fn with_safety_weight(&self, safety_weight: f64) -> Human {
        let mut human = self.clone();
        human.settings = Settings { safety_weight: Some(safety_weight), style: None, ..self.settings };
        human
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "human"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Human::new(*self))
    }

    fn description(&self) -> String {
        format!("{}, {}", self.kind(), self.manner())
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime { alone_s: 0.27e-3, share_of_each_other: 0.09 }.searching(self.passing_orders)
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(self.prediction)
    }

    fn goes_first(&self) -> bool {
        true
    }

    fn reaction_s(&self) -> f64 {
        self.reaction_s
    }

    /// The more, the more safety weighs: nice drivers 6.9 s, normal 4 s and tough ones 0 s, of real cars.
    fn patience_s(&self) -> f64 {
        let weight = self.weight();
        PATIENCE_S * weight / (weight + Style::Normal.safety_weight())
    }

    /// A reaction of 0.6 s: people need 0.5 to 1.5 s.
    fn people_defaults(&self) -> Map<String, Json> {
        Map::from_iter([("reaction_s".to_owned(), json!(REACTION_S))])
    }
}

impl Drive for Human {
    /// Makes a plan for the scene as this driver sees it: late by its reaction time, and with the last decision while
    /// it hesitates.
    ///
    /// # Errors
    /// [`PlanError`] if none of the guesses leads to an optimum.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        // What is seen of motion is late already.
        let reaction_s = if scene.knowledge.is_of_motion() { 0.0 } else { self.settings.reaction_s };
        let seen = self.perception.perceive(scene, reaction_s);
        let expected = self.decision.hold(&seen, self.settings.hesitation_s);
        let mut wanted = Cow::Borrowed(seen.as_ref());
        let adapts = [self.settings.adapts_to_leaders, self.settings.adapts_to_lane];
        if let Some(speed_mps) = flow::adapted_speed_mps(&seen, adapts) {
            wanted.to_mut().goal.target.speed_mps = speed_mps;
        }
        if let Some(speed_mps) = gap_closing::hurried_speed_mps(&expected, self.settings.closing_mps) {
            wanted.to_mut().goal.target.speed_mps = speed_mps;
        }
        let was_passing = self.obstacles.passing().map(str::to_owned);
        let met = if wanted.ego.rules.are_kept {
            let manoeuvre = self.obstacles.judge(&wanted);
            manoeuvre.map(|manoeuvre| manoeuvre.laid_over(&mut wanted))
        } else {
            // Right of way is kept in any case.
            if let Some(line_m) = self.arrivals.stop_line_m(&wanted) {
                wanted.to_mut().ego.rules.stop_before(line_m);
            }
            None
        };
        if scene.knowledge.is_of_motion() {
            let minded = wanted.others.iter().filter(|other| is_minded(&wanted, met.as_ref(), other));
            let leader = wanted.ego.leader_among(minded);
            let followed = leader.and_then(|leader| wanted.followed(leader, self.settings.gap_share()));
            let followed = followed.or_else(|| wanted.before_lane_end());
            wanted.to_mut().ego.rules.follows = followed;
        }
        let scene = wanted.as_ref();
        let problem = pose(scene, &expected.others, met.as_ref(), &self.settings);
        let is_kept_back =
            |obstacle: &Obstacle| self.last.as_ref().is_some_and(|last| obstacle.keeps_back(scene, last));
        let start = match &met {
            Some((obstacle, true)) if was_passing.as_ref() != Some(&obstacle.name) || is_kept_back(obstacle) => {
                obstacle.guess(scene)
            }
            _ => guess(scene, self.last.as_ref()),
        };
        let optimum = self.optimiser.optimise_or_improve(&problem, &[start])?;
        let trajectory = optimum.trajectory(0);
        self.last = Some(trajectory.clone());
        Ok(Plan {
            trajectory,
            diagnostics: vec![diagnostics::SAFETY_WEIGHT.is(self.settings.weight())],
            problem: Some(Arc::new(problem)),
            statistics: optimum.statistics,
            ..Plan::default()
        })
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = settings_of::<Settings>(settings)?.driven();
        let optimiser = self.optimiser.clone().searching(settings.passing_orders);
        Some(Box::new(Human { settings, optimiser, ..self.clone() }))
    }
}

/// The problem that a driver poses who neither reacts late nor hesitates.
pub fn problem(scene: &Scene, settings: &Settings) -> Problem {
    pose(scene, &scene.others, None, settings)
}

/// The problem of a driver who sees `scene`, yields to the others as `expected`, in the order of the scene, and meets an obstacle, which
/// it passes or not.
fn pose(scene: &Scene, expected: &[Agent], met: Option<&(Obstacle, bool)>, settings: &Settings) -> Problem {
    let mut terms = scene.own_terms(0, &scene.goal);
    let others = scene.others.iter().zip(expected);
    let others: Vec<(&Agent, &Agent)> = others.filter(|(other, _)| is_minded(scene, met, other)).collect();
    let leader = scene.ego.leader_among(others.iter().map(|(other, _)| *other));
    // Behind a vehicle that is followed by its motion, a line keeps it back.
    let ellipses_around = leader.filter(|_| scene.ego.rules.follows.is_none());
    let followed = ellipses_around.map(|leader| followed(scene, leader, settings)).unwrap_or_default();
    let yielded_to = yielded_to(scene, leader, &others, settings);
    let beside = met.map(|(obstacle, _)| obstacle.keep_out(scene));
    terms.extend(followed.into_iter().chain(yielded_to).chain(beside).map(Term::KeepOut));
    let rules = &scene.ego.rules;
    let line =
        rules.stop_line_m.filter(|_| !rules.are_kept).map(|line_m| scene.ego.stop_line(0, vec![line_m; scene.horizon]));
    terms.extend(line.map(Term::StopLine));
    Problem { horizon: scene.horizon, participants: vec![scene.participant()], shared_steps: 0, terms }
}

/// Whether a driver minds another vehicle who meets an obstacle, which it passes or not. Oncoming vehicles are checked before passing is
/// allowed, and at every tick.
fn is_minded(scene: &Scene, met: Option<&(Obstacle, bool)>, other: &Agent) -> bool {
    // Before one that comes head-on, a line keeps the driver back; it does not pass it on its other side.
    scene.ego.rules.evades.as_ref() != Some(&other.name)
        && met.is_none_or(|(obstacle, is_passed)| {
            obstacle.name != other.name && !(*is_passed && scene.meets_in_its_lane(other))
        })
}

/// The starting guess of an optimisation: the last plan one step later, or before the first plan a little braking.
pub fn guess(scene: &Scene, last: Option<&Trajectory>) -> Vec<Input> {
    last.map_or_else(|| steadily(scene, -FIRST_BRAKING_RATIO), Trajectory::later_inputs)
}

/// Straight on with a share of the strongest acceleration, or of the strongest braking where it is negative.
fn steadily(scene: &Scene, share: f64) -> Vec<Input> {
    let limits = &scene.ego.limits;
    let bound = if share < 0.0 { -limits.acceleration_min_mps2 } else { limits.acceleration_max_mps2 };
    steady_inputs(scene, share * bound)
}

/// The vehicle ahead in the same lane: followed at a comfortable distance, and not entered while brakes can help.
fn followed(scene: &Scene, leader: &Agent, settings: &Settings) -> Vec<KeepOut> {
    let penalty = Penalty::hinge(settings.weight().max(settings.following_weight));
    let mut comfortable = scene.keep_out(&leader.prediction, &scene.ego.route, penalty);
    let SafetyEllipse { along_m, across_m } = scene.goal.safety;
    let axes_m = scene.following_axes_m(leader, settings.weight(), settings.time_gap_ratio);
    if let Some([along_m, _]) = axes_m {
        comfortable.ellipses = ellipses(SafetyEllipse { along_m, across_m }, &scene.ego.route, &comfortable.centres);
    }
    let firm_m = axes_m.map_or(LEADER_LENGTH_RATIO * along_m, |[_, firm_m]| firm_m);
    let ellipse = SafetyEllipse { along_m: firm_m, across_m: LEADER_WIDTH_RATIO * across_m };
    let firm = KeepOut {
        ellipses: ellipses(ellipse, &scene.ego.route, &comfortable.centres),
        penalty: Penalty::EXACT,
        ..comfortable.clone()
    };
    vec![comfortable, firm]
}

/// Those who might cut in or cross, where the driver expects them; `others` are pairs of a vehicle and what is expected of it.
fn yielded_to(scene: &Scene, leader: Option<&Agent>, others: &[(&Agent, &Agent)], settings: &Settings) -> Vec<KeepOut> {
    let (ego, weight) = (&scene.ego, settings.weight());
    // A driver that stays behind its leader cannot reach a vehicle beyond the leader.
    let is_beyond = |other: &Agent| {
        let follows = leader.filter(|_| ego.rules.follows.is_some());
        follows.is_some_and(|leader| ego.shares_lane_with(other) && ego.lead_of(other) > ego.lead_of(leader))
    };
    let leader = leader.map(|leader| &leader.name);
    let beside = others.iter().filter(|(other, _)| Some(&other.name) != leader);
    let mut keep_outs: Vec<KeepOut> =
        beside.filter_map(|(_, expected)| scene.lane_change_keep_out(expected, weight)).collect();
    let behind = |other: &&Agent| ego.shares_lane_with(other) && ego.lead_of(other) <= 0.0;
    let concerns = |other: &Agent| {
        !ego.is_waited_for_by(other)
            && ego.may_meet(other)
            && Some(&other.name) != leader
            && !behind(&other)
            && !is_beyond(other)
    };
    // A driver who yields to none still runs into no obstacle, and among people into no oncoming vehicle.
    let is_firm = |other: &Agent| {
        weight > 0.0 || other.is_obstacle || scene.knowledge.is_of_motion() && scene.meets_in_its_lane(other)
    };
    for (other, expected) in others.iter().filter(|(other, _)| is_firm(other) && concerns(other)) {
        let predicted = settings.prediction.predict(expected, scene.horizon, scene.step_s);
        if other.is_obstacle {
            keep_outs.push(scene.beside(other, Penalty::EXACT));
            continue;
        }
        if scene.meets_in_its_lane(other) {
            let expected = Agent { prediction: Arc::new(predicted), ..(*expected).clone() };
            if !scene.is_parted_by_lane_line(&expected) {
                keep_outs.push(scene.beside(&expected, Penalty::EXACT));
            }
            continue;
        }
        keep_outs.push(scene.room_for(other, &predicted, weight, Penalty::hinge(weight)));
        if ego.crosses(other) {
            keep_outs.push(scene.keep_out(&predicted, &ego.route, Penalty::hinge(weight)));
        }
    }
    keep_outs
}
