//! The behaviour of people on real roads, for files that do not state another: comfort, time gaps, reaction, rules, and the time
//! steps that it needs.

use interplay_planners::rules::RuleKeeping;
use interplay_planners::{ComfortLimits, DriverKind};
use serde_json::{Map, Value as Json, json};

use super::fill::scaled;
use crate::format::json_schema::SchemaNode;
use crate::format::registry::Registry;
use crate::model::classes::FULL_SCALE;
use crate::model::traffic::conduct::Conduct;

/// Time from one tick to the next, and from one plan to the next, for full-size cars \[s\].
const STEPS_S: [f64; 2] = [0.1, 0.2];

/// Stages of a plan: 8 s of a full-size car.
const HORIZON_STEPS: usize = 40;

/// Whether drivers are people: as stated, or else at full size if no figure of the dissertation is reproduced.
pub(super) fn are_people(root: &Map<String, Json>, is_full: bool) -> bool {
    let stated: Option<Conduct> = root.get("conduct").and_then(|stated| serde_json::from_value(stated.clone()).ok());
    stated.map_or(is_full && !root.contains_key("figure"), |stated| stated == Conduct::People)
}

/// Writes the time steps into a scenario that does not state them.
pub(super) fn state_steps(root: &mut Map<String, Json>, scale: f64) {
    if root.contains_key("step_s") {
        return;
    }
    let times = STEPS_S.map(|full_s| full_s * (scale / FULL_SCALE).sqrt());
    for (key, time_s) in ["step_s", "planning_period_s"].into_iter().zip(times) {
        root.entry(key).or_insert(json!(time_s));
    }
    root.entry("horizon_steps").or_insert(json!(HORIZON_STEPS));
}

/// Writes into a two-way road that both directions may use the lane of the other, if the file does not say who may.
pub(super) fn state_overtaking(root: &mut Map<String, Json>) {
    let road = root.get_mut("road").and_then(Json::as_object_mut);
    let Some(road) = road.filter(|road| road.get("kind").and_then(Json::as_str) == Some("two-way")) else { return };
    road.entry("overtaking").or_insert(json!("both"));
}

/// Writes the settings of its driver into a vehicle; `schema` is that of vehicles.
pub(super) fn state_habits(vehicle: &mut Map<String, Json>, registry: &Registry, schema: SchemaNode, scale: f64) {
    let ratio = scale / FULL_SCALE;
    let kind = vehicle.get("driver").and_then(|driver| registry.driver_kind(driver.get("kind")?.as_str()?));
    let rules = kind.map_or(RuleKeeping::Kept, DriverKind::people_rules);
    vehicle.entry("rules").or_insert(json!(rules));
    for key in ["tells_plan", "knows_plans"] {
        vehicle.entry(key).or_insert(json!(false));
    }
    if let Some(limits) = vehicle.entry("limits").or_insert_with(|| json!({})).as_object_mut() {
        let comfort = schema.property("limits").and_then(|limits| limits.property("comfort"));
        let real = serde_json::to_value(ComfortLimits::default()).unwrap_or_default();
        limits
            .entry("comfort")
            .or_insert_with(|| comfort.map_or_else(|| real.clone(), |key| scaled(key, &real, ratio)));
    }
    let (Some(kind), Some(driver)) = (kind, vehicle.get_mut("driver").and_then(Json::as_object_mut)) else { return };
    let of_kind = schema.property("driver").and_then(|driver| driver.of_kind(kind.kind()));
    for (key, value) in kind.people_defaults() {
        let property = of_kind.and_then(|kind| kind.property(&key));
        driver.entry(key).or_insert_with(|| property.map_or_else(|| value.clone(), |key| scaled(key, &value, ratio)));
    }
}
