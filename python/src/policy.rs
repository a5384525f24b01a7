//! Python functions that drive a vehicle in any run.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, PoisonError, RwLock};

use interplay_planners::prediction::Prediction;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, DriverKind, Plan, PlanError, Scene};
use interplay_simulation::environment::{Action, AgentInterface, AgentView, Policy, PolicyDriver, PolicyError};
use numpy::{IntoPyArray, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyAny;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::arrays::numbers;

/// The functions that were registered, by name.
static POLICIES: LazyLock<RwLock<HashMap<String, Arc<Py<PyAny>>>>> = LazyLock::new(RwLock::default);

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

/// Registers a function under a name, in place of any before it. It is given the flat observation, with the kind and shape of each
/// view in it, and returns the flat action.
#[pyfunction]
pub fn register_policy(name: String, function: Py<PyAny>) {
    let mut policies = POLICIES.write().unwrap_or_else(PoisonError::into_inner);
    policies.insert(name, Arc::new(function));
}

/// A function of Python as a driver: what it sees and decides, and which one it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PythonPolicy {
    /// The name under which the function was registered.
    pub policy: String,
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
            let PythonPolicy { policy, observations, action, decision_s, .. } = &self.settings;
            let policies = POLICIES.read().unwrap_or_else(PoisonError::into_inner);
            let found = policies.get(policy).cloned();
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
