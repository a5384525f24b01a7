//! The check of scripts, triggers, and the times at which vehicles are on the road.

use interplay_planners::Driver;
use interplay_planners::drivers::scripted::Order;
use interplay_planners::scene::trigger::Trigger;

use super::checker::Checker;
use crate::model::scenario::Vehicle;
use crate::model::traffic::plant::Plant;
use crate::text::error::quoted;
use crate::text::readable::readable;

/// The tolerance for rounding beside the road in a script \[m\].
const ROUNDING_M: f64 = 1e-9;

impl Checker<'_> {
    /// A script is checked like a goal: speeds, accelerations, positions, and orders that never begin or contradict each other.
    pub(super) fn script(&mut self, index: usize, vehicle: &Vehicle) {
        let Driver::Scripted(settings) = &vehicle.driver else { return };
        let stated = format!("vehicle.{index}.driver.script");
        if settings.script.is_empty() && self.tree.at(&stated).is_some() {
            let message = format!("the script of vehicle {} has no orders", quoted(&vehicle.name));
            self.refuse(
                &stated,
                "empty",
                message,
                "leave it out: without a script a vehicle keeps its speed and its place",
            );
        }
        for (number, order) in settings.script.iter().enumerate() {
            let path = format!("{stated}.{number}");
            let shown = |key: &str| format!("`vehicle.{}.driver.script.{number}.{key}`", vehicle.name);
            self.script_order(vehicle, &settings.script, number, &path);
            if let Some(speed_mps) = order.speed_mps {
                self.script_speed(vehicle, speed_mps, &format!("{path}.speed_mps"), &shown("speed_mps"));
            }
            if let Some(lateral_m) = order.lateral_m {
                self.script_place(vehicle, lateral_m, &format!("{path}.lateral_m"), &shown("lateral_m"));
            }
            if order.when.is_none() && order.from_s >= self.scenario.duration_s {
                let message = format!("{} ({}) is after the end of the run", shown("from_s"), readable(order.from_s));
                let help = format!("the run takes {} s", readable(self.scenario.duration_s));
                self.refuse(&format!("{path}.from_s"), "never begins", message, &help);
            }
            if let Some(when) = &order.when {
                self.trigger(when, &format!("{path}.when"), &shown("when"));
            }
        }
    }

    /// An order states something, comes after those above it, and does not repeat the time of one that rules the same.
    fn script_order(&mut self, vehicle: &Vehicle, script: &[Order], number: usize, path: &str) {
        let (order, name) = (&script[number], quoted(&vehicle.name));
        if order.speed_mps.is_none() && order.lateral_m.is_none() {
            let message = format!("order {number} of vehicle {name} says neither how fast nor where to drive");
            self.refuse(path, "changes nothing", message, "state `speed_mps`, `lateral_m` or both");
        }
        let above = || script[..number].iter().enumerate().filter(|(_, earlier)| earlier.when == order.when);
        let same = above().find(|(_, earlier)| {
            let rules_the_same = (earlier.speed_mps.is_some() && order.speed_mps.is_some())
                || (earlier.lateral_m.is_some() && order.lateral_m.is_some());
            earlier.from_s == order.from_s && rules_the_same
        });
        if let Some((earlier, _)) = same {
            let message = format!("orders {earlier} and {number} of vehicle {name} begin at one time");
            self.refuse(path, "at the same time", message, "let one of them begin later, or leave it out");
        }
        if let Some((earlier, later)) = above().find(|(_, earlier)| earlier.from_s > order.from_s) {
            let message = format!(
                "order {number} of vehicle {name} begins at {} s, before order {earlier} above it, at {} s",
                readable(order.from_s),
                readable(later.from_s)
            );
            let help = "write the orders in the order of their times: the one that begins last rules";
            self.refuse(&format!("{path}.from_s"), "out of order", message, help);
        }
    }

    fn script_speed(&mut self, vehicle: &Vehicle, speed_mps: f64, path: &str, shown: &str) {
        let (slowest, fastest) = (vehicle.limits.speed_min_mps, vehicle.limits.speed_max_mps);
        if speed_mps < 0.0 {
            let message =
                format!("{shown} ({}) asks for driving backwards, which no vehicle does", readable(speed_mps));
            self.refuse(path, "backwards", message, "0 lets it stand; reversing is not simulated");
        } else if !(slowest..=fastest).contains(&speed_mps) {
            let message = format!("{shown} ({}) is outside the vehicle's limits", readable(speed_mps));
            let help = format!("its speed may be from {} to {}", readable(slowest), readable(fastest));
            self.refuse(path, "outside the limits", message, &help);
        }
    }

    fn script_place(&mut self, vehicle: &Vehicle, lateral_m: f64, path: &str, shown: &str) {
        let at_m = vehicle.route.along(vehicle.start.position());
        let [right_m, left_m] = [&vehicle.route.right, &vehicle.route.left].map(|edge| edge.value(at_m));
        if lateral_m < right_m - ROUNDING_M || lateral_m > left_m + ROUNDING_M {
            let message = format!("{shown} ({}) is beside the road", readable(lateral_m));
            let help = format!("where it starts, the road reaches from {} to {}", readable(right_m), readable(left_m));
            self.refuse(path, "beside the road", message, &help);
        }
    }

    /// A pedestrian may wait for a vehicle.
    pub(super) fn walker(&mut self, index: usize, vehicle: &Vehicle) {
        let Driver::Walker(settings) = &vehicle.driver else { return };
        if let Some(when) = &settings.when {
            let path = format!("vehicle.{index}.driver.when");
            self.trigger(when, &path, &format!("`vehicle.{}.driver.when`", vehicle.name));
        }
    }

    /// A trigger names a vehicle and a position on its route.
    fn trigger(&mut self, trigger: &Trigger, path: &str, shown: &str) {
        self.known(&format!("{path}.vehicle"), &trigger.vehicle);
        let Some(vehicle) = self.scenario.vehicle(&trigger.vehicle) else { return };
        let (route, along_m) = (&vehicle.route, trigger.reaches.along_m);
        let lanes: Vec<String> = route.legs.iter().map(|leg| format!("`{}`", leg.lane)).collect();
        let path = |key: &str| format!("{path}.reaches.{key}");
        match &trigger.reaches.lane {
            Some(lane) if route.along_m(lane, along_m).is_none() => {
                let message = format!("{shown}: lane {} is not on the way of {}", quoted(lane), quoted(&vehicle.name));
                let help = if lanes.is_empty() {
                    "this road has no lanes with names: leave `lane` out".to_owned()
                } else {
                    format!("its way is {}", lanes.join(", "))
                };
                self.refuse(&path("lane"), "not on its way", message, &help);
            }
            None if !lanes.is_empty() => {
                let message = format!("{shown}: nothing says on which lane");
                self.refuse(
                    &path("along_m"),
                    "of which lane",
                    message,
                    &format!("state `lane`: one of {}", lanes.join(", ")),
                );
            }
            _ => {}
        }
    }

    /// The times at which a vehicle is on the road.
    pub(super) fn stay(&mut self, index: usize, vehicle: &Vehicle) {
        let stay = vehicle.stay;
        if stay.is_permanent() {
            return;
        }
        let (name, path) = (quoted(&vehicle.name), format!("vehicle.{index}"));
        let key = if stay.enters_s.is_some() {
            "enters_s"
        } else if stay.leaves_s.is_some() {
            "leaves_s"
        } else {
            "leaves_at_end"
        };
        if matches!(self.scenario.plant, Plant::Dynamic(_)) {
            let message = format!("vehicle {name} comes or leaves, which the dynamic plant cannot carry out");
            self.refuse(&format!("{path}.{key}"), "with the dynamic plant", message, "leave `plant` out");
        }
        if index == self.scenario.ego_index() && stay.enters_s.is_some_and(|enters_s| enters_s > 0.0) {
            let message = format!("the ego, {name}, is not there when the run begins");
            self.refuse(
                &format!("{path}.enters_s"),
                "the ego",
                message,
                "let the others come later, or call another vehicle `ego`",
            );
        }
        if let (Some(enters_s), Some(leaves_s)) = (stay.enters_s, stay.leaves_s)
            && leaves_s <= enters_s
        {
            let message = format!(
                "vehicle {name} leaves ({} s) before it has come ({} s)",
                readable(leaves_s),
                readable(enters_s)
            );
            self.refuse(&format!("{path}.leaves_s"), "too early", message, "let it leave later");
        }
    }
}
