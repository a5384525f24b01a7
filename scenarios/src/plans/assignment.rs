//! One change that a plan makes to a scenario.

use std::borrow::Cow;

use crate::format::json_schema::SchemaNode;
use crate::format::read::overrides::{SettingPath, lay_planner};
use crate::format::read::tree::{Table, TomlNode, TomlValue};
use crate::model::traffic::start_jitter::StartJitter;
use crate::text::error::{Fault, Place};

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
