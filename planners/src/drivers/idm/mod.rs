//! The field's baseline of a human driver: the intelligent driver model along the road (`car_following`), and MOBIL for lane
//! changes (`mobil`).
//!
//! On a network it keeps to the right of way (module `right_of_way`): a line at which it must wait counts as a standing
//! vehicle. On straight roads that cross it ignores crossing vehicles.

mod car_following;
pub mod diagnostics;
mod mobil;
mod motion;
mod reacting;
mod settings;

pub use settings::{Mobil, Settings};

use std::borrow::Cow;

use serde_json::{Map, Value as Json, json};

use crate::drivers::drive::StandardReplacement;
use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::drivers::lanes::{RoadLanes, leader};
use crate::drivers::reaction::Reaction;
use crate::road::network::{ConflictKind, Precedence, RouteConflict};
use crate::rules::obstacle::ObstacleMemory;
use crate::rules::right_of_way::ArrivalMemory;
use crate::scene::Moment;
use crate::scene::inferred_futures::InferredFutures;
use crate::scene::relation::{Relation, is_on_strip};
use crate::scene::road_rules::Obstacle;
use crate::{Agent, Plan, PlanError, PlanEvent, PlanTime, Scene};
use diagnostics::{GAP, INCENTIVE, LANE};
use mobil::{Changing, LaneChoice, LanesOfScene};
use motion::Motion;

/// Free space beside what stands, for 1/10 scale cars \[m\].
const BESIDE_OBSTACLE_M: f64 = 0.02;

/// A driver that follows the intelligent driver model (IDM) and changes lanes by MOBIL.
#[derive(Clone, Debug)]
pub struct Idm {
    settings: Settings,
    /// Lateral position on its route of the centre of the lane it drives in or changes to \[m\]. On a network, lanes beside the
    /// route come and go, and with them the number of a lane.
    lane_centre_m: Option<f64>,
    arrivals: ArrivalMemory,
    obstacles: ObstacleMemory,
}

impl Idm {
    /// A driver who has not chosen a lane yet.
    pub fn new(settings: Settings) -> Self {
        Idm { settings, lane_centre_m: None, arrivals: ArrivalMemory::default(), obstacles: ObstacleMemory::default() }
    }

    /// The lane it is in: the chosen one, while that is near and it drives there. Where the plan that led there was refused, it does not.
    fn lane(&self, scene: &Scene, lanes: &RoadLanes) -> usize {
        let Agent { route, state, prediction, .. } = &scene.ego;
        let here_m = route.across(state.position());
        let nearest = lanes.at(here_m);
        let is_near = |lane: &usize| !route.is_in_network() || lane.abs_diff(nearest) <= 1;
        let end_m = prediction.states.last().map_or(here_m, |end| route.across(end.position()));
        let is_taken = |lane: &usize| {
            let from_m = |across_m: f64| (across_m - lanes.centre_m(*lane)).abs();
            *lane == nearest || !scene.knowledge.is_of_motion() || from_m(end_m) < from_m(here_m)
        };
        self.lane_centre_m.map(|centre_m| lanes.at(centre_m)).filter(is_near).filter(is_taken).unwrap_or(nearest)
    }
}

impl Idm {
    /// The lane it is in, and the one that it drives in or changes to. On a lane that ends it keeps to its route, which leaves that lane in
    /// the gap that the rules choose.
    fn choose_lane(&self, minded: &Scene, others: &[Agent], lanes: &RoadLanes) -> (usize, LaneChoice) {
        if is_on_ending_lane(&minded.ego) {
            let lane = lanes.at(0.0);
            return (lane, LaneChoice { lane, incentive_mps2: 0.0 });
        }
        let now = self.lane(minded, lanes);
        let seen = LanesOfScene { scene: minded, others, lanes };
        (now, mobil::choose(&Changing::of(minded), &self.settings, lanes, now, &seen))
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "idm"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Idm::new(*self))
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime::SIMPLE
    }

    /// The model changes lanes by its own rule, which knows no oncoming traffic.
    fn patience_s(&self) -> f64 {
        f64::INFINITY
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(self.prediction)
    }

    fn goes_first(&self) -> bool {
        true
    }

    fn can_be_asked(&self) -> bool {
        false
    }

    fn reacts(&self) -> bool {
        true
    }

    /// The values of the literature (Treiber, Hennecke and Helbing, 2000; for lane changes Kesting, Treiber and Helbing, 2007).
    fn people_defaults(&self) -> Map<String, Json> {
        let Settings { headway_s, gap_m, acceleration_mps2, braking_mps2, .. } = Settings::literature();
        Map::from_iter([
            ("headway_s".to_owned(), json!(headway_s)),
            ("gap_m".to_owned(), json!(gap_m)),
            ("acceleration_mps2".to_owned(), json!(acceleration_mps2)),
            ("braking_mps2".to_owned(), json!(braking_mps2)),
            ("mobil".to_owned(), json!({ "safe_braking_mps2": 2.0 })),
        ])
    }

    fn lane_defaults(&self, lane_width_m: f64) -> Map<String, Json> {
        Map::from_iter([("mobil".to_owned(), json!({ "lane_width_m": lane_width_m }))])
    }

    /// It follows and gives way by rules and weighs nothing, so it is a factor of its own.
    fn replacement_in_why(&self) -> Option<StandardReplacement> {
        Some(StandardReplacement { rank: 3, factor: "replacement by IDM" })
    }
}

impl Drive for Idm {
    /// Chooses a lane and makes a plan along it.
    ///
    /// # Errors
    /// Never.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let mut seen = Cow::Borrowed(scene);
        let was_passing = self.obstacles.passing().map(str::to_owned);
        let passed = if scene.ego.rules.are_kept {
            let manoeuvre = self.obstacles.judge(scene);
            let met = manoeuvre.map(|manoeuvre| manoeuvre.laid_over(&mut seen));
            met.filter(|(_, is_passed)| *is_passed).map(|(obstacle, _)| obstacle)
        } else {
            if let Some(line_m) = self.arrivals.stop_line_m(scene) {
                seen.to_mut().ego.rules.stop_before(line_m);
            }
            None
        };
        let whole = self.settings.prediction.applied_to(&along_the_road(scene)).into_owned();
        let is_in_the_way = |other: &Agent| !other.is_obstacle || is_on_path(&whole, other);
        let is_minded = |other: &&Agent| {
            is_in_the_way(other) && passed.as_ref().is_none_or(|row| !row.is_passed_with(&scene.ego, other))
        };
        let minded = with_others(&whole, is_minded);
        let lanes = RoadLanes::of_road(&minded, self.settings.mobil.lane_width_m);
        let (now, choice) = self.choose_lane(&minded, &scene.others, &lanes);
        self.lane_centre_m = Some(lanes.centre_m(choice.lane));
        let line_m = seen.ego.rules.stop_line_m;
        let from_to = [now, choice.lane];
        let joins = |other: &Agent| has_to_let_go_first(&minded.ego, other);
        let owed = minded.others.iter().any(joins).then(|| with_others(&minded, |other| !joins(other)));
        let motion = Motion {
            settings: &self.settings,
            own: &minded.ego,
            wanted_mps: minded.goal.target.speed_mps,
            step_s: minded.step_s,
            lanes,
            from_to,
            line_m,
            passed: passed.as_ref(),
        };
        let mut trajectory = motion.driven(&minded, owed.as_deref());
        // Who has begun to pass goes on unless it would touch.
        let spaces = |obstacle: &Obstacle| if was_passing.as_ref() == Some(&obstacle.name) { 0.0 } else { 1.0 };
        let is_touched = |obstacle: &&Obstacle| obstacle.is_touched_by(&whole, &trajectory, spaces(obstacle));
        if let Some(obstacle) = passed.as_ref().filter(is_touched) {
            let behind_m = obstacle.line_m(&whole);
            let line_m = Some(line_m.map_or(behind_m, |line_m: f64| line_m.min(behind_m)));
            trajectory = Motion { line_m, passed: None, ..motion }.driven(&whole, None);
        }
        let ahead = leader(&minded, &lanes, choice.lane, &minded.ego.state, 0);
        let mut diagnostics = vec![LANE.is(choice.lane as f64), INCENTIVE.is(choice.incentive_mps2)];
        diagnostics.extend(ahead.map(|leader| GAP.is(leader.gap_m)));
        let events = (choice.lane != now)
            .then(|| PlanEvent::note(format!("changes to lane {}", choice.lane)))
            .into_iter()
            .collect();
        Ok(Plan { trajectory, diagnostics, events, ..Plan::default() })
    }

    fn react(&mut self, moment: &Moment<'_>) -> Option<Reaction> {
        let (reaction, lane_m) = reacting::answer(&self.settings, self.lane_centre_m, moment)?;
        self.lane_centre_m = Some(lane_m);
        Some(reaction)
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = *settings_of::<Settings>(settings)?;
        Some(Box::new(Idm { settings, ..self.clone() }))
    }
}

/// Whether an obstacle reaches into the path of the planning vehicle, or so near that it would touch it.
fn is_on_path(scene: &Scene, obstacle: &Agent) -> bool {
    let ego = &scene.ego;
    let at_m = ego.route.across(obstacle.state.position());
    let reach_m = 0.5 * (ego.body.width_m + obstacle.body.width_m) + BESIDE_OBSTACLE_M * ego.body.scale;
    let paths_m = [ego.state.position(), scene.goal.target.position()].map(|place| ego.route.across(place));
    paths_m.iter().any(|path_m| (at_m - path_m).abs() < reach_m)
}

/// Whether a vehicle is on a lane that ends, and which its route leaves late.
fn is_on_ending_lane(ego: &Agent) -> bool {
    ego.route.leg(ego.along_m() - ego.body.rear_m).is_some_and(|leg| leg.is_left_late)
}

/// The scene with those others only that are on the same road; to a driver who knows comfort also those on it whose way joins the own
/// only ahead.
fn along_the_road(scene: &Scene) -> Cow<'_, Scene> {
    let ego = &scene.ego;
    let joins =
        |other: &Agent| matches!(ego.relation(other), Relation::Conflict(at) if at.kind == ConflictKind::Merging);
    let joins_ahead = |other: &Agent| ego.limits.comfort.is_some() && joins(other) && is_on_strip(ego, other);
    with_others(scene, |other| ego.relation(other) == Relation::Alongside || joins_ahead(other))
}

/// Whether another vehicle joins the way of one who goes first, and is not in its lane yet.
fn has_to_let_go_first(ego: &Agent, other: &Agent) -> bool {
    let joins = |at: &RouteConflict| at.kind == ConflictKind::Merging && at.precedence == Precedence::Own;
    ego.limits.comfort.is_some() && matches!(ego.relation(other), Relation::Conflict(at) if joins(at))
}

/// The scene with only those others for which a condition holds.
fn with_others(scene: &Scene, holds: impl Fn(&&Agent) -> bool) -> Cow<'_, Scene> {
    if scene.others.iter().all(|other| holds(&other)) {
        return Cow::Borrowed(scene);
    }
    let others = scene.others.iter().filter(&holds).cloned().collect();
    Cow::Owned(Scene { others, ego: scene.ego.clone(), ..*scene })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Corridor;
    use crate::fixture::{agent, scene};

    fn in_lanes(mut ego: Agent, others: Vec<Agent>, lane_m: f64, wanted_mps: f64) -> Scene {
        ego.route = Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end: None }.into();
        let mut scene = scene(ego, others);
        (scene.goal.target.y_m, scene.goal.target.speed_mps) = (lane_m, wanted_mps);
        scene
    }

    #[test]
    fn a_slow_leader_is_followed_and_a_standing_one_is_not_hit() {
        let leader = agent(1.2, 0.185, 0.0, 0.0);
        let mut scene = in_lanes(agent(0.0, 0.185, 0.0, 0.8), vec![leader], 0.185, 1.0);
        scene.horizon = 100;
        let plan = Idm::new(Settings::default()).plan(&scene, &InferredFutures::default()).expect("a plan");
        let end = plan.trajectory.states.last().expect("states");
        assert!(end.x_m + 0.4 < 1.2 && end.speed_mps < 0.05, "{end:?}");
    }

    #[test]
    fn the_goal_s_lane_is_taken_when_its_follower_is_far_and_not_when_it_is_near() {
        for (behind_m, lane) in [(-3.0, 1.0), (-0.7, 0.0)] {
            let follower = agent(behind_m, 0.555, 0.0, 1.2);
            let scene = in_lanes(agent(0.0, 0.185, 0.0, 1.0), vec![follower], 0.555, 1.0);
            let plan = Idm::new(Settings::default()).plan(&scene, &InferredFutures::default()).expect("a plan");
            assert_eq!(plan.value_of(&LANE), Some(lane), "follower at {behind_m}");
        }
    }

    #[test]
    fn a_slow_leader_is_overtaken_by_a_driver_without_a_lane_preference() {
        let leader = agent(0.9, 0.185, 0.0, 0.3);
        let scene = in_lanes(agent(0.0, 0.185, 0.0, 1.0), vec![leader], 0.185, 1.2);
        let lane = |bias_mps2: f64| {
            let mobil = Mobil { bias_mps2, ..Mobil::default() };
            Idm::new(Settings { mobil, ..Settings::default() })
                .plan(&scene, &InferredFutures::default())
                .expect("a plan")
                .value_of(&LANE)
        };
        assert_eq!((lane(0.0), lane(100.0)), (Some(1.0), Some(0.0)));
    }

    #[test]
    fn a_lane_that_ends_is_left_or_stopped_in() {
        // A vehicle stays beside it, so that it cannot leave.
        let beside = agent(0.0, 0.555, 0.0, 1.0);
        let mut scene = in_lanes(agent(0.0, 0.185, 0.0, 1.0), vec![beside], 0.555, 1.0);
        let end = Some(crate::LaneEnd { end_m: 3.5, height_m: 0.37, taper_m: 0.3 });
        scene.ego.route = Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end }.into();
        scene.horizon = 100;
        let plan = Idm::new(Settings::default()).plan(&scene, &InferredFutures::default()).expect("a plan");
        let end = plan.trajectory.states.last().expect("states");
        assert!(end.x_m + 0.21 < 2.6 && end.speed_mps < 0.05, "{end:?}");
    }
}
