//! Loads, changes and checks scenarios.

use std::sync::{Arc, OnceLock};

use interplay_planners::Driver;
use interplay_scenarios::{Override, Registry, Scenario, embedded};
use interplay_simulation::measure::RegisterMetrics;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::refused;
use crate::policy::PythonPolicy;

/// The registry of all kinds of drivers and metrics of Interplay, and of Python policies.
pub fn registry() -> PyResult<&'static Registry> {
    static REGISTRY: OnceLock<Result<Registry, String>> = OnceLock::new();
    let made = REGISTRY.get_or_init(|| {
        let registry = Registry::default().with_driver::<PythonPolicy>().and_then(Registry::with_own_metrics);
        registry.map_err(|error| error.to_string())
    });
    made.as_ref().map_err(|error| PyValueError::new_err(error.clone()))
}

/// A scenario that was read and checked; it does not change.
#[pyclass(name = "Scenario", module = "interplay._native", frozen)]
pub struct PyScenario {
    pub scenario: Arc<Scenario>,
    /// The name of the scenario in reports, and the name or path from which it was loaded.
    pub name: String,
    pub source: String,
    /// The changes with which it was loaded.
    sets: Vec<String>,
    seed: Option<u64>,
    planner: Option<String>,
}

/// What a scenario was loaded with: source, changes, seed, planner.
type LoadedWith = (String, Vec<String>, Option<u64>, Option<String>);

#[pymethods]
impl PyScenario {
    /// Reads a scenario: a name of `interplay.list()`, or a path. `sets` are changes as `--set` takes them.
    #[staticmethod]
    #[pyo3(signature = (source, sets=Vec::new(), seed=None, planner=None))]
    fn load(
        py: Python<'_>,
        source: &str,
        sets: Vec<String>,
        seed: Option<u64>,
        planner: Option<String>,
    ) -> PyResult<PyScenario> {
        let kinds = planner.iter().cloned().map(Override::Planner);
        let seeds = seed.into_iter().map(Override::Seed);
        let overrides: Vec<Override> = kinds.chain(seeds).chain(sets.iter().cloned().map(Override::Set)).collect();
        let registry = registry()?;
        let mut scenario = py.detach(|| registry.load(source, &overrides)).map_err(refused)?;
        if overrides.iter().any(|change| matches!(change, Override::Planner(_))) {
            scenario = scenario.without_counterfactuals();
        }
        let name = std::path::Path::new(source).file_stem().filter(|_| source.ends_with(".toml"));
        let name = name.map_or_else(|| source.to_owned(), |stem| stem.to_string_lossy().into_owned());
        Ok(PyScenario { scenario: Arc::new(scenario), name, source: source.to_owned(), sets, seed, planner })
    }

    /// The changes with which it was loaded: those of `set`, the seed, and the planner.
    #[getter]
    fn changes(&self) -> (Vec<String>, Option<u64>, Option<String>) {
        (self.sets.clone(), self.seed, self.planner.clone())
    }

    /// A copy reads the same again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, LoadedWith)> {
        let load = py.get_type::<PyScenario>().getattr("load")?;
        Ok((load, (self.source.clone(), self.sets.clone(), self.seed, self.planner.clone())))
    }

    /// The scenario as a file: everything stated.
    fn to_toml(&self) -> String {
        self.scenario.to_file().to_toml()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The name or path from which it was loaded.
    #[getter]
    fn source(&self) -> &str {
        &self.source
    }

    #[getter]
    fn title(&self) -> &str {
        &self.scenario.title
    }

    #[getter]
    fn shows(&self) -> &str {
        &self.scenario.shows
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.scenario.seed
    }

    #[getter]
    fn duration_s(&self) -> f64 {
        self.scenario.duration_s
    }

    #[getter]
    fn step_s(&self) -> f64 {
        self.scenario.step_s
    }

    #[getter]
    fn horizon_steps(&self) -> usize {
        self.scenario.horizon_steps
    }

    /// The names of the vehicles, obstacles last.
    #[getter]
    fn vehicles(&self) -> Vec<&str> {
        self.scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect()
    }

    /// The kind of driver of each vehicle.
    #[getter]
    fn drivers(&self) -> Vec<&str> {
        self.scenario.vehicles.iter().map(|vehicle| vehicle.driver.kind()).collect()
    }

    /// The names of the obstacles: parked cars, cones, walls.
    #[getter]
    fn obstacles(&self) -> Vec<&str> {
        let obstacles = self.scenario.vehicles.iter().filter(|vehicle| vehicle.obstacle.is_some());
        obstacles.map(|vehicle| vehicle.name.as_str()).collect()
    }

    /// The names of the vehicles that are agents of an environment unless others are named: their drivers decide what to do.
    #[getter]
    fn default_agents(&self) -> Vec<&str> {
        let decides = |driver: &Driver| driver.can_take_wheel() || driver.is_driven_from_outside();
        let agents = self.scenario.vehicles.iter();
        let agents = agents.filter(|vehicle| vehicle.obstacle.is_none() && decides(&vehicle.driver));
        agents.map(|vehicle| vehicle.name.as_str()).collect()
    }

    /// Whether it has a building.
    #[getter]
    fn has_building(&self) -> bool {
        self.scenario.building.is_some()
    }

    /// What is allowed and may not have been meant.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.scenario.remarks.iter().map(ToString::to_string).collect()
    }

    fn __repr__(&self) -> String {
        format!("<Scenario {:?}: {}>", self.source, self.scenario.title)
    }
}

/// The scenarios in the package: name, title, what it shows, figure of the dissertation.
#[pyfunction]
pub fn list_scenarios(py: Python<'_>) -> PyResult<Vec<(String, String, String, Option<String>)>> {
    let registry = registry()?;
    py.detach(|| {
        let row = |name: &str| {
            let scenario = registry.load(name, &[]).map_err(refused)?;
            Ok((name.to_owned(), scenario.title, scenario.shows, scenario.figure))
        };
        embedded().iter().map(|file| row(file.name)).collect()
    })
}

/// The names of the scenarios in the package.
#[pyfunction]
pub fn scenario_names() -> Vec<&'static str> {
    embedded().iter().map(|file| file.name).collect()
}

/// The kinds of drivers.
#[pyfunction]
pub fn driver_kinds() -> PyResult<Vec<String>> {
    Ok(registry()?.driver_kinds().into_iter().filter(|kind| *kind != "python").map(str::to_owned).collect())
}
