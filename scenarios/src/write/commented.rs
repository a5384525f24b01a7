//! Writes a scenario as a file to start from, with a comment from the schema on every key.
//!
//! Keys that the scenario states are written with their values, including those that it inherits by `extends`. On request, all
//! other keys follow as comments with their defaults (`#step_s = 0.1`). Each kind of table is explained where it first
//! appears; later tables of the kind contain only the keys that they state.

use std::collections::BTreeSet;
use std::path::Path;

use interplay_common::bounds::Bound;
use interplay_common::spelling::listed;
use serde_json::{Map, Value as Json};

use crate::format::json_schema::{Concern, SchemaNode};
use crate::format::registry::Registry;
use crate::load::{make_paths_absolute, tree};
use crate::text::error::LoadError;
use crate::text::readable::toml;

/// Columns of a comment.
const WIDTH: usize = 110;

impl Registry {
    /// The scenario with this name or path as a commented file that means the same, for a file in `folder`. A path to a file that
    /// would lead elsewhere from there becomes absolute. The figure is left out, since a variant shows another picture. With
    /// `all_keys`, the keys that are not stated follow as comments with their defaults.
    ///
    /// # Errors
    ///
    /// As [`Registry::load`].
    pub fn commented(&self, name_or_path: &str, folder: &Path, all_keys: bool) -> Result<String, LoadError> {
        let scenario = self.load(name_or_path, &[])?;
        let mut tree = tree(self, name_or_path)?;
        make_paths_absolute(&mut tree, folder);
        let Json::Object(mut stated) = tree.to_json() else { return Ok(String::new()) };
        stated.remove("figure");
        let [vehicles, building] = [!scenario.vehicles.is_empty(), scenario.building.is_some()];
        let mut writer = Writer { text: String::new(), explained: Some(BTreeSet::new()), all_keys, vehicles, building };
        writer.table("", self.complete(), &stated, true);
        Ok(writer.text)
    }
}

/// A file that states `stated`, without comments.
pub(crate) fn plain(stated: &Map<String, Json>) -> String {
    let mut writer = Writer { text: String::new(), explained: None, all_keys: false, vehicles: true, building: true };
    writer.table("", Registry::standard().complete(), stated, true);
    writer.text
}

struct Writer {
    text: String,
    /// Tables that have been explained, by definition and kind; none if nothing is explained.
    explained: Option<BTreeSet<String>>,
    /// Whether keys that are not stated are written, as comments.
    all_keys: bool,
    vehicles: bool,
    building: bool,
}

/// A table below another, to be written after its plain keys.
struct Section<'a> {
    path: String,
    schema: SchemaNode<'a>,
    value: &'a Json,
    live: bool,
}

impl Writer {
    /// Writes the keys of a table, then the tables below it. Unless `live`, all of it is a comment.
    fn table(&mut self, path: &str, schema: SchemaNode, value: &Map<String, Json>, live: bool) {
        let first = self.explained.as_mut().is_some_and(|explained| explained.insert(table_type(schema, value)));
        let mut sections = Vec::new();
        let kind = value.get("kind").and_then(Json::as_str).filter(|_| !schema.kinds().is_empty());
        if kind.is_some_and(|kind| schema.of_kind(kind).is_none()) {
            // The schema of Interplay does not describe the keys of a kind from another crate.
            for (key, value) in value {
                self.line(&format!("{key} = {}", inline(schema, value)), live);
            }
            return;
        }
        for (key, property) in keys(schema, value) {
            let below = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            let stated = value.get(key).filter(|value| !value.is_null());
            let shown = stated.or_else(|| property.default_or_example().filter(|_| first && self.all_keys));
            let is_written = stated.is_some() || !property.is_deprecated();
            let Some(shown) = shown.filter(|_| is_written && self.concerns(property)) else { continue };
            let live = live && stated.is_some();
            if self.explained.is_none() && says_nothing(property, shown) {
                continue;
            }
            let is_new = |table: &Map<String, Json>| !self.is_explained(&table_type(property, table));
            let is_list = property.table_entries().is_some();
            let is_inline = property.holds_paths() || property.forms().next().is_some();
            if !is_list && !is_inline && shown.as_object().is_some_and(is_new) || is_list && (first || !is_empty(shown))
            {
                sections.push(Section { path: below, schema: property, value: shown, live });
            } else if !is_list && (stated.is_some() || is_inline || !shown.is_object()) {
                if first && key != "kind" {
                    self.explain(property);
                }
                self.line(&format!("{key} = {}", inline(property, shown)), live);
            }
        }
        for section in sections {
            self.section(&section);
        }
    }

    fn section(&mut self, section: &Section<'_>) {
        let Section { path, schema, value, live } = section;
        let empty = Map::new();
        let (header, table, values): (_, _, Vec<&Map<String, Json>>) = match (schema.table_entries(), value) {
            (Some(entry), Json::Array(items)) if !items.is_empty() => {
                (format!("[[{path}]]"), entry, items.iter().filter_map(Json::as_object).collect())
            }
            (Some(entry), _) => (format!("[[{path}]]"), entry, vec![&empty]),
            (None, value) => (format!("[{path}]"), *schema, value.as_object().into_iter().collect()),
        };
        let is_list = schema.table_entries().is_some();
        let live = *live && !(is_list && is_empty(value));
        if !live && is_list && self.is_explained(&table_type(table, &empty)) {
            return;
        }
        for (index, value) in values.into_iter().enumerate() {
            self.text.push('\n');
            if index == 0 && self.explained.is_some() {
                self.explain(*schema);
            }
            self.line(&header, live);
            self.table(path, table, value, live);
        }
    }

    fn is_explained(&self, table: &str) -> bool {
        self.explained.as_ref().is_some_and(|explained| explained.contains(table))
    }

    /// Whether a key has to do with anything in this scenario.
    fn concerns(&self, property: SchemaNode) -> bool {
        match property.concerns() {
            Some(Concern::Vehicles) => self.vehicles,
            Some(Concern::Building) => self.building,
            None => true,
        }
    }

    /// What the schema says of a key, as a comment.
    fn explain(&mut self, property: SchemaNode) {
        let mut words = property.description().to_owned();
        // A lower bound of 0 on a count need not be stated.
        let is_news = |bound: &Bound| *bound != Bound::AtLeast(0.0) || property.type_name() == Some("number");
        let bounds: Vec<String> = property.bounds().filter(is_news).map(|bound| bound.to_string()).collect();
        let mut bounds = bounds.join(", ");
        if let Some(first) = bounds.get_mut(..1) {
            first.make_ascii_uppercase();
            words += &format!(" {bounds}.");
        }
        let choices = [property.words(), property.kinds()].concat();
        if !choices.is_empty() {
            words += &format!(" One of: {}.", listed(&choices));
        }
        let mut line = String::from("#");
        for word in words.split_whitespace() {
            if line.chars().count() + 1 + word.chars().count() > WIDTH {
                self.text += &(std::mem::replace(&mut line, String::from("#")) + "\n");
            }
            line += " ";
            line += word;
        }
        self.text += &(line + "\n");
    }

    fn line(&mut self, words: &str, live: bool) {
        self.text += &format!("{}{words}\n", if live { "" } else { "#" });
    }
}

/// The properties of a table; of a tagged one, those of its `kind`, and where a value has several forms, those of the table.
fn keys<'s>(schema: SchemaNode<'s>, value: &Map<String, Json>) -> impl Iterator<Item = (&'s String, SchemaNode<'s>)> {
    let kind = value.get("kind").and_then(Json::as_str);
    let form = || schema.forms().find(|form| form.properties().next().is_some());
    kind.and_then(|kind| schema.of_kind(kind)).or_else(form).unwrap_or(schema).properties()
}

/// What makes two tables the same sort of table: definition and kind.
fn table_type(schema: SchemaNode, value: &Map<String, Json>) -> String {
    let kind = value.get("kind").and_then(Json::as_str).unwrap_or_default();
    format!("{} {kind}", schema.definition_name().unwrap_or_default())
}

fn is_empty(value: &Json) -> bool {
    value.as_array().is_some_and(Vec::is_empty)
}

/// Whether a key may be left out: a list or a table without entries that is so by default.
fn says_nothing(property: SchemaNode, value: &Json) -> bool {
    match value {
        Json::Array(items) => items.is_empty() && property.is_default(value),
        Json::Object(table) => table.is_empty() && property.default().is_some(),
        _ => false,
    }
}

/// A value as TOML, on one line, a table in the order of its schema.
pub(crate) fn inline(property: SchemaNode, value: &Json) -> String {
    let Some(table) = value.as_object().filter(|_| !property.holds_paths()) else { return toml(value) };
    let pairs = keys(property, table).filter_map(|(key, below)| Some((key, below, table.get(key)?)));
    let pairs: Vec<String> = pairs.map(|(key, below, value)| format!("{key} = {}", inline(below, value))).collect();
    format!("{{ {} }}", pairs.join(", "))
}
