//! From a scenario to entities.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::{Goal, Input};
use interplay_scenarios::Scenario;

use crate::climate::{self, BuildingError};
use crate::components::{
    Clock, Committed, CurrentFrame, Driving, Identity, Motion, Sensed, VehicleGoal, VehicleParameters,
};
use crate::measure::{BuildingMeasures, Measures};
use crate::physics::{Physics, VehicleBody};
use crate::time_points::TimePoint;
use crate::watch::{Watcher, Watchers};

/// A world with everything that the scenario names, seen by `watchers`.
///
/// # Errors
/// [`BuildingError`], for a building that was not checked when it was loaded.
pub fn world(scenario: &Scenario, watchers: Vec<Box<dyn Watcher>>) -> Result<World, BuildingError> {
    let mut world = World::new();
    let mut physics = Physics::new(scenario);
    for (index, (vehicle, state)) in scenario.vehicles.iter().zip(scenario.starts()).enumerate() {
        let handle = physics.add(index, &vehicle.body, &state);
        let goal = Goal {
            target: vehicle.target(&scenario.road),
            tracking: vehicle.weights.tracking(),
            comfort: vehicle.weights.comfort(),
            safety: vehicle.safety,
        };
        world.spawn((
            Identity { index, name: vehicle.name.clone() },
            Motion { state, input: Input::default(), crashed: false },
            VehicleParameters { body: vehicle.body, limits: vehicle.limits, route: Arc::clone(&vehicle.route) },
            VehicleGoal { goal, shared: vehicle.driver.shared_goal(&goal) },
            Driving {
                can_be_asked: vehicle.driver.can_be_asked(),
                planner: vehicle.planner().with_deadline(scenario.plan_deadline(vehicle)),
                goes_first: vehicle.driver.goes_first(),
                knows_plans: vehicle.driver.knows_plans(),
                sensor: vehicle.sensor(scenario.seed),
            },
            Committed::default(),
            VehicleBody(handle),
        ));
    }
    world.insert_resource(Clock { tick: 0, step_s: scenario.step_s, horizon: scenario.horizon_steps });
    world.insert_resource(TimePoint { time_s: 0.0, vehicles: true, building: false });
    world.insert_resource(Sensed::default());
    world.insert_resource(CurrentFrame::default());
    world.insert_resource(Measures::new(scenario));
    world.insert_resource(physics);
    world.insert_resource(Watchers::new(watchers));
    climate::spawn(&mut world, scenario)?;
    let measures = world.get_resource().map(|building| BuildingMeasures::new(building, &scenario.controller()));
    if let Some(measures) = measures {
        world.insert_resource(measures);
    }
    Ok(world)
}
