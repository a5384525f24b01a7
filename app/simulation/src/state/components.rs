//! Components of vehicles, and resources of a world.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::perception::sensing::{Sensor, Sight};
use interplay_planners::traffic::{RoadUser, Traffic};
use interplay_planners::{Input, Planner};

use crate::state::detail::{LevelOfDetail, NotCopied};
use crate::state::frame::{Frame, VehicleFrame};

/// The name of a vehicle.
#[derive(Component, Clone, Debug)]
pub struct Identity {
    /// Name in the scenario.
    pub name: String,
}

/// The row of a vehicle in [`CurrentTraffic`], which holds its state in the loop.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrafficRow(pub usize);

impl TrafficRow {
    /// The vehicle's row.
    pub fn of(self, traffic: &CurrentTraffic) -> &RoadUser {
        &traffic.0.road_users[self.0]
    }
}

/// The driver of a vehicle, with the planner's memory.
#[derive(Component, Debug)]
pub struct Driving {
    /// The planner.
    pub planner: Planner,
    /// Wall time of the plan of this tick, 0 without one \[ms\].
    pub plan_ms: f64,
    /// Sensor of the vehicle; `None` for one that sees all vehicles without error.
    pub sensor: Option<Sensor>,
    /// The vehicles that the sensor sees in this tick.
    pub sight: Option<Sight>,
    /// The drivers near the ego and far from it; none for a vehicle that always has the same driver.
    pub detail: Option<LevelOfDetail>,
}

impl Driving {
    /// Whether the driver may be asked for an input at the next plan, given what is handed in from outside.
    pub fn may_react(&self, handed_in: &HandedIn) -> bool {
        *handed_in == HandedIn::NotExternal && self.planner.reacts() && self.sensor.is_none()
    }

    /// A copy with the same memory, for the driver of the vehicle called `name`.
    ///
    /// # Errors
    /// [`NotCopied`] if the driver cannot be copied.
    pub fn fork(&self, name: &str) -> Result<Self, NotCopied> {
        Ok(Driving {
            planner: self.planner.fork().ok_or_else(|| NotCopied::driver_of(name))?,
            plan_ms: self.plan_ms,
            sensor: self.sensor.clone(),
            sight: self.sight.clone(),
            detail: self.detail.as_ref().map(|detail| detail.fork(name)).transpose()?,
        })
    }
}

/// An input or a plan that the caller sets for the next tick.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub enum HandedIn {
    /// The vehicle has its own driver.
    #[default]
    NotExternal,
    /// The vehicle is driven from outside, and nothing was handed in yet.
    Awaited,
    /// An input.
    Input(Input),
    /// The inputs of a whole plan, one for each step of the horizon.
    Plan(Vec<Input>),
}

impl HandedIn {
    /// Awaits an input if the driver is external.
    pub fn awaited_if(is_external: bool) -> Self {
        if is_external { HandedIn::Awaited } else { HandedIn::NotExternal }
    }

    /// Takes the input; `None` for a vehicle with its own driver.
    pub fn take(&mut self) -> Option<Self> {
        match self {
            HandedIn::NotExternal => None,
            _ => Some(std::mem::replace(self, HandedIn::Awaited)),
        }
    }
}

/// Simulated time.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Clock {
    /// Number of ticks since the run began.
    pub tick: usize,
    /// Length of a tick \[s\].
    pub step_s: f64,
    /// Number of stages of a plan.
    pub horizon: usize,
    /// Number of ticks from one plan to the next.
    pub ticks_per_plan: usize,
}

impl Clock {
    /// Number of ticks since vehicles planned: 0 if they plan in this one.
    pub fn ticks_since_plan(&self) -> usize {
        self.tick % self.ticks_per_plan
    }

    /// Number of plans before this tick.
    pub fn plans(&self) -> usize {
        self.tick.div_ceil(self.ticks_per_plan)
    }

    /// Time between two plans, which is also the length of a stage of a plan \[s\].
    pub fn planning_period_s(&self) -> f64 {
        self.step_s * self.ticks_per_plan as f64
    }

    /// Simulated time at the start of this tick \[s\].
    pub fn time_s(&self) -> f64 {
        self.within_s(0.0)
    }

    /// Simulated time after a share of this tick, rounded to the nanosecond: 29 ticks of 0.1 s are 2.9 s and not
    /// 2.9000000000000004 s \[s\].
    pub fn within_s(&self, share: f64) -> f64 {
        to_nanosecond(self.step_s * (self.tick as f64 + share))
    }
}

/// A time without rounding errors below the nanosecond \[s\].
pub fn to_nanosecond(time_s: f64) -> f64 {
    (time_s * 1e9).round() / 1e9
}

/// All vehicles as plain values, in the scenario's order.
#[derive(Resource, Clone, Debug, Default)]
pub struct CurrentTraffic(pub Traffic);

/// The parts of a tick that are made only if they are measured.
#[derive(Resource, Clone, Copy, Debug)]
pub struct MeasuredParts {
    /// The distances between footprints.
    pub gaps: bool,
    /// The plans of vehicles that have reacted.
    pub plans: bool,
}

/// The vehicles of the last frame, whose memory the next frame uses again.
#[derive(Resource, Clone, Debug, Default)]
pub struct SpareFrames(pub Vec<VehicleFrame>);

/// The threads on which vehicles decide whose decisions do not depend on each other; none decide on the thread of the world.
#[derive(Resource, Clone, Debug, Default)]
pub struct DecidingThreads(pub Option<Arc<rayon::ThreadPool>>);

/// The entity of every vehicle, in the scenario's order.
#[derive(Resource, Clone, Debug, Default)]
pub struct Fleet(pub Vec<Entity>);

/// The frame of the current tick, which the phases fill in.
#[derive(Resource, Clone, Debug, Default)]
pub struct CurrentFrame(pub Frame);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simulated_times_have_no_rounding_errors() {
        let clock = |tick| Clock { tick, step_s: 0.1, horizon: 30, ticks_per_plan: 1 };
        for tick in 0..100_000_u32 {
            let written = format!("{}.{}", tick / 10, tick % 10);
            assert_eq!(format!("{:?}", clock(tick as usize).time_s()), written);
        }
        assert_eq!(clock(29).within_s(0.25), 2.925);
    }
}
