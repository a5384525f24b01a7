//! The loop as one visible list. Each phase is a file here, or a folder beside this one: physics, climate and measure.

pub mod act;
pub(crate) mod external;
pub mod plan;
pub mod predict;
pub(crate) mod presence;
pub mod sense;
pub mod time_points;
pub mod watch;

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor};

use crate::{climate, measure, physics};

/// One tick, phase by phase. Data flows in one direction: no phase depends on later ones.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// The traffic is prepared for a plan, and sensors measure the vehicles.
    Sense,
    /// The motion of each vehicle is predicted.
    Predict,
    /// Every driver decides; on a failure a fallback applies.
    Plan,
    /// The first input of each plan is applied.
    Act,
    /// Bodies move; contacts become collisions.
    Physics,
    /// The building's heat balance: disturbance, control, temperatures, learning at the day's end.
    Climate,
    /// The results of the tick are measured.
    Measure,
    /// Watchers record the tick.
    Record,
}

impl Phase {
    /// All phases, in the order in which they run.
    pub const IN_ORDER: [Phase; 8] = [
        Phase::Sense,
        Phase::Predict,
        Phase::Plan,
        Phase::Act,
        Phase::Physics,
        Phase::Climate,
        Phase::Measure,
        Phase::Record,
    ];
}

/// A slot for additional systems between two phases. A phase runs after all systems before it, and before all systems after it.
///
/// [`SimulationBuilder::with_system`](crate::SimulationBuilder::with_system) adds them. They run at every
/// [`TimePoint`](time_points::TimePoint), of the vehicles and of the building.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Slot {
    /// After the systems that follow the previous phase, and before this phase.
    Before(Phase),
    /// After this phase, and before the systems that precede the next one.
    After(Phase),
}

/// The schedule of a world.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tick;

/// The loop: phases in order, on one thread for each world (worlds run in parallel); ambiguous orders are errors.
pub fn schedule() -> Schedule {
    use Phase::{Act, Climate, Measure, Physics, Plan, Predict, Record, Sense};
    let mut schedule = Schedule::new(Tick);
    schedule.set_executor(SingleThreadedExecutor::new());
    schedule.set_build_settings(ScheduleBuildSettings {
        ambiguity_detection: LogLevel::Error,
        ..ScheduleBuildSettings::default()
    });
    for phase in Phase::IN_ORDER {
        schedule.configure_sets((Slot::Before(phase), phase, Slot::After(phase)).chain());
    }
    for [phase, next] in Phase::IN_ORDER.array_windows() {
        schedule.configure_sets((Slot::After(*phase), Slot::Before(*next)).chain());
    }
    schedule.add_systems((
        (
            (sense::sense, (presence::come_and_go, sense::look).chain().run_if(sense::plans_now)).chain().in_set(Sense),
            predict::predict.in_set(Predict).run_if(sense::plans_now),
            plan::plan.in_set(Plan).run_if(sense::plans_now),
            (act::act, act::describe).chain().in_set(Act),
            physics::step.in_set(Physics),
            measure::measure.in_set(Measure),
        )
            .run_if(time_points::vehicles),
        (
            (climate::disturb, climate::control, climate::balance, climate::learn).chain().in_set(Climate),
            measure::measure_building.in_set(Measure).after(measure::measure),
        )
            .run_if(time_points::building),
        watch::show.in_set(Record),
    ));
    schedule
}
