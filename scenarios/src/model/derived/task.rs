//! What a vehicle has to reach.

use interplay_planners::{Body, Route, State};

use crate::model::scenario::{Scenario, Vehicle};
use crate::roads::Road;

/// Tolerance of the lateral position at the goal, as a share of the lane's width.
const LATERAL_TOLERANCE_SHARE: f64 = 0.15;

/// What a vehicle has to reach on its route. On a road of parallel lanes its centre is to be within 15 % of a lane's width of the goal's
/// lateral position; at an intersection, its rear bumper is to leave the conflict zone; on a network, its rear bumper is to be on the last
/// lane of its route.
#[derive(Clone, Copy, Debug)]
pub enum Task {
    /// A lateral position.
    Lane {
        /// The position beside the route's centre line \[m\].
        lateral_m: f64,
        /// The largest distance from it \[m\].
        tolerance_m: f64,
    },
    /// The far side of the other road, for the whole body.
    Cross {
        /// Where the conflict zone ends, along the route \[m\].
        end_m: f64,
        /// The vehicle's body.
        body: Body,
    },
    /// The last lane of the route, for the whole body.
    LastLane {
        /// Where the lane begins, along the route \[m\].
        from_m: f64,
        /// The vehicle's body.
        body: Body,
    },
}

impl Task {
    /// Whether the task is done in a state, on the route of the vehicle.
    pub fn is_done(&self, route: &Route, state: &State) -> bool {
        let position = state.position();
        match *self {
            Task::Lane { lateral_m, tolerance_m } => (route.across(position) - lateral_m).abs() <= tolerance_m,
            Task::Cross { end_m: place_m, body } | Task::LastLane { from_m: place_m, body } => {
                route.along(position) - body.rear_m > place_m
            }
        }
    }
}

impl Vehicle {
    /// What it has to reach on this road.
    pub fn task(&self, road: &Road) -> Task {
        let route = &self.route;
        let last = route.legs.last().filter(|_| road.parallel_lanes().is_none() && route.legs.len() > 1);
        match (road.conflict_zone_m(self.road), last) {
            (Some([_, end_m]), _) => Task::Cross { end_m, body: self.body },
            (None, Some(leg)) => Task::LastLane { from_m: leg.from_m, body: self.body },
            (None, None) => Task::Lane {
                lateral_m: route.across(self.target(road).position()),
                tolerance_m: LATERAL_TOLERANCE_SHARE * road.lane_width_m(),
            },
        }
    }

    /// Whether it starts away from its goal and does not follow a record: only then can it complete its task.
    pub fn has_task(&self, road: &Road) -> bool {
        self.driver.record().is_none() && !self.task(road).is_done(&self.route, &self.start)
    }
}

impl Scenario {
    /// The expectations that a vehicle completes a task although it has none, by their indices, with its name.
    pub(crate) fn expected_without_task(&self) -> impl Iterator<Item = (usize, &str)> {
        let found = self.expect.completes.iter().enumerate().filter(|(_, completes)| {
            let vehicle = self.vehicles.iter().find(|vehicle| vehicle.name == completes.vehicle);
            vehicle.is_some_and(|vehicle| !vehicle.has_task(&self.road))
        });
        found.map(|(index, completes)| (index, completes.vehicle.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use crate::format::read::overrides::Override;
    use crate::load;

    #[test]
    fn an_expectation_of_a_vehicle_without_a_task_is_remarked_upon() {
        let said = |sets: &[&str]| -> Vec<String> {
            let sets: Vec<Override> = sets.iter().map(|set| Override::Set((*set).to_owned())).collect();
            let scenario = load("lane-change/front-nice", &sets).expect("authored");
            scenario.remarks.iter().map(|remark| remark.to_string()).collect()
        };
        assert!(said(&["expect.completes=[{ vehicle = 'ego' }]"]).is_empty());
        let said = said(&["expect.completes=[{ vehicle = 'front' }]"]);
        assert!(said.iter().any(|remark| remark.contains("`front` has nothing to complete")), "{said:?}");
    }
}
