//! From a scenario to the components of its vehicles.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::{Goal, Input};
use interplay_scenarios::Scenario;

use crate::phases::presence::Presence;
use crate::physics::{Physics, VehicleBody};
use crate::state::components::{Committed, Driving, HandedIn, Identity, Motion, VehicleGoal, VehicleParameters};
use crate::state::detail::LevelOfDetail;

/// All components of a vehicle.
#[derive(Bundle, Debug)]
pub struct VehicleState {
    /// Index and name of the vehicle.
    pub identity: Identity,
    /// State, last input, and whether it has crashed.
    pub motion: Motion,
    /// Whether it is on the road.
    pub presence: Presence,
    /// Body, limits and route.
    pub parameters: VehicleParameters,
    /// The goal of the vehicle.
    pub goal: VehicleGoal,
    /// The driver with all that it remembers, and the sensor.
    pub driving: Driving,
    /// Inputs or a plan that were handed in from outside for the next tick.
    pub handed_in: HandedIn,
    /// The plan that it decided on last.
    pub committed: Committed,
    /// Body of the vehicle in the physics engine.
    pub body: VehicleBody,
}

/// Every vehicle of a scenario at its start, in the scenario's order; each gets a body in `physics`.
pub fn vehicles(scenario: &Scenario, physics: &mut Physics) -> Vec<VehicleState> {
    let vehicles = scenario.vehicles.iter().zip(scenario.starts()).enumerate();
    let vehicles = vehicles.map(|(index, (vehicle, state))| {
        let goal = Goal {
            target: vehicle.target(&scenario.road),
            tracking: vehicle.weights.tracking(),
            comfort: vehicle.weights.comfort(),
            safety: vehicle.safety,
        };
        let input = Input { acceleration_mps2: vehicle.start_acceleration_mps2, steering_rad: 0.0 };
        VehicleState {
            identity: Identity { index, name: vehicle.name.clone() },
            motion: Motion { state, input, crashed: false },
            presence: Presence::at_start(&vehicle.stay),
            parameters: VehicleParameters {
                body: vehicle.body,
                limits: vehicle.limits,
                route: Arc::clone(&vehicle.route),
                outline: vehicle.outline().cloned(),
                stay: vehicle.stay,
                record: vehicle.driver.record().map(Arc::new),
            },
            goal: VehicleGoal { goal, shared: vehicle.driver.shared_goal(&goal) },
            driving: Driving {
                can_be_asked: vehicle.driver.can_be_asked(),
                planner: vehicle.planner().with_deadline(scenario.plan_deadline(vehicle)),
                goes_first: vehicle.driver.goes_first(),
                knows_plans: vehicle.driver.knows_plans(),
                keeps_rules: vehicle.keeps_rules(),
                sensor: vehicle.sensor(scenario.seed),
                sight: None,
                detail: LevelOfDetail::of(scenario, index),
            },
            handed_in: HandedIn::awaited_if(vehicle.driver.is_driven_from_outside()),
            committed: Committed::default(),
            body: VehicleBody(physics.add(index, (&vehicle.body, vehicle.outline()), &state)),
        }
    });
    vehicles.collect()
}
