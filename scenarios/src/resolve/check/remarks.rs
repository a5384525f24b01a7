//! Remarks on vehicles: values that are allowed but probably not intended.
//!
//! A number for another scale may be within its bounds and yet give a meaningless run: a 1/10 scale car on a motorway, an ellipse
//! that does not contain a lorry. Each remark is located like an error, and states what would work.

use interplay_building::network::Zone;
use interplay_planners::{Body, Driver, SafetyEllipse};

use crate::format::flow::FlowConfig;
use crate::format::json_schema::SchemaNode;
use crate::format::read::degrees;
use crate::format::read::tree::{TomlNode, TomlValue};
use crate::model::classes::VehicleClass;
use crate::model::derived::narrowest_lane::{NarrowestLane, narrowest_lane};
use crate::model::derived::{script_contact, swept_width};
use crate::model::remark::{ScenarioRemark, ScenarioRemarks};
use crate::model::scenario::{Scenario, Vehicle};
use crate::text::error::{Fault, quoted};
use crate::text::readable::readable;

/// The widest lane, as a multiple of the width of a vehicle without a class \[-\]: a car of 1.8 m on a road of 6 m.
const MAX_LANE_PER_BODY: f64 = 3.5;
/// The widest body, as a share of its lane.
const MAX_BODY_PER_LANE: f64 = 0.9;
/// The tolerance for rounding of a body beside its lane \[m\].
const ROUNDING_M: f64 = 1e-6;
/// The largest angle of a start to its road \[deg\].
const MAX_START_ANGLE_DEG: f64 = 20.0;

/// More vehicles an hour than a lane carries: a queue forms before the road.
const MOST_PER_LANE_PER_H: f64 = 2000.0;

/// A zone without a stated capacity is remarked upon if it cools by more than [`MOST_COOLING_K`] in [`NIGHT_S`] without heating while its
/// surroundings are colder by [`COLDER_K`].
const MOST_COOLING_K: f64 = 10.0;
const NIGHT_S: f64 = 5.0 * 3600.0;
const COLDER_K: f64 = 20.0;

/// All remarks.
pub(crate) fn collect(scenario: &Scenario, tree: &TomlNode, schema: SchemaNode) -> ScenarioRemarks {
    let mut faults = degrees::remarks(tree, schema);
    faults.extend(crowded_flows(tree));
    faults.extend(idle_detail(scenario, tree));
    faults.extend(light_zones(scenario, tree));
    faults.extend(idle_expectations(scenario, tree));
    let mut last = None;
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        // The first vehicle of a flow stands for all of them, since they are written in one place.
        let place = tree.at(&format!("vehicle.{index}")).map(|node| &node.place);
        let before = std::mem::replace(&mut last, place);
        if place.zip(before).is_some_and(|(place, before)| place.holds(before) && before.holds(place)) {
            continue;
        }
        let remark = |key: &str, label: &str, (message, help): (String, String)| {
            let place = tree.place_of(&format!("vehicle.{index}.{key}"));
            Fault::at(place, label, message).help(help)
        };
        if vehicle.driver.record().is_some() {
            continue;
        }
        faults.extend(too_small_ellipse(scenario, index).map(|said| remark("safety", "too small", said)));
        faults.extend(proportion(scenario, vehicle).map(|said| remark("body", "out of proportion", said)));
        faults.extend(off_lane(scenario, vehicle).map(|said| remark("start", "off its lane", said)));
        faults.extend(askew(vehicle).map(|said| remark("start", "at an angle", said)));
        faults.extend(swept_width::remark(scenario, vehicle).map(|said| remark("class", "needs more room", said)));
        faults.extend(script_contact::remark(scenario, vehicle).map(|said| remark("driver", "leads through it", said)));
        faults.extend(short_horizon(scenario, vehicle).map(|said| remark("goal.speed_mps", "cannot stop", said)));
    }
    ScenarioRemarks(faults.into_iter().map(ScenarioRemark).collect())
}

/// Zones whose capacity is not stated and that cool by many kelvin in a night without heating.
fn light_zones(scenario: &Scenario, tree: &TomlNode) -> Vec<Fault> {
    let Some(building) = &scenario.building else { return Vec::new() };
    let remark = |(index, zone): (usize, &Zone)| {
        let stated = tree.at(&format!("building.zone.{index}"))?;
        let walls = building.walls.iter().filter(|wall| wall.between.contains(&zone.name));
        let conductance_kw_per_k: f64 = walls.map(|wall| 1.0 / wall.resistance_k_per_kw).sum();
        let share = 1.0 - libm::exp(-NIGHT_S * conductance_kw_per_k / zone.capacity_kj_per_k);
        let is_light = COLDER_K * share > MOST_COOLING_K && stated.at("capacity_kj_per_k").is_none();
        let message = format!(
            "zone {} cools by {:.0} K in 5 h if it is 20 K colder around it: `capacity_kj_per_k` is not stated, and the default is \
             that of its air ({})",
            quoted(&zone.name),
            COLDER_K * share,
            zone.capacity_kj_per_k
        );
        let help = "a room with furniture and the inner side of its walls has about 10000";
        is_light.then(|| Fault::at(&stated.place, "cools quickly", message).help(help))
    };
    building.zones.iter().enumerate().filter_map(remark).collect()
}

/// Expectations that a vehicle completes a task although it has none, which fail in every run.
fn idle_expectations(scenario: &Scenario, tree: &TomlNode) -> Vec<Fault> {
    let remark = |(index, vehicle): (usize, &str)| {
        let name = quoted(vehicle);
        let message = format!("{name} has nothing to complete: it starts where it is to go, or follows a record");
        let help = format!("give {name} a goal in another lane, or leave the expectation out");
        let place = tree.place_of(&format!("expect.completes.{index}.vehicle"));
        Fault::at(place, "has nothing to complete", message).help(help)
    };
    scenario.expected_without_task().map(remark).collect()
}

/// A level of detail that concerns no vehicle.
fn idle_detail(scenario: &Scenario, tree: &TomlNode) -> Option<Fault> {
    let concerned = (0..scenario.vehicles.len()).any(|index| scenario.detail_of(index).is_some());
    let message =
        "`detail` changes nothing: it concerns drivers of kind `human` beside the ego, and there are none".to_owned();
    (scenario.detail.is_some() && !concerned)
        .then(|| Fault::at(tree.place_of("detail"), "concerns no vehicle", message).help("leave it out".to_owned()))
}

/// Flows of more vehicles than their lanes carry.
fn crowded_flows(tree: &TomlNode) -> Vec<Fault> {
    let Some(TomlValue::Array(nodes)) = tree.at("flow").map(|flows| &flows.value) else { return Vec::new() };
    let remark = |node: &TomlNode| {
        let flow: FlowConfig = serde_json::from_value(node.to_json()).ok()?;
        let most_per_h =
            flow.vehicles_per_h.into_iter().chain(flow.rates.iter().map(|rate| rate[1])).fold(0.0, f64::max);
        let message = format!(
            "{most_per_h} vehicles an hour of `{}` come on {} lanes: a lane carries about {MOST_PER_LANE_PER_H}, and a queue will stand outside",
            flow.name,
            flow.from.len()
        );
        (most_per_h > MOST_PER_LANE_PER_H * flow.from.len() as f64).then(|| {
            Fault::at(node.place_of("name"), "more than they carry", message)
                .help("let them come on more lanes, or fewer".to_owned())
        })
    };
    nodes.iter().filter_map(remark).collect()
}

/// Whether the vehicle may touch a parallel one outside its safety ellipse.
///
/// The bodies overlap if the centres are nearer than `l` along and `w` across the road, half the sums of their lengths and
/// widths. No such position is outside the ellipse `(a, b)` if `(l/a)² + (w/b)² ≤ 1`.
fn too_small_ellipse(scenario: &Scenario, index: usize) -> Option<(String, String)> {
    let vehicle = &scenario.vehicles[index];
    // These drivers do not use an ellipse.
    if matches!(vehicle.driver, Driver::Idm(_) | Driver::Scripted(_) | Driver::Recorded(_) | Driver::External(_)) {
        return None;
    }
    let others = scenario.vehicles.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, other)| other);
    let others = others.filter(|other| other.obstacle.is_none());
    let reach = |other: &Vehicle| corner(&vehicle.safety, covered_m(&vehicle.body, &other.body));
    let worst = others.max_by(|one, other| reach(one).total_cmp(&reach(other))).filter(|worst| reach(worst) > 1.0)?;
    let [length_m, width_m] = covered_m(&vehicle.body, &worst.body);
    let SafetyEllipse { along_m, across_m } = vehicle.safety;
    let message = format!(
        "outside its safety ellipse (`along_m` = {}, `across_m` = {}) vehicle {} may still touch {}",
        readable(along_m),
        readable(across_m),
        quoted(&vehicle.name),
        quoted(&worst.name)
    );
    let share = width_m / across_m;
    let help = if share < 1.0 {
        format!("with this `across_m`, `along_m` must be at least {}", up(length_m / (1.0 - share * share).sqrt()))
    } else {
        format!("`across_m` must be more than {}, and `along_m` more than {}", up(width_m), up(length_m))
    };
    Some((message, help))
}

/// Half the sums of the lengths and of the widths of two parallel bodies, from centre to centre \[m\].
fn covered_m(own: &Body, other: &Body) -> [f64; 2] {
    let length_m = (own.front_m + other.rear_m).max(own.rear_m + other.front_m);
    [length_m, 0.5 * (own.width_m + other.width_m)]
}

fn corner(ellipse: &SafetyEllipse, [length_m, width_m]: [f64; 2]) -> f64 {
    (length_m / ellipse.along_m).powi(2) + (width_m / ellipse.across_m).powi(2)
}

/// Whether a body has another size than its lane. A body that does not fit at all is an error.
fn proportion(scenario: &Scenario, vehicle: &Vehicle) -> Option<(String, String)> {
    let NarrowestLane { width_m: lane_m, key, .. } = narrowest_lane(scenario, vehicle);
    let (width_m, name) = (vehicle.body.width_m, quoted(&vehicle.name));
    // The other classes are full size: a bicycle is much narrower than its lane.
    let may_be_another_size = matches!(vehicle.class, None | Some(VehicleClass::ScaleCar));
    if may_be_another_size && lane_m > MAX_LANE_PER_BODY * width_m {
        let message = format!(
            "vehicle {name} is {} m wide, on lanes of {} m, {} times its width",
            readable(width_m),
            readable(lane_m),
            (lane_m / width_m).round()
        );
        let help = if vehicle.class.is_some() {
            "for a real car state `class = \"car\"`"
        } else {
            "for real cars state `scale = \"full\"`, or the `class` of the vehicle"
        };
        return Some((message, help.to_owned()));
    }
    let most_m = MAX_BODY_PER_LANE * lane_m;
    (width_m > most_m).then(|| {
        let [width_m, lane_m] = [width_m, lane_m].map(readable);
        let message = format!("vehicle {name} is {width_m} m wide and nearly fills its lane of {lane_m} m");
        (message, format!("up to {} m leaves it room to steer; `road.{key}` widens the lane", down(most_m)))
    })
}

/// Whether the body starts on two lanes.
fn off_lane(scenario: &Scenario, vehicle: &Vehicle) -> Option<(String, String)> {
    let at = vehicle.route.locate(vehicle.start.position(), None);
    let (lane, offset_m, lane_m) = match scenario.road.parallel_lanes() {
        Some(lanes) => {
            let centres = (0..lanes.count).filter_map(|lane| scenario.road.lane_centre_m(vehicle.road, lane));
            let offsets_m = centres.map(|centre_m| at.across_m - centre_m).enumerate();
            let (lane, offset_m) = offsets_m.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
            (lane.to_string(), offset_m, lanes.width_m)
        }
        None => {
            let lane = vehicle.route.leg(at.along_m)?.lane.clone();
            (quoted(&lane), at.across_m, 2.0 * vehicle.route.half_width.value(at.along_m))
        }
    };
    let most_m = 0.5 * (lane_m - vehicle.body.width_m).max(0.0);
    (offset_m.abs() > most_m + ROUNDING_M).then(|| {
        let message = format!("vehicle {} starts on the edge of lane {lane}", quoted(&vehicle.name));
        let help = format!(
            "it is {} m off the lane's centre, and up to {} m keeps its body in the lane; `lane` and `along_m` place it there",
            up(offset_m.abs()),
            down(most_m)
        );
        (message, help)
    })
}

/// Whether a vehicle starts at an angle to its road. A start against the road is an error.
fn askew(vehicle: &Vehicle) -> Option<(String, String)> {
    let road_rad = vehicle.route.heading_at(vehicle.start.position());
    let angle_deg = (vehicle.start.heading_rad - road_rad).to_degrees();
    (angle_deg.abs() > MAX_START_ANGLE_DEG).then(|| {
        let message = format!("vehicle {} starts at {}° to its road", quoted(&vehicle.name), angle_deg.round());
        (message, format!("the road runs at `heading_deg = {}` there", (10.0 * road_rad.to_degrees()).round() / 10.0))
    })
}

/// Whether plans end before the vehicle could stop from its speed at the start, or from its desired speed. Drivers that do not
/// look ahead, or follow a script, gain nothing from longer plans.
fn short_horizon(scenario: &Scenario, vehicle: &Vehicle) -> Option<(String, String)> {
    if matches!(vehicle.driver, Driver::Idm(_) | Driver::Scripted(_) | Driver::Recorded(_) | Driver::Inputs(_)) {
        return None;
    }
    let horizon_s = scenario.planning_period_s() * scenario.horizon_steps as f64;
    let fastest_mps = vehicle.goal.speed_mps.unwrap_or(0.0).max(vehicle.start.speed_mps);
    let stop_s = fastest_mps / -vehicle.limits.acceleration_min_mps2;
    (horizon_s < stop_s).then(|| {
        let message = format!(
            "plans reach {} s ahead, but vehicle {} needs {} s to stop from {} m/s",
            down(horizon_s),
            quoted(&vehicle.name),
            up(stop_s),
            readable(fastest_mps)
        );
        let key = if scenario.ticks_per_plan > 1 { "planning_period_s" } else { "step_s" };
        let steps = (stop_s / scenario.planning_period_s()).ceil();
        (
            message,
            format!("`horizon_steps = {steps}` works, or a `{key}` of {}", up(stop_s / scenario.horizon_steps as f64)),
        )
    })
}

/// Rounds up to hundredths, without a negative zero.
fn up(number: f64) -> f64 {
    (100.0 * number - 1e-6).ceil() / 100.0 + 0.0
}

/// Rounds down to hundredths, without a negative zero.
fn down(number: f64) -> f64 {
    (100.0 * number + 1e-6).floor() / 100.0 + 0.0
}

#[cfg(test)]
mod tests {
    use super::{down, up};

    #[test]
    fn bounds_are_rounded_to_the_safe_side_and_zero_has_no_sign() {
        assert_eq!((up(0.1201), down(0.1299)), (0.13, 0.12));
        assert_eq!((up(0.12), down(0.12)), (0.12, 0.12));
        for zero in [up(0.0), up(-0.0), down(0.0), down(-0.0)] {
            assert_eq!(zero.to_string(), "0");
        }
    }
}
