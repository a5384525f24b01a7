//! A simulation as a world that the caller steps.

mod builder;
mod extensions;
pub(crate) mod run_error;
mod saved_run;
pub mod spawn;
mod wheel;
pub(crate) mod world_state;
mod zones;

pub use builder::SimulationBuilder;
pub use saved_run::{SavedRunError, Snapshot};
pub use zones::ZoneNow;

use std::sync::Arc;
use std::time::Instant;

use bevy_ecs::prelude::*;
use interplay_planners::perception::sensing::SensedScene;
use interplay_planners::traffic::RoadUser;
use interplay_planners::{Drive, Input, State};
use interplay_scenarios::Scenario;

use self::saved_run::{Course, HandedInput};
use crate::climate::Building;
use crate::measure::{BuildingMeasures, Measures};
use crate::report::Report;
use crate::simulation::run_error::RunError;
use crate::state::components::{
    Clock, CurrentFrame, CurrentTraffic, Driving, Fleet, HandedIn, SpareFrames, to_nanosecond,
};
use crate::state::detail::{LevelOfDetail, NotCopied};
use crate::state::frame::Frame;

use crate::phases::watch::{Watcher, Watchers};
use crate::phases::{self, sense};
use crate::simulation::world_state::WorldState;

/// A scenario as a world that the caller can step, observe, control, copy and resume.
///
/// Only [`Simulation::step`] advances a world; [`run`](crate::run::run) is a loop over it. The run depends only on
/// the scenario (its seed included) and on the caller's inputs: the same inputs give the same digest, bit for bit.
///
/// ```
/// use interplay_simulation::Simulation;
///
/// let scenario = interplay_scenarios::load("lane-change/front-nice", &[])?;
/// let mut simulation = Simulation::new(&scenario)?;
/// while let Some(frame) = simulation.step()? {
///     if frame.time_s >= 2.0 {
///         break;
///     }
/// }
/// let fork = simulation.snapshot()?;
/// let report = simulation.finish()?;
/// assert_eq!(report.ended_early_s, Some(2.1));
/// let resumed = fork.resume()?;
/// assert_eq!(resumed.frame().map(|frame| frame.tick), Some(20));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Simulation {
    pub(crate) course: Course,
    pub(crate) world: World,
    schedule: Schedule,
    has_failed: bool,
    /// Wall time of building and stepping the world \[s\].
    wall_s: f64,
}

impl Simulation {
    /// The world of `scenario` before its first tick.
    ///
    /// # Errors
    /// [`RunError`] if the scenario's building cannot be built.
    pub fn new(scenario: &Scenario) -> Result<Self, RunError> {
        Self::builder(scenario).build()
    }

    /// The world of `scenario` before its first tick, called `name` in its report, with watchers that receive every tick.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn watched(name: &str, scenario: &Scenario, watchers: Vec<Box<dyn Watcher>>) -> Result<Self, RunError> {
        Self::builder(scenario).with_name(name).with_watchers(watchers).build()
    }

    pub(crate) fn assembled(course: Course, mut world: World) -> Result<Self, RunError> {
        let mut schedule = phases::schedule();
        extensions::initialize(&mut schedule, &mut world)?;
        course.extensions.add_systems(&mut schedule, &mut world)?;
        Ok(Simulation { course, world, schedule, has_failed: false, wall_s: 0.0 })
    }

    /// The scenario that is simulated.
    pub fn scenario(&self) -> &Scenario {
        &self.course.scenario
    }

    /// Advances the world by one tick of the vehicles or one step of the building, whichever comes next. Returns the
    /// frame of that tick, or `None` once the scenario is over; then nothing moves.
    ///
    /// # Errors
    /// [`RunError::NoInput`] if a vehicle that is driven from outside has no input for this tick; nothing has moved then.
    /// [`RunError::Climate`] if the building cannot continue. After that every step is [`RunError::Ended`].
    pub fn step(&mut self) -> Result<Option<&Frame>, RunError> {
        let began = Instant::now();
        if self.has_failed {
            return Err(RunError::Ended);
        }
        let mut ahead = self.course.time_points.clone();
        let Some(time_point) = ahead.next() else { return Ok(None) };
        if time_point.vehicles && self.world.resource::<Clock>().ticks_since_plan() == 0 {
            self.repeat_inputs()?;
            self.refuse_without_input()?;
        }
        let tick = self.course.time_points.passed();
        self.course.time_points = ahead;
        let frame = Frame { tick, time_s: time_point.time_s, ..Frame::default() };
        let last = std::mem::replace(&mut self.world.resource_mut::<CurrentFrame>().0, frame);
        if !last.vehicles.is_empty() {
            self.world.resource_mut::<SpareFrames>().0 = last.vehicles;
        }
        self.world.insert_resource(time_point);
        self.schedule.run(&mut self.world);
        self.wall_s += began.elapsed().as_secs_f64();
        if let Some(mut building) = self.world.get_resource_mut::<Building>()
            && let Some(reason) = building.failure.take()
        {
            self.has_failed = true;
            return Err(RunError::Climate { day: (building.step - 1) / building.steps_per_day() + 1, reason });
        }
        Ok(Some(&self.world.resource::<CurrentFrame>().0))
    }

    /// Steps until all ticks that begin before `time_s` are done, or the scenario is over. Does nothing if the world is there
    /// already.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn advance_to(&mut self, time_s: f64) -> Result<(), RunError> {
        let end_s = to_nanosecond(time_s);
        while self.course.time_points.clone().next().is_some_and(|time_point| time_point.time_s < end_s) {
            self.step()?;
        }
        Ok(())
    }

    /// A resource of the world: one that [`SimulationBuilder::with_state`] has added, or one of the simulation itself.
    pub fn state<T: Resource>(&self) -> Option<&T> {
        self.world.get_resource()
    }

    /// The last frame; `None` before the first step.
    pub fn frame(&self) -> Option<&Frame> {
        (self.course.time_points.passed() > 0).then(|| &self.world.resource::<CurrentFrame>().0)
    }

    /// Simulated time up to which the world has advanced \[s\].
    pub fn time_s(&self) -> f64 {
        self.course.time_points.reached_s()
    }

    /// Whether the scenario is over and a step does nothing.
    pub fn is_over(&self) -> bool {
        self.course.time_points.clone().next().is_none()
    }

    /// Whether any tick of the vehicles remains.
    pub(crate) fn vehicles_move_again(&self) -> bool {
        self.world.get_resource::<Clock>().is_some_and(|clock| clock.tick < self.course.scenario.tick_count())
    }

    /// The scene that the driver of a vehicle would receive at the next tick, sensing included: the state of every visible vehicle, the
    /// roads, its own goal. The call changes nothing: repeated calls return the same scene, and no digest depends on it.
    ///
    /// The plans in it are those of the last tick, continued by one step. Before the first tick, and for vehicles that are driven from
    /// outside without a plan, they are motion at constant velocity. In a tick, a planner additionally knows the new
    /// plans of the vehicles that go first. A driver that infers plans receives none.
    ///
    /// # Errors
    /// [`RunError::NoVehicle`] if the scenario has no vehicle of that name.
    pub fn observe(&self, vehicle: &str) -> Result<SensedScene, RunError> {
        let index = self.index_of(vehicle)?;
        self.observe_all(&[index]).and_then(|mut sensed| sensed.pop()).ok_or_else(|| self.no_vehicle(vehicle))
    }

    /// The same for several vehicles, by their indices in the scenario, at little more cost than for one; none if one does not exist.
    pub(crate) fn observe_all(&self, vehicles: &[usize]) -> Option<Vec<SensedScene>> {
        sense::observed(&self.world, vehicles)
    }

    /// Sets the input of a vehicle with `driver = { kind = "external" }` for the next tick. The others expect it to keep its
    /// speed afterwards. Inputs are clipped to the limits of the vehicle, as those of any plan. The last call before a step
    /// counts.
    ///
    /// # Errors
    /// [`RunError::NoVehicle`]; [`RunError::NotExternal`] if the scenario gives it another driver; [`RunError::NotFinite`].
    pub fn apply(&mut self, vehicle: &str, input: Input) -> Result<(), RunError> {
        if !input.is_finite() {
            return Err(RunError::NotFinite { vehicle: vehicle.to_owned() });
        }
        self.hand_in(vehicle, HandedIn::Input(input))
    }

    /// As [`Simulation::apply`], with a plan whose first input is applied. The others know it like the plan of any other driver.
    ///
    /// # Errors
    /// As [`Simulation::apply`]; [`RunError::WrongPlan`] if its length is not the scenario's horizon.
    pub fn apply_plan(&mut self, vehicle: &str, inputs: &[Input]) -> Result<(), RunError> {
        let steps = self.course.scenario.horizon_steps;
        if inputs.len() != steps {
            return Err(RunError::WrongPlan { vehicle: vehicle.to_owned(), found: inputs.len(), steps });
        }
        if !inputs.iter().all(Input::is_finite) {
            return Err(RunError::NotFinite { vehicle: vehicle.to_owned() });
        }
        self.hand_in(vehicle, HandedIn::Plan(inputs.to_vec()))
    }

    /// Replaces the driver of a vehicle from the next tick on, by one of Interplay or of another crate. Which plans of the others the
    /// vehicle knows, and whether it plans before them, still follows from its `driver` in the scenario. A vehicle that was driven
    /// from outside needs no inputs any more.
    ///
    /// # Errors
    /// [`RunError::NoVehicle`] if the scenario has no vehicle of that name.
    pub fn drive_with(&mut self, vehicle: &str, driver: impl Drive + 'static) -> Result<(), RunError> {
        let index = self.index_of(vehicle)?;
        self.course.replaced.push(vehicle.to_owned());
        self.give_wheel(index, Some(Box::new(driver)));
        Ok(())
    }

    /// Replaces the drivers, from the next tick on, by those of another form of the scenario with the same vehicles. A driver with changed
    /// settings keeps its memory; one of another kind starts anew.
    pub(crate) fn change_drivers(&mut self, changed: &Scenario) {
        let fleet = self.world.resource::<Fleet>().0.clone();
        for (row, entity) in fleet.into_iter().enumerate() {
            let [old, new] = [&*self.course.scenario, changed].map(|scenario| &scenario.vehicles[row]);
            if (&old.driver, &old.inference) == (&new.driver, &new.inference) {
                continue;
            }
            if let Some(mut driving) = self.world.get_mut::<Driving>(entity) {
                driving.planner.change(&*new.driver, &new.inference.unwrap_or_default());
                driving.detail = LevelOfDetail::of(changed, row);
            }
            let user = &mut self.world.resource_mut::<CurrentTraffic>().into_inner().0.road_users[row];
            user.agent.can_be_asked = new.driver.can_be_asked();
            user.agent.shared_goal = new.driver.shared_goal(&user.goal);
            user.goes_first = new.driver.goes_first();
            user.knows_plans = new.knows_plans();
            user.reaction_s = new.driver.reaction_s();
            user.patience_s = new.driver.patience_s();
            user.decides = new.driver.is_vetoed();
        }
        self.course.scenario = Arc::new(changed.clone());
    }

    /// A copy of all state, which can be resumed any number of times and outlives this simulation. Watchers are not copied.
    ///
    /// # Errors
    /// [`NotCopied`] names the part that cannot be copied: a building behind a socket, a driver of another crate that does not fork, state
    /// of an added system that was not registered.
    pub fn snapshot(&self) -> Result<Snapshot, NotCopied> {
        let mut world = WorldState::copy_from(&self.world)?.into_world(Vec::new());
        self.course.extensions.refuse_uncopied(&self.world, &world)?;
        self.course.extensions.copy_states(&self.world, &mut world);
        Ok(Snapshot { course: self.course.clone(), world })
    }

    /// Restores a snapshot, of this world or of any other. The watchers stay and receive the following ticks.
    ///
    /// # Errors
    /// As [`Simulation::snapshot`].
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), RunError> {
        let mut restored = snapshot.resume()?;
        let watchers = self.world.remove_resource::<Watchers>().unwrap_or_default();
        restored.world.insert_resource(watchers);
        restored.wall_s = self.wall_s;
        *self = restored;
        Ok(())
    }

    /// Ends the run: watchers finish, and the measures are judged. The run may end before the scenario is over; the report
    /// then states it in [`Report::ended_early_s`].
    ///
    /// # Errors
    /// [`RunError::Watch`] if a watcher failed.
    pub fn finish(mut self) -> Result<Report, RunError> {
        let watchers = self.world.remove_resource::<Watchers>().unwrap_or_default();
        watchers.finish().map_err(RunError::Watch)?;
        Ok(self.report())
    }

    /// The report of the measures so far, judged as if the run ended here.
    pub fn report(&self) -> Report {
        let ended_early_s = (!self.is_over()).then(|| self.time_s());
        let building = self.world.get_resource::<BuildingMeasures>();
        Report::new(&self.course.name, &self.course.scenario, self.measures(), building, self.wall_s, ended_early_s)
    }

    /// The measures so far.
    pub fn measures(&self) -> &Measures {
        self.world.resource::<Measures>()
    }

    /// The present state of every vehicle, in the scenario's order.
    pub fn states(&self) -> Vec<State> {
        self.world.resource::<CurrentTraffic>().0.road_users.iter().map(|user| user.agent.state).collect()
    }
}

impl Simulation {
    fn index_of(&self, vehicle: &str) -> Result<usize, RunError> {
        self.course.scenario.index_of(vehicle).ok_or_else(|| self.no_vehicle(vehicle))
    }

    /// The entity of a vehicle, by its row.
    fn entity(&self, row: usize) -> Entity {
        self.world.resource::<Fleet>().0[row]
    }

    fn no_vehicle(&self, vehicle: &str) -> RunError {
        let names = self.course.scenario.vehicles.iter().map(|vehicle| vehicle.name.clone());
        RunError::NoVehicle { vehicle: vehicle.to_owned(), names: names.collect::<Vec<_>>().join(", ") }
    }

    /// Sets the decision of an external driver.
    pub(crate) fn hand_in(&mut self, vehicle: &str, decided: HandedIn) -> Result<(), RunError> {
        let index = self.index_of(vehicle)?;
        let step = self.course.time_points.passed();
        let handed = HandedInput::of(step, vehicle, &decided);
        match self.world.get_mut::<HandedIn>(self.entity(index)) {
            Some(mut handed_in) if *handed_in != HandedIn::NotExternal => *handed_in = decided,
            _ => return Err(RunError::NotExternal { vehicle: vehicle.to_owned() }),
        }
        // The last call before a step counts.
        let before = self.course.inputs.iter().rposition(|before| before.step < step).map_or(0, |last| last + 1);
        let same = self.course.inputs[before..].iter().position(|handed| handed.vehicle == vehicle);
        same.map(|same| self.course.inputs.remove(before + same));
        self.course.inputs.extend(handed);
        Ok(())
    }

    /// Returns an error if an external driver has not decided.
    fn refuse_without_input(&mut self) -> Result<(), RunError> {
        let traffic = &self.world.resource::<CurrentTraffic>().0;
        let fleet = &self.world.resource::<Fleet>().0;
        let waits = |(row, user): &(usize, &RoadUser)| {
            self.world.get::<HandedIn>(fleet[*row]) == Some(&HandedIn::Awaited) && !user.is_crashed
        };
        match traffic.road_users.iter().enumerate().find(waits) {
            Some((_, user)) => Err(RunError::NoInput { vehicle: user.agent.name.clone(), time_s: self.time_s() }),
            None => Ok(()),
        }
    }
}
