//! What the entities carry: components of vehicles, and the resources of a world.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::drivers::recorded::Record;
use interplay_planners::perception::sensing::{Sensor, Sight};
use interplay_planners::traffic::{CommittedPlan, Traffic};
use interplay_planners::{Body, Goal, Input, Limits, Planner, Route, State};
use interplay_scenarios::{Outline, Stay};

use crate::state::detail::LevelOfDetail;
use crate::state::frame::{Frame, VehicleFrame};
use crate::state::not_copied::NotCopied;

/// The identity of a vehicle: its index in the scenario, which is the order of everything that is listed, and its name.
#[derive(Component, Clone, Debug)]
pub struct Identity {
    /// Index in the scenario.
    pub index: usize,
    /// Name in the scenario.
    pub name: String,
}

/// The motion of a vehicle.
#[derive(Component, Clone, Copy, Debug)]
pub struct Motion {
    /// Present position, heading and speed.
    pub state: State,
    /// The input it applied last.
    pub input: Input,
    /// Whether it had a collision that left it unfit to go on; with the dynamic plant every one does.
    pub crashed: bool,
}

/// The parameters of a vehicle that do not change during a run.
#[derive(Component, Clone, Debug)]
pub struct VehicleParameters {
    /// Body and axles.
    pub body: Body,
    /// The limits of its inputs and speed.
    pub limits: Limits,
    /// The road it may use.
    pub route: Arc<Route>,
    /// Its outline where it is an obstacle, which nobody drives.
    pub outline: Option<Outline>,
    /// When it is on the road.
    pub stay: Stay,
    /// The motion that it carries out, whatever its inputs are; none for a vehicle that its inputs move.
    pub record: Option<Arc<Record>>,
}

impl VehicleParameters {
    /// Whether others are told nothing of its plan: it follows a record at this time \[s\].
    pub fn hides_plan_at(&self, time_s: f64) -> bool {
        self.record.as_ref().is_some_and(|record| record.holds_at(time_s))
    }
}

/// The goal of a vehicle.
#[derive(Component, Clone, Copy, Debug)]
pub struct VehicleGoal {
    /// The vehicle's goal.
    pub goal: Goal,
    /// The goal that it communicates to the others, if any.
    pub shared: Option<Goal>,
}

/// The driver of a vehicle, with all that the planner remembers.
#[derive(Component, Debug)]
pub struct Driving {
    /// Whether others can ask it to give way.
    pub can_be_asked: bool,
    /// The planner.
    pub planner: Planner,
    /// Whether it plans before those who rely on knowing its plan.
    pub goes_first: bool,
    /// Whether it is told the plans of the others.
    pub knows_plans: bool,
    /// Whether it keeps all rules of the road.
    pub keeps_rules: bool,
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
        let Driving { can_be_asked, goes_first, knows_plans, keeps_rules, .. } = *self;
        Ok(Driving {
            can_be_asked,
            planner: self.planner.fork().ok_or_else(|| NotCopied::driver_of(name))?,
            goes_first,
            knows_plans,
            keeps_rules,
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

/// The plan that a vehicle decided on last; others predict it, and it is continued if the planner fails.
#[derive(Component, Clone, Debug, Default)]
pub struct Committed(pub CommittedPlan);

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

/// All vehicles as plain values, in the scenario's order; sensed anew every tick.
#[derive(Resource, Clone, Debug, Default)]
pub struct Sensed(pub Traffic);

/// The vehicles as they were in the last tick that had any, while the next one is made of them: those follow their plans until they
/// plan again.
#[derive(Resource, Clone, Debug, Default)]
pub struct LastVehicles(pub Vec<VehicleFrame>);

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
