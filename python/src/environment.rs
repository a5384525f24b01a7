//! Environments for learning, and the planners of Interplay in them.

use std::collections::HashMap;

use interplay_planners::{Driver, Planner};
use interplay_presentation::figures::RecordedRun;
use interplay_simulation::environment::{
    ActionSpace, Environment, EnvironmentSettings, Episode, ObservationSpace, RewardTerm, SavedEpisode,
};
use interplay_simulation::frame::{Frame, VehicleFrame};
use numpy::{IntoPyArray, PyArray1, PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{numbers, shaped};
use crate::errors::{bad_json, of_environment};
use crate::scenario::PyScenario;

/// A scenario in which some vehicles are driven from Python, episode by episode.
#[pyclass(name = "Environment", module = "interplay._native")]
pub struct PyEnvironment {
    pub environment: Environment,
    made_of: MadeOf,
}

/// What an environment is made of: its scenario, and its settings as JSON.
type MadeOf = (Py<PyScenario>, String);
/// A function of the package, and what to call it with; pickle calls it in another process.
pub type Remade<'py, T> = (Bound<'py, PyAny>, T);

/// A planner of Interplay with its memory, for the agent of one environment.
#[pyclass(name = "Planner", module = "interplay._native")]
pub struct PyPlanner {
    driver: Driver,
    /// By agent: what each of them remembers.
    planners: HashMap<usize, Planner>,
}

/// Reads the settings of an environment from JSON; omitted settings have their defaults.
pub fn settings(json: &str) -> PyResult<EnvironmentSettings> {
    serde_json::from_str(json).map_err(|error| bad_json("settings of the environment", &error))
}

/// Describes the observation of an agent: for each view its kind, shape, names, and lowest and highest number.
pub fn described(spaces: Vec<ObservationSpace>) -> Vec<(String, Vec<usize>, Vec<String>, f32, f32)> {
    spaces.into_iter().map(|space| (space.kind.to_owned(), space.shape, space.names, space.low, space.high)).collect()
}

/// Describes an action: the number of its rows, or the number of alternatives to choose from.
pub fn described_action(space: ActionSpace) -> (Option<usize>, Option<usize>) {
    match space {
        ActionSpace::Rows(rows) => (Some(rows), None),
        ActionSpace::OneOf(count) => (None, Some(count)),
    }
}

fn remade_of(py: Python<'_>, (scenario, settings): &MadeOf) -> MadeOf {
    (scenario.clone_ref(py), settings.clone())
}

/// A value as JSON.
pub fn as_json(what: &str, value: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|error| bad_json(what, &error))
}

/// The state of every vehicle of an environment, by name: position, heading and speed.
pub fn states(environment: &Environment) -> Vec<(String, [f64; 4])> {
    let Some(world) = environment.world() else { return Vec::new() };
    let names = world.scenario().vehicles.iter().map(|vehicle| vehicle.name.clone());
    names.zip(world.states()).map(|(name, state)| (name, state.to_array())).collect()
}

/// The picture of an environment now; none before the first episode.
pub fn picture<'py>(py: Python<'py>, environment: &Environment) -> PyResult<Option<Bound<'py, PyArrayDyn<u8>>>> {
    let Some(world) = environment.world() else { return Ok(None) };
    let picture = py.detach(|| {
        let scenario = world.scenario().clone();
        let now = scenario.vehicles.iter().zip(world.states()).enumerate().map(|(index, (vehicle, state))| {
            let last = world.frame().and_then(|frame| frame.vehicles.get(index).cloned()).unwrap_or_default();
            VehicleFrame { name: vehicle.name.clone(), state, ..last }
        });
        let frame =
            Frame { time_s: world.time_s(), vehicles: now.collect(), ..world.frame().cloned().unwrap_or_default() };
        let now = RecordedRun::to_draw(scenario, vec![frame], world.report());
        interplay_presentation::animation::last_picture(&now)
    });
    picture.map(|([width, height], pixels)| shaped(py, pixels, &[height as usize, width as usize, 3])).transpose()
}

/// The names of the terms of the reward.
pub fn term_names() -> Vec<&'static str> {
    RewardTerm::ALL.iter().map(|term| term.name()).collect()
}

#[pymethods]
impl PyEnvironment {
    #[new]
    fn new(scenario: Py<PyScenario>, settings_json: String) -> PyResult<Self> {
        let environment = Environment::new(&scenario.get().scenario, &settings(&settings_json)?);
        Ok(PyEnvironment { environment: environment.map_err(of_environment)?, made_of: (scenario, settings_json) })
    }

    /// An environment in the middle of an episode, which it repeats from its text.
    #[staticmethod]
    fn repeated(py: Python<'_>, scenario: Py<PyScenario>, settings_json: String, saved: &str) -> PyResult<Self> {
        let mut made = PyEnvironment::new(scenario, settings_json)?;
        let saved: SavedEpisode = serde_json::from_str(saved).map_err(|error| bad_json("a saved episode", &error))?;
        py.detach(|| made.environment.repeat(&saved)).map_err(of_environment)?;
        Ok(made)
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let environment = py.detach(|| self.environment.fork()).map_err(of_environment)?;
        Ok(PyEnvironment { environment, made_of: remade_of(py, &self.made_of) })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Remade<'py, (Py<PyScenario>, String, String)>> {
        let (scenario, settings) = remade_of(py, &self.made_of);
        let repeated = py.get_type::<PyEnvironment>().getattr("repeated")?;
        Ok((repeated, (scenario, settings, as_json("a saved episode", &self.environment.saved())?)))
    }

    /// The name of the street of the episode, if streets are drawn.
    #[getter]
    fn street(&self) -> Option<&str> {
        self.environment.street()
    }

    /// The names of the agents' vehicles.
    #[getter]
    fn agents(&self) -> Vec<&str> {
        self.environment.agents().collect()
    }

    #[getter]
    fn decision_s(&self) -> f64 {
        self.environment.decision_s()
    }

    fn observation_spaces(&self) -> Vec<(String, Vec<usize>, Vec<String>, f32, f32)> {
        described(self.environment.observation_spaces())
    }

    fn action_space(&self) -> (Option<usize>, Option<usize>) {
        described_action(self.environment.action_space())
    }

    /// The names of the terms of the reward, in the order of `terms`.
    #[staticmethod]
    fn reward_terms() -> Vec<&'static str> {
        term_names()
    }

    /// Begins an episode: of a new sequence if there is a seed, else the next of the sequence.
    #[pyo3(signature = (seed=None))]
    fn reset(&mut self, py: Python<'_>, seed: Option<u64>) -> PyResult<()> {
        py.detach(|| self.environment.reset(seed)).map_err(of_environment)
    }

    /// Begins the episode of the scenario as it is written, with a seed of its random numbers.
    fn reset_as_written(&mut self, py: Python<'_>, seed: u64) -> PyResult<()> {
        py.detach(|| self.environment.reset_as_written(seed)).map_err(of_environment)
    }

    /// Moves the world by one decision of every agent.
    fn step(&mut self, py: Python<'_>, actions: PyReadonlyArrayDyn<'_, f32>) -> PyResult<()> {
        let actions = numbers(&actions);
        py.detach(|| self.environment.step(&actions)).map_err(of_environment)
    }

    /// What an agent sees now, in a new array.
    fn observe<'py>(&self, py: Python<'py>, agent: usize) -> PyResult<Bound<'py, PyArray1<f32>>> {
        self.check(agent)?;
        let mut out = vec![0.0; self.environment.observation_len()];
        self.environment.observe(agent, &mut out).map_err(of_environment)?;
        Ok(out.into_pyarray(py))
    }

    /// Reward, terminated, truncated and how the episode ended, of an agent in the last decision.
    fn outcome(&self, agent: usize) -> PyResult<(f64, bool, bool, Option<&'static str>)> {
        self.check(agent)?;
        let episode: &Episode = self.environment.episode(agent);
        let is_terminated = episode.is_terminated();
        let ending = episode.ending.map(|ending| ending.name());
        Ok((self.environment.reward(agent), is_terminated, episode.is_over() && !is_terminated, ending))
    }

    /// The terms of the reward of an agent in the last decision.
    fn terms<'py>(&self, py: Python<'py>, agent: usize) -> PyResult<Bound<'py, PyDict>> {
        self.check(agent)?;
        let terms = PyDict::new(py);
        for (name, value) in term_names().into_iter().zip(self.environment.episode(agent).terms) {
            terms.set_item(name, value)?;
        }
        Ok(terms)
    }

    /// Whether any agent's episode goes on.
    #[getter]
    fn is_live(&self) -> bool {
        self.environment.is_live()
    }

    /// Simulated time; 0 before the first episode.
    #[getter]
    fn time_s(&self) -> f64 {
        self.environment.time_s()
    }

    /// Which meta-actions an agent can do now.
    fn action_mask(&self, agent: usize) -> PyResult<Option<Vec<bool>>> {
        self.check(agent)?;
        Ok(self.environment.action_mask(agent).map(|mask| mask.to_vec()))
    }

    /// The state of every vehicle now, by name: position, heading and speed.
    fn states(&self) -> Vec<(String, [f64; 4])> {
        states(&self.environment)
    }

    /// Ends the episode and returns its report as JSON; none before the first.
    fn finish(&mut self) -> PyResult<Option<String>> {
        let report = self.environment.finish().map_err(of_environment)?;
        report.map(|report| as_json("the report", &report)).transpose()
    }

    /// The picture of the world now: an array of rows, columns and red, green, blue; none before the first episode.
    fn picture<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<u8>>>> {
        picture(py, &self.environment)
    }
}

impl PyEnvironment {
    fn check(&self, agent: usize) -> PyResult<()> {
        let count = self.environment.agents().count();
        let message = || format!("agent {agent} of {count}");
        if agent < count { Ok(()) } else { Err(PyValueError::new_err(message())) }
    }
}

#[pymethods]
impl PyPlanner {
    /// A planner of a kind with settings, as `driver = { … }` of a scenario file takes them.
    #[new]
    fn new(driver_json: &str) -> PyResult<Self> {
        let driver: Driver = serde_json::from_str(driver_json).map_err(|error| bad_json("driver", &error))?;
        Ok(PyPlanner { driver, planners: HashMap::new() })
    }

    /// The action of the planner for an agent now, as the environment's action space has it.
    fn act<'py>(
        &mut self,
        py: Python<'py>,
        environment: &PyEnvironment,
        agent: usize,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        environment.check(agent)?;
        self.planned(py, agent, (&environment.environment, agent))
    }

    /// The same for a world of a batch.
    fn act_in<'py>(
        &mut self,
        py: Python<'py>,
        batch: &crate::batch::PyBatch,
        world: usize,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let Some(environment) = batch.batch.environments().get(world) else {
            return Err(PyValueError::new_err(format!("there is no world {world}")));
        };
        self.planned(py, world, (environment, 0))
    }

    /// Forgets all that it remembers of an agent or a world, or of all.
    #[pyo3(signature = (which=None))]
    fn forget(&mut self, which: Option<usize>) {
        match which {
            Some(which) => drop(self.planners.remove(&which)),
            None => self.planners.clear(),
        }
    }
}

impl PyPlanner {
    /// The action for an agent of an environment; what is remembered is kept under a number.
    fn planned<'py>(
        &mut self,
        py: Python<'py>,
        number: usize,
        (environment, agent): (&Environment, usize),
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let driver = &self.driver;
        let planner = self.planners.entry(number).or_insert_with(|| environment.planner(agent, &**driver));
        let action = py.detach(|| environment.action_of(agent, planner)).map_err(of_environment)?;
        Ok(action.into_pyarray(py))
    }
}
