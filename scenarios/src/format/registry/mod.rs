//! What a scenario file may name: the kinds of drivers and the metrics of Interplay and of other crates.

pub(crate) mod foreign_kind;

use std::sync::{Arc, LazyLock};

use interplay_planners::{Driver, DriverKind};
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value as Json;
use thiserror::Error;

use crate::format::json_schema::{self, SchemaNode};
use crate::format::registry::foreign_kind::ForeignKind;
use crate::format::scenario_file::ScenarioFile;
use crate::format::stated::Stated;
use crate::model::metric::{DeclaredMetric, RegisteredMetrics};
use crate::text::name;

/// What a scenario file may name: the kinds of drivers, and with them the JSON Schema that files are checked against.
///
/// Loading, sweeping and everything else that reads a scenario is a method of a registry. [`Registry::standard`] has the kinds
/// of Interplay; [`load`](crate::load) and the other functions of the crate are shorthands for it. A program with kinds of its
/// own adds them to one:
///
/// ```
/// use interplay_planners::{Drive, DriverKind, scripted};
/// use interplay_scenarios::Registry;
/// use schemars::JsonSchema;
/// use serde::{Deserialize, Serialize};
///
/// /// Keeps its speed, or the stated one.
/// #[derive(Debug, Default, Deserialize, JsonSchema, Serialize)]
/// #[serde(deny_unknown_fields, default)]
/// struct Steady {}
///
/// impl DriverKind for Steady {
///     fn kind(&self) -> &'static str {
///         "steady"
///     }
///
///     fn driver(&self) -> Box<dyn Drive> {
///         scripted::Settings::default().driver()
///     }
/// }
///
/// let registry = Registry::default().with_driver::<Steady>()?;
/// let scenario = registry.load("lane-change/front-nice", &[interplay_scenarios::Override::Planner("steady".to_owned())])?;
/// assert_eq!(scenario.vehicles[0].driver.kind(), "steady");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Registry {
    /// The kinds of drivers of other crates.
    drivers: Vec<ForeignKind>,
    /// The metrics that are declared.
    metrics: RegisteredMetrics,
    /// The schema of a whole scenario, all that it extends included.
    schema: Arc<Json>,
}

/// Why a kind of driver or a metric cannot be added.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum RegistryError {
    /// There is a kind of this word already.
    #[error("there is a kind of driver `{0}` already")]
    KindTaken(&'static str),
    /// The word could not be written in a scenario file, on the command line and in the path of a recording alike.
    #[error("a kind of driver cannot be called `{0}`: {help}", help = name::in_words())]
    NotAName(&'static str),
    /// There is a metric of this name already, or something else in reports or rows is called so.
    #[error("a metric cannot be called `{0}`: something in reports or in rows of sweeps is called so already")]
    MetricTaken(String),
}

/// The schema of a whole scenario, all that it extends included, whose vehicles may have drivers of `foreign` kinds.
pub(crate) fn complete(foreign: &[ForeignKind]) -> Json {
    json_schema::generated_with::<ScenarioFile>(|generator| {
        foreign.iter().map(|foreign| foreign.schema(generator)).collect()
    })
}

/// [`Registry::schema`] of what Interplay has.
pub fn schema() -> Json {
    Registry::standard().schema()
}

static STANDARD: LazyLock<Registry> = LazyLock::new(Registry::default);

impl Default for Registry {
    /// The kinds of Interplay.
    fn default() -> Self {
        Registry { drivers: Vec::new(), metrics: RegisteredMetrics::default(), schema: Arc::new(complete(&[])) }
    }
}

impl Registry {
    /// The kinds of Interplay, and no others.
    pub fn standard() -> &'static Registry {
        &STANDARD
    }

    /// The same registry with another kind of driver: that of these settings.
    ///
    /// A table `driver = { kind = "…", … }` of a scenario file is checked against the schema of the settings and read by
    /// `serde`. Whatever is said of a setting stands on its field, as in Interplay: units, bounds, examples, defaults
    /// (`docs/guide/extending.md`).
    ///
    /// # Errors
    /// [`RegistryError`] if the kind's word is taken or is no name.
    pub fn with_driver<S>(mut self) -> Result<Registry, RegistryError>
    where
        S: DriverKind + Default + Serialize + DeserializeOwned + JsonSchema + 'static,
    {
        let foreign = ForeignKind::of::<S>();
        if self.driver_kinds().contains(&foreign.kind) {
            return Err(RegistryError::KindTaken(foreign.kind));
        }
        if !name::is_name(foreign.kind) {
            return Err(RegistryError::NotAName(foreign.kind));
        }
        self.drivers.push(foreign);
        self.schema = Arc::new(complete(&self.drivers));
        Ok(self)
    }

    /// The same registry with another metric declared. What computes it is known to who made the value: users of the simulation
    /// call `with_metric` of `interplay_simulation::measure::RegisterMetrics`.
    ///
    /// # Errors
    /// [`RegistryError::MetricTaken`] if its name or one of its keys is taken by another metric.
    pub fn with_declared_metric(mut self, metric: Arc<dyn DeclaredMetric>) -> Result<Registry, RegistryError> {
        let keys = metric.declaration().keys();
        let known = self.metrics.0.iter().flat_map(|known| known.declaration().keys());
        if let Some(taken) = known.into_iter().find(|key| keys.contains(key)) {
            return Err(RegistryError::MetricTaken(taken));
        }
        self.metrics.0.push(metric);
        Ok(self)
    }

    /// The metrics that are declared. Without any, `[[expect.metric]]` may name whatever it likes; whoever runs the scenario knows
    /// which metrics there are.
    pub fn metrics(&self) -> &RegisteredMetrics {
        &self.metrics
    }

    /// The kinds of drivers that a vehicle may have.
    pub fn driver_kinds(&self) -> Vec<&str> {
        let vehicle = self.complete().property("vehicle").and_then(SchemaNode::entries);
        vehicle.and_then(|vehicle| vehicle.property("driver")).map(SchemaNode::kinds).unwrap_or_default()
    }

    /// The kinds of controllers that a building may have.
    pub fn controller_kinds(&self) -> Vec<&str> {
        self.complete().property("controller").map(SchemaNode::kinds).unwrap_or_default()
    }

    /// The JSON Schema of a scenario file, for editors. A file that extends another need not repeat what that one states.
    pub fn schema(&self) -> Json {
        json_schema::of_file(&self.schema)
    }

    /// The schema of a whole scenario, all that it extends included.
    pub(crate) fn complete(&self) -> SchemaNode<'_> {
        SchemaNode::new(&self.schema)
    }

    /// The driver that a table of a scenario file describes.
    ///
    /// # Errors
    /// What keeps the table from being the settings of its kind, although it fits the schema.
    pub(crate) fn driver(&self, table: Stated<Driver>) -> Result<Driver, serde_json::Error> {
        let foreign = self.drivers.iter().find(|foreign| table.get("kind").is_some_and(|kind| kind == foreign.kind));
        match foreign {
            Some(foreign) => foreign.driver(table.into_keys()),
            None => table.settings(),
        }
    }

    /// The versions of the kinds and metrics of other crates; empty without any.
    pub(crate) fn versions(&self) -> String {
        let drivers = self.drivers.iter().map(|foreign| format!("{} {}\n", foreign.kind, foreign.version));
        let metrics = self.metrics.0.iter().filter_map(|metric| Some((metric.declaration().name, metric.version()?)));
        drivers.chain(metrics.map(|(name, version)| format!("{name} {version}\n"))).collect()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_kinds_of_drivers_are_those_of_the_planners() {
        let kinds = Registry::standard().driver_kinds();
        assert!(kinds.contains(&"human") && kinds.contains(&"negotiation"), "{kinds:?}");
        for kind in kinds {
            let driver: Driver = serde_json::from_value(json!({ "kind": kind })).expect("every setting has a default");
            assert_eq!(driver.kind(), kind);
        }
    }

    #[test]
    fn a_variant_may_leave_out_what_a_complete_file_must_state() {
        let whole_scenario = complete(&[]);
        let file = json_schema::of_file(&whole_scenario);
        let definitions = file["$defs"].to_string();
        assert!(!definitions.contains("required"), "{definitions}");
        let [variant, whole] = file["anyOf"].as_array().expect("two cases").as_slice() else { panic!("two cases") };
        assert_eq!(variant, &json!({ "required": ["extends"] }));
        assert_eq!(whole["not"], *variant);
        assert_eq!(whole["required"], whole_scenario["required"]);
        let vehicle = &whole["properties"]["vehicle"]["items"];
        assert_eq!(vehicle["required"], json!(["name", "start"]));
        assert_eq!(vehicle["properties"]["start"]["required"], json!(["speed_mps"]));
        assert_eq!(vehicle["properties"]["driver"]["required"], json!(["kind"]));
    }
}
