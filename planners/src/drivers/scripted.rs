//! A driver who does what the scenario says, whatever happens around it.
//!
//! A script is a list of orders, each from a time on, or from the moment at which a vehicle reaches a place: a speed to drive at, a
//! lateral position to drive to. Of the orders that have begun, the latest with a speed rules the speed, and the latest with a position
//! the position; before the first, the vehicle keeps what it has. The plan covers what the script says about the horizon, so others who
//! know plans see it coming.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::prediction::Prediction;
use crate::prediction::steering::{admissible, roll_out, steer};
use crate::scene::inferred_futures::InferredFutures;
use crate::scene::trigger::{Trigger, TriggerMemory};
use crate::{Input, Plan, PlanError, PlanTime, Scene};

/// The settings of a scripted driver: what to do, and when.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// The orders, each with the time at which it begins.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("default" = []))]
    pub script: Vec<Order>,
}

/// An order of the script.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// Time at which the order begins, since the start of the run, or since the moment of `when` \[s\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 2.0)]
    pub from_s: f64,
    /// The moment from which `from_s` counts: that at which a vehicle reaches a place.
    #[serde(default)]
    #[schemars(example = json!({ "vehicle": "ego", "reaches": { "lane": "street", "along_m": 40.0 } }))]
    pub when: Option<Trigger>,
    /// The speed to drive at \[m/s\].
    #[serde(default)]
    #[schemars(example = 0.5)]
    pub speed_mps: Option<f64>,
    /// How fast the speed changes; by default as fast as the vehicle can \[m/s²\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 0.5)]
    pub acceleration_mps2: Option<f64>,
    /// The lateral position on its road to drive to: on a straight road whose lanes have numbers, a `y`; where lanes have names, from the
    /// middle of the lane of its route, positive to the left \[m\].
    #[serde(default)]
    #[schemars(example = 0.555)]
    pub lateral_m: Option<f64>,
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "scripted"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Scripted::new(self.clone()))
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

    fn reacts(&self) -> bool {
        true
    }

    fn can_be_asked(&self) -> bool {
        false
    }

    fn can_take_wheel(&self) -> bool {
        false
    }
}

/// A driver that follows a script.
#[derive(Clone, Debug)]
pub struct Scripted {
    settings: Settings,
    /// Speed and lateral position at the first step, kept until an order says otherwise.
    kept: Option<[f64; 2]>,
    /// Of each order, whether the moment of its `when` has come.
    triggers: Vec<TriggerMemory>,
}

/// Orders begin this much early, for times that are sums of steps \[s\].
const TIME_TOLERANCE_S: f64 = 1e-9;

impl Scripted {
    /// A driver that has not planned yet.
    pub fn new(settings: Settings) -> Self {
        let triggers = vec![TriggerMemory::default(); settings.script.len()];
        Scripted { settings, kept: None, triggers }
    }
}

impl Drive for Scripted {
    /// Makes a plan that follows the script.
    ///
    /// # Errors
    /// Never.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let own = &scene.ego;
        let [speed, lateral] = *self.kept.get_or_insert([own.state.speed_mps, own.across_m()]);
        self.look(scene);
        let trajectory = roll_out(scene, |t, state| {
            let time_s = scene.step_s * (scene.tick + t) as f64;
            let order = self.latest(time_s, scene.step_s, |order| order.speed_mps.is_some());
            let wanted = order.and_then(|order| order.speed_mps).unwrap_or(speed);
            let most = order.and_then(|order| order.acceleration_mps2).unwrap_or(f64::INFINITY);
            let acceleration = ((wanted - state.speed_mps) / scene.step_s).clamp(-most, most);
            let place = self.latest(time_s, scene.step_s, |order| order.lateral_m.is_some());
            Input {
                acceleration_mps2: admissible(own, state, acceleration, scene.step_s),
                steering_rad: steer(own, state, place.and_then(|order| order.lateral_m).unwrap_or(lateral)),
            }
        });
        Ok(Plan { trajectory, ..Plan::default() })
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = settings_of::<Settings>(settings)?.clone();
        let mut changed = Scripted { settings, ..self.clone() };
        changed.triggers.resize(changed.settings.script.len(), TriggerMemory::default());
        Some(Box::new(changed))
    }
}

impl Scripted {
    /// The order that rules at a time, of those that `applies` accepts; of orders at one time, the last.
    fn latest(&self, time_s: f64, step_s: f64, applies: impl Fn(&Order) -> bool) -> Option<&Order> {
        let orders = self.settings.script.iter().zip(&self.triggers).filter(|(order, _)| applies(order));
        let begins = orders.filter_map(|(order, trigger)| {
            let counts_from_s = match order.when {
                None => 0.0,
                Some(_) => step_s * trigger.fired()? as f64,
            };
            Some((order, counts_from_s + order.from_s))
        });
        let begun = begins.filter(|(_, from_s)| *from_s <= time_s + TIME_TOLERANCE_S);
        begun.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(order, _)| order)
    }

    /// Looks whether the moments have come from which orders count.
    fn look(&mut self, scene: &Scene) {
        for (order, trigger) in self.settings.script.iter().zip(&mut self.triggers) {
            if let Some(when) = &order.when {
                trigger.has_fired(when, scene);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Agent;
    use crate::fixture::{agent, scene};
    use crate::scene::trigger::TriggerPlace;

    fn order(from_s: f64, speed_mps: Option<f64>, lateral_m: Option<f64>) -> Order {
        Order { from_s, speed_mps, lateral_m, ..Order::default() }
    }

    fn driven(script: Vec<Order>, tick: usize) -> Plan {
        let mut scene = scene(agent(0.0, 0.185, 0.0, 1.0), Vec::new());
        scene.tick = tick;
        Scripted::new(Settings { script }).plan(&scene, &InferredFutures::default()).expect("a plan")
    }

    #[test]
    fn without_orders_everything_stays_as_it_is() {
        let end = *driven(Vec::new(), 0).trajectory.states.last().expect("states");
        assert!((end.x_m - 3.0).abs() < 1e-9 && (end.y_m - 0.185).abs() < 1e-9 && end.speed_mps == 1.0);
    }

    #[test]
    fn orders_are_carried_out_from_their_time_on_and_each_sets_only_what_it_states() {
        let plan =
            driven(vec![order(1.0, Some(0.4), None), order(0.5, Some(1.2), None), order(0.8, None, Some(0.555))], 0);
        let at = |t: usize| plan.trajectory.states[t];
        assert!((at(5).speed_mps - 1.0).abs() < 1e-12 && at(8).y_m == 0.185);
        assert!((at(10).speed_mps - 1.2).abs() < 1e-12);
        assert!((at(20).speed_mps - 0.4).abs() < 1e-9, "at the vehicle's own limits");
        assert!(at(30).y_m > 0.45);
        // The same script later in the run.
        assert!((driven(vec![order(1.0, Some(0.4), None)], 10).trajectory.states[6].speed_mps - 0.4).abs() < 1e-9);
    }

    #[test]
    fn an_order_may_wait_for_a_vehicle_to_reach_a_place() {
        let place = TriggerPlace { lane: None, along_m: 1.0 };
        let when = Some(Trigger { vehicle: "bus".to_owned(), reaches: place });
        let mut driver = Scripted::new(Settings { script: vec![Order { when, ..order(0.5, Some(0.4), None) }] });
        let mut speed_after = |x_m: f64, tick: usize| {
            let bus = Agent { name: "bus".to_owned(), ..agent(x_m, 0.185, 0.0, 1.0) };
            let scene = Scene { tick, ..scene(bus, Vec::new()) };
            driver.plan(&scene, &InferredFutures::default()).expect("a plan").trajectory.states[15].speed_mps
        };
        assert_eq!(speed_after(0.0, 0), 1.0);
        // Reached at 2 s, so that it slows down from 2.5 s on.
        assert!((speed_after(1.0, 20) - 0.4).abs() < 1e-9);
    }

    #[test]
    fn a_stated_acceleration_is_kept() {
        let gently = Order { acceleration_mps2: Some(0.2), ..order(0.0, Some(0.5), None) };
        let plan = driven(vec![gently], 0);
        assert!(plan.trajectory.inputs.iter().take(25).all(|input| (input.acceleration_mps2 + 0.2).abs() < 1e-9));
        assert!((plan.trajectory.states[30].speed_mps - 0.5).abs() < 1e-9);
    }
}
