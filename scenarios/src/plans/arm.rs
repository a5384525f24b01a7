//! The compared arms: planners of the ego, and drivers of the other vehicles.

use interplay_common::spelling::suggestion;
use interplay_planners::drivers::human::Style;

use super::assignment::{Assignment, path_of};
use super::factor::{DrawSettings, Factor, factors};
use crate::format::read::overrides::{SettingPath, settings_of};
use crate::format::read::tree::{Table, TomlEntry, TomlNode, TomlValue};
use crate::format::registry::Registry;
use crate::text::error::{Fault, quoted};

/// A planner of the ego, or drivers of the others.
#[derive(Clone)]
pub(super) struct Arm {
    /// Its name.
    pub name: String,
    /// The kind of driver of the ego, if it is changed.
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

    /// The kind of driver that the arm gives the ego, if any.
    pub fn kind(&self) -> Option<&TomlNode> {
        self.kind.as_ref()
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
