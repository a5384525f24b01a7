//! The standard list of changes with which `interplay why` finds the causes of the outcome of a drive.
//!
//! - the style of each human, nice or tough, and of each pedestrian; for another driver that does not interact, a human of either style;
//! - the planner of each interactive vehicle: negotiation, conservative or cooperative (`DriverKind::replacement_in_why`);
//! - the intelligent driver model instead, which does not interact: a separate factor;
//! - each mechanism of such a planner switched off: the settings whose schema says `x-mechanism`;
//! - each other setting of such a planner that the file changes from the planner's default: that default;
//! - whether a vehicle knows the plans of the others, or expects constant velocities.

use interplay_planners::drivers::human::Style;
use interplay_planners::drivers::walker::WalkerStyle;
use interplay_planners::{Driver, StandardReplacement};
use serde_json::Value as Json;

use crate::format::json_schema::SchemaNode;
use crate::format::read::overrides::Override;
use crate::format::read::tree::{TomlNode, TomlValue};
use crate::format::registry::Registry;
use crate::load;
use crate::model::scenario::{Scenario, Vehicle};
use crate::text::error::LoadError;

/// A kind with which a driver loses the settings of its own kind.
const OTHER_KIND: &str = "idm";

/// Settings that other changes vary, or that name the planner itself.
const VARIED_OTHERWISE: [&str; 2] = ["kind", "prediction"];

/// One change of a scenario, and the changed scenario.
#[derive(Clone, Debug)]
pub struct StandardChange {
    /// The factor that the change varies, such as "front's style".
    pub factor: String,
    /// The change, such as "front: style = tough".
    pub change: String,
    /// The same as arguments of `--set`.
    pub sets: Vec<String>,
    /// The changed scenario, with the expectations of the original and without counterfactuals.
    pub scenario: Scenario,
}

impl Registry {
    /// The changed scenarios of the standard list. `scenario` is the one of `name_or_path` with `overrides`.
    ///
    /// # Errors
    /// As [`Registry::load`], if a change does not fit the scenario.
    pub fn standard_changes(
        &self,
        name_or_path: &str,
        scenario: &Scenario,
        overrides: &[Override],
    ) -> Result<Vec<StandardChange>, LoadError> {
        let changed_tree = load::changed_tree(self, name_or_path, overrides)?;
        // Vehicles of flows are not in the file, so no change can name them.
        let is_written = |vehicle: &&Vehicle| {
            let written = changed_tree.at("vehicle").map(|vehicles| &vehicles.value);
            matches!(written, Some(TomlValue::Array(all)) if all.iter().any(|one| one.label() == Some(&*vehicle.name)))
        };
        let driven = scenario.vehicles.iter().filter(|vehicle| vehicle.obstacle.is_none());
        let stated = driven.filter(is_written).flat_map(|vehicle| {
            let plain = self.plain_driver(name_or_path, vehicle, overrides);
            let kind = kind_to_state(vehicle, &changed_tree);
            let changes = changes(vehicle, plain.as_ref(), self).into_iter();
            changes.map(move |(factor, change, set)| (factor, change, kind.iter().cloned().chain([set]).collect()))
        });
        let changed = stated.map(|(factor, change, sets): (String, String, Vec<String>)| {
            let without_counterfactuals = Override::Set("counterfactual=[]".to_owned());
            let more = [without_counterfactuals].into_iter().chain(sets.iter().cloned().map(Override::Set));
            let overrides: Vec<Override> = overrides.iter().cloned().chain(more).collect();
            let scenario = self.load(name_or_path, &overrides)?;
            Ok(StandardChange { factor, change, sets, scenario })
        });
        changed.collect()
    }
}

impl Registry {
    /// The settings that the planner of an interactive vehicle would have in a scenario whose file does not state them; `None` for
    /// drivers that do not interact.
    fn plain_driver(&self, name_or_path: &str, vehicle: &Vehicle, overrides: &[Override]) -> Option<Driver> {
        if vehicle.driver.goes_first() {
            return None;
        }
        let (name, kind) = (&vehicle.name, vehicle.driver.kind());
        // Another kind drops the settings that it does not know.
        let sets = [
            "counterfactual=[]".to_owned(),
            "expect={}".to_owned(),
            format!("vehicle.{name}.driver.kind=\"{OTHER_KIND}\""),
            format!("vehicle.{name}.driver.kind=\"{kind}\""),
        ];
        let plain = self.load(name_or_path, &[overrides, &sets.map(Override::Set)].concat()).ok()?;
        plain.vehicle(name).map(|vehicle| vehicle.driver.clone())
    }
}

/// The argument of `--set` that states the kind of a driver whose table the file omits: without it, no key of the table can be set.
fn kind_to_state(vehicle: &Vehicle, tree: &TomlNode) -> Option<String> {
    let Some(TomlValue::Array(stated)) = tree.at("vehicle").map(|vehicles| &vehicles.value) else { return None };
    let is_it = |node: &&TomlNode| node.at("name").and_then(TomlNode::text) == Some(&vehicle.name);
    let lacks_table = stated.iter().find(is_it).is_some_and(|node| node.at("driver").is_none());
    lacks_table.then(|| format!("vehicle.{}.driver.kind=\"{}\"", vehicle.name, vehicle.driver.kind()))
}

/// Factor, change, and the argument of `--set`.
type Change = (String, String, String);

fn changes(vehicle: &Vehicle, plain: Option<&Driver>, registry: &Registry) -> Vec<Change> {
    let mut changes = match &vehicle.driver {
        Driver::Human(settings) => {
            let styles = [Style::Tough, Style::Nice].into_iter();
            let others = styles.filter(|style| style.safety_weight() != settings.weight());
            others.map(|style| style_change(vehicle, style)).collect()
        }
        // A pedestrian cannot become a driver, and keeps its trigger.
        Driver::Walker(settings) => {
            let styles = [WalkerStyle::Careful, WalkerStyle::Normal, WalkerStyle::Bold].into_iter();
            styles.filter(|style| *style != settings.style).filter_map(|style| walker_change(vehicle, style)).collect()
        }
        driver if driver.goes_first() => [Style::Tough, Style::Nice].map(|style| human(vehicle, style)).to_vec(),
        driver => {
            let mut others: Vec<(StandardReplacement, &str)> = registry
                .drivers()
                .filter(|other| other.kind() != driver.kind())
                .filter_map(|other| Some((other.replacement_in_why()?, other.kind())))
                .collect();
            others.sort_by_key(|(replacement, _)| replacement.rank);
            others.into_iter().map(|(replacement, kind)| planner_change(vehicle, replacement.factor, kind)).collect()
        }
    };
    let settings = serde_json::to_value(&vehicle.driver).unwrap_or_default();
    let plain = plain.and_then(|plain| serde_json::to_value(plain).ok()).unwrap_or_default();
    for (key, property) in settings_of(&vehicle.driver, registry.complete()) {
        let value = settings.get(key).unwrap_or(&Json::Null);
        let off = mechanism_change(vehicle, key, property, value);
        let by_itself = plain.get(key).filter(|plain| off.is_none() && *plain != value && !plain.is_null());
        changes.extend(by_itself.and_then(|plain| plain_change(vehicle, key, property, [value, plain])));
        changes.extend(off);
        if key == "prediction" {
            let others = property.words().into_iter().filter(|word| value != word);
            changes.extend(others.map(|word| prediction_change(vehicle, word)));
        }
    }
    changes
}

fn style_change(Vehicle { name, .. }: &Vehicle, style: Style) -> Change {
    let word = style.name();
    let set = format!("vehicle.{name}.driver.style=\"{word}\"");
    (format!("{name}'s style"), format!("{name}: style = {word}"), set)
}

fn walker_change(Vehicle { name, .. }: &Vehicle, style: WalkerStyle) -> Option<Change> {
    let word = serde_json::to_value(style).ok()?.as_str()?.to_owned();
    let set = format!("vehicle.{name}.driver.style=\"{word}\"");
    Some((format!("{name}'s style"), format!("{name}: style = {word}"), set))
}

fn human(Vehicle { name, .. }: &Vehicle, style: Style) -> Change {
    let word = style.name();
    let set = format!("vehicle.{name}.driver={{ kind = \"human\", style = \"{word}\" }}");
    (format!("{name}'s driver"), format!("{name}: driver = human, {word}"), set)
}

fn planner_change(Vehicle { name, .. }: &Vehicle, factor: &str, kind: &str) -> Change {
    let set = format!("vehicle.{name}.driver.kind=\"{kind}\"");
    (format!("{name}'s {factor}"), format!("{name}: planner = {kind}"), set)
}

fn prediction_change(Vehicle { name, .. }: &Vehicle, word: &str) -> Change {
    let set = format!("vehicle.{name}.driver.prediction=\"{word}\"");
    (format!("{name}'s knowledge of plans"), format!("{name}: prediction = {word}"), set)
}

/// Switches a mechanism off, if this setting is one and it is on.
fn mechanism_change(vehicle: &Vehicle, key: &str, property: SchemaNode, value: &Json) -> Option<Change> {
    let (mechanism, off) = property.mechanism()?;
    let name = &vehicle.name;
    // The value is left out if it is a table, which would be wider than the rest of the row.
    let how = if off.is_object() { String::new() } else { format!(" ({key} = {})", toml_of(off)) };
    let set = format!("vehicle.{name}.driver.{key}={}", toml_of(off));
    (value != off).then(|| (format!("{name}'s {mechanism}"), format!("{name}: without {mechanism}{how}"), set))
}

/// Gives a setting the planner's default; a mechanism that the file switches off is switched on.
fn plain_change(
    Vehicle { name, .. }: &Vehicle,
    key: &str,
    property: SchemaNode,
    [value, plain]: [&Json; 2],
) -> Option<Change> {
    if VARIED_OTHERWISE.contains(&key) {
        return None;
    }
    let set = format!("vehicle.{name}.driver.{key}={}", toml_of(plain));
    let how = if plain.is_object() { String::new() } else { format!(" = {}", toml_of(plain)) };
    match property.mechanism() {
        Some((mechanism, off)) if off == value => {
            Some((format!("{name}'s {mechanism}"), format!("{name}: with {mechanism} ({key}{how})"), set))
        }
        _ => Some((format!("{name}'s {key}"), format!("{name}: {key}{how}"), set)),
    }
}

/// A JSON value as TOML, on one line.
fn toml_of(value: &Json) -> String {
    match value {
        Json::Object(table) => {
            let pairs: Vec<String> = table.iter().map(|(key, value)| format!("{key} = {}", toml_of(value))).collect();
            format!("{{ {} }}", pairs.join(", "))
        }
        plain => plain.to_string(),
    }
}

/// The settings of a driver as its kind has them.
fn settings_of<'s>(driver: &Driver, schema: SchemaNode<'s>) -> impl Iterator<Item = (&'s String, SchemaNode<'s>)> {
    let vehicle = schema.property("vehicle").and_then(SchemaNode::entries);
    let kinds = vehicle.and_then(|vehicle| vehicle.property("driver"));
    kinds.and_then(|kinds| kinds.of_kind(driver.kind())).into_iter().flat_map(SchemaNode::properties)
}
