//! The check of expectations of vehicles.

use interplay_common::spelling::suggestion;

use super::checker::Checker;
use crate::model::expectations::expect::{ExpectedMetric, ExpectedYield};
use crate::model::expectations::metric_bound::MetricBoundKey;
use crate::model::metric::{MetricDeclaration, MetricKind, MetricSubject};
use crate::model::scenario::Vehicle;
use crate::text::error::quoted;
use crate::text::readable::readable;

impl Checker<'_> {
    /// Whether each expectation is about vehicles that exist, and may hold in one run and fail in another.
    pub(super) fn expectations(&mut self) {
        self.order();
        self.collisions();
        let expect = &self.scenario.expect;
        for (index, completes) in expect.completes.iter().enumerate() {
            let path = format!("expect.completes.{index}");
            self.known(&format!("{path}.vehicle"), &completes.vehicle);
            self.window(&path, completes.after_s, completes.before_s);
        }
        for (index, speed) in expect.speed.iter().enumerate() {
            self.bounds("speed", index, &speed.vehicle, &speed.bounds());
        }
        for (index, comfort) in expect.comfort.iter().enumerate() {
            self.bounds("comfort", index, &comfort.vehicle, &comfort.bounds());
        }
        for (index, metric) in expect.metrics.iter().enumerate() {
            self.metric(index, metric);
        }
        for (index, expected) in expect.yields.iter().enumerate() {
            self.yields(index, expected);
        }
        self.speed_limits();
        self.rules();
    }

    /// An order of fewer than two vehicles holds in every run.
    fn order(&mut self) {
        let Some(order) = &self.scenario.expect.order else { return };
        if order.len() < 2 {
            let whom = order.first().map_or("no vehicle".to_owned(), |name| format!("{} only", quoted(name)));
            let names: Vec<String> =
                self.scenario.vehicles.iter().map(|vehicle| format!("\"{}\"", vehicle.name)).collect();
            let help = if names.len() < 2 {
                "leave the key out: one vehicle has no order".to_owned()
            } else {
                format!("name two vehicles or more, such as `order = [{}]`, or leave the key out", names.join(", "))
            };
            self.refuse("expect.order", "can never fail", format!("`expect.order` names {whom}"), &help);
        }
        for (index, name) in order.iter().enumerate() {
            let path = format!("expect.order.{index}");
            self.known(&path, name);
            if order[..index].contains(name) {
                let message = format!("`expect.order` names {} twice", quoted(name));
                self.refuse(&path, "again", message, "");
            }
        }
    }

    fn collisions(&mut self) {
        let Some(collisions) = &self.scenario.expect.collisions else { return };
        if collisions.is_empty() {
            let help = "`no_collision = true` expects that no two vehicles touch";
            self.refuse("expect.collisions", "no pair", "`expect.collisions` names no vehicle".to_owned(), help);
        }
        for (index, pair) in collisions.iter().enumerate() {
            let path = format!("expect.collisions.{index}");
            for (end, name) in pair.iter().enumerate() {
                self.known(&format!("{path}.{end}"), name);
            }
            if pair[0] == pair[1] {
                let message = format!("a vehicle cannot collide with itself: {} is named twice", quoted(&pair[0]));
                self.refuse(&path, "the same vehicle", message, "");
            }
        }
    }

    /// Whether an entry of a list states a bound, for a vehicle that exists.
    fn bounds(&mut self, list: &str, index: usize, vehicle: &str, bounds: &[MetricBoundKey; 4]) {
        let path = format!("expect.{list}.{index}");
        self.known(&format!("{path}.vehicle"), vehicle);
        if bounds.iter().all(|(_, bound, ..)| bound.is_none()) {
            let message = format!("`expect.{list}` for {} expects nothing", quoted(vehicle));
            let [a, b, c, d] = bounds.map(|(key, ..)| key);
            self.refuse(&path, "no bound", message, &format!("state `{a}`, `{b}`, `{c}` or `{d}`"));
        }
    }

    /// Whether an entry bounds a metric that exists, of a vehicle that exists, by a value of the right type. Without
    /// declared metrics, the program that runs the scenario checks this.
    fn metric(&mut self, index: usize, stated: &ExpectedMetric) {
        let ExpectedMetric { name, vehicle, at_most, at_least, is } = stated;
        let path = format!("expect.metric.{index}");
        if let Some(vehicle) = vehicle {
            self.known(&format!("{path}.vehicle"), vehicle);
        }
        let declarations: Vec<MetricDeclaration> =
            self.scenario.metrics.0.iter().map(|one| one.declaration()).collect();
        let declaration = declarations.iter().find(|one| one.name == name);
        if declaration.is_none() && !declarations.is_empty() {
            let names: Vec<&str> = declarations.iter().map(|one| one.name).collect();
            let message = format!("there is no metric {}", quoted(name));
            let help = suggestion(name, "the metrics are", &names);
            return self.refuse(&format!("{path}.name"), "unknown metric", message, &help);
        }
        let is_flag = declaration.map(|one| one.kind == MetricKind::Flag);
        let has_bound = at_most.is_some() || at_least.is_some();
        let help = match is_flag {
            Some(true) => "state `is = true` or `is = false`",
            Some(false) => "state `at_most` or `at_least`",
            None => "state `at_most`, `at_least` or `is`",
        };
        if is_flag.map_or(!has_bound && is.is_none(), |is_flag| if is_flag { is.is_none() } else { !has_bound }) {
            let message = format!("`expect.metric` of {} expects nothing", quoted(name));
            self.refuse(&path, "no bound", message, help);
        } else if is_flag.is_some_and(|is_flag| if is_flag { has_bound } else { is.is_some() }) {
            let key = if is.is_some() && is_flag == Some(false) { "is" } else { "a bound" };
            self.refuse(&path, "of another type", format!("{} cannot have {key}", quoted(name)), help);
        }
        if vehicle.is_some() && declaration.is_some_and(|one| one.of == MetricSubject::Run) {
            let message = format!("{} is a metric of the run, and no vehicle has one of its own", quoted(name));
            self.refuse(&format!("{path}.vehicle"), "not of a vehicle", message, "leave `vehicle` out");
        }
    }

    /// Whether the routes of both vehicles meet, so that one can let the other go first.
    fn yields(&mut self, index: usize, ExpectedYield { vehicle, to }: &ExpectedYield) {
        let path = format!("expect.yields.{index}");
        self.known(&format!("{path}.vehicle"), vehicle);
        self.known(&format!("{path}.to"), to);
        let scenario = self.scenario;
        let (Some(own), Some(other)) = (scenario.vehicle(vehicle), scenario.vehicle(to)) else { return };
        if vehicle == to {
            let message = format!("a vehicle cannot give way to itself: {} is named twice", quoted(to));
            self.refuse(&format!("{path}.to"), "the same vehicle", message, "");
        } else if scenario.road.conflict_zones(own, other).is_empty() {
            let message = format!("the ways of {} and {} never cross or merge", quoted(vehicle), quoted(to));
            let help = "`order` judges vehicles on one road";
            self.refuse(&path, "cannot give way", message, help);
        }
    }

    /// Whether any lane has a speed limit that may be exceeded.
    fn speed_limits(&mut self) {
        let has_limit = |vehicle: &Vehicle| vehicle.route.legs.iter().any(|leg| leg.speed_limit_mps.is_some());
        let scenario = self.scenario;
        if scenario.expect.speed_limit_exceeded_by_at_most_mps.is_some() && !scenario.vehicles.iter().any(has_limit) {
            let path = "expect.speed_limit_exceeded_by_at_most_mps";
            let message = "no lane on the way of any vehicle has a speed limit".to_owned();
            let help = "`max_below_mps` of `[[expect.speed]]` bounds the speed of a vehicle on any road";
            self.refuse(path, "no limit", message, help);
        }
    }

    /// Whether any vehicle keeps rules that it may break.
    fn rules(&mut self) {
        let scenario = self.scenario;
        if scenario.expect.rules_kept.is_some() && !scenario.vehicles.iter().any(Vehicle::keeps_rules) {
            let message = "no vehicle keeps the rules of the road".to_owned();
            let help = "state `rules = \"kept\"` of a vehicle, or `conduct = \"people\"` of the scenario";
            self.refuse("expect.rules_kept", "can never fail", message, help);
        }
    }

    pub(super) fn known(&mut self, path: &str, name: &str) {
        if self.scenario.vehicle(name).is_none() {
            let names: Vec<&str> = self.scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
            let message = format!("there is no vehicle {}", quoted(name));
            self.refuse(path, "unknown vehicle", message, &suggestion(name, "the vehicles are", &names));
        }
    }

    fn window(&mut self, path: &str, after_s: Option<f64>, before_s: Option<f64>) {
        let duration_s = self.scenario.duration_s;
        let shown_s = readable(duration_s);
        match (after_s, before_s) {
            (Some(after), Some(before)) if after >= before => {
                let message = format!("nothing is both after {after} s and before {before} s");
                self.refuse(&format!("{path}.after_s"), "not before `before_s`", message, "");
            }
            (Some(after), _) if after >= duration_s => {
                let message = format!("`after_s` ({after}) is not before the end of the run at {shown_s} s");
                self.refuse(&format!("{path}.after_s"), "after the end", message, "");
            }
            _ => {}
        }
    }
}
