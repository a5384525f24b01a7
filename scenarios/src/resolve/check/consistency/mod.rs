//! The check of meaning: positions, names and times that do not fit together.
//!
//! Every key already has the right type and range; the tree holds their places.

mod building;
mod checker;
mod conduct;
pub(crate) mod counterfactual;
mod detectors;
mod expectations;
mod road;
mod zones;

use interplay_planners::{Body, State};

use crate::format::json_schema::SchemaNode;
use crate::format::read::tree::TomlNode;
use crate::model::derived::narrowest_lane::{NarrowestLane, narrowest_lane};
use crate::model::scenario::{Scenario, Vehicle};
use crate::model::traffic::lane_reference::LaneReference;
use crate::model::traffic::plant::Plant;
use crate::resolve::budget;
use crate::roads::{Branch, Road};
use crate::text::error::{Fault, Place, quoted};
use crate::text::readable::readable;
use checker::Checker;

pub(crate) use road::{curve_faults, no_such_lane};

/// The most ticks a run may take.
const MAX_TICKS: f64 = 100_000.0;
/// The tolerance for rounding of a corner beyond the road \[m\].
const ROUNDING_M: f64 = 1e-9;

/// All inconsistencies.
pub(crate) fn check(scenario: &Scenario, tree: &TomlNode, schema: SchemaNode) -> Vec<Fault> {
    let mut checker = Checker::new(scenario, tree);
    checker.times();
    checker.names();
    checker.road();
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        if vehicle.obstacle.is_some() {
            continue;
        }
        checker.branch(index, vehicle);
        checker.goal(index, vehicle);
        checker.driver(index, vehicle);
        checker.script(index, vehicle);
        checker.walker(index, vehicle);
        checker.stay(index, vehicle);
        // A recorded vehicle really had its speed and position, beside the lanes too: neither is checked.
        if vehicle.driver.record().is_some() {
            checker.recorded(index, vehicle);
            continue;
        }
        checker.limits(index, vehicle);
        checker.width(index, vehicle);
        checker.turns(index, vehicle);
    }
    checker.starts();
    checker.detectors();
    checker.expectations();
    checker.faults.extend(building::check(scenario, tree, schema));
    if checker.faults.is_empty() {
        checker.faults = budget::check(scenario, tree);
    }
    checker.faults
}

/// The faults of the times of a scenario, whose vehicles may have no positions.
pub(crate) fn check_times(scenario: &Scenario, tree: &TomlNode) -> Vec<Fault> {
    let mut checker = Checker::new(scenario, tree);
    checker.times();
    checker.faults
}

impl Checker<'_> {
    fn times(&mut self) {
        let Scenario { duration_s, step_s, .. } = *self.scenario;
        let [shown_s, shown_step_s] = [duration_s, step_s].map(readable);
        if duration_s < step_s {
            let message = format!("`duration_s` ({shown_s}) is shorter than one step (`step_s` = {shown_step_s})");
            self.refuse("duration_s", "too short", message, "simulate at least one step");
        } else if duration_s / step_s > MAX_TICKS {
            let message = format!("{shown_s} s in steps of {shown_step_s} s are more than {MAX_TICKS} ticks");
            self.refuse("duration_s", "too long", message, "shorten `duration_s` or lengthen `step_s`");
        }
    }

    fn names(&mut self) {
        let vehicles = &self.scenario.vehicles;
        for (index, vehicle) in vehicles.iter().enumerate() {
            if let Some(first) = vehicles[..index].iter().position(|earlier| earlier.name == vehicle.name) {
                let what = if vehicle.obstacle.is_some() { "two vehicles or obstacles" } else { "two vehicles" };
                let message = format!("{what} are called {}", quoted(&vehicle.name));
                let [second, first] = [index, first].map(|index| format!("{}.name", self.path(index)));
                let fault = Fault::at(self.place(&second), "the second", message);
                let fault = fault.also(self.place(&first), "the first");
                self.faults.push(fault.help("give each vehicle a name of its own"));
            }
        }
    }

    fn limits(&mut self, index: usize, vehicle: &Vehicle) {
        let (name, limits, path) = (&vehicle.name, vehicle.limits, format!("vehicle.{index}"));
        let (slowest, fastest) = (limits.speed_min_mps, limits.speed_max_mps);
        let inside = slowest..=fastest;
        let [slowest, fastest] = [slowest, fastest].map(readable);
        if inside.is_empty() || inside.start() == inside.end() {
            let message =
                format!("`vehicle.{name}.limits`: the smallest speed ({slowest}) is not below the largest ({fastest})");
            self.refuse(&format!("{path}.limits.speed_min_mps"), "not below the largest", message, "");
            return;
        }
        let speeds = [("start", Some(vehicle.start.speed_mps)), ("goal", vehicle.goal.speed_mps)];
        for (table, speed) in speeds {
            if let Some(speed) = speed.filter(|speed| !inside.contains(speed)).map(readable) {
                let message = format!("`vehicle.{name}.{table}.speed_mps` ({speed}) is outside the vehicle's limits");
                let help = format!(
                    "its speed may be from {slowest} to {fastest}: `speed_min_mps` and `speed_max_mps` in its `limits`, which \
                     follow from its `class`, or the file's `scale`, where nothing is said of them"
                );
                self.refuse(&format!("{path}.{table}.speed_mps"), "outside the limits", message, &help);
            }
        }
    }

    fn width(&mut self, index: usize, vehicle: &Vehicle) {
        let NarrowestLane { width_m: lane_m, place, key } = narrowest_lane(self.scenario, vehicle);
        if vehicle.body.width_m <= lane_m {
            return;
        }
        let [width_m, lane_m] = [vehicle.body.width_m, lane_m].map(readable);
        let name = quoted(&vehicle.name);
        let message = match place {
            None => format!("vehicle {name} is {width_m} m wide, but a lane only {lane_m} m"),
            Some((lane, along_m)) => format!(
                "vehicle {name} is {width_m} m wide, but lane {} on its route only {lane_m} m, {} m along it",
                quoted(&lane),
                readable(along_m)
            ),
        };
        let help = format!("widen `road.{key}`, or state the `class` and `scale` that both are of");
        let place = self.place(&format!("vehicle.{index}.body.width_m"));
        let fault = Fault::at(place, "wider than its lane", message).help(help);
        let stated = self.tree.at(&format!("road.{key}"));
        self.faults.push(stated.into_iter().fold(fault, |fault, width| fault.also(&width.place, "this width")));
    }

    fn goal(&mut self, index: usize, vehicle: &Vehicle) {
        let (name, goal, road) = (&vehicle.name, &vehicle.goal, &self.scenario.road);
        let path = format!("vehicle.{index}.goal");
        let number = goal.lane.as_ref().and_then(LaneReference::number);
        let refused = number.and_then(|lane| no_such_lane(&format!("vehicle.{name}.goal.lane"), lane, road));
        if let Some((message, help)) = refused {
            self.refuse(&format!("{path}.lane"), "no such lane", message, &help);
        }
        if number == Some(0) && road.lane_end().is_some() {
            let (ramp, it) = if matches!(road, Road::Curve(_)) { ("", "it") } else { ("the ramp, ", "the ramp") };
            let message = format!("`vehicle.{name}.goal.lane` is 0, {ramp}which ends");
            self.refuse(&format!("{path}.lane"), "this lane ends", message, &format!("lane 1 is the one beside {it}"));
        }
        if goal.y_m.is_some() && (vehicle.road == Branch::Cross || road.corridor(vehicle.road).is_none()) {
            let (which, label) = match (vehicle.road, road) {
                (Branch::Cross, _) => ("the crossing road", "along this road"),
                (Branch::Main, Road::Curve(_)) => ("a curve", "y of the world"),
                (Branch::Main, _) => ("a network of lanes", "y of the world"),
            };
            let message = format!("`vehicle.{name}.goal.y_m` is not a lateral position on {which}");
            self.refuse(&format!("{path}.y_m"), label, message, "state its `lane`");
            return;
        }
        if let Some(y_m) = goal.y_m.filter(|y_m| !(0.0..=road.width_m()).contains(y_m)) {
            let message = format!("`vehicle.{name}.goal.y_m` ({}) is beside the road", readable(y_m));
            self.refuse(&format!("{path}.y_m"), "beside the road", message, &extent(road, vehicle.road));
        }
        if vehicle.weights.x > 0.0 {
            let message =
                format!("`vehicle.{name}.weights.x` is not 0, but nothing along its road can be a vehicle's goal");
            self.refuse(&format!("vehicle.{index}.weights.x"), "must be 0", message, "");
        }
    }

    fn driver(&mut self, index: usize, vehicle: &Vehicle) {
        let Err(error) = vehicle.driver.check(self.scenario.horizon_steps) else { return };
        let key = error.key();
        let message = format!("`vehicle.{}.driver.{key}` {error}", vehicle.name);
        self.refuse(&format!("vehicle.{index}.driver.{key}"), error.label(), message, &error.remedy());
    }

    /// A record moves its vehicle along the record only: tyres and random starts do not apply.
    fn recorded(&mut self, index: usize, vehicle: &Vehicle) {
        let name = quoted(&vehicle.name);
        if matches!(self.scenario.plant, Plant::Dynamic(_)) {
            let message = format!("vehicle {name} follows a record, which the dynamic plant cannot carry out");
            let help = "leave `plant` out, or give the vehicle another driver";
            self.refuse(&format!("vehicle.{index}.driver.kind"), "with the dynamic plant", message, help);
        }
    }

    fn starts(&mut self) {
        let (scenario, starts) = (self.scenario, self.scenario.starts());
        let jitter = scenario.start_jitter;
        let moved = if jitter.position_m > 0.0 { " (moved by `start_jitter`)" } else { "" };
        let pairs = || scenario.vehicles.iter().zip(&starts).enumerate();
        for (index, (vehicle, start)) in pairs() {
            let path = format!("vehicle.{index}.start");
            let is_recorded = vehicle.driver.record().is_some();
            // Only the corners count: on a curve, the inner side of a long body reaches further than they do.
            if !is_recorded && !vehicle.route.contains(&vehicle.body, start, ROUNDING_M) {
                let message = format!("vehicle {} starts outside the road{moved}", quoted(&vehicle.name));
                let help = format!("{}, and the whole body must lie on it", extent(&scenario.road, vehicle.road));
                self.refuse(&path, "a corner is beside the road", message, &help);
            }
            for (other_index, (other, other_start)) in pairs().take(index) {
                // Boxes of recorded vehicles overlap where the record is inexact.
                let come_later = |vehicle: &Vehicle| vehicle.stay.enters_s.is_some_and(|enters_s| enters_s > 0.0);
                if (is_recorded && other.driver.record().is_some()) || come_later(vehicle) || come_later(other) {
                    continue;
                }
                if overlap(&vehicle.body, start, &other.body, other_start) {
                    let message = format!(
                        "vehicles {} and {} overlap at the start{moved}",
                        quoted(&other.name),
                        quoted(&vehicle.name)
                    );
                    let [own, others] = [index, other_index].map(|index| self.place_of_footprint(index));
                    // The flag or key that moved one vehicle onto the other is blamed, not the file that it changes.
                    let (blamed, other) =
                        if others.document.rank < own.document.rank { (others, own) } else { (own, others) };
                    let fault = Fault::at(blamed, "overlaps", message).also(other, "with this one");
                    self.faults.push(
                        fault.help(
                            "`x_m` and `y_m` are the mass centre; `body` says how far the vehicle reaches from it",
                        ),
                    );
                }
            }
        }
    }
}

/// The keys besides a vehicle's own that determine its footprint at the start.
const SHARED_CAUSES: [&str; 4] = ["scale", "defaults.class", "defaults.body", "road"];
/// The key that does so if starts are moved at random.
const CAUSES_OF_JITTER: [&str; 2] = ["start_jitter", "seed"];

impl Checker<'_> {
    /// The place of the key that puts the footprint of a vehicle where it is at the start: of all such keys, the one that was merged
    /// last; its start if all are in one file.
    fn place_of_footprint(&self, index: usize) -> &Place {
        let path = self.path(index);
        if self.scenario.vehicles[index].obstacle.is_some() {
            return self.place(&path);
        }
        let own = ["start", "body", "class"].map(|key| format!("{path}.{key}"));
        let is_moved = self.scenario.start_jitter.position_m > 0.0;
        let random = CAUSES_OF_JITTER.iter().filter(|_| is_moved);
        let causes = own.into_iter().chain(SHARED_CAUSES.iter().chain(random).map(|path| (*path).to_owned()));
        let stated = causes.filter(|path| self.tree.at(path).is_some()).map(|path| self.tree.place_of(&path));
        stated.min_by_key(|place| place.document.rank).unwrap_or(&self.tree.place)
    }
}

fn extent(road: &Road, branch: Branch) -> String {
    let (width, half) = (readable(road.width_m()), readable(0.5 * road.width_m()));
    if road.parallel_lanes().is_none() {
        return "a vehicle may use its own lane and those beside it into which it may change".to_owned();
    }
    match (road, branch) {
        (Road::Curve(curve), _) => {
            let end = curve.lane_end.map(|end| readable(end.end_m));
            let end = end.map(|end_m| format!(", and its lane 0 narrows until it ends after {end_m} m"));
            format!("the road reaches {half} m to either side of its middle{}", end.unwrap_or_default())
        }
        (Road::RampMerge(ramp), _) => {
            let end = readable(ramp.ramp_end_m);
            format!("the road reaches from y = 0 to y = {width}, and its lane 0 narrows until it ends at x = {end}")
        }
        (_, Branch::Main) => format!("the road reaches from y = 0 to y = {width}"),
        (_, Branch::Cross) => format!(
            "the crossing road reaches {0} to either side of its middle, which runs through x = 0, y = {0} at {1} degrees",
            half,
            readable(road.heading_rad(branch).to_degrees())
        ),
    }
}

/// Whether two footprints share more than a line: no edge of either separates them (separating axis theorem).
pub(crate) fn overlap(first: &Body, at: &State, second: &Body, other_at: &State) -> bool {
    let (corners, other_corners) = (first.corners(at), second.corners(other_at));
    let headings = [at.heading_rad, other_at.heading_rad].map(libm::sincos);
    let axes = headings.iter().flat_map(|(sin, cos)| [[*cos, *sin], [-sin, *cos]]);
    let mut gaps = axes.map(|axis| {
        let (low, high) = projection(&corners, axis);
        let (other_low, other_high) = projection(&other_corners, axis);
        (other_low - high).max(low - other_high)
    });
    gaps.all(|gap| gap < -ROUNDING_M)
}

/// The projection of a rectangle onto an axis.
fn projection(corners: &[[f64; 2]; 4], [x, y]: [f64; 2]) -> (f64, f64) {
    let along = corners.map(|corner| corner[0] * x + corner[1] * y);
    along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(*at), high.max(*at)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two equal cars of 0.4 m × 0.19 m, the second elsewhere and turned.
    fn touches(x_m: f64, y_m: f64, heading_rad: f64) -> bool {
        let text =
            "title = 'a'\nshows = 'b'\nvehicle = [{ name = 'a', start = { x_m = 0, y_m = 0.2, speed_mps = 1 } }]";
        let scenario = crate::from_text("cars.toml", text, &[]).expect("a scenario without fault");
        let (car, start) = (&scenario.vehicles[0], State::default());
        let other = State { x_m, y_m, heading_rad, speed_mps: 0.0 };
        let (one_way, other_way) =
            (overlap(&car.body, &start, &car.body, &other), overlap(&car.body, &other, &car.body, &start));
        assert_eq!(one_way, other_way, "touching is mutual");
        one_way
    }

    #[test]
    fn footprints_touch_when_no_edge_separates_them() {
        assert!(touches(0.0, 0.0, 0.0));
        assert!(touches(0.399, 0.189, 0.0));
        assert!(!touches(0.4, 0.0, 0.0), "bumper to bumper");
        assert!(!touches(0.0, 0.19, 0.0), "door to door");
        // Turned by 45°, the bounding boxes overlap, the rectangles do not.
        assert!(!touches(0.40, 0.21, -std::f64::consts::FRAC_PI_4));
        assert!(touches(0.28, 0.14, -std::f64::consts::FRAC_PI_4));
    }
}
