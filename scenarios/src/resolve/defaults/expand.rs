//! A scenario in which all size-dependent keys are stated.

use serde_json::{Map, Value as Json, json};

use super::fill::{fill_key, scaled};
use super::people;
use crate::format::json_schema::SchemaNode;
use crate::format::registry::Registry;
use crate::format::vehicle_config::default_driver;
use crate::model::classes::{FULL_SCALE, NamedScale, ScenarioScale, VehicleClass};
use crate::resolve::defaults::stated_road::StatedRoad;

/// The keys of a scenario that are scaled besides its vehicles.
const SCALED_KEYS: [&str; 5] = ["duration_s", "step_s", "plant", "road", "start_jitter"];

/// Writes the defaults of a scenario's size into it: of the scenario where it states a `scale` or the `class` of a vehicle, and
/// of each vehicle. If neither is stated, the width of the lanes determines the size. A scenario of 1/10 scale is left as it is, except
/// for the lanes of IDM drivers. A value that is not a table of the format is left, too.
pub(crate) fn expand(scenario: &mut Json, registry: &Registry) {
    let schema = registry.complete();
    let Some(root) = scenario.as_object_mut() else { return };
    root.remove("defaults");
    let size = size(root, schema);
    let of_people = size.filter(|size| people::are_people(root, size.is_full));
    if let Some(Size { scale, .. }) = of_people {
        people::state_steps(root, scale);
        people::state_overtaking(root);
    }
    if let Some(Size { scale, is_full }) = size {
        // If not stated, it is one of these two.
        root.entry("scale").or_insert_with(|| json!(if is_full { NamedScale::Full } else { NamedScale::Tenth }));
        if !root.contains_key("road") {
            root.insert("road".to_owned(), json!({ "kind": "lanes" }));
        }
        for (key, property) in schema.properties().filter(|(key, _)| SCALED_KEYS.contains(&key.as_str())) {
            // Networks of lanes are full size by default.
            let native = if key == "road" && StatedRoad::read(root, schema).is_network() { FULL_SCALE } else { 1.0 };
            fill_key(key, property, root, scale / native);
        }
    }
    let lane_width_m = StatedRoad::read(root, schema).lane_widths_m().next();
    let vehicles = root.get_mut("vehicle").and_then(Json::as_array_mut).into_iter().flatten();
    for vehicle in vehicles.filter_map(Json::as_object_mut) {
        if let Some(lane_width_m) = lane_width_m {
            state_lane_width(vehicle, registry, lane_width_m);
        }
        if let (Some(Size { scale, .. }), Some(schema)) = (of_people, vehicle_schema(schema)) {
            vehicle.entry("driver").or_insert_with(default_kind);
            people::state_habits(vehicle, registry, schema, scale);
        }
        expand_vehicle(vehicle, size, schema);
    }
}

fn vehicle_schema(schema: SchemaNode<'_>) -> Option<SchemaNode<'_>> {
    schema.property("vehicle").and_then(SchemaNode::entries)
}

/// The size of a scenario.
#[derive(Clone, Copy)]
struct Size {
    /// Ratio of lengths to those of 1/10 scale.
    scale: f64,
    /// Whether vehicles without a class are full-size cars.
    is_full: bool,
}

/// The stated scale, or else that of the largest class, or else that of the road; `None` if nothing determines it.
fn size(root: &Map<String, Json>, schema: SchemaNode) -> Option<Size> {
    if let Some(stated) = root.get("scale").and_then(read::<ScenarioScale>) {
        return Some(Size { scale: stated.ratio(), is_full: stated == ScenarioScale::Named(NamedScale::Full) });
    }
    let vehicles = root.get("vehicle").and_then(Json::as_array).into_iter().flatten();
    let scales = vehicles.filter_map(|vehicle| read::<VehicleClass>(vehicle.get("class")?).map(VehicleClass::scale));
    let of_road = || scale_of_road(&StatedRoad::read(root, schema), states_a_body(root));
    scales
        .max_by(f64::total_cmp)
        .or_else(of_road)
        .map(|scale| Size { scale, is_full: scale > VehicleClass::ScaleCar.scale() })
}

/// Lanes at least this wide are full size \[m\].
const MIN_FULL_SIZE_LANE_M: f64 = 2.0;
/// Lanes of a network that are all narrower than this are not full size \[m\].
const MAX_SCALED_LANE_M: f64 = 1.0;

/// The scale that a road implies: networks of lanes are full size, parallel lanes are 1/10 scale, unless their
/// width implies otherwise. If a vehicle states its `body`, the width implies nothing. `None` for parallel lanes of 1/10 scale.
fn scale_of_road(road: &StatedRoad, states_a_body: bool) -> Option<f64> {
    let widest_m = road.lane_widths_m().fold(0.0, f64::max);
    match (road.is_network(), states_a_body) {
        (true, false) if widest_m < MAX_SCALED_LANE_M => Some(VehicleClass::ScaleCar.scale()),
        (true, _) => Some(FULL_SCALE),
        (false, false) if widest_m >= MIN_FULL_SIZE_LANE_M => Some(FULL_SCALE),
        (false, _) => None,
    }
}

fn states_a_body(root: &Map<String, Json>) -> bool {
    let mut vehicles = root.get("vehicle").and_then(Json::as_array).into_iter().flatten();
    vehicles.any(|vehicle| vehicle.get("body").is_some())
}

fn read<T: serde::de::DeserializeOwned>(value: &Json) -> Option<T> {
    serde_json::from_value(value.clone()).ok()
}

/// Writes the defaults of a vehicle's class and scale into it.
fn expand_vehicle(vehicle: &mut Map<String, Json>, size: Option<Size>, schema: SchemaNode) {
    let stated = vehicle.get("class").and_then(read::<VehicleClass>);
    let own_scale = vehicle.get("body").and_then(|body| body.get("scale")?.as_f64());
    if size.is_none() && own_scale.is_none() {
        return;
    }
    let class = stated.unwrap_or_else(|| VehicleClass::of_scale(size.is_some_and(|size| size.is_full)));
    let of_scenario = size.filter(|size| stated.is_none() && !size.is_full).map(|size| size.scale);
    let scale = own_scale.or(of_scenario).unwrap_or_else(|| class.scale());
    let Some(schema) = vehicle_schema(schema) else { return };
    let dimensions = serde_json::to_value(class.dimensions()).unwrap_or_default();
    let mut dimensions = scaled(schema, &dimensions, scale / class.scale());
    dimensions["body"]["scale"] = json!(scale);
    lay_under(vehicle, dimensions);
    vehicle.entry("driver").or_insert_with(default_kind);
    if class != VehicleClass::ScaleCar {
        state_angle_weights(vehicle, schema, scale);
    }
    for (key, property) in schema.properties().filter(|(key, _)| ["weights", "driver"].contains(&key.as_str())) {
        fill_key(key, property, vehicle, scale);
    }
}

/// The speed of a 1/10 scale car for which the default weights of angles are chosen \[m/s\].
const WEIGHED_SPEED_MPS: f64 = 1.0;

/// Writes the weights of a vehicle's angles at its speed.
///
/// Full-size cars drive much faster than a 1/10 scale car scaled by Froude's law: 25 m/s and not 3. A heading `θ` moves a vehicle
/// sideways by `ẏ = v θ`, and a steering angle `δ` accelerates it by `ÿ = v² δ/L`. At `r` times the speed of the law, the weight
/// of the heading is multiplied by `r²` and that of changes of steering by `r⁴`, so that sideways motion costs the same.
fn state_angle_weights(vehicle: &mut Map<String, Json>, schema: SchemaNode, scale: f64) {
    let speed = |table: &str| vehicle.get(table).and_then(|table| table.get("speed_mps")?.as_f64());
    let fastest_mps = speed("start").into_iter().chain(speed("goal")).fold(0.0, f64::max);
    let ratio = (fastest_mps / (WEIGHED_SPEED_MPS * scale.sqrt())).max(1.0);
    let Some(property) = schema.property("weights") else { return };
    let weights = vehicle.entry("weights").or_insert_with(|| json!({}));
    for (key, factor) in [("heading", ratio * ratio), ("steering_change", ratio * ratio * ratio * ratio)] {
        let default = property.property(key).and_then(SchemaNode::default).and_then(Json::as_f64);
        if let (Some(default), Some(weights)) = (default, weights.as_object_mut()) {
            weights.entry(key).or_insert(json!(default * factor));
        }
    }
}

/// Writes the keys that a table does not state, including those of tables below it.
fn lay_under(table: &mut Map<String, Json>, under: Json) {
    let Json::Object(under) = under else { return };
    for (key, value) in under {
        match (table.get_mut(&key), value) {
            (Some(Json::Object(below)), value) => lay_under(below, value),
            (Some(_), _) => {}
            (None, value) => {
                table.insert(key, value);
            }
        }
    }
}

/// Writes the settings of a driver that follow from the width of the road's lanes.
fn state_lane_width(vehicle: &mut Map<String, Json>, registry: &Registry, lane_width_m: f64) {
    let Some(driver) = vehicle.get_mut("driver").and_then(Json::as_object_mut) else { return };
    let kind = driver.get("kind").and_then(Json::as_str).and_then(|kind| registry.driver_kind(kind));
    if let Some(kind) = kind {
        lay_under(driver, Json::Object(kind.lane_defaults(lane_width_m)));
    }
}

/// The driver of a vehicle that does not state one.
fn default_kind() -> Json {
    json!({ "kind": default_driver().kind() })
}
