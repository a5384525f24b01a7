//! Many worlds that are stepped in one call.

use interplay_simulation::environment::{Autoreset, BatchSteps, Ending, Environment, EnvironmentBatch};
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{numbers, shaped};
use crate::environment::{described, described_action, picture, settings, states, term_names};
use crate::errors::of_environment;
use crate::scenario::PyScenario;
use crate::threads::on_all_cores;

/// Worlds that are stepped side by side, on all cores; rows of several agents follow one another, those of the first world first.
#[pyclass(name = "Batch", module = "interplay._native")]
pub struct PyBatch {
    pub batch: EnvironmentBatch,
    observation_len: usize,
}

/// Observations, last observations, rewards, terminated, truncated, terms of the rewards, agents that go on, endings.
type Steps<'py> = (
    Bound<'py, PyArrayDyn<f32>>,
    Bound<'py, PyArrayDyn<f32>>,
    Bound<'py, PyArrayDyn<f64>>,
    Bound<'py, PyArrayDyn<bool>>,
    Bound<'py, PyArrayDyn<bool>>,
    Bound<'py, PyArrayDyn<f64>>,
    Bound<'py, PyArrayDyn<bool>>,
    Vec<Option<&'static str>>,
);

impl PyBatch {
    fn worlds(&self) -> usize {
        self.batch.environments().len()
    }

    fn rows(&self) -> usize {
        self.worlds() * self.batch.agents()
    }

    fn world(&self, world: usize) -> PyResult<&Environment> {
        let message = || PyValueError::new_err(format!("{world} is not the number of a world"));
        self.batch.environments().get(world).ok_or_else(message)
    }
}

#[pymethods]
impl PyBatch {
    /// Worlds of one scenario each; what ends an episode: `next_step`, `same_step` or `disabled`.
    #[new]
    fn new(scenarios: Vec<PyRef<'_, PyScenario>>, settings_json: &str, autoreset: &str) -> PyResult<Self> {
        let settings = settings(settings_json)?;
        let autoreset = match autoreset {
            "next_step" => Autoreset::NextStep,
            "same_step" => Autoreset::SameStep,
            "disabled" => Autoreset::Disabled,
            word => {
                return Err(PyValueError::new_err(format!(
                    "autoreset `{word}`; choose from next_step, same_step, disabled"
                )));
            }
        };
        let worlds = scenarios.iter().map(|scenario| Environment::new(&scenario.scenario, &settings));
        let worlds = worlds.collect::<Result<Vec<_>, _>>().map_err(of_environment)?;
        let batch = EnvironmentBatch::new(worlds, autoreset).map_err(of_environment)?;
        let observation_len = batch.environments()[0].observation_len();
        Ok(PyBatch { batch, observation_len })
    }

    fn observation_spaces(&self) -> Vec<(String, Vec<usize>, Vec<String>, f32, f32)> {
        described(self.batch.environments()[0].observation_spaces())
    }

    fn action_space(&self) -> (Option<usize>, Option<usize>) {
        described_action(self.batch.environments()[0].action_space())
    }

    #[getter]
    fn decision_s(&self) -> f64 {
        self.batch.environments()[0].decision_s()
    }

    /// Begins episodes where `which` says so, each with its seed or the next of its sequence.
    fn reset(&mut self, py: Python<'_>, seeds: Vec<Option<u64>>, which: Vec<bool>) -> PyResult<()> {
        let worlds = self.worlds();
        if seeds.len() != worlds || which.len() != worlds {
            return Err(PyValueError::new_err(format!("{worlds} seeds and as many words of which are needed")));
        }
        py.detach(|| on_all_cores(|| self.batch.reset(&seeds, &which)))?.map_err(of_environment)
    }

    /// What all agents see now, a row an agent.
    fn observe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
        let (rows, length, agents) = (self.rows(), self.observation_len, self.batch.agents());
        let mut out = vec![0.0; rows * length];
        for (row, out) in out.chunks_exact_mut(length).enumerate() {
            self.world(row / agents)?.observe(row % agents, out).map_err(of_environment)?;
        }
        shaped(py, out, &[rows, length])
    }

    /// Steps all worlds by one decision each, on all cores.
    fn step<'py>(&mut self, py: Python<'py>, actions: PyReadonlyArrayDyn<'_, f32>) -> PyResult<Steps<'py>> {
        let (actions, rows, length) = (numbers(&actions), self.rows(), self.observation_len);
        let mut steps = BatchSteps::new(rows, length);
        py.detach(|| on_all_cores(|| self.batch.step(&actions, &mut steps)))?.map_err(of_environment)?;
        let terms = steps.terms.concat();
        Ok((
            shaped(py, steps.observations, &[rows, length])?,
            shaped(py, steps.last_observations, &[rows, length])?,
            shaped(py, steps.rewards, &[rows])?,
            shaped(py, steps.terminated, &[rows])?,
            shaped(py, steps.truncated, &[rows])?,
            shaped(py, terms, &[rows, term_names().len()])?,
            shaped(py, steps.present, &[rows])?,
            steps.endings.into_iter().map(|ending| ending.map(Ending::name)).collect(),
        ))
    }

    /// The names of the agents' vehicles in a world.
    fn agents(&self, world: usize) -> PyResult<Vec<&str>> {
        Ok(self.world(world)?.agents().collect())
    }

    /// Simulated time of a world, and the name of its street, if streets are drawn.
    fn about(&self, world: usize) -> PyResult<(f64, Option<&str>)> {
        let world = self.world(world)?;
        Ok((world.time_s(), world.street()))
    }

    /// The state of every vehicle of a world, by name: position, heading and speed.
    fn states(&self, world: usize) -> PyResult<Vec<(String, [f64; 4])>> {
        self.world(world).map(states)
    }

    /// The picture of a world; none before the first episode.
    fn picture<'py>(&self, py: Python<'py>, world: usize) -> PyResult<Option<Bound<'py, PyArrayDyn<u8>>>> {
        picture(py, self.world(world)?)
    }

    /// Which meta-actions each agent can do now.
    fn action_masks(&self) -> Vec<Option<Vec<bool>>> {
        let agents = self.batch.agents();
        let worlds = self.batch.environments().iter();
        let masks = worlds.flat_map(|world| (0..agents).map(|agent| world.action_mask(agent)));
        masks.map(|mask| mask.map(|mask| mask.to_vec())).collect()
    }
}
