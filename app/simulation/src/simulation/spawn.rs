//! Builds the rows and components of a scenario's vehicles.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::rules::RoadRules;
use interplay_planners::traffic::RoadUser;
use interplay_planners::{Agent, Goal, Input, State};
use interplay_scenarios::{Scenario, Vehicle};

use crate::physics::{Physics, VehicleBody};
use crate::state::components::{Driving, HandedIn, Identity, TrafficRow};
use crate::state::detail::LevelOfDetail;

/// All components of a vehicle: its name and row, and the state of its plug-ins. All other state is in its row.
#[derive(Bundle, Debug)]
pub struct VehicleState {
    /// Name of the vehicle.
    pub identity: Identity,
    /// Its row in the traffic.
    pub row: TrafficRow,
    /// The driver with its memory, and the sensor.
    pub driving: Driving,
    /// Input or plan from outside for the next tick.
    pub handed_in: HandedIn,
    /// Body of the vehicle in the physics engine.
    pub body: VehicleBody,
}

/// Every vehicle of a scenario at its start, in the scenario's order; each receives a body in `physics`.
pub fn vehicles(scenario: &Scenario, physics: &mut Physics) -> Vec<VehicleState> {
    let vehicles = scenario.vehicles.iter().zip(scenario.starts()).enumerate();
    let vehicles = vehicles.map(|(index, (vehicle, state))| VehicleState {
        identity: Identity { name: vehicle.name.clone() },
        row: TrafficRow(index),
        driving: Driving {
            planner: vehicle.planner().with_deadline(scenario.plan_deadline(vehicle)),
            plan_ms: 0.0,
            sensor: vehicle.sensor(scenario.seed),
            sight: None,
            detail: LevelOfDetail::of(scenario, index),
        },
        handed_in: HandedIn::awaited_if(vehicle.driver.is_driven_from_outside()),
        body: VehicleBody(physics.add(index, (&vehicle.body, vehicle.outline()), &state)),
    });
    vehicles.collect()
}

/// The rows of all vehicles of a scenario at its start, in the scenario's order.
pub fn road_users(scenario: &Scenario) -> Vec<RoadUser> {
    scenario
        .vehicles
        .iter()
        .zip(scenario.starts())
        .map(|(vehicle, state)| road_user(scenario, vehicle, state))
        .collect()
}

fn road_user(scenario: &Scenario, vehicle: &Vehicle, state: State) -> RoadUser {
    let goal = Goal {
        target: vehicle.target(&scenario.road),
        tracking: vehicle.weights.tracking(),
        comfort: vehicle.weights.comfort(),
        safety: vehicle.safety,
    };
    let mut agent = Agent {
        name: vehicle.name.clone(),
        state,
        previous_input: Input { acceleration_mps2: vehicle.start_acceleration_mps2, steering_rad: 0.0 },
        body: vehicle.body,
        limits: vehicle.limits,
        route: Arc::clone(&vehicle.route),
        prediction: Arc::default(),
        shared_goal: vehicle.driver.shared_goal(&goal),
        can_be_asked: vehicle.driver.can_be_asked(),
        is_obstacle: vehicle.outline().is_some(),
        indicator: None,
        rules: RoadRules::default(),
        urgency: 1.0,
        own_place: Default::default(),
    };
    // Wheels that take time to turn are turned along the road at the start.
    if agent.limits.steering_rate_max_radps.is_some() {
        agent.previous_input.steering_rad = agent.steering_along_road_rad();
    }
    RoadUser {
        knows_plans: vehicle.knows_plans(),
        tells_plan: vehicle.tells_plan(),
        reaction_s: vehicle.driver.reaction_s(),
        patience_s: vehicle.driver.patience_s(),
        decides: vehicle.driver.is_vetoed(),
        may_react: vehicle.driver.reacts() && vehicle.sensing.is_none(),
        keeps_rules: vehicle.keeps_rules(),
        presence: vehicle.stay.presence_at_start(),
        stay: vehicle.stay,
        record: vehicle.driver.record().map(Arc::new),
        ..RoadUser::new(agent, goal, vehicle.driver.goes_first())
    }
}
