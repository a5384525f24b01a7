//! Sense: components become plain values, in the scenario's order, and sensors measure them.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::Agent;
use interplay_planners::perception::sensing::SensedScene;
use interplay_planners::rules::{RoadRules, RuleBook};
use interplay_planners::traffic::{CommittedPlan, RoadUser, Traffic};
use interplay_planners::trajectory::Statistics;

use crate::phases::presence::Presence;
use crate::state::components::{
    Clock, Committed, CurrentFrame, Driving, Identity, LastVehicles, Motion, Sensed, VehicleGoal, VehicleParameters,
};
use crate::state::frame::{Frame, VehicleFrame};

/// The components of a vehicle that others may see.
type SeenParts = (
    &'static Identity,
    &'static Motion,
    &'static Presence,
    &'static VehicleParameters,
    &'static VehicleGoal,
    &'static Driving,
    &'static Committed,
);

/// The same of one vehicle.
type SeenItem<'w> =
    (&'w Identity, &'w Motion, &'w Presence, &'w VehicleParameters, &'w VehicleGoal, &'w Driving, &'w Committed);

/// Fills [`Sensed`] and opens the tick's [`Frame`].
pub fn sense(
    vehicles: Query<SeenParts>,
    clock: Res<Clock>,
    (mut last, mut sensed): (ResMut<LastVehicles>, ResMut<Sensed>),
    mut current_frame: ResMut<CurrentFrame>,
) {
    let last = std::mem::take(&mut last.0);
    let (traffic, frame) = (&mut sensed.0, &mut current_frame.0);
    let plans = clock.ticks_since_plan() == 0;
    *frame = Frame { tick: clock.tick, time_s: clock.time_s(), plans, ..Frame::default() };
    if !plans {
        frame.vehicles = last;
        return go_on(vehicles.iter(), traffic, frame);
    }
    *traffic = sensed_anew(vehicles.iter(), &clock, std::mem::take(&mut traffic.rule_book));
    let mut names = last.into_iter().map(|vehicle| vehicle.name);
    let vehicles = traffic.road_users.iter().map(|user| VehicleFrame {
        name: names.next().unwrap_or_else(|| user.agent.name.clone()),
        state: user.agent.state,
        is_absent: user.is_absent,
        ..VehicleFrame::default()
    });
    frame.vehicles = vehicles.collect();
}

/// Between two plans only the states are new: everybody follows the last plan, and what happened while it planned is told once.
fn go_on<'w>(vehicles: impl Iterator<Item = SeenItem<'w>>, traffic: &mut Traffic, frame: &mut Frame) {
    for VehicleFrame { plan, plan_ms, .. } in &mut frame.vehicles {
        plan.events.clear();
        plan.statistics = Statistics::default();
        *plan_ms = 0.0;
    }
    for (identity, motion, ..) in vehicles {
        traffic.road_users[identity.index].agent.state = motion.state;
        frame.vehicles[identity.index].state = motion.state;
    }
}

/// Whether vehicles plan in this tick.
pub fn plans_now(clock: Res<Clock>) -> bool {
    clock.ticks_since_plan() == 0
}

/// Lets every sensor measure the others. The plans that they will tell are joined to what is seen in the phase Plan.
pub fn look(mut vehicles: Query<(&Identity, &mut Driving)>, mut sensed: ResMut<Sensed>) {
    if vehicles.iter().any(|(_, driving)| driving.sensor.is_some()) {
        sensed.0.find_neighbours();
    }
    for (identity, mut driving) in &mut vehicles {
        let Driving { sensor, sight, .. } = &mut *driving;
        *sight = sensor.as_mut().map(|sensor| sensor.look(&sensed.0.moment(identity.index)));
    }
}

/// What the drivers of some vehicles would be given at the next tick, before anybody has planned in it; none if one of them is not there.
pub fn observed(world: &World, wanted: &[usize]) -> Option<Vec<SensedScene>> {
    let mut vehicles = world.try_query::<SeenParts>()?;
    let rule_book = world.get_resource::<Sensed>()?.0.rule_book.clone();
    let mut traffic = sensed_anew(vehicles.iter(world), world.get_resource()?, rule_book);
    traffic.predict();
    let sensed = |vehicle: &usize| {
        let scene = (*vehicle < traffic.road_users.len()).then(|| traffic.scene(*vehicle))?;
        let (.., driving, _) = vehicles.iter(world).find(|(identity, ..)| identity.index == *vehicle)?;
        let mut sensor = driving.sensor.clone();
        Some(sensor.as_mut().map_or_else(|| SensedScene::perfect(&scene), |sensor| sensor.sense(&scene)))
    };
    wanted.iter().map(sensed).collect()
}

/// Everybody as plain values, in the scenario's order.
fn sensed_anew<'w>(vehicles: impl Iterator<Item = SeenItem<'w>>, clock: &Clock, rule_book: RuleBook) -> Traffic {
    let mut sorted: Vec<_> = vehicles.collect();
    sorted.sort_by_key(|(identity, ..)| identity.index);
    let road_users =
        sorted.into_iter().map(|(identity, motion, presence, parameters, objective, driving, committed)| RoadUser {
            agent: Agent {
                name: identity.name.clone(),
                state: motion.state,
                previous_input: motion.input,
                body: parameters.body,
                limits: parameters.limits,
                route: Arc::clone(&parameters.route),
                prediction: Arc::default(),
                shared_goal: objective.shared,
                can_be_asked: driving.can_be_asked,
                is_obstacle: parameters.outline.is_some(),
                rules: RoadRules::default(),
                urgency: 1.0,
            },
            goal: objective.goal,
            goes_first: driving.goes_first,
            knows_plans: driving.knows_plans,
            keeps_rules: driving.keeps_rules,
            is_crashed: motion.crashed,
            is_absent: presence.is_absent(),
            // Whoever follows a record is expected to keep its speed, from where it is now on.
            committed: if parameters.hides_plan_at(clock.time_s()) {
                CommittedPlan::default()
            } else {
                committed.0.clone()
            },
        });
    let road_users = road_users.collect();
    let step_s = clock.planning_period_s();
    Traffic { tick: clock.plans(), step_s, horizon: clock.horizon, road_users, rule_book, ..Traffic::default() }
}
