//! The names that a scenario file may use: the kinds of drivers, controllers and roads and the metrics of Interplay and of other crates.

pub(crate) mod foreign_kind;

use std::sync::{Arc, LazyLock};

use interplay_building::control::{Controller, ControllerKind};
use interplay_planners::{Driver, DriverKind};
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value as Json, json};
use thiserror::Error;

use crate::format::json_schema::{self, SchemaNode};
use crate::format::registry::foreign_kind::ForeignKind;
use crate::format::scenario_file::ScenarioFile;
use crate::format::stated::Stated;
use crate::model::metric::{DeclaredMetric, RegisteredMetrics};
use crate::model::traffic::obstacle::DeclaredObstacle;
use crate::roads::{Road, RoadForm};
use crate::text::name;

/// The names that a scenario file may use: the kinds of drivers and so on, and with them the JSON Schema of files.
///
/// Loading, sweeping and everything else that reads a scenario is a method of a registry. [`Registry::standard`] has the kinds
/// of Interplay; [`load`](crate::load) and the other functions of the crate are shorthands for it. A program with kinds of its
/// own adds them to one:
///
/// ```
/// use interplay_planners::drivers::{Drive, DriverKind, scripted};
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
    /// The kinds of other crates.
    foreign: ForeignKinds,
    /// The metrics that are declared.
    metrics: RegisteredMetrics,
    /// The schema of a whole scenario, all that it extends included.
    schema: Arc<Json>,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct ForeignKinds {
    drivers: Vec<ForeignKind<dyn DriverKind>>,
    controllers: Vec<ForeignKind<dyn ControllerKind>>,
    roads: Vec<ForeignKind<dyn RoadForm>>,
    obstacles: Vec<DeclaredObstacle>,
}

/// Why a kind or a metric cannot be added.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum RegistryError {
    /// There is a kind of this word already, of drivers, of controllers or of roads.
    #[error("there is a kind `{0}` already")]
    KindTaken(&'static str),
    /// The word could not be written in a scenario file, on the command line and in the path of a recording alike.
    #[error("a kind cannot be called `{0}`: {help}", help = name::in_words())]
    NotAName(&'static str),
    /// A metric of this name exists already, or another entry of reports or rows has this name.
    #[error("a metric cannot be called `{0}`: something in reports or in rows of sweeps is called so already")]
    MetricTaken(String),
}

/// The schema of a whole scenario, all that it extends included, which may name `foreign` kinds.
pub(crate) fn complete(foreign: &ForeignKinds) -> Json {
    json_schema::generated_with::<ScenarioFile, 4>(|generator| {
        [
            ("Driver", foreign.drivers.iter().map(|kind| kind.schema(generator)).collect()),
            ("Controller", foreign.controllers.iter().map(|kind| kind.schema(generator)).collect()),
            ("Road", foreign.roads.iter().map(|kind| kind.schema(generator)).collect()),
            ("ObstacleKind", foreign.obstacles.iter().map(word_schema).collect()),
        ]
    })
}

/// The schema of the word for a kind of obstacle.
fn word_schema(obstacle: &DeclaredObstacle) -> Json {
    json!({ "type": "string", "const": obstacle.kind, "description": obstacle.about })
}

/// The kind of another crate that a table names, if it names one.
fn named_by<'k, Kind: ?Sized, S>(kinds: &'k [ForeignKind<Kind>], table: &Stated<S>) -> Option<&'k ForeignKind<Kind>> {
    kinds.iter().find(|foreign| table.get("kind").is_some_and(|kind| kind == foreign.kind))
}

/// The [`Registry::schema`] of the standard registry.
pub fn schema() -> Json {
    Registry::standard().schema()
}

static STANDARD: LazyLock<Registry> = LazyLock::new(Registry::default);

impl Default for Registry {
    /// The kinds of Interplay.
    fn default() -> Self {
        let foreign = ForeignKinds::default();
        let schema = Arc::new(complete(&foreign));
        Registry { foreign, metrics: RegisteredMetrics::default(), schema }
    }
}

impl Registry {
    /// The registry with the kinds of Interplay, and no others.
    pub fn standard() -> &'static Registry {
        &STANDARD
    }

    /// Adds a kind of driver with these settings to the registry.
    ///
    /// A table `driver = { kind = "…", … }` of a scenario file is checked against the schema of the settings and read by
    /// `serde`. The fields of the settings state all that the schema says, as in Interplay: units, bounds, examples, defaults
    /// (`docs/guide/extending.md`).
    ///
    /// # Errors
    /// [`RegistryError`] if the kind's word is taken or is not a valid name.
    pub fn with_driver<S>(mut self) -> Result<Registry, RegistryError>
    where
        S: DriverKind + Default + Serialize + DeserializeOwned + JsonSchema + 'static,
    {
        let kind =
            ForeignKind::<dyn DriverKind>::of::<S>(|settings| Arc::new(settings), |kind| [kind.kind(), kind.version()]);
        is_free(kind.kind, &self.driver_kinds())?;
        self.foreign.drivers.push(kind);
        Ok(self.with_schema())
    }

    /// Adds a kind of controller with these settings to the registry, as [`Registry::with_driver`] does.
    ///
    /// # Errors
    /// [`RegistryError`] if the kind's word is taken or is not a valid name.
    pub fn with_controller<S>(mut self) -> Result<Registry, RegistryError>
    where
        S: ControllerKind + Default + Serialize + DeserializeOwned + JsonSchema + 'static,
    {
        let kind = ForeignKind::<dyn ControllerKind>::of::<S>(
            |settings| Arc::new(settings),
            |kind| [kind.kind(), kind.version()],
        );
        is_free(kind.kind, &self.controller_kinds())?;
        self.foreign.controllers.push(kind);
        Ok(self.with_schema())
    }

    /// Adds a form of road with these settings to the registry, as [`Registry::with_driver`] does.
    ///
    /// # Errors
    /// [`RegistryError`] if the form's word is taken or is not a valid name.
    pub fn with_road<S>(mut self) -> Result<Registry, RegistryError>
    where
        S: RoadForm + Default + Serialize + DeserializeOwned + JsonSchema + 'static,
    {
        let kind =
            ForeignKind::<dyn RoadForm>::of::<S>(|settings| Arc::new(settings), |kind| [kind.kind(), kind.version()]);
        is_free(kind.kind, &self.road_kinds())?;
        self.foreign.roads.push(kind);
        Ok(self.with_schema())
    }

    /// Adds a kind of obstacle to the registry: a word with its usual size.
    ///
    /// # Errors
    /// [`RegistryError`] if the kind's word is taken or is not a valid name.
    pub fn with_obstacle(mut self, obstacle: DeclaredObstacle) -> Result<Registry, RegistryError> {
        let words = self.complete().property("obstacle").and_then(SchemaNode::entries);
        let words = words.and_then(|entry| entry.property("kind")).map(SchemaNode::words).unwrap_or_default();
        is_free(obstacle.kind, &words)?;
        self.foreign.obstacles.push(obstacle);
        Ok(self.with_schema())
    }

    fn with_schema(mut self) -> Registry {
        self.schema = Arc::new(complete(&self.foreign));
        self
    }

    /// Adds a declared metric to the registry. The caller who made the value knows how to compute it: users of the
    /// simulation call `with_metric` of `interplay_simulation::measure::RegisterMetrics`.
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

    /// The declared metrics. If none are declared, `[[expect.metric]]` may use any name; the program that runs the scenario then
    /// checks it.
    pub fn metrics(&self) -> &RegisteredMetrics {
        &self.metrics
    }

    /// The kinds of drivers that a vehicle may have.
    pub fn driver_kinds(&self) -> Vec<&str> {
        let vehicle = self.complete().property("vehicle").and_then(SchemaNode::entries);
        vehicle.and_then(|vehicle| vehicle.property("driver")).map(SchemaNode::kinds).unwrap_or_default()
    }

    /// The kinds of drivers of Interplay and of other crates, each with the defaults of its settings.
    pub(crate) fn drivers(&self) -> impl Iterator<Item = &dyn DriverKind> {
        let own = Driver::kinds().iter().map(|driver| &**driver);
        own.chain(self.foreign.drivers.iter().map(|foreign| &*foreign.plain))
    }

    /// The kind of driver that a scenario file calls `kind`, with the defaults of its settings.
    pub(crate) fn driver_kind(&self, kind: &str) -> Option<&dyn DriverKind> {
        self.drivers().find(|driver| driver.kind() == kind)
    }

    /// The kinds of obstacles of other crates.
    pub(crate) fn obstacles(&self) -> &[DeclaredObstacle] {
        &self.foreign.obstacles
    }

    /// The kinds of controllers that a building may have.
    pub fn controller_kinds(&self) -> Vec<&str> {
        self.complete().property("controller").map(SchemaNode::kinds).unwrap_or_default()
    }

    /// The kinds of roads that a scenario may have.
    pub fn road_kinds(&self) -> Vec<&str> {
        self.complete().property("road").map(SchemaNode::kinds).unwrap_or_default()
    }

    /// The JSON Schema of a scenario file, for editors. A file that extends another need not repeat its parent's keys.
    pub fn schema(&self) -> Json {
        json_schema::of_file(&self.schema)
    }

    /// The schema of a whole scenario, including all that it extends.
    pub(crate) fn complete(&self) -> SchemaNode<'_> {
        SchemaNode::new(&self.schema)
    }

    /// The driver that a table of a scenario file describes.
    ///
    /// # Errors
    /// The reason why the table cannot be read as the settings of its kind, although it fits the schema.
    pub(crate) fn driver(&self, table: Stated<Driver>) -> Result<Driver, serde_json::Error> {
        match named_by(&self.foreign.drivers, &table) {
            Some(foreign) => foreign.settings(table.into_keys()).map(Driver::Foreign),
            None => table.settings(),
        }
    }

    /// The controller that a table of a scenario file describes.
    ///
    /// # Errors
    /// As [`Registry::driver`].
    pub(crate) fn controller(&self, table: Stated<Controller>) -> Result<Controller, serde_json::Error> {
        match named_by(&self.foreign.controllers, &table) {
            Some(foreign) => foreign.settings(table.into_keys()).map(Controller::Foreign),
            None => table.settings(),
        }
    }

    /// The road that a table of a scenario file describes.
    ///
    /// # Errors
    /// As [`Registry::driver`].
    pub(crate) fn road(&self, table: Stated<Road>) -> Result<Road, serde_json::Error> {
        match named_by(&self.foreign.roads, &table) {
            Some(foreign) => foreign.settings(table.into_keys()).map(Road::Foreign),
            None => table.settings(),
        }
    }

    /// The versions of the kinds and metrics of other crates; empty without any.
    pub(crate) fn versions(&self) -> String {
        let drivers = self.foreign.drivers.iter().map(|foreign| [foreign.kind, foreign.version]);
        let controllers = self.foreign.controllers.iter().map(|foreign| [foreign.kind, foreign.version]);
        let roads = self.foreign.roads.iter().map(|foreign| [foreign.kind, foreign.version]);
        let metrics = self.metrics.0.iter().filter_map(|metric| Some((metric.declaration().name, metric.version()?)));
        let kinds = drivers.chain(controllers).chain(roads);
        kinds.chain(metrics.map(|(name, version)| [name, version])).map(|about| about.join(" ") + "\n").collect()
    }
}

/// Whether a kind can have this word beside the others.
fn is_free(word: &'static str, others: &[&str]) -> Result<(), RegistryError> {
    if others.contains(&word) {
        return Err(RegistryError::KindTaken(word));
    }
    if name::is_name(word) { Ok(()) } else { Err(RegistryError::NotAName(word)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_registry_lists_every_kind_of_driver_of_the_planners() {
        let kinds = Registry::standard().driver_kinds();
        assert!(kinds.contains(&"human") && kinds.contains(&"negotiation"), "{kinds:?}");
        for kind in kinds {
            let driver: Driver = serde_json::from_value(json!({ "kind": kind })).expect("every setting has a default");
            assert_eq!(driver.kind(), kind);
        }
    }

    #[test]
    fn a_variant_may_omit_required_keys() {
        let whole_scenario = complete(&ForeignKinds::default());
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
