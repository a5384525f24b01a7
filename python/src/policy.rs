//! Python functions that drive a vehicle in any run.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, PoisonError, RwLock};

use interplay_planners::prediction::Prediction;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, DriverKind, DriverSettingError, Plan, PlanError, Scene};
use interplay_simulation::environment::{
    Action, AgentInterface, AgentView, NetworkPolicy, Policy, PolicyDriver, PolicyError,
};
use numpy::{IntoPyArray, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyAny;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::arrays::numbers;
use crate::environment::as_json;

/// The functions that are registered, by name and number of the registration.
static POLICIES: LazyLock<RwLock<HashMap<(String, u64), Arc<Py<PyAny>>>>> = LazyLock::new(RwLock::default);

/// A function of Python from an observation, with the kind and shape of each view in it, to an action.
struct PythonFunction {
    function: Arc<Py<PyAny>>,
    views: Vec<(String, Vec<usize>)>,
}

/// The kind and shape of each view.
fn views(interface: &AgentInterface) -> Vec<(String, Vec<usize>)> {
    interface.observation_spaces().into_iter().map(|space| (space.kind.to_owned(), space.shape)).collect()
}

impl Policy for PythonFunction {
    fn act(&self, observation: &[f32]) -> Result<Vec<f32>, PolicyError> {
        Python::attach(|py| {
            let observation = observation.to_vec().into_pyarray(py);
            let action = self.function.call1(py, (observation, self.views.clone()))?;
            let action: PyReadonlyArrayDyn<'_, f32> = action.extract(py)?;
            Ok::<_, PyErr>(numbers(&action))
        })
        .map_err(|error| PolicyError(error.to_string()))
    }
}

/// Registers a function under a name and a number; whether the place was free. It is given the flat observation, with the kind and
/// shape of each view in it, and returns the flat action.
#[pyfunction]
pub fn register_policy(py: Python<'_>, name: String, registration: u64, function: Py<PyAny>) -> bool {
    py.detach(|| {
        let mut policies = POLICIES.write().unwrap_or_else(PoisonError::into_inner);
        let place = (name, registration);
        let is_free = !policies.contains_key(&place);
        if is_free {
            policies.insert(place, Arc::new(function));
        }
        is_free
    })
}

/// Takes away a registered function.
#[pyfunction]
pub fn remove_policy(py: Python<'_>, name: String, registration: u64) {
    let removed = py.detach(|| POLICIES.write().unwrap_or_else(PoisonError::into_inner).remove(&(name, registration)));
    // The function is dropped without the lock: what Python does then may register another.
    drop(removed);
}

/// A trained network of a `.safetensors` file, as it drives with `kind = "policy"`.
#[pyclass(name = "Network", module = "interplay._native", frozen)]
pub struct PyNetwork(NetworkPolicy);

#[pymethods]
impl PyNetwork {
    /// Reads the file.
    #[new]
    fn new(file: String) -> PyResult<Self> {
        let fault = |reason: String| PyValueError::new_err(format!("`{file}` {reason}"));
        NetworkPolicy::of_file(file.clone()).map(PyNetwork).map_err(fault)
    }

    /// The views as JSON, the kind of action as JSON, and the digest of the file.
    fn about(&self) -> PyResult<(String, String, String)> {
        let (views, action, digest) = self.0.about().map_err(PyValueError::new_err)?;
        Ok((as_json("the views", &views)?, as_json("the action", &action)?, digest.to_owned()))
    }

    /// The outputs of the last layer for one flat observation, and the flat action.
    fn decide(&self, observation: PyReadonlyArrayDyn<'_, f32>) -> PyResult<(Vec<f64>, Vec<f32>)> {
        self.0.decide(&numbers(&observation)).map_err(|reason| PyValueError::new_err(format!("the network {reason}")))
    }
}

/// A function of Python as a driver: what it sees and decides, and which one it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PythonPolicy {
    /// The name under which the function is registered,
    pub policy: String,
    /// and the number of its registration, which tells functions of one name apart.
    pub registration: u64,
    /// What tells its results from those of earlier versions.
    pub version: String,
    /// What it sees.
    pub observations: Vec<AgentView>,
    /// What it decides.
    pub action: Action,
    /// Time from one decision to the next; without it as in an environment.
    pub decision_s: Option<f64>,
}

impl Default for PythonPolicy {
    fn default() -> Self {
        PythonPolicy {
            policy: String::new(),
            registration: 0,
            version: String::new(),
            observations: vec![AgentView::Kinematics(Default::default())],
            action: Action::Continuous,
            decision_s: None,
        }
    }
}

impl DriverKind for PythonPolicy {
    fn kind(&self) -> &'static str {
        "python"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Waiting { settings: self.clone(), driver: None })
    }

    fn prediction(&self) -> Option<Prediction> {
        None
    }

    /// It drives as it did where it learned, in an environment.
    fn may_be_refused(&self) -> bool {
        false
    }

    fn description(&self) -> String {
        self.policy.clone()
    }

    /// What an environment would refuse is refused here, too.
    fn check(&self, _: usize) -> Result<(), DriverSettingError> {
        let fault = self.observations.iter().find_map(AgentView::fault);
        let remedy = "the bounds are those of environments".to_owned();
        fault.map_or(Ok(()), |reason| Err(DriverSettingError::Unfit { key: "observations", reason, remedy }))
    }
}

/// The driver before it knows how long its plans are.
#[derive(Clone, Debug)]
struct Waiting {
    settings: PythonPolicy,
    driver: Option<PolicyDriver>,
}

impl Drive for Waiting {
    fn plan(&mut self, scene: &Scene, outlook: &InferredFutures) -> Result<Plan, PlanError> {
        if self.driver.is_none() {
            let PythonPolicy { policy, registration, observations, action, decision_s, .. } = &self.settings;
            let policies = POLICIES.read().unwrap_or_else(PoisonError::into_inner);
            let found = policies.get(&(policy.clone(), *registration)).cloned();
            drop(policies);
            let function = found.ok_or_else(|| PlanError::BadInput(format!("no function `{policy}` is registered")))?;
            let interface = AgentInterface::new(observations, *action, scene.horizon);
            let function = Arc::new(PythonFunction { function, views: views(&interface) });
            let plans = action.plans_per_decision(*decision_s, &scene.ego.body, scene.step_s);
            self.driver = Some(PolicyDriver::new(function, interface, plans));
        }
        match &mut self.driver {
            Some(driver) => driver.plan(scene, outlook),
            None => Err(PlanError::NoInput),
        }
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }
}
