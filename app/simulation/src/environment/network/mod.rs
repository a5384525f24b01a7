//! `kind = "policy"`: a trained network as a driver, read from a file, so that it drives wherever a scenario runs.
//!
//! The file is a `.safetensors` file with the tensors `layers.0.weight` (outputs × inputs), `layers.0.bias` and so on. Its metadata state
//! `observations` (a list of views as JSON), `action` (`Continuous`, `DiscreteMeta` or `Plan`), and optionally `activation` (`tanh` or
//! `relu`), `output` (`linear` or `tanh`) and `decision_s`.

mod layers;
mod tensors;

use std::path::Path;
use std::sync::{Arc, OnceLock};

use interplay_planners::prediction::Prediction;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, DriverKind, DriverSettingError, Plan, PlanError, PlanTime, Scene};
use interplay_scenarios::{Registry, RegistryError, read_regular};
use schemars::JsonSchema;
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};

use self::layers::Network;
use super::{Action, AgentInterface, AgentView, PolicyDriver};

/// The largest file: the most weights, and a header \[bytes\].
const MAX_FILE_BYTES: u64 = 4 * tensors::MAX_WEIGHTS as u64 + (1 << 16);
/// The word for the kind.
const KIND: &str = "policy";

/// A trained network, read from a `.safetensors` file.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NetworkPolicy {
    /// The file of the network, relative to the folder of the scenario.
    #[schemars(example = &"policy.safetensors")]
    pub file: String,
    /// Digest of the file: a scenario that states it is refused if the file has changed.
    pub digest: Option<String>,
    #[serde(skip)]
    network: OnceLock<Result<Arc<Network>, String>>,
}

impl NetworkPolicy {
    /// The network of a file, as a driver.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn of_file(file: String) -> Result<NetworkPolicy, String> {
        let policy = NetworkPolicy { file, ..NetworkPolicy::default() };
        policy.network().map(|_| ())?;
        Ok(policy)
    }

    /// What the network sees, what it decides, and the digest of its file.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn about(&self) -> Result<(&[AgentView], Action, &str), String> {
        self.network().map(|network| (&network.observations[..], network.action, network.digest.as_str()))
    }

    /// The outputs of the last layer for an observation, and the action that follows from them.
    ///
    /// # Errors
    /// What is wrong with the file, or the length of the observation.
    pub fn decide(&self, observation: &[f32]) -> Result<(Vec<f64>, Vec<f32>), String> {
        let network = self.network()?;
        let (found, wanted) = (observation.len(), network.inputs());
        if found != wanted {
            return Err(format!("has {wanted} inputs, and the observation {found} numbers"));
        }
        Ok((network.outputs(observation), network.action_for(observation)))
    }

    /// The network, read at the first call; or what is wrong with the file.
    fn network(&self) -> Result<&Arc<Network>, String> {
        let read = || {
            let bytes = read_regular(Path::new(&self.file), MAX_FILE_BYTES);
            let bytes = bytes.map_err(|error| format!("cannot be read: {error}"))?;
            Network::parse(&bytes.ok_or("is larger than a network of 100,000 weights")?).map(Arc::new)
        };
        self.network.get_or_init(read).as_ref().map_err(Clone::clone)
    }

    /// The fault of file and settings for plans with this number of steps, if there is one.
    fn fault(&self, horizon_steps: usize) -> Option<String> {
        let network = match self.network() {
            Ok(network) => network,
            Err(reason) => return Some(reason),
        };
        if let Some(stated) = self.digest.as_ref().filter(|stated| **stated != network.digest) {
            return Some(format!("has the digest {}, and the scenario states {stated}", network.digest));
        }
        let interface = AgentInterface::new(&network.observations, network.action, horizon_steps);
        network.misfit(interface.observation_len(), interface.action_space())
    }
}

/// With the digest of the file, as soon as the file is read.
impl Serialize for NetworkPolicy {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let digest = self.digest.clone().or_else(|| self.network().ok().map(|network| network.digest.clone()));
        let mut table = serializer.serialize_struct("NetworkPolicy", 2)?;
        table.serialize_field("file", &self.file)?;
        table.serialize_field("digest", &digest)?;
        table.end()
    }
}

impl DriverKind for NetworkPolicy {
    fn kind(&self) -> &'static str {
        KIND
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(NetworkDriver { settings: self.clone(), driver: None })
    }

    fn description(&self) -> String {
        let name = Path::new(&self.file).file_stem().map(|stem| stem.to_string_lossy().into_owned());
        name.unwrap_or_else(|| KIND.to_owned())
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime::SIMPLE
    }

    fn prediction(&self) -> Option<Prediction> {
        None
    }

    /// It drives as it did where it learned, in an environment.
    fn may_be_refused(&self) -> bool {
        false
    }

    fn check(&self, horizon_steps: usize) -> Result<(), DriverSettingError> {
        let refused = |reason: String| {
            let remedy = "`docs/guide/python.md` shows how a network is written".to_owned();
            Err(DriverSettingError::Unfit { key: "file", reason, remedy })
        };
        if self.file.is_empty() {
            return refused("is missing: a driver of the kind `policy` needs the file of a network".to_owned());
        }
        self.fault(horizon_steps).map_or(Ok(()), |fault| refused(format!("(`{}`) {fault}", self.file)))
    }
}

/// The driver before and after its first plan, which tells it the horizon.
#[derive(Clone, Debug)]
struct NetworkDriver {
    settings: NetworkPolicy,
    driver: Option<PolicyDriver>,
}

impl Drive for NetworkDriver {
    /// # Errors
    /// [`PlanError::BadInput`] if the network cannot be read or does not fit.
    fn plan(&mut self, scene: &Scene, inferred_futures: &InferredFutures) -> Result<Plan, PlanError> {
        if let Some(driver) = &mut self.driver {
            return driver.plan(scene, inferred_futures);
        }
        if let Some(fault) = self.settings.fault(scene.horizon) {
            return Err(PlanError::BadInput(format!("the network {fault}")));
        }
        let network = Arc::clone(self.settings.network().map_err(PlanError::BadInput)?);
        let interface = AgentInterface::new(&network.observations, network.action, scene.horizon);
        let plans = network.action.plans_per_decision(network.decision_s, &scene.ego.body, scene.step_s);
        let driver = self.driver.insert(PolicyDriver::new(network, interface, plans));
        driver.plan(scene, inferred_futures)
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }
}

/// Adds the kind of trained networks to a registry.
pub trait RegisterPolicies: Sized {
    /// The same registry with the kind `policy` of drivers, unless it has one.
    ///
    /// # Errors
    /// [`RegistryError`], never for a registry of Interplay.
    fn with_policies(self) -> Result<Self, RegistryError>;
}

impl RegisterPolicies for Registry {
    fn with_policies(self) -> Result<Self, RegistryError> {
        let has_kind = self.driver_kinds().contains(&KIND);
        if has_kind { Ok(self) } else { self.with_driver::<NetworkPolicy>() }
    }
}

#[cfg(test)]
mod tests;
