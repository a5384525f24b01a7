//! One change that a plan makes to a scenario.

use std::borrow::Cow;

use interplay_common::spelling::suggestion;
use interplay_planners::drivers::human::Style;

use super::factor::{DrawSettings, Factor, factors};
use crate::format::json_schema::SchemaNode;
use crate::format::read::overrides::{SettingPath, ego_kind, lay_planner, settings_of};
use crate::format::read::tree::{Table, TomlEntry, TomlNode, TomlValue};
use crate::format::registry::Registry;
use crate::model::traffic::weights::StartJitter;
use crate::text::error::{Fault, Place, quoted};

/// A setting of a scenario, or the driver of its ego, and the value that a plan gives it.
#[derive(Clone)]
pub(super) struct Assignment<'a> {
    /// The path; `None` for the kind of driver of the ego.
    path: Option<Cow<'a, SettingPath>>,
    value: Cow<'a, TomlNode>,
    /// Whether the value differs from run to run.
    pub is_varied: bool,
}

impl<'a> Assignment<'a> {
    /// Assigns the kind of driver of the ego.
    pub fn driver(kind: &'a TomlNode) -> Assignment<'a> {
        Assignment { path: None, value: Cow::Borrowed(kind), is_varied: false }
    }

    /// Assigns a setting that all runs of an arm share.
    pub fn setting(path: &'a SettingPath, value: &'a TomlNode) -> Assignment<'a> {
        Assignment { path: Some(Cow::Borrowed(path)), value: Cow::Borrowed(value), is_varied: false }
    }

    /// Assigns a varying setting its value in one run.
    pub fn varied(path: &'a SettingPath, value: TomlNode) -> Assignment<'a> {
        Assignment { path: Some(Cow::Borrowed(path)), value: Cow::Owned(value), is_varied: true }
    }

    /// Assigns the random change of the starts, which is stated at a place of the plan.
    pub fn of_jitter(jitter: StartJitter, place: &Place) -> Vec<Assignment<'a>> {
        let amounts = [("start_jitter.position_m", jitter.position_m), ("start_jitter.speed_mps", jitter.speed_mps)];
        let assignment = |(path, amount)| {
            let value = TomlNode { place: place.clone(), value: TomlValue::Float(amount) };
            let path = path_of(path, place).ok()?;
            Some(Assignment { path: Some(Cow::Owned(path)), value: Cow::Owned(value), is_varied: false })
        };
        amounts.into_iter().filter_map(assignment).collect()
    }

    /// Merges the value into a scenario.
    pub fn lay(&self, root: &mut Table, schema: SchemaNode) -> Result<(), Fault> {
        let Some(path) = &self.path else {
            if root.get("vehicle").is_none_or(|entry| entry.node.is_empty_list()) {
                let message = "the scenario has no vehicles, so a planner has nothing to drive";
                return Err(Fault::at(&self.value.place, "no vehicle to drive", message));
            }
            return lay_planner(root, self.value.clone().into_owned(), schema);
        };
        path.lay(root, &self.value, schema)
    }

    /// Whether the setting is one of these or below one of them, by the first key of its path.
    pub fn is_below(&self, first_keys: &[&str]) -> bool {
        let written = self.path.as_ref().map(|path| path.written()).unwrap_or_default();
        first_keys.iter().any(|key| written.split('.').next() == Some(key))
    }

    /// The path in a scenario, as the plan writes it.
    pub fn path(&self, root: &Table) -> String {
        self.path.as_ref().map_or_else(|| ego_kind(root, self.place()).written(), |path| path.written())
    }

    /// The place of the last word of the path.
    pub fn key(&self) -> &Place {
        self.path.as_ref().and_then(|path| path.places().last()).unwrap_or(self.place())
    }

    pub fn value(&self) -> &TomlNode {
        &self.value
    }

    /// The place in the plan at which the value is written.
    pub fn place(&self) -> &Place {
        &self.value.place
    }

    /// Whether the path or the value is written at a place.
    pub fn is_written_at(&self, place: &Place) -> bool {
        let mut words = self.path.iter().flat_map(|path| path.places());
        words.any(|own| own.holds(place)) || is_within(&self.value, place)
    }

    /// Whether the format has a setting at the path.
    pub fn has_known_path(&self, schema: SchemaNode) -> bool {
        self.path.as_ref().is_none_or(|path| path.schema(schema).is_some())
    }

    /// The assignment as text, with numbers to six digits.
    pub fn written(&self) -> String {
        let path = self.path.as_ref().map_or_else(|| "planner".to_owned(), |path| path.written());
        let value = match self.value.value {
            TomlValue::Float(number) => rounded(number),
            _ => self.value.to_json().to_string(),
        };
        format!("`{path} = {value}`")
    }
}

/// Whether a value, or something in it, is written at a place. The place of a table whose keys are stated line by line is that of the
/// first.
fn is_within(value: &TomlNode, place: &Place) -> bool {
    value.place.holds(place)
        || match &value.value {
            TomlValue::Table(table) => {
                table.values().any(|entry| entry.key.holds(place) || is_within(&entry.node, place))
            }
            TomlValue::Array(items) => items.iter().any(|item| is_within(item, place)),
            _ => false,
        }
}

/// A number to six digits, as short as it can be written.
fn rounded(number: f64) -> String {
    let short: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    serde_json::Value::from(short).to_string()
}

/// A path whose words are all written at one place.
pub(super) fn path_of(path: &str, place: &Place) -> Result<SettingPath, Fault> {
    path.split('.').try_fold(SettingPath::root(), |before, word| before.join(word, place))
}

/// A planner of the ego, or drivers of the others.
#[derive(Clone)]
pub(super) struct Arm {
    pub name: String,
    /// The kind of driver that the arm gives the ego, if any.
    kind: Option<TomlNode>,
    changes: Vec<(SettingPath, TomlNode)>,
    /// The factors that vary with it.
    pub factors: Vec<Factor>,
}

/// The name of an arm that leaves the scenario as it is.
const AS_WRITTEN: &str = "as-written";

impl Arm {
    /// An arm that changes nothing: the scenario as its file states it.
    pub fn as_written() -> Arm {
        Arm { name: AS_WRITTEN.to_owned(), kind: None, changes: Vec::new(), factors: Vec::new() }
    }

    /// An arm that changes settings and has its own factors.
    pub fn changing(name: &str, changes: Vec<(SettingPath, TomlNode)>, factors: Vec<Factor>) -> Arm {
        Arm { name: name.to_owned(), kind: None, changes, factors }
    }

    /// An arm that replaces the planner of the ego: by a kind of driver, or by a table.
    pub fn planner(node: &TomlNode, registry: &Registry) -> Result<Arm, Vec<Fault>> {
        match &node.value {
            TomlValue::Table(table) => {
                let kind = table.get("kind").map(|entry| entry.node.clone());
                Ok(Arm { kind, ..Arm::stated(table, (Default::default(), 0, 0), registry)? })
            }
            _ => {
                let name = node.text().unwrap_or_default().to_owned();
                let kind = (name != AS_WRITTEN).then(|| node.clone());
                Ok(Arm { name, kind, ..Arm::as_written() })
            }
        }
    }

    /// An arm that is a counterfactual of a scenario, under its name.
    pub fn counterfactual(table: &Table, registry: &Registry) -> Result<Arm, Vec<Fault>> {
        let kind = table.get("planner").map(|entry| entry.node.clone());
        Ok(Arm { kind, ..Arm::stated(table, (Default::default(), 0, 0), registry)? })
    }

    /// An arm that replaces the drivers of the other vehicles: by a style of humans, a kind of driver, or a table.
    pub fn style(node: &TomlNode, settings: DrawSettings, registry: &Registry) -> Result<Arm, Vec<Fault>> {
        if let TomlValue::Table(table) = &node.value {
            return Arm::stated(table, settings, registry);
        }
        let word = node.text().unwrap_or_default();
        if word == AS_WRITTEN {
            return Ok(Arm::as_written());
        }
        let styles: Vec<&str> = Style::ALL.into_iter().chain([Style::Measured]).map(Style::name).collect();
        let kinds = registry.driver_kinds();
        let text = |word: &str| TomlNode { place: node.place.clone(), value: TomlValue::Text(word.to_owned()) };
        let entry = |word: &str| TomlEntry { key: node.place.clone(), node: text(word) };
        let driver = if styles.contains(&word) {
            Table::from([("kind".to_owned(), entry("human")), ("style".to_owned(), entry(word))])
        } else if kinds.contains(&word) {
            Table::from([("kind".to_owned(), entry(word))])
        } else {
            let words: Vec<&str> = styles.into_iter().chain(kinds).collect();
            let message = format!("{} is neither a style nor a kind of driver", quoted(word));
            return Err(vec![Fault::at(&node.place, "unknown", message).help(suggestion(word, "choose from", &words))]);
        };
        let path = path_of("vehicle.*.driver", &node.place).map_err(|fault| vec![fault])?;
        let changes = vec![(path, TomlNode { place: node.place.clone(), value: TomlValue::Table(driver) })];
        Ok(Arm { name: word.to_owned(), changes, ..Arm::as_written() })
    }

    fn stated(table: &Table, settings: DrawSettings, registry: &Registry) -> Result<Arm, Vec<Fault>> {
        let schema = registry.complete();
        let name = table.get("name").and_then(|entry| entry.node.text()).unwrap_or_default().to_owned();
        let part = |key: &str| table.get(key).and_then(|entry| entry.node.table());
        let changes = part("set").map_or_else(|| Ok(Vec::new()), |set| settings_of(set.clone(), schema))?;
        let factors = part("vary").map_or_else(|| Ok(Vec::new()), |vary| factors(vary, settings, schema))?;
        Ok(Arm { name, kind: None, changes, factors })
    }

    /// The settings that the arm changes.
    pub fn settings(&self) -> &[(SettingPath, TomlNode)] {
        &self.changes
    }

    /// The changes of the arm: the driver of the ego, then its settings.
    pub fn assignments(&self) -> impl Iterator<Item = Assignment<'_>> {
        let kind = self.kind.iter().map(Assignment::driver);
        kind.chain(self.changes.iter().map(|(path, value)| Assignment::setting(path, value)))
    }

    /// The changes of the arm in words; different arms have different words.
    pub fn canonical(&self) -> String {
        let kind = self.kind.iter().map(|kind| format!("kind={}", kind.to_json()));
        let changes = self.changes.iter().map(|(path, value)| format!("{}={}", path.written(), value.to_json()));
        kind.chain(changes).collect::<Vec<_>>().join("\n")
    }
}
