//! Frames: one tick as plain values, which watchers receive.

use std::sync::Arc;

use interplay_building::control::Design;
use interplay_planners::plan::diagnostic;
use interplay_planners::rules::RoadRules;
use interplay_planners::scene::IndicatorSide;
pub use interplay_planners::traffic::Origin;
use interplay_planners::traffic::Traffic;
use interplay_planners::{Input, Plan, PlanEventKind, State, Trajectory};
use serde::Serialize;

use crate::state::day::DayFigures;

/// One tick of a run as plain values, the input of metrics, recorders and tests.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Number of earlier ticks; for a building alone, number of its steps.
    pub tick: usize,
    /// Simulated time at which the plans were made and the states hold \[s\].
    pub time_s: f64,
    /// Every vehicle, in the scenario's order.
    pub vehicles: Vec<VehicleFrame>,
    /// Whether the vehicles planned in this tick; otherwise they follow their last plans.
    pub plans: bool,
    /// Events of the tick, in order.
    pub events: Vec<Event>,
    /// The contacts that began during the tick, in order.
    pub collisions: Vec<Collision>,
    /// The rules of the road that were broken during the tick.
    pub broken_rules: Vec<BrokenRule>,
    /// The vehicles of people that came during the tick into the way of one behind with a shorter gap than they owe.
    pub cut_ins: Vec<String>,
    /// Distance of the ego's footprint to the nearest other one at the beginning of the tick \[m\]; none without others.
    pub gap_m: Option<f64>,
    /// The smallest such distance during the tick, its end included \[m\].
    pub smallest_gap_m: Option<f64>,
    /// The two vehicles that came closest to each other during the tick, its end included; none if there is only one.
    pub closest: Option<PairGap>,
    /// The building, if this is one of its steps.
    pub building: Option<BuildingFrame>,
}

/// A building at one of its steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BuildingFrame {
    /// The day, from 0: the iteration.
    pub day: usize,
    /// The step within the day, from 0.
    pub step: usize,
    /// Every zone, in the scenario's order.
    pub zones: Vec<ZoneFrame>,
    /// Outdoor temperature during the step \[°C\].
    pub ambient_c: f64,
    /// Outdoor temperature that was forecast at midnight for the step \[°C\].
    pub forecast_c: f64,
    /// Temperatures of the walls that store heat, at the start of the step \[°C\].
    pub walls_c: Vec<f64>,
    /// Global radiation on a horizontal plane during the step \[W/m²\].
    pub sun_w_per_m2: f64,
    /// The price of electricity in the step \[currency/kWh\]; none without a tariff.
    pub price_per_kwh: Option<f64>,
    /// The controller's description of its plan for the day, at the first step of the day.
    pub design: Option<Box<Design>>,
    /// The key figures of the day, at its last step.
    pub figures: Option<DayFigures>,
}

/// One zone at one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ZoneFrame {
    /// Temperature at the start of the step \[°C\].
    pub temperature_c: f64,
    /// Temperature at its end \[°C\].
    pub next_c: f64,
    /// The target temperature at its start \[°C\]; none if it is free.
    pub reference_c: Option<f64>,
    /// Half-width of the comfort band \[K\]; none while the zone is unoccupied.
    pub band_k: Option<f64>,
    /// Heat that the controller requested \[kW\].
    pub requested_kw: f64,
    /// Heat from the equipment, negative for cooling \[kW\].
    pub heat_kw: f64,
    /// Heat from people, sun and machines \[kW\].
    pub gains_kw: f64,
    /// Solar part of these gains \[kW\].
    pub sun_kw: f64,
    /// Electricity for its heat \[kW\].
    pub electric_kw: f64,
}

/// One vehicle at one tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VehicleFrame {
    /// Name of the vehicle.
    pub name: String,
    /// Whether it is not on the road: it has not entered yet, or has left. Then the other fields have no meaning.
    pub is_absent: bool,
    /// State of the vehicle when it planned.
    pub state: State,
    /// Input that the vehicle applies during the tick.
    pub input: Input,
    /// The plan that it follows; after a failure, the fallback.
    pub plan: Arc<Plan>,
    /// Where the plan comes from.
    pub origin: Origin,
    /// The motion that the others expected when they planned: the plan itself if it plans first, otherwise the continuation of its last
    /// plan. Vehicles ahead of it that also plan first had planned before it and knew only its last plan. Of a vehicle that does not tell
    /// its plan, this is what its motion leads others to expect who see it without delay.
    pub prediction: Arc<Trajectory>,
    /// The side on which it indicated a change of lane when it planned, among people.
    pub indicator: Option<IndicatorSide>,
    /// Requirements of the rules of the road.
    pub rules: RoadRules,
    /// Factor by which its required braking exceeded comfortable braking when it planned; 1 if comfortable braking sufficed.
    pub urgency: f64,
    /// Wall time of planning \[ms\]; never part of a digest.
    pub plan_ms: f64,
}

impl VehicleFrame {
    /// Becomes a row of the traffic after its decision and before it moves; `plan_ms` is the wall time of its plan \[ms\]. The name and
    /// lists are written only where they differ from those of the last tick.
    pub(crate) fn become_row(&mut self, traffic: &Traffic, row: usize, plan_ms: f64) {
        let user = &traffic.road_users[row];
        let agent = &user.agent;
        if self.name != agent.name {
            self.name.clone_from(&agent.name);
        }
        if self.rules != agent.rules {
            self.rules = agent.rules.clone();
        }
        (self.is_absent, self.state, self.origin) = (user.is_absent(), agent.state, user.origin);
        self.input = if user.is_absent() { Input::default() } else { agent.previous_input };
        self.plan.clone_from(&user.plan);
        self.prediction.clone_from(traffic.expected_of(row));
        (self.indicator, self.urgency, self.plan_ms) = (agent.indicator, agent.urgency, plan_ms);
    }

    /// The cost of the plan; `None` for a plan that was not chosen by cost.
    pub fn plan_cost(&self) -> Option<f64> {
        self.plan.value_of(&diagnostic::COST)
    }

    /// The new partner of the vehicle's planner, or the end of the partnership; `None` if neither has changed in this tick.
    pub fn new_partner(&self) -> Option<Option<&str>> {
        self.plan.events.iter().rev().find_map(|event| match &event.kind {
            PlanEventKind::Partner(partner) => Some(partner.as_deref()),
            _ => None,
        })
    }
}

/// The distance between the footprints of two vehicles.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairGap {
    /// The distance; 0 where they touch \[m\].
    pub m: f64,
    /// The names of both vehicles, in the scenario's order.
    pub between: [String; 2],
    /// Simulated time \[s\].
    pub time_s: f64,
}

/// Two vehicles that began to touch.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Collision {
    /// Simulated time \[s\].
    pub time_s: f64,
    /// The names of both vehicles, in the scenario's order.
    pub between: [String; 2],
    /// Impulse of the contact \[N s\].
    pub impulse_ns: f64,
    /// The vehicle at fault; none before it is measured.
    pub fault: Option<ContactFault>,
}

/// The vehicle at fault in a contact, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactFault {
    /// Its name.
    pub vehicle: String,
    /// What it did, in a sentence.
    pub why: String,
}

/// A rule of the road that a vehicle broke, with time and place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BrokenRule {
    /// Simulated time \[s\].
    pub time_s: f64,
    /// Name of the vehicle.
    pub vehicle: String,
    /// The rule.
    pub rule: RoadRule,
    /// Position of its mass centre along the world's x axis \[m\].
    pub x_m: f64,
    /// Position of its mass centre along the world's y axis \[m\].
    pub y_m: f64,
    /// The lane of its route there; none without a network.
    pub lane: Option<String>,
    /// Arc length of its mass centre along that lane, or along its road \[m\].
    pub along_m: f64,
}

/// A rule of the road.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RoadRule {
    /// A vehicle stands before a stop sign.
    StopSign,
    /// A vehicle does not pass a red light.
    RedLight,
    /// A vehicle lets those with priority go first.
    RightOfWay,
    /// A vehicle keeps the limit of its lane.
    SpeedLimit,
    /// A vehicle does not overtake one that waits in a queue.
    OvertakingQueue,
    /// A vehicle does not overtake at a zebra crossing.
    OvertakingAtZebra,
    /// A vehicle does not overtake in a junction.
    OvertakingInJunction,
    /// A vehicle does not overtake before a traffic light.
    OvertakingBeforeLight,
}

impl BrokenRule {
    /// What the vehicle did, and where: `passed the red light of lane in`.
    pub fn words(&self) -> String {
        let place = match (&self.lane, self.rule) {
            (Some(lane), RoadRule::StopSign | RoadRule::RedLight) => format!(" of lane {lane}"),
            (Some(lane), _) => format!(" on lane {lane}, {:.0} m along it", self.along_m),
            (None, _) => format!(" {:.0} m along its route", self.along_m),
        };
        match self.rule {
            RoadRule::StopSign => format!("passed the stop sign{place} without standing"),
            RoadRule::RedLight => format!("passed the red light{place}"),
            RoadRule::RightOfWay => format!("took the right of way of another{place}"),
            RoadRule::SpeedLimit => format!("exceeded the speed limit{place}"),
            RoadRule::OvertakingQueue => format!("overtook a vehicle that waits{place}"),
            RoadRule::OvertakingAtZebra => format!("overtook at a zebra crossing{place}"),
            RoadRule::OvertakingInJunction => format!("overtook in a junction{place}"),
            RoadRule::OvertakingBeforeLight => format!("overtook before a traffic light{place}"),
        }
    }
}

/// An event of a run, for its log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Event {
    /// The source of the event: a vehicle, or `controller` for that of the building.
    pub vehicle: String,
    /// How serious it is.
    pub level: Level,
    /// The event in words.
    pub text: String,
}

/// The severity of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// For information.
    Note,
    /// A planner failed or a filter intervened.
    Warning,
    /// A collision.
    Alarm,
}
