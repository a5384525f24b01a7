//! Loads, changes and checks scenarios.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, OnceLock};

use interplay_planners::Driver;
use interplay_scenarios::{Override, Registry, Scenario, embedded};
use interplay_simulation::environment::RegisterPolicies;
use interplay_simulation::measure::RegisterMetrics;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::environment::Remade;
use crate::errors::{bad_json, refused};
use crate::policy::PythonPolicy;

/// The registry of all kinds of drivers and metrics of Interplay, and of Python policies.
pub fn registry() -> PyResult<&'static Registry> {
    static REGISTRY: OnceLock<Result<Registry, String>> = OnceLock::new();
    let made = REGISTRY.get_or_init(|| {
        let registry = Registry::default().with_driver::<PythonPolicy>();
        let registry = registry.and_then(Registry::with_own_metrics).and_then(Registry::with_policies);
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

/// The changes with which a scenario was loaded: those of `set`, the seed, and the planner.
type Changes = (Vec<String>, Option<u64>, Option<String>);
/// A scenario as a value: its file, its seed, and its name, source and changes.
type Written = (String, u64, String, String, Changes);

impl PyScenario {
    /// A scenario that was made without changes of a file.
    pub fn of(scenario: Scenario, name: &str, source: &str) -> PyScenario {
        let (sets, seed, planner) = Changes::default();
        PyScenario {
            scenario: Arc::new(scenario),
            name: name.to_owned(),
            source: source.to_owned(),
            sets,
            seed,
            planner,
        }
    }
}

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
        let source = source.to_owned();
        Ok(PyScenario { scenario: Arc::new(scenario), name: name_of(&source), source, sets, seed, planner })
    }

    /// Reads the text of a scenario file; `name` is its name in errors and reports, and paths in it are relative to it.
    #[staticmethod]
    #[pyo3(signature = (text, name="scenario.toml"))]
    fn from_toml(py: Python<'_>, text: &str, name: &str) -> PyResult<PyScenario> {
        let registry = registry()?;
        let scenario = py.detach(|| registry.from_text(name, text, &[])).map_err(refused)?;
        Ok(PyScenario::of(scenario, &name_of(name), name))
    }

    /// The scenario of a dictionary with the keys of a scenario file.
    #[staticmethod]
    fn from_dict(py: Python<'_>, table: &Bound<'_, PyAny>) -> PyResult<PyScenario> {
        let text: String = py.import("interplay._library")?.getattr("as_json")?.call1((table,))?.extract()?;
        let table = serde_json::from_str(&text).map_err(|error| bad_json("the scenario", &error))?;
        let registry = registry()?;
        let file = py.detach(|| registry.file_from_json(&table)).map_err(refused)?;
        let scenario = py.detach(|| registry.resolve(&file)).map_err(refused)?;
        let title = scenario.title.clone();
        Ok(PyScenario::of(scenario, &title, &title))
    }

    /// The scenario of a file as it was when it was pickled.
    #[staticmethod]
    fn written(
        py: Python<'_>,
        text: &str,
        seed: u64,
        name: String,
        source: String,
        changes: Changes,
    ) -> PyResult<PyScenario> {
        let registry = registry()?;
        let read = || registry.from_text(&format!("{name}.toml"), text, &[Override::Seed(seed)]);
        let scenario = py.detach(read).map_err(refused)?;
        let (sets, seed, planner) = changes;
        Ok(PyScenario { scenario: Arc::new(scenario), name, source, sets, seed, planner })
    }

    /// The changes with which it was loaded: those of `set`, the seed, and the planner.
    #[getter]
    fn changes(&self) -> Changes {
        (self.sets.clone(), self.seed, self.planner.clone())
    }

    /// A copy is the same scenario, also after its file was edited.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Remade<'py, Written>> {
        let written = py.get_type::<PyScenario>().getattr("written")?;
        let (name, source) = (self.name.clone(), self.source.clone());
        Ok((written, (self.to_toml(), self.scenario.seed, name, source, self.changes())))
    }

    /// It never changes.
    fn __deepcopy__(own: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        own
    }

    /// Whether all that is run is the same, whatever the scenarios are called.
    fn __eq__(&self, other: &PyScenario) -> bool {
        Arc::ptr_eq(&self.scenario, &other.scenario) || self.scenario == other.scenario
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (self.to_toml(), self.scenario.seed).hash(&mut hasher);
        hasher.finish()
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
        format!("<Scenario {:?}: {}>", self.source, self.scenario.title.replace(['\n', '\r'], " "))
    }
}

/// The name of a scenario in reports: of a file without folder and extension.
fn name_of(source: &str) -> String {
    let stem = std::path::Path::new(source).file_stem().filter(|_| source.ends_with(".toml"));
    stem.map_or_else(|| source.to_owned(), |stem| stem.to_string_lossy().into_owned())
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
