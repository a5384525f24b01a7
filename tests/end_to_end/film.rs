//! A run of the library, kept frame by frame.

use std::sync::{Arc, LazyLock, Mutex};

use interplay_planners::State;
use interplay_scenarios::{Override, Plant, Scenario, embedded, load};
use interplay_simulation::frame::Frame;
use interplay_simulation::report::Report;
use interplay_simulation::run::run;
use interplay_simulation::watch::{WatchError, Watcher};
use rayon::prelude::*;

/// A run and all that was seen of it.
pub struct Film {
    pub scenario: Scenario,
    pub frames: Vec<Frame>,
    pub report: Report,
}

#[derive(Clone, Default)]
pub struct Camera(Arc<Mutex<Vec<Frame>>>);

impl Camera {
    pub fn frames(&self) -> Vec<Frame> {
        self.0.lock().expect("no thread panicked with the camera").clone()
    }
}

impl Watcher for Camera {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        self.0.lock().map_err(|error| error.to_string())?.push(frame.clone());
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}

/// Runs a scenario in front of a camera.
pub fn film(name: &str, scenario: Scenario) -> Film {
    let camera = Camera::default();
    let report = run(name, &scenario, vec![Box::new(camera.clone())]).expect("the run can be finished");
    Film { frames: camera.frames(), scenario, report }
}

/// An authored scenario, changed like by `--set`.
pub fn authored(name: &str, changes: &[&str]) -> Scenario {
    let changes: Vec<_> = changes.iter().map(|change| Override::Set((*change).to_owned())).collect();
    load(name, &changes).unwrap_or_else(|error| panic!("{error}: {:?}", error.faults()))
}

/// Every authored scenario of vehicles alone that plan at every tick (where people drive, inputs change evenly between two plans, and
/// `conduct.rs` and `streets.rs` look at what they do), and the first one with other drivers and starts; made once, in parallel.
pub static FILMS: LazyLock<Vec<Film>> = LazyLock::new(|| {
    let mut takes: Vec<(&str, Scenario)> =
        embedded().iter().map(|file| (file.name, authored(file.name, &[]))).collect();
    takes.retain(|(_, scenario)| scenario.building.is_none() && scenario.ticks_per_plan == 1);
    let jitter = ["start_jitter.position_m=0.1", "start_jitter.speed_mps=0.1", "duration_s=6", "seed=7"];
    for kind in ["conservative", "human", "negotiation"] {
        let driver = format!("vehicle.ego.driver.kind=\"{kind}\"");
        takes.push((kind, authored("lane-change/front-nice", &[&jitter[..], &[&driver]].concat())));
    }
    takes.into_par_iter().map(|(name, scenario)| film(name, scenario)).collect()
});

/// The authored scenarios in which people drive.
pub static FILMS_OF_PEOPLE: LazyLock<Vec<Film>> = LazyLock::new(|| {
    let takes = embedded().iter().map(|file| (file.name, authored(file.name, &[])));
    let mut takes: Vec<(&str, Scenario)> = takes.collect();
    takes.retain(|(_, scenario)| scenario.building.is_none() && scenario.ticks_per_plan > 1);
    takes.into_par_iter().map(|(name, scenario)| film(name, scenario)).collect()
});

/// The films in which vehicles move exactly as planners think.
pub fn kinematic() -> impl Iterator<Item = &'static Film> {
    FILMS.iter().filter(|film| matches!(film.scenario.plant, Plant::Kinematic(_)))
}

impl Film {
    /// The states of all vehicles after a tick.
    pub fn states_after(&self, tick: usize) -> Vec<State> {
        match self.frames.get(tick + 1) {
            Some(next) => next.vehicles.iter().map(|vehicle| vehicle.state).collect(),
            None => self.report.vehicles.iter().map(|vehicle| vehicle.last).collect(),
        }
    }

    /// The states of all vehicles at any time: the physics moves them evenly within a tick.
    pub fn states_at(&self, time_s: f64) -> Vec<State> {
        let ticks = time_s / self.scenario.step_s;
        let tick = (ticks as usize).min(self.frames.len() - 1);
        let share = ticks - tick as f64;
        let mixed = |(from, to): (State, State)| {
            let (from, to) = (from.to_array(), to.to_array());
            State::from_array(std::array::from_fn(|i| from[i] + share * (to[i] - from[i])))
        };
        let from = self.frames[tick].vehicles.iter().map(|vehicle| vehicle.state);
        from.zip(self.states_after(tick)).map(mixed).collect()
    }

    pub fn name(&self) -> &str {
        &self.report.scenario
    }
}
