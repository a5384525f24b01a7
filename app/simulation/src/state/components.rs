//! What the entities carry: components of vehicles, and the resources of a world.

use bevy_ecs::prelude::*;
use interplay_planners::perception::sensing::{Sensor, Sight};
use interplay_planners::traffic::{RoadUser, Traffic};
use interplay_planners::{Input, Planner};

use crate::state::detail::LevelOfDetail;
use crate::state::frame::Frame;
use crate::state::not_copied::NotCopied;

/// The name of a vehicle.
#[derive(Component, Clone, Debug)]
pub struct Identity {
    /// Name in the scenario.
    pub name: String,
}

/// The row of a vehicle in [`CurrentTraffic`], where all that the loop keeps of it stands.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrafficRow(pub usize);

impl TrafficRow {
    /// The vehicle's row.
    pub fn of(self, traffic: &CurrentTraffic) -> &RoadUser {
        &traffic.0.road_users[self.0]
    }
}

/// The driver of a vehicle, with all that the planner remembers.
#[derive(Component, Debug)]
pub struct Driving {
    /// The planner.
    pub planner: Planner,
    /// Wall time of the plan of this tick, 0 without one \[ms\].
    pub plan_ms: f64,
    /// Sensor of the vehicle; `None` for one that sees everybody as it is.
    pub sensor: Option<Sensor>,
    /// The vehicles that the sensor sees in this tick.
    pub sight: Option<Sight>,
    /// Who takes turns at the wheel, near the ego and far from it; none for a vehicle that drives in the same way everywhere.
    pub detail: Option<LevelOfDetail>,
}

impl Driving {
    /// A copy that remembers the same, of the driver of a vehicle called `name`.
    ///
    /// # Errors
    /// [`NotCopied`] if the driver does not fork.
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

/// Inputs or a plan that were handed in from outside for the next tick.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub enum HandedIn {
    /// Nothing ever is: the vehicle has a driver of its own.
    #[default]
    NotExternal,
    /// Nothing yet.
    Awaited,
    /// An input.
    Input(Input),
    /// The inputs of a whole plan, one for each step of the horizon.
    Plan(Vec<Input>),
}

impl HandedIn {
    /// Nothing yet, if the driver is external.
    pub fn awaited_if(is_external: bool) -> Self {
        if is_external { HandedIn::Awaited } else { HandedIn::NotExternal }
    }

    /// Takes what was handed in; none for a vehicle with a driver of its own.
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
    /// How many ticks there are from one plan to the next.
    pub ticks_per_plan: usize,
}

impl Clock {
    /// How many ticks have passed since vehicles planned: 0 where they plan in this one.
    pub fn ticks_since_plan(&self) -> usize {
        self.tick % self.ticks_per_plan
    }

    /// How often vehicles have planned before this tick.
    pub fn plans(&self) -> usize {
        self.tick.div_ceil(self.ticks_per_plan)
    }

    /// Time from one plan to the next, and length of a stage of a plan \[s\].
    pub fn planning_period_s(&self) -> f64 {
        self.step_s * self.ticks_per_plan as f64
    }

    /// Simulated time at the start of this tick \[s\].
    pub fn time_s(&self) -> f64 {
        self.within_s(0.0)
    }

    /// Simulated time when a share of this tick has passed, to the nanosecond: 29 ticks of 0.1 s are 2.9 s and not
    /// 2.9000000000000004 s \[s\].
    pub fn within_s(&self, share: f64) -> f64 {
        to_nanosecond(self.step_s * (self.tick as f64 + share))
    }
}

/// A time without the rounding errors of its making \[s\].
pub fn to_nanosecond(time_s: f64) -> f64 {
    (time_s * 1e9).round() / 1e9
}

/// All vehicles as plain values, in the scenario's order.
#[derive(Resource, Clone, Debug, Default)]
pub struct CurrentTraffic(pub Traffic);

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
    fn times_are_what_people_write() {
        let clock = |tick| Clock { tick, step_s: 0.1, horizon: 30, ticks_per_plan: 1 };
        for tick in 0..100_000_u32 {
            let written = format!("{}.{}", tick / 10, tick % 10);
            assert_eq!(format!("{:?}", clock(tick as usize).time_s()), written);
        }
        assert_eq!(clock(29).within_s(0.25), 2.925);
    }
}
