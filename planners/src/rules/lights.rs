//! Where traffic lights ask a vehicle to stop.

use crate::Agent;
use crate::road::network::{LightColour, RouteLeg};
use crate::rules::giving_way::{can_stop, front_m, stopping_distance_m};

/// At amber, who would have to brake harder than this goes on \[m/s²\].
const AMBER_BRAKING_MPS2: f64 = 3.0;
/// A vehicle that already brakes at amber stops even if that takes more braking, up to this \[m/s²\].
const DECIDED_BRAKING_MPS2: f64 = 5.0;
/// A vehicle that decelerates more than this is braking \[m/s²\].
const BRAKES_MPS2: f64 = 0.3;

/// The line of the next traffic light at which a vehicle has to stop now, along its route; none where it goes on \[m\].
pub(super) fn line_m(agent: &Agent, time_s: f64) -> Option<f64> {
    let front_m = front_m(agent);
    let before_m = stopping_distance_m(agent);
    let asks = |leg: &RouteLeg| {
        let Some(light) = &leg.light else { return false };
        match light.colour_at(time_s) {
            LightColour::Red | LightColour::RedAmber => can_stop(agent, leg.to_m - before_m),
            LightColour::Amber => {
                let brakes = agent.previous_input.acceleration_mps2 < -BRAKES_MPS2;
                let most_mps2 = if brakes { DECIDED_BRAKING_MPS2 } else { AMBER_BRAKING_MPS2 };
                let braking_m = agent.state.speed_mps * agent.state.speed_mps / (2.0 * most_mps2);
                front_m + braking_m <= leg.to_m
            }
            LightColour::Green | LightColour::Off => false,
        }
    };
    let ahead = agent.route.legs.iter().filter(|leg| leg.to_m >= front_m);
    ahead.into_iter().find(|leg| asks(leg)).map(|leg| leg.to_m)
}

/// Whether a traffic light works at a line: then the sign there does not count \[m\].
pub(super) fn is_lit(agent: &Agent, line_m: f64, time_s: f64) -> bool {
    let lit = |leg: &RouteLeg| leg.light.as_ref().is_some_and(|light| light.colour_at(time_s) != LightColour::Off);
    agent.route.legs.iter().any(|leg| leg.to_m == line_m && lit(leg))
}
