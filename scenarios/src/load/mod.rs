//! Loads a [`Scenario`] by its name and checks it; the documentation of the crate describes the steps.

mod chain;
mod changed;
pub(crate) mod files;

use std::fs;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde_json::{Map, Value as Json};

use self::chain::{NamedBy, blamed_on, extended, read_link};
use crate::commonroad::{ImportOptions, Imported, import_file, is_commonroad};
use crate::format::json_schema::SchemaNode;
use crate::format::read::degrees;
use crate::format::read::overrides::Override;
use crate::format::read::source::Source;
use crate::format::read::tree::{self, Table, TomlNode, TomlValue};
use crate::format::registry::Registry;
use crate::format::scenario_file::ScenarioFile;
use crate::model::expectations::counterfactual::CounterfactualConfig;
use crate::model::remark::ScenarioRemark;
use crate::model::scenario::{Counterfactual, Scenario};
use crate::resolve::budget;
use crate::resolve::check::{consistency, shape};
use crate::resolve::defaults::{expand, with_defaults, with_driver_kinds};
use crate::resolve::flows::with_flows;
use crate::resolve::placement::KnownRoads;
use crate::resolve::resolve;
use crate::resolve::weather_file::is_embedded_weather;
use crate::text::error::{Document, Fault, LoadError, Place};

/// The name of a scenario without a title in errors.
const UNTITLED: &str = "without title";

/// [`Registry::load`] with the standard registry.
///
/// # Errors
///
/// As [`Registry::load`].
pub fn load(name_or_path: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
    Registry::standard().load(name_or_path, overrides)
}

/// [`Registry::from_text`] with the standard registry.
///
/// # Errors
///
/// As [`Registry::load`].
pub fn from_text(name: &str, text: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
    Registry::standard().from_text(name, text, overrides)
}

impl ScenarioFile {
    /// [`Registry::file`] with the standard registry.
    ///
    /// # Errors
    /// As [`Registry::file`].
    pub fn load(name_or_path: &str, overrides: &[Override]) -> Result<ScenarioFile, LoadError> {
        Registry::standard().file(name_or_path, overrides)
    }

    /// [`Registry::file_from_json`] with the standard registry.
    ///
    /// # Errors
    /// As [`Registry::file_from_json`].
    pub fn from_json(table: &Map<String, Json>) -> Result<ScenarioFile, LoadError> {
        Registry::standard().file_from_json(table)
    }

    /// [`Registry::resolve`] with the standard registry.
    ///
    /// # Errors
    /// As [`Registry::resolve`].
    pub fn resolve(&self) -> Result<Scenario, LoadError> {
        Registry::standard().resolve(self)
    }
}

impl Registry {
    /// Loads the authored scenario of that name, otherwise the file at that path, changed by `overrides` in their order. A file of
    /// CommonRoad is imported first, and the parts that could not be carried over are among the scenario's remarks.
    ///
    /// # Errors
    ///
    /// All faults of the file, of those that it extends, and of the overrides, each located.
    pub fn load(&self, name_or_path: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
        let path = Path::new(name_or_path);
        if !is_commonroad(path) {
            return finish(self, name_or_path, tree(self, name_or_path)?, overrides);
        }
        let imported = import_file(path, &ImportOptions::default());
        let imported = imported.map_err(|fault| LoadError::new(name_or_path, vec![fault]))?;
        let notes = imported.notes.clone();
        let mut scenario = finish(self, name_or_path, imported.into_tree(), overrides)?;
        scenario.remarks.0.extend(notes.into_iter().map(|note| ScenarioRemark(Fault::new(note))));
        Ok(scenario)
    }

    /// Loads a scenario from a text; `name` is its name in errors. It may extend authored scenarios, and
    /// files relative to `name` taken as a path.
    ///
    /// # Errors
    ///
    /// As [`Registry::load`].
    pub fn from_text(&self, name: &str, text: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
        let document = Document::new(name, text, 1);
        let tree = tree::parse(&document, text).and_then(|tree| whole(name, tree, self.complete()));
        finish(self, name, tree.map_err(|faults| LoadError::new(name, faults))?, overrides)
    }

    /// The authored scenario of that name, otherwise the file at that path, as it is written: changed by `overrides`, merged into what
    /// it extends, without defaults. Paths of files in it are relative to the current folder.
    ///
    /// # Errors
    /// Those of [`Registry::load`] that are found from the keys and their values alone.
    pub fn file(&self, name_or_path: &str, overrides: &[Override]) -> Result<ScenarioFile, LoadError> {
        let mut tree = tree(self, name_or_path)?;
        let changed = apply(overrides, &mut tree, self.complete());
        changed.and_then(|()| as_stated(tree, self.complete())).map_err(|faults| LoadError::new(name_or_path, faults))
    }

    /// The file that a table of JSON states, `extends` included, as if it were in the current folder.
    ///
    /// # Errors
    /// As [`Registry::file`]; each names the path of its key.
    pub fn file_from_json(&self, table: &Map<String, Json>) -> Result<ScenarioFile, LoadError> {
        let tree = whole("", tree::of_value(&Json::Object(table.clone())), self.complete());
        let name = table.get("title").and_then(Json::as_str).unwrap_or(UNTITLED);
        tree.and_then(|tree| as_stated(tree, self.complete())).map_err(|faults| LoadError::new(name, faults))
    }

    /// The scenario that a file describes: defaults are added, the road is built, the vehicles are placed on it, the named files
    /// are read, and the result is checked.
    ///
    /// # Errors
    /// All reasons why it cannot be run. Each error names the path of its key.
    pub fn resolve(&self, file: &ScenarioFile) -> Result<Scenario, LoadError> {
        let name = if file.title.is_empty() { UNTITLED } else { &file.title };
        finish(self, name, tree::of_value(&Json::Object(file.stated())), &[])
    }
}

impl Imported {
    /// The scenario that is run. Every error has its place in the imported text.
    ///
    /// # Errors
    /// All reasons why it cannot be run.
    pub fn resolve(&self, registry: &Registry) -> Result<Scenario, LoadError> {
        finish(registry, &self.name, self.clone().into_tree(), &[])
    }
}

/// The tree of a scenario, `extends` resolved, unchecked.
pub(crate) fn tree(registry: &Registry, name_or_path: &str) -> Result<TomlNode, LoadError> {
    let source = Source::find(name_or_path)?;
    let read = read_link(&source, NamedBy::Command, &mut Vec::new(), registry.complete());
    read.map_err(|(_, faults)| LoadError::new(name_or_path, faults))
}

/// The same, changed by `overrides` in their order.
pub(crate) fn changed_tree(
    registry: &Registry,
    name_or_path: &str,
    overrides: &[Override],
) -> Result<TomlNode, LoadError> {
    let mut tree = tree(registry, name_or_path)?;
    apply(overrides, &mut tree, registry.complete()).map_err(|faults| LoadError::new(name_or_path, faults))?;
    Ok(tree)
}

/// The same for a source that a plan names at `place`, which is to blame for a file that is not a scenario.
pub(crate) fn tree_named_at(registry: &Registry, source: &str, place: &Place) -> Result<TomlNode, Vec<Fault>> {
    let source = Source::find(source).map_err(|error| error.faults().to_vec())?;
    read_link(&source, NamedBy::File, &mut Vec::new(), registry.complete()).map_err(|refusal| blamed_on(place, refusal))
}

/// A tree merged into what it extends; paths are relative to `name`.
fn whole(name: &str, tree: TomlNode, schema: SchemaNode) -> Result<TomlNode, Vec<Fault>> {
    let source = Source::File(PathBuf::from(name));
    extended(&source, tree, &mut vec![source.clone()], schema)
}

/// The value that a whole tree states, without defaults.
fn as_stated(mut tree: TomlNode, schema: SchemaNode) -> Result<ScenarioFile, Vec<Fault>> {
    make_paths_absolute(&mut tree, Path::new(""));
    let faults = shape::check(&tree, schema);
    if faults.is_empty() { Ok(read(tree.to_json(), &tree)?) } else { Err(faults) }
}

/// The value of a tree that fits the schema.
fn read<T: DeserializeOwned>(stated: Json, tree: &TomlNode) -> Result<T, Fault> {
    serde_json::from_value(stated).map_err(|error| Fault::at(&tree.place, "in this file", error.to_string()))
}

/// Merges overrides into a tree, in their order.
fn apply(overrides: &[Override], tree: &mut TomlNode, schema: SchemaNode) -> Result<(), Vec<Fault>> {
    let TomlValue::Table(root) = &mut tree.value else { return Ok(()) };
    let faults: Vec<Fault> = overrides.iter().filter_map(|change| change.apply(root, schema).err()).collect();
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

fn finish(registry: &Registry, name: &str, mut tree: TomlNode, overrides: &[Override]) -> Result<Scenario, LoadError> {
    let refused = |faults| LoadError::new(name, faults);
    let as_written = tree.clone();
    apply(overrides, &mut tree, registry.complete()).map_err(refused)?;
    let assembled = assemble(registry, &tree);
    let mut scenario = assembled.map_err(|faults| {
        refused([faults, changed::faults(registry, &tree, |tree| assemble(registry, tree))].concat())
    })?;
    let as_written = Some(&as_written).filter(|_| !overrides.is_empty());
    add_counterfactuals(registry, &mut scenario, &tree, as_written).map_err(refused)?;
    let faults = budget::check_all(&scenario, &tree);
    if faults.is_empty() { Ok(scenario) } else { Err(refused(faults)) }
}

/// The scenario that a whole tree describes, without its counterfactuals.
pub(crate) fn assemble(registry: &Registry, tree: &TomlNode) -> Result<Scenario, Vec<Fault>> {
    assemble_on(registry, tree, &KnownRoads::default())
}

/// The same, with a road that may be known already.
pub(crate) fn assemble_on(
    registry: &Registry,
    tree: &TomlNode,
    known_roads: &KnownRoads,
) -> Result<Scenario, Vec<Fault>> {
    let schema = registry.complete();
    let tree = &with_defaults(with_flows(with_driver_kinds(tree.clone()), schema)?, schema)?;
    if let Some(fault) = plan_in_its_place(tree) {
        return Err(vec![fault]);
    }
    let faults = shape::check(tree, schema);
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut stated = tree.to_json();
    degrees::to_radians(schema, &mut stated);
    expand(&mut stated, registry);
    resolve(registry, read(stated, tree)?, tree, known_roads)
}

/// The fault of a file that is a plan of many runs and not a scenario.
pub(crate) fn plan_in_its_place(tree: &TomlNode) -> Option<Fault> {
    let table =
        tree.table().filter(|table| !["shows", "vehicle", "building"].iter().any(|key| table.contains_key(*key)))?;
    let entry = table.get("scenario")?;
    let fault = Fault::at(&entry.key, "scenarios have no such key", "this is a plan of many runs, not a scenario");
    Some(fault.help("`interplay sweep FILE` makes its runs; `--dry-run` shows what they are"))
}

/// The counterfactuals that a tree states, which the schema has admitted.
pub(crate) fn stated_counterfactuals(tree: &TomlNode) -> Result<Vec<CounterfactualConfig>, Fault> {
    tree.at("counterfactual").map_or_else(|| Ok(Vec::new()), |stated| read(stated.to_json(), stated))
}

/// Gives a scenario the counterfactuals of its tree, each with the scenario that is run for it. A counterfactual that flags have made
/// impossible is left out: `as_written` is the tree without these flags, if there are any.
fn add_counterfactuals(
    registry: &Registry,
    scenario: &mut Scenario,
    tree: &TomlNode,
    as_written: Option<&TomlNode>,
) -> Result<(), Vec<Fault>> {
    let assembled = |tree: &TomlNode, index: usize| {
        let stated = tree.at(&format!("counterfactual.{index}")).and_then(TomlNode::table);
        let changed = |stated| changed::tree(tree, stated, registry.complete());
        stated.map_or_else(|| Err(Vec::new()), |stated| assemble(registry, &changed(stated)?))
    };
    let stated = stated_counterfactuals(tree)?;
    let (mut faults, mut runs) = (Vec::new(), Vec::new());
    for (index, counterfactual) in stated.iter().enumerate() {
        match assembled(tree, index) {
            Ok(scenario) => runs.push(Ok(scenario)),
            Err(found) if as_written.is_some_and(|tree| assembled(tree, index).is_ok()) => {
                runs.push(Err(found.first().map(|fault| fault.message().to_owned()).unwrap_or_default()));
            }
            Err(found) => faults.extend(found.into_iter().map(|fault| fault.in_counterfactual(&counterfactual.name))),
        }
    }
    let changed = if faults.is_empty() { runs.iter().flatten().collect() } else { Vec::new() };
    let as_written = as_written.is_none().then_some(changed.as_slice());
    faults.extend(consistency::counterfactual::check(scenario, &stated, tree, as_written));
    if !faults.is_empty() {
        return Err(faults);
    }
    for (stated, run) in stated.into_iter().zip(runs) {
        match run {
            Ok(scenario_run) => scenario.counterfactuals.push(Counterfactual { stated, scenario: scenario_run }),
            Err(reason) => scenario.left_out.push([stated.name, reason]),
        }
    }
    Ok(())
}

/// Makes the relative paths to files that a scenario names absolute, if they start from another folder than `folder`.
pub(crate) fn make_paths_absolute(tree: &mut TomlNode, folder: &Path) {
    let TomlValue::Table(root) = &mut tree.value else { return };
    for file in named_files(root) {
        let beside = Path::new(&file.place.document.name).parent().unwrap_or(Path::new("")).to_owned();
        let TomlValue::Text(name) = &mut file.value else { continue };
        let real = |path: &Path| fs::canonicalize(if path.as_os_str().is_empty() { Path::new(".") } else { path });
        let same = matches!((real(&beside), real(folder)), (Ok(one), Ok(other)) if one == other);
        if !is_embedded_weather(name)
            && !same
            && let Ok(path) = real(&beside.join(&*name))
        {
            *name = path.to_string_lossy().into_owned();
        }
    }
}

/// An entry of a table; `None` for other values.
fn entry_of<'a>(node: &'a mut TomlNode, key: &str) -> Option<&'a mut TomlNode> {
    match &mut node.value {
        TomlValue::Table(table) => table.get_mut(key).map(|entry| &mut entry.node),
        _ => None,
    }
}

/// The keys that name files: the weather, the prices, the gains, the unit of the building, and the records of the vehicles.
fn named_files(root: &mut Table) -> Vec<&mut TomlNode> {
    let mut found = Vec::new();
    for (key, entry) in root {
        match (key.as_str(), &mut entry.node) {
            ("weather" | "tariff", node) => found.extend(entry_of(node, "file")),
            ("building", node) => found.extend(entry_of(node, "plant").and_then(|plant| entry_of(plant, "fmu"))),
            ("gains", TomlNode { value: TomlValue::Array(tables), .. }) => {
                found.extend(tables.iter_mut().filter_map(|table| entry_of(table, "file")))
            }
            ("vehicle", TomlNode { value: TomlValue::Array(vehicles), .. }) => {
                let drivers = vehicles.iter_mut().filter_map(|vehicle| entry_of(vehicle, "driver"));
                found.extend(drivers.filter_map(|driver| entry_of(driver, "file")));
            }
            _ => {}
        }
    }
    found
}
