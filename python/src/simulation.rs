//! A world that is stepped from Python.

use std::sync::Arc;

use interplay_planners::{Agent, Input};
use interplay_scenarios::Scenario;
use interplay_simulation::{SavedRunError, Simulation, Snapshot};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::shaped;
use crate::environment::Remade;
use crate::errors::{RunError, refused, unfinished};
use crate::frames;
use crate::scenario::{PyScenario, registry};

/// A scenario as a world that Python steps, observes, controls, copies and resumes.
#[pyclass(name = "Simulation", module = "interplay._native")]
pub struct PySimulation {
    world: Option<Simulation>,
    scenario: Arc<Scenario>,
}

/// All state of a world; it outlives the world.
#[pyclass(name = "Snapshot", module = "interplay._native", frozen)]
pub struct PySnapshot(Arc<Snapshot>);

#[pymethods]
impl PySnapshot {
    /// Simulated time.
    #[getter]
    fn time_s(&self) -> f64 {
        self.0.time_s()
    }

    /// The snapshot as text, which `Snapshot.from_json` reads.
    fn to_json(&self) -> PyResult<String> {
        self.0.to_json().map_err(unread)
    }

    /// The snapshot of such a text: it repeats the run, which takes as long as the run took.
    #[staticmethod]
    fn from_json(py: Python<'_>, text: &str) -> PyResult<Self> {
        let registry = registry()?;
        let snapshot = py.detach(|| Snapshot::from_json(text, registry)).map_err(unread)?;
        Ok(PySnapshot(Arc::new(snapshot)))
    }

    /// It never changes.
    fn __deepcopy__(own: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        own
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Remade<'py, (String,)>> {
        Ok((py.get_type::<PySnapshot>().getattr("from_json")?, (self.to_json()?,)))
    }
}

/// The exception for a snapshot that is not written or read as text.
fn unread(error: SavedRunError) -> PyErr {
    match error {
        SavedRunError::Text(_) | SavedRunError::Format { .. } => PyValueError::new_err(error.to_string()),
        SavedRunError::Scenario(error) => refused(error),
        error => RunError::new_err(error.to_string()),
    }
}

impl PySimulation {
    fn world(&self) -> PyResult<&Simulation> {
        self.world.as_ref().ok_or_else(finished)
    }

    fn world_mut(&mut self) -> PyResult<&mut Simulation> {
        self.world.as_mut().ok_or_else(finished)
    }
}

fn finished() -> PyErr {
    RunError::new_err("the simulation is finished; make a new one")
}

#[pymethods]
impl PySimulation {
    /// The world of a scenario before its first tick. `external` are the vehicles that are driven from here.
    #[new]
    #[pyo3(signature = (scenario, external=Vec::new()))]
    fn new(py: Python<'_>, scenario: &PyScenario, external: Vec<String>) -> PyResult<Self> {
        let mut changed = (*scenario.scenario).clone();
        for name in external {
            let Some(index) = changed.index_of(&name) else {
                let names: Vec<&str> = changed.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
                return Err(PyValueError::new_err(format!(
                    "there is no vehicle `{name}`; the vehicles are {}",
                    names.join(", ")
                )));
            };
            changed.vehicles[index].driver = interplay_planners::Driver::External(Default::default());
        }
        let scenario_name = scenario.name.clone();
        let world = py.detach(|| Simulation::watched(&scenario_name, &changed, Vec::new())).map_err(unfinished)?;
        Ok(PySimulation { world: Some(world), scenario: Arc::new(changed) })
    }

    /// A world that continues from a snapshot.
    #[staticmethod]
    fn resumed(py: Python<'_>, snapshot: &PySnapshot) -> PyResult<Self> {
        let world = py.detach(|| snapshot.0.resume()).map_err(unfinished)?;
        let scenario = Arc::new(world.scenario().clone());
        Ok(PySimulation { world: Some(world), scenario })
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let world = self.world()?;
        let copy = py.detach(|| world.fork()).map_err(unfinished)?;
        Ok(PySimulation { world: Some(copy), scenario: Arc::clone(&self.scenario) })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Remade<'py, (PySnapshot,)>> {
        Ok((py.get_type::<PySimulation>().getattr("resumed")?, (self.snapshot(py)?,)))
    }

    /// Moves the world by a tick, or a step of the building, whichever comes next; whether there was one left.
    fn step(&mut self, py: Python<'_>) -> PyResult<bool> {
        let world = self.world_mut()?;
        py.detach(|| world.step().map(|frame| frame.is_some())).map_err(unfinished)
    }

    /// Whether the scenario is over.
    #[getter]
    fn is_over(&self) -> PyResult<bool> {
        Ok(self.world()?.is_over())
    }

    /// Simulated time up to which the world has moved.
    #[getter]
    fn time_s(&self) -> PyResult<f64> {
        Ok(self.world()?.time_s())
    }

    /// The last tick as arrays by name; none before the first.
    fn frame<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(frame) = self.world()?.frame() else { return Ok(None) };
        let arrays = frames::arrays(py, &self.scenario, std::slice::from_ref(frame))?;
        arrays.set_item("tick", frame.tick)?;
        Ok(Some(arrays))
    }

    /// The scene that the driver of a vehicle would plan from at the next tick: its own vehicle first, then those that it sees.
    fn observe<'py>(&self, py: Python<'py>, vehicle: &str) -> PyResult<Bound<'py, PyDict>> {
        let world = self.world()?;
        let scene = py.detach(|| world.observe(vehicle)).map_err(unfinished)?.scene;
        let agents: Vec<&Agent> = std::iter::once(&scene.ego).chain(&scene.others).collect();
        let seen = PyDict::new(py);
        seen.set_item("time_s", world.time_s())?;
        seen.set_item("vehicles", agents.iter().map(|agent| agent.name.as_str()).collect::<Vec<_>>())?;
        let states = agents.iter().flat_map(|agent| agent.state.to_array()).collect();
        seen.set_item("state", shaped(py, states, &[agents.len(), 4])?)?;
        let size = |agent: &&Agent| {
            [agent.body.front_m, agent.body.rear_m, agent.body.width_m, agent.body.front_axle_m, agent.body.rear_axle_m]
        };
        seen.set_item("body_m", shaped(py, agents.iter().flat_map(size).collect(), &[agents.len(), 5])?)?;
        let horizon = scene.horizon + 1;
        let predicted = |agent: &&Agent| {
            let states = agent.prediction.states.clone();
            let last = states.last().copied().unwrap_or(agent.state);
            (0..horizon).flat_map(move |t| states.get(t).unwrap_or(&last).to_array()).collect::<Vec<f64>>()
        };
        seen.set_item(
            "prediction",
            shaped(py, agents.iter().flat_map(predicted).collect(), &[agents.len(), horizon, 4])?,
        )?;
        let route = |agent: &&Agent| {
            let at = scene.ego.route.locate(agent.state.position(), None);
            [at.along_m, at.across_m, at.heading_rad]
        };
        seen.set_item("route", shaped(py, agents.iter().flat_map(route).collect(), &[agents.len(), 3])?)?;
        let goal = scene.goal.target;
        seen.set_item("goal", shaped(py, goal.to_array().to_vec(), &[4])?)?;
        let limits = &scene.ego.limits;
        let bounds = vec![
            limits.acceleration_min_mps2,
            limits.acceleration_max_mps2,
            limits.steering_max_rad,
            limits.speed_max_mps,
        ];
        seen.set_item("limits", shaped(py, bounds, &[4])?)?;
        seen.set_item("step_s", scene.step_s)?;
        seen.set_item("horizon_steps", scene.horizon)?;
        seen.set_item("stop_line_m", scene.ego.rules.stop_line_m)?;
        Ok(seen)
    }

    /// Hands in the input of a vehicle that is driven from here, for the next tick.
    fn apply(&mut self, vehicle: &str, acceleration_mps2: f64, steering_rad: f64) -> PyResult<()> {
        self.world_mut()?.apply(vehicle, Input { acceleration_mps2, steering_rad }).map_err(unfinished)
    }

    /// Hands in a whole plan, which the others know: a row of acceleration and steering for each step of the horizon.
    fn apply_plan(&mut self, vehicle: &str, inputs: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let inputs = inputs.as_array();
        if inputs.ncols() != 2 {
            return Err(PyValueError::new_err(format!(
                "a plan has 2 columns, acceleration and steering, and not {}",
                inputs.ncols()
            )));
        }
        let row = |row: numpy::ndarray::ArrayView1<'_, f64>| Input { acceleration_mps2: row[0], steering_rad: row[1] };
        let inputs: Vec<Input> = inputs.rows().into_iter().map(row).collect();
        self.world_mut()?.apply_plan(vehicle, &inputs).map_err(unfinished)
    }

    /// The zones of the building now: name, temperature, wanted temperature, comfortable deviation, strongest heating and cooling.
    #[allow(clippy::type_complexity, reason = "a row of numbers for Python")]
    fn zones(&self) -> PyResult<Vec<(String, f64, Option<f64>, Option<f64>, f64, f64)>> {
        let zones = self.world()?.zones().into_iter();
        Ok(zones
            .map(|zone| {
                (zone.name, zone.temperature_c, zone.reference_c, zone.band_k, zone.heating_kw, zone.cooling_kw)
            })
            .collect())
    }

    /// Hands in the heat of every zone for the next step of the building.
    fn apply_heats(&mut self, heat_kw: Vec<f64>) -> PyResult<()> {
        self.world_mut()?.apply_heats(&heat_kw).map_err(unfinished)
    }

    /// A copy of all state.
    fn snapshot(&self, py: Python<'_>) -> PyResult<PySnapshot> {
        let world = self.world()?;
        let snapshot = py.detach(|| world.snapshot()).map_err(|error| RunError::new_err(error.to_string()))?;
        Ok(PySnapshot(Arc::new(snapshot)))
    }

    /// Goes back, or forth, to a snapshot.
    fn restore(&mut self, py: Python<'_>, snapshot: &PySnapshot) -> PyResult<()> {
        let (snapshot, world) = (Arc::clone(&snapshot.0), self.world_mut()?);
        py.detach(|| world.restore(&snapshot)).map_err(unfinished)?;
        self.scenario = Arc::new(world.scenario().clone());
        Ok(())
    }

    /// Ends the run and returns its report, the document of `interplay run --json`.
    fn finish(&mut self, py: Python<'_>) -> PyResult<String> {
        let world = self.world.take().ok_or_else(finished)?;
        let report = py.detach(|| world.finish()).map_err(unfinished)?;
        serde_json::to_string(&report).map_err(|error| RunError::new_err(error.to_string()))
    }
}
