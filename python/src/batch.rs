//! Many worlds that are stepped in one call.

use interplay_simulation::environment::{Autoreset, BatchSteps, Ending, Environment, EnvironmentBatch};
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{numbers, shaped};
use crate::environment::{described, described_action, settings, term_names};
use crate::errors::of_environment;
use crate::scenario::PyScenario;
use crate::threads::on_all_cores;

/// Worlds with one agent each that are stepped side by side, on all cores.
#[pyclass(name = "Batch", module = "interplay._native")]
pub struct PyBatch {
    pub batch: EnvironmentBatch,
    observation_len: usize,
}

/// Observations, last observations, rewards, terminated, truncated, terms of the rewards, endings.
type Steps<'py> = (
    Bound<'py, PyArrayDyn<f32>>,
    Bound<'py, PyArrayDyn<f32>>,
    Bound<'py, PyArrayDyn<f64>>,
    Bound<'py, PyArrayDyn<bool>>,
    Bound<'py, PyArrayDyn<bool>>,
    Bound<'py, PyArrayDyn<f64>>,
    Vec<Option<&'static str>>,
);

impl PyBatch {
    fn worlds(&self) -> usize {
        self.batch.environments().len()
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

    /// What all agents see now, a row a world.
    fn observe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
        let mut out = vec![0.0; self.worlds() * self.observation_len];
        for (environment, row) in self.batch.environments().iter().zip(out.chunks_exact_mut(self.observation_len)) {
            environment.observe(0, row).map_err(of_environment)?;
        }
        shaped(py, out, &[self.worlds(), self.observation_len])
    }

    /// Steps all worlds by one decision each, on all cores.
    fn step<'py>(&mut self, py: Python<'py>, actions: PyReadonlyArrayDyn<'_, f32>) -> PyResult<Steps<'py>> {
        let (actions, worlds, length) = (numbers(&actions), self.worlds(), self.observation_len);
        let mut steps = BatchSteps::new(worlds, length);
        py.detach(|| on_all_cores(|| self.batch.step(&actions, &mut steps)))?.map_err(of_environment)?;
        let terms = steps.terms.concat();
        Ok((
            shaped(py, steps.observations, &[worlds, length])?,
            shaped(py, steps.last_observations, &[worlds, length])?,
            shaped(py, steps.rewards, &[worlds])?,
            shaped(py, steps.terminated, &[worlds])?,
            shaped(py, steps.truncated, &[worlds])?,
            shaped(py, terms, &[worlds, term_names().len()])?,
            steps.endings.into_iter().map(|ending| ending.map(Ending::name)).collect(),
        ))
    }

    /// Which meta-actions the agent of each world can do now.
    fn action_masks(&self) -> Vec<Option<Vec<bool>>> {
        let worlds = self.batch.environments().iter();
        worlds.map(|environment| environment.action_mask(0).map(|mask| mask.to_vec())).collect()
    }
}
