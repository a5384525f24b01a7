//! Plan: every driver decides, those first whose plans others rely on.
//!
//! Humans plan from the front of the road to its rear, so that each knows what the car ahead is about to do; the others
//! follow and know the humans' plans (the source's assumption of perfect prediction), but not one another's: of each
//! other they expect that the last plan goes on, so that it does not matter who is listed first. A planner that fails
//! falls back to its previous plan, shifted, and then to full braking; the failure is recorded and counted. Who has crashed
//! brakes, and is not asked.

use std::time::Instant;

use bevy::ecs::prelude::*;
use interplay_planners::Bicycle;
use interplay_planners::predict::steady;
use interplay_planners::{Agent, Input, Plan, PlanError, Scene, Trajectory};

use crate::components::{Agents, Clock, Identity, Intention, Mind, Motion, Present, Wish};
use crate::frame::{Event, Level, Origin};

/// Lets every driver decide.
pub fn plan(
    mut vehicles: Query<(&Identity, &Motion, &Wish, &mut Mind, &mut Intention)>,
    clock: Res<Clock>,
    mut agents: ResMut<Agents>,
    mut present: ResMut<Present>,
) {
    let mut drivers: Vec<_> = vehicles.iter_mut().collect();
    drivers.sort_by(|(a, _, _, a_mind, _), (b, _, _, b_mind, _)| {
        let ahead = || {
            let along = |index: usize| agents.0[index].corridor.along(agents.0[index].state.position());
            along(b.index).total_cmp(&along(a.index))
        };
        let first = b_mind.goes_first.cmp(&a_mind.goes_first);
        let by_place = if a_mind.goes_first && b_mind.goes_first { ahead() } else { std::cmp::Ordering::Equal };
        first.then(by_place).then(a.index.cmp(&b.index))
    });
    for (identity, motion, wish, mut mind, mut intention) in drivers {
        let scene = scene(identity.index, wish, &clock, &agents.0);
        let frame = &mut present.0;
        let (plan, origin) = if motion.crashed {
            (Plan { trajectory: braking(&scene), ..Plan::default() }, Origin::Crashed)
        } else {
            let began = Instant::now();
            let outcome = mind.planner.plan(&scene);
            frame.vehicles[identity.index].plan_ms = 1e3 * began.elapsed().as_secs_f64();
            settle(outcome, &scene, &intention, &mut frame.events)
        };
        let vehicle = &mut frame.vehicles[identity.index];
        if mind.goes_first {
            agents.0[identity.index].prediction = plan.trajectory.clone();
            vehicle.prediction = plan.trajectory.clone();
        }
        intention.remaining = match origin {
            Origin::Planned => plan.trajectory.horizon().saturating_sub(1),
            Origin::Continued => intention.remaining.saturating_sub(1),
            Origin::Braking | Origin::Crashed => 0,
        };
        intention.plan = Some(plan.trajectory.clone());
        vehicle.input = plan.trajectory.inputs.first().copied().unwrap_or_default();
        vehicle.origin = origin;
        vehicle.plan = plan;
    }
}

/// The moment as one vehicle sees it.
fn scene(index: usize, wish: &Wish, clock: &Clock, agents: &[Agent]) -> Scene {
    let others = agents.iter().enumerate().filter(|(other, _)| *other != index);
    Scene {
        tick: clock.tick,
        step_s: clock.step_s,
        horizon: clock.horizon,
        ego: agents[index].clone(),
        goal: wish.goal,
        others: others.map(|(_, agent)| agent.clone()).collect(),
    }
}

/// The plan, or what to do without one.
fn settle(
    outcome: Result<Plan, PlanError>,
    scene: &Scene,
    intention: &Intention,
    events: &mut Vec<Event>,
) -> (Plan, Origin) {
    let mut note = |level, text| events.push(Event { vehicle: scene.ego.name.clone(), level, text });
    match outcome {
        Ok(plan) => {
            for text in &plan.events {
                note(Level::Note, text.clone());
            }
            (plan, Origin::Planned)
        }
        Err(error) => {
            let (trajectory, origin) = fallback(scene, intention);
            let doing = if origin == Origin::Continued { "continues its previous plan" } else { "brakes" };
            note(Level::Warning, format!("no plan ({error}); {doing}"));
            (Plan { trajectory, ..Plan::default() }, origin)
        }
    }
}

/// The previous plan one step further while inputs of it are left, then full braking.
fn fallback(scene: &Scene, intention: &Intention) -> (Trajectory, Origin) {
    match intention.plan.as_ref().filter(|_| intention.remaining > 0) {
        Some(plan) => (rolled_out(scene, plan.shifted().inputs), Origin::Continued),
        None => (braking(scene), Origin::Braking),
    }
}

/// Full braking until the vehicle stands.
fn braking(scene: &Scene) -> Trajectory {
    let limits = &scene.ego.limits;
    let brake = limits.acceleration_min_mps2;
    rolled_out(scene, steady(&scene.ego.state, brake, limits, scene.horizon, scene.step_s))
}

/// Where inputs lead.
fn rolled_out(scene: &Scene, inputs: Vec<Input>) -> Trajectory {
    let mut states = Vec::new();
    Bicycle::new(&scene.ego.body, scene.step_s).roll_out(&scene.ego.state, &inputs, &mut states);
    Trajectory { states, inputs }
}
