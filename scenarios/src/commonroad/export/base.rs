//! The parts of an exported scenario that are the same in every run.

use std::collections::BTreeMap;
use std::fmt::Write;

use interplay_planners::{Body, State};

use super::super::model::ROOT;
use super::goal::GoalPlaces;
use super::xml_text::{Ids, escaped, number, number_in, state};
use crate::model::classes::VehicleClass;
use crate::model::scenario::Scenario;

/// Roads and planning problem of an exported scenario, as text.
#[derive(Clone, Debug, Default)]
pub(super) struct Base {
    pub attributes: Vec<(String, String)>,
    /// The name among the benchmarks.
    pub benchmark: String,
    /// Place, tags, lanelets, signs, lights and intersections.
    pub roads: String,
    /// The planning problem; `None` if it follows from the driven motion.
    pub problem: Option<String>,
    /// The id of the planning problem.
    pub problem_id: u64,
    /// The goals of the planning problem.
    pub goals: GoalPlaces,
    pub ids: Ids,
    /// The type of each obstacle of the source, by its id.
    pub kinds: BTreeMap<u64, String>,
    /// The position in the written coordinates that is the origin of the run \[m\].
    pub origin: [f64; 2],
    /// The time step at which the run begins.
    pub begin: i64,
    /// A road of parallel lanes, whose length depends on where vehicles drove.
    pub parallel: Option<Box<Scenario>>,
    /// The lanelets in which the ego's route ends; empty if it may end anywhere.
    pub last_lanelets: Vec<u64>,
}

impl Base {
    /// A position of the run in the written coordinates \[m\].
    pub(super) fn written(&self, place: [f64; 2]) -> [f64; 2] {
        [place[0] + self.origin[0], place[1] + self.origin[1]]
    }

    /// The scenario with the driven motion.
    pub(super) fn scenario(&self, others: &[DrivenVehicle], ego: Option<&DrivenVehicle>) -> String {
        let mut text = format!("<?xml version='1.0' encoding='UTF-8'?>\n<{ROOT}");
        for (name, value) in &self.attributes {
            // Writing to a text cannot fail.
            let _ = write!(text, " {name}=\"{}\"", escaped(value));
        }
        text.push_str(">\n");
        text.push_str(&self.roads);
        let mut ids = self.ids.clone();
        for vehicle in others.iter().filter(|vehicle| !vehicle.states.is_empty()) {
            text.push_str(&self.obstacle(vehicle, &mut ids));
        }
        match &self.problem {
            Some(problem) => text.push_str(problem),
            None => text.push_str(&ego.map_or_else(String::new, |ego| self.problem_of(ego))),
        }
        let _ = writeln!(text, "</{ROOT}>");
        text
    }

    fn obstacle(&self, vehicle: &DrivenVehicle, ids: &mut Ids) -> String {
        let wanted = number_in(&vehicle.name);
        let known = wanted.and_then(|id| self.kinds.get(&id)).map(|kind| escaped(kind));
        let kind = known.unwrap_or_else(|| kind(vehicle.class).to_owned());
        let body = &vehicle.body;
        let [length_m, width_m] = [body.front_m + body.rear_m, body.width_m].map(number);
        let mut text = format!(
            "  <dynamicObstacle id=\"{}\">\n    <type>{kind}</type>\n    \
             <shape><rectangle><length>{length_m}</length><width>{width_m}</width></rectangle></shape>\n",
            ids.give(wanted)
        );
        for (index, at) in vehicle.states.iter().enumerate() {
            let time = self.begin + (vehicle.first_step + index) as i64;
            let written = state(at, self.written(middle(vehicle, at)), time);
            let _ = match index {
                0 => writeln!(text, "    <initialState>{written}</initialState>\n    <trajectory>"),
                _ => writeln!(text, "      <state>{written}</state>"),
            };
        }
        text.push_str("    </trajectory>\n  </dynamicObstacle>\n");
        text
    }

    /// The planning problem of an ego without one: its first state, and the lanelets in which its route ends.
    fn problem_of(&self, ego: &DrivenVehicle) -> String {
        let Some(start) = ego.states.first() else { return String::new() };
        let initial = state(start, self.written(middle(ego, start)), self.begin);
        let last = self.begin + ego.states.len() as i64 - 1;
        let lanelets: String = self.last_lanelets.iter().map(|id| format!("<lanelet ref=\"{id}\"/>")).collect();
        let position = if lanelets.is_empty() { lanelets } else { format!("<position>{lanelets}</position>") };
        format!(
            "  <planningProblem id=\"{}\">\n    <initialState>{initial}<yawRate><exact>0</exact></yawRate>\
             <slipAngle><exact>0</exact></slipAngle></initialState>\n    <goalState>{position}<time>\
             <intervalStart>{}</intervalStart><intervalEnd>{last}</intervalEnd></time></goalState>\n  </planningProblem>\n",
            self.problem_id,
            (self.begin + 1).min(last),
        )
    }
}

/// The middle of a vehicle's box \[m\].
pub(super) fn middle(vehicle: &DrivenVehicle, at: &State) -> [f64; 2] {
    let ahead_m = 0.5 * (vehicle.body.front_m - vehicle.body.rear_m);
    let (sin, cos) = libm::sincos(at.heading_rad);
    [at.x_m + ahead_m * cos, at.y_m + ahead_m * sin]
}

/// The type of an obstacle.
fn kind(class: Option<VehicleClass>) -> &'static str {
    match class {
        Some(VehicleClass::Truck | VehicleClass::Van) => "truck",
        Some(VehicleClass::Bus) => "bus",
        Some(VehicleClass::Bicycle) => "bicycle",
        Some(VehicleClass::Pedestrian) => "pedestrian",
        Some(VehicleClass::Car | VehicleClass::ScaleCar) | None => "car",
    }
}

/// The version of the format that is written.
pub(super) const VERSION: &str = "2020a";

/// The motion of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenVehicle {
    /// Its name.
    pub name: String,
    /// Its class of vehicle, if known.
    pub class: Option<VehicleClass>,
    /// Its size and axles.
    pub body: Body,
    /// The tick at which it entered the road.
    pub first_step: usize,
    /// Its states at the start of each tick from then on, and at the end of its last tick; empty if it never entered.
    pub states: Vec<State>,
    /// Its steering angle during each tick \[rad\].
    pub steering_rad: Vec<f64>,
}

/// The exported texts of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The scenario as it was driven: all vehicles but the ego are obstacles.
    pub scenario: String,
    /// The motion of the ego as a solution.
    pub solution: String,
    /// Whether that motion reaches the goal of the planning problem; the solution ends there.
    pub reaches_goal: bool,
}
