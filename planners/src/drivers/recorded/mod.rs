//! A driver who does what a vehicle did that was recorded, whatever happens around it.
//!
//! The record gives pose and speed at times. Who moves the vehicles puts this one where its record says
//! ([`DriverKind::record`]); its inputs are those that the bicycle would need for that. No other driver knows where it will be: its plan
//! is to keep its speed along its road, and so are the predictions of the others. With `plans_record` its plan is its record, which who
//! knows its plan then knows.
//!
//! Where the record ends, the vehicle keeps its speed and its place in its lane; or another driver takes over before, with
//! `hands_over`.

mod hand_over;

pub use hand_over::{HandOver, HandOverTime, Successor};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::plan::{PlanEvent, PlanEventKind};
use crate::prediction::steering::steer;
use crate::prediction::{Prediction, steadily_along};
use crate::scene::inferred_futures::InferredFutures;
pub use crate::scene::record::{Record, RecordFault, next_to};
use crate::scene::road_rules::RuleKeeping;
use crate::{DriverSettingError, Input, Plan, PlanError, PlanTime, Scene, Trajectory};

/// The settings of a recorded driver: what was recorded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// A table with the record, as CSV with the columns `time_s,x_m,y_m,heading_rad,speed_mps`, of the mass centre in world
    /// coordinates, and `id` where the table has the records of several vehicles.
    #[schemars(length(min = 1), example = &"traffic.csv", extend("x-excludes" = ["points"]))]
    pub file: Option<String>,
    /// Which of the vehicles of the table it is, by the column `id`.
    #[schemars(example = &"car-7", extend("x-excludes" = ["points"]))]
    pub id: Option<String>,
    /// The record itself, in place of a table: rows of time \[s\], x and y \[m\], heading \[rad\] and speed \[m/s\].
    #[schemars(length(max = 100_000), example = vec![[0.0, 12.0, 1.75, 0.0, 8.0], [1.0, 20.0, 1.75, 0.0, 8.0]])]
    pub points: Vec<[f64; 5]>,
    /// Whether its plan is its record: then a driver who knows its plan knows where it will be, as planners of CommonRoad do. Otherwise its plan
    /// is to keep its speed.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    #[schemars(example = true)]
    pub plans_record: bool,
    /// The driver that takes over from the record, and when; by default none does.
    #[schemars(example = json!({ "to": "human", "when": "disturbed" }))]
    pub hands_over: Option<HandOver>,
}

impl Settings {
    /// A vehicle that stands at a place: x and y \[m\], heading \[rad\].
    pub fn standing([x_m, y_m, heading_rad]: [f64; 3]) -> Settings {
        Settings { points: vec![[0.0, x_m, y_m, heading_rad, 0.0]], ..Settings::default() }
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "recorded"
    }

    fn driver(&self) -> Box<dyn Drive> {
        let Settings { hands_over, plans_record, .. } = self.clone();
        Box::new(Recorded { record: self.record(), plans_record, hands_over, successor: None })
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime::SIMPLE
    }

    fn prediction(&self) -> Option<Prediction> {
        None
    }

    fn goes_first(&self) -> bool {
        true
    }

    /// The driver that takes over may plan ahead.
    fn reacts(&self) -> bool {
        self.hands_over.is_none()
    }

    fn can_be_asked(&self) -> bool {
        false
    }

    fn can_take_wheel(&self) -> bool {
        false
    }

    /// A record is judged by no rule.
    fn people_rules(&self) -> RuleKeeping {
        RuleKeeping::Ignored
    }

    fn record(&self) -> Option<Record> {
        Record::new(&self.points).ok()
    }

    fn check(&self, _: usize) -> Result<(), DriverSettingError> {
        let refused = |message: String| {
            let remedy = "state rows of time, x, y, heading and speed, each later than the one before it, or a `file`";
            Err(DriverSettingError::Unfit { key: "points", reason: message, remedy: remedy.to_owned() })
        };
        if self.hands_over.as_ref().is_some_and(|hands_over| !hands_over.is_sound()) {
            let remedy = "`when` is a time in seconds, or `\"disturbed\"`".to_owned();
            let reason = "says with an unknown word when it hands over".to_owned();
            return Err(DriverSettingError::Unfit { key: "hands_over", reason, remedy });
        }
        match Record::new(&self.points) {
            Ok(_) => Ok(()),
            Err(RecordFault::Empty) => refused("is empty: nothing says where the vehicle was".to_owned()),
            Err(RecordFault::NotFinite { row }) => refused(format!("has a number that is not finite in row {row}")),
            Err(RecordFault::NotLater { row }) => refused(format!("goes back in time in row {row}")),
        }
    }
}

/// A driver that follows a record.
#[derive(Debug)]
pub struct Recorded {
    record: Option<Record>,
    plans_record: bool,
    hands_over: Option<HandOver>,
    /// Who has taken over.
    successor: Option<Box<dyn Drive>>,
}

impl Drive for Recorded {
    /// Plans to keep the speed along the road. The first input leads to where the record goes on. Once another driver has taken over, plans
    /// as that driver does.
    ///
    /// # Errors
    /// Those of the driver who has taken over.
    fn plan(&mut self, scene: &Scene, inferred_futures: &InferredFutures) -> Result<Plan, PlanError> {
        if let Some(successor) = &mut self.successor {
            return successor.plan(&wanting(scene, self.record.as_ref()), inferred_futures);
        }
        let due = self.hands_over.as_ref().zip(self.record.as_ref());
        if let Some((hands_over, reason)) = due.and_then(|(to, record)| Some((to, to.is_due(record, scene)?))) {
            let successor = self.successor.insert(hands_over.driver(scene));
            let mut plan = successor.plan(&wanting(scene, self.record.as_ref()), inferred_futures)?;
            let text = format!("drives itself from now on, not after its record: {reason}");
            plan.events.push(PlanEvent { kind: PlanEventKind::LeavesRecord, text });
            return Ok(plan);
        }
        let own = &scene.ego;
        if let Some(record) = self.record.as_ref().filter(|_| self.plans_record) {
            let mut trajectory = record.onwards(scene);
            trajectory.inputs.first_mut().into_iter().for_each(|first| *first = self.input(scene));
            return Ok(Plan { trajectory, ..Plan::default() });
        }
        let Trajectory { states, mut inputs } =
            steadily_along(&own.route, &own.body, &own.state, scene.horizon, scene.step_s);
        if let Some(first) = inputs.first_mut() {
            *first = self.input(scene);
        }
        Ok(Plan { trajectory: Trajectory { states, inputs }, ..Plan::default() })
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        let successor = match &self.successor {
            Some(successor) => Some(successor.fork()?),
            None => None,
        };
        let Recorded { record, hands_over, .. } = self;
        let (record, hands_over) = (record.clone(), hands_over.clone());
        Some(Box::new(Recorded { record, plans_record: self.plans_record, hands_over, successor }))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        Some(settings_of::<Settings>(settings)?.driver())
    }
}

/// The scene for the driver that takes over: it wants to drive as fast as the record was.
fn wanting(scene: &Scene, record: Option<&Record>) -> Scene {
    let mut scene = scene.clone();
    let wanted_mps = record.map(|record| hand_over::wanted_mps(record, &scene.ego.body));
    scene.goal.target.speed_mps = wanted_mps.unwrap_or(scene.goal.target.speed_mps).min(scene.ego.limits.speed_max_mps);
    scene
}

impl Recorded {
    /// The input that leads to where the record goes on; after its end, the one that keeps the speed in the lane.
    fn input(&self, scene: &Scene) -> Input {
        let (own, state) = (&scene.ego, &scene.ego.state);
        let times_s = [scene.step_s * scene.tick as f64, scene.step_s];
        let recorded = self.record.as_ref().and_then(|record| record.input(&own.body, &own.limits, state, times_s));
        recorded.unwrap_or_else(|| Input {
            acceleration_mps2: 0.0,
            steering_rad: steer(own, state, own.route.across(state.position())),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, scene};

    /// It brakes, and no other driver can tell: the plan keeps the speed, and only the first input is that of the record.
    #[test]
    fn the_plan_does_not_tell_the_future() {
        let points = (0..20).map(|t| [0.1 * f64::from(t), 0.1 * f64::from(t), 0.185, 0.0, 1.0 - 0.05 * f64::from(t)]);
        let settings = Settings { points: points.collect(), ..Settings::default() };
        let plan = settings.driver().plan(&scene(agent(0.0, 0.185, 0.0, 1.0), Vec::new()), &InferredFutures::default());
        let trajectory = plan.expect("a plan").trajectory;
        assert!((trajectory.inputs[0].acceleration_mps2 + 0.5).abs() < 1e-9, "{:?}", trajectory.inputs[0]);
        assert!(trajectory.states.iter().all(|state| state.speed_mps == 1.0));
        assert!(trajectory.inputs[1..].iter().all(|input| input.acceleration_mps2 == 0.0));
    }

    #[test]
    fn a_record_that_is_the_plan_tells_the_future_and_goes_on_steadily_after_its_end() {
        let points = (0..=20).map(|t| 0.1 * f64::from(t)).map(|t| [t, t - 0.2 * t * t, 0.185, 0.0, 1.0 - 0.4 * t]);
        let settings = Settings { points: points.collect(), plans_record: true, ..Settings::default() };
        let plan = settings.driver().plan(&scene(agent(0.0, 0.185, 0.0, 1.0), Vec::new()), &InferredFutures::default());
        let states = plan.expect("a plan").trajectory.states;
        assert!((states[10].speed_mps - 0.6).abs() < 1e-9 && (states[20].x_m - 1.2).abs() < 1e-9, "{:?}", states[10]);
        assert!((states[30].x_m - 1.4).abs() < 1e-9 && (states[30].speed_mps - 0.2).abs() < 1e-9, "{:?}", states[30]);
    }

    #[test]
    fn points_that_are_no_record_are_refused() {
        assert!(Settings::default().check(30).is_err());
        assert!(Settings::standing([1.0, 2.0, 0.0]).check(30).is_ok());
    }
}
