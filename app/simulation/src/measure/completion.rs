//! The time at which a vehicle reaches its goal.

use std::sync::Arc;

use interplay_planners::{Route, State};
use interplay_scenarios::{Road, Task, Vehicle};

/// Whether and when a vehicle completes its [`Task`]. A vehicle that starts at its goal has no task, nor has a vehicle that follows a
/// record.
#[derive(Clone, Debug)]
pub struct Completion {
    route: Arc<Route>,
    task: Task,
    has_task: bool,
    /// Time at which the goal was first reached \[s\].
    pub completed_s: Option<f64>,
}

impl Completion {
    /// A measure of whether a vehicle completes its task on this road.
    pub fn new(vehicle: &Vehicle, road: &Road) -> Self {
        Completion {
            route: Arc::clone(&vehicle.route),
            task: vehicle.task(road),
            has_task: vehicle.has_task(road),
            completed_s: None,
        }
    }

    /// The arc length of a position on its road \[m\].
    pub fn along_m(&self, position: [f64; 2]) -> f64 {
        self.route.along(position)
    }

    /// Whether the vehicle started away from its goal and therefore has a task.
    pub fn has_task(&self) -> bool {
        self.has_task
    }

    /// Whether the task is to cross the other road.
    pub fn crosses(&self) -> bool {
        matches!(self.task, Task::Cross { .. })
    }

    /// Updates the measure with a state; returns whether the goal is reached for the first time.
    pub fn observe(&mut self, state: &State, time_s: f64) -> bool {
        let reached = self.has_task && self.completed_s.is_none() && self.task.is_done(&self.route, state);
        if reached {
            self.completed_s = Some(time_s);
        }
        reached
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::{Scenario, load};

    use super::*;

    fn at(route: &Route, along_m: f64, across_m: f64) -> State {
        let [x_m, y_m] = route.position(along_m, across_m);
        State { x_m, y_m, ..State::default() }
    }

    fn ego(scenario: &Scenario) -> &Vehicle {
        scenario.vehicles.iter().find(|vehicle| vehicle.name == "ego").expect("an ego")
    }

    /// Whether a vehicle completes its task in a state; only the first time counts.
    fn reaches(vehicle: &Vehicle, road: &Road, state: &State) -> bool {
        let mut completion = Completion::new(vehicle, road);
        assert!(completion.has_task());
        let reached = completion.observe(state, 3.0);
        assert_eq!(completion.completed_s, reached.then_some(3.0));
        assert!(!completion.observe(state, 4.0), "it is reached once");
        assert_eq!(completion.completed_s, reached.then_some(3.0));
        reached
    }

    #[test]
    fn a_target_lane_is_reached_within_fifteen_percent_of_its_width() {
        let scenario = load("lane-change/front-nice", &[]).expect("authored");
        let (ego, road) = (ego(&scenario), &scenario.road);
        let wanted_m = ego.route.across(ego.target(road).position());
        let beside = |widths: f64| at(&ego.route, 2.0, wanted_m + widths * road.lane_width_m());
        assert!([-0.149, 0.149].into_iter().all(|widths| reaches(ego, road, &beside(widths))));
        assert!(![-0.151, 0.151].into_iter().any(|widths| reaches(ego, road, &beside(widths))));
        let mut there = ego.clone();
        there.start = beside(0.0);
        let mut nothing = Completion::new(&there, road);
        assert!(!nothing.has_task() && !nothing.observe(&beside(0.0), 1.0) && !nothing.crosses());
        assert_eq!(nothing.completed_s, None);
        assert!((nothing.along_m(beside(0.0).position()) - 2.0).abs() < 1e-9);
    }

    /// The rear bumper counts: at the other road, and at the last lane of a route.
    #[test]
    fn a_conflict_zone_is_cleared_by_the_rear_bumper() {
        for (name, crosses) in [("intersection/nice", true), ("roundabout/nice", false)] {
            let scenario = load(name, &[]).expect("authored");
            let (ego, road) = (ego(&scenario), &scenario.road);
            let last_m = ego.route.legs.last().map(|leg| leg.from_m);
            let place_m = road.conflict_zone_m(ego.road).map(|[_, end_m]| end_m).or(last_m).expect("a place");
            let behind = |by_m: f64| at(&ego.route, place_m + ego.body.rear_m + by_m, 0.0);
            assert!(reaches(ego, road, &behind(0.02)) && !reaches(ego, road, &behind(-0.02)), "{name}");
            assert_eq!(Completion::new(ego, road).crosses(), crosses, "{name}");
        }
    }
}
