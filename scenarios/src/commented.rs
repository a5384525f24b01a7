//! A scenario written out as a file to start from: every key with what the schema says of it.
//!
//! What the scenario states is written as it stands, `extends` resolved. What it leaves out follows as a comment with its
//! default (`#step_s = 0.1`). Each sort of table is explained where it first appears; later ones state only their own.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::{Map, Value as Json};

use crate::building::is_embedded_weather;
use crate::error::LoadError;
use crate::load::{load, tree};
use crate::nearest::listed;
use crate::schema::{self, resolved};
use crate::tree::{Node, Value};

/// Columns of a comment.
const WIDTH: usize = 110;
/// Keys of a file that concern vehicles, or a building: left out where there are none.
const DRIVING: [&str; 6] = ["duration_s", "step_s", "horizon_steps", "plant", "road", "start_jitter"];
const BUILDING: [&str; 6] = ["building", "weather", "occupancy", "setpoints", "controller", "iterations"];

/// The scenario of that name or path as a commented file that means the same, for a file in `folder`: a path to a weather
/// file that would lead elsewhere from there is made absolute. Its figure is left out, since a variant is another picture.
///
/// # Errors
///
/// As [`load`].
pub fn commented(name_or_path: &str, folder: &Path) -> Result<String, LoadError> {
    let scenario = load(name_or_path, &[])?;
    let mut tree = tree(name_or_path)?;
    settle_weather(&mut tree, folder);
    let Json::Object(mut stated) = tree.to_json() else { return Ok(String::new()) };
    stated.remove("figure");
    let [vehicles, building] = [!scenario.vehicles.is_empty(), scenario.building.is_some()];
    let mut writer = Writer { text: String::new(), explained: BTreeSet::new(), vehicles, building };
    writer.table("", schema::complete(), &stated, true);
    Ok(writer.text)
}

/// Makes a relative path to a weather file absolute if it starts from another folder than `folder`.
fn settle_weather(tree: &mut Node, folder: &Path) {
    let Value::Table(root) = &mut tree.value else { return };
    let Some(Value::Table(weather)) = root.get_mut("weather").map(|entry| &mut entry.node.value) else { return };
    let Some(file) = weather.get_mut("file").map(|entry| &mut entry.node) else { return };
    let beside = Path::new(&file.place.document.name).parent().unwrap_or(Path::new("")).to_owned();
    let Value::Text(name) = &mut file.value else { return };
    let real = |path: &Path| fs::canonicalize(if path.as_os_str().is_empty() { Path::new(".") } else { path });
    let same = matches!((real(&beside), real(folder)), (Ok(one), Ok(other)) if one == other);
    if !is_embedded_weather(name)
        && !same
        && let Ok(path) = real(&beside.join(&*name))
    {
        *name = path.to_string_lossy().into_owned();
    }
}

struct Writer {
    text: String,
    /// Tables that have been explained, by definition and kind.
    explained: BTreeSet<String>,
    vehicles: bool,
    building: bool,
}

/// A table below another, to be written after its plain keys.
struct Section<'a> {
    path: String,
    property: &'static Json,
    value: &'a Json,
    live: bool,
}

impl Writer {
    /// Writes the keys of a table, then the tables below it. Unless `live`, all of it is a comment.
    fn table(&mut self, path: &str, property: &'static Json, value: &Map<String, Json>, live: bool) {
        let first = self.explained.insert(identity(property, value));
        let mut sections = Vec::new();
        for (key, property) in keys(property, value) {
            let below = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            let stated = value.get(key).filter(|value| !value.is_null());
            let spare = || property.get("default").or_else(|| property.get("examples")?.get(0));
            let shown = stated.or_else(|| first.then(spare).flatten());
            let Some(shown) = shown.filter(|_| self.concerns(&below)) else { continue };
            let live = live && stated.is_some();
            let list = list_of_tables(property);
            if list.is_none() && shown.is_object() && !self.explained.contains(&identity_of(property, shown))
                || list.is_some_and(|_| first || !is_empty(shown))
            {
                sections.push(Section { path: below, property, value: shown, live });
            } else if list.is_none() && (stated.is_some() || !shown.is_object()) {
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
        let Section { path, property, value, live } = section;
        let empty = Map::new();
        let (header, item, tables): (_, _, Vec<&Map<String, Json>>) = match (list_of_tables(property), value) {
            (Some(item), Json::Array(items)) if !items.is_empty() => {
                (format!("[[{path}]]"), item, items.iter().filter_map(Json::as_object).collect())
            }
            (Some(item), _) => (format!("[[{path}]]"), item, vec![&empty]),
            (None, value) => (format!("[{path}]"), *property, value.as_object().into_iter().collect()),
        };
        let live = *live && (list_of_tables(property).is_none() || !is_empty(value));
        if !live && list_of_tables(property).is_some() && self.explained.contains(&identity(item, &empty)) {
            return;
        }
        for (index, table) in tables.into_iter().enumerate() {
            self.text.push('\n');
            if index == 0 {
                self.explain(property);
            }
            self.line(&header, live);
            self.table(path, item, table, live);
        }
    }

    /// Whether a key has to do with anything in this scenario.
    fn concerns(&self, path: &str) -> bool {
        let building = BUILDING.contains(&path) || path.starts_with("expect.building");
        let driving = DRIVING.contains(&path) || path == "vehicle" || path.starts_with("expect.");
        if building { self.building } else { self.vehicles || !driving }
    }

    /// What the schema says of a key, as a comment.
    fn explain(&mut self, property: &'static Json) {
        let schema = resolved(schema::complete(), property);
        let said = [property, schema].iter().find_map(|schema| schema.get("description")?.as_str());
        let mut words = said.unwrap_or_default().to_owned();
        let ranges = [
            ("minimum", "at least"),
            ("exclusiveMinimum", "above"),
            ("maximum", "at most"),
            ("exclusiveMaximum", "below"),
        ];
        let bounds = ranges.iter().filter_map(|(keyword, says)| {
            let bound = property.get(*keyword).or_else(|| schema.get(*keyword))?.as_f64()?;
            (bound != 0.0 || schema["type"] == "number").then(|| format!("{says} {bound}"))
        });
        let mut bounds = bounds.collect::<Vec<_>>().join(", ");
        if let Some(first) = bounds.get_mut(..1) {
            first.make_ascii_uppercase();
            words += &format!(" {bounds}.");
        }
        let choices = choices(schema);
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

/// The properties of a table; of a tagged one, those of its `kind`.
fn keys(property: &'static Json, value: &Map<String, Json>) -> impl Iterator<Item = (&'static String, &'static Json)> {
    let schema = resolved(schema::complete(), property);
    let alternatives = schema.get("oneOf").and_then(Json::as_array).into_iter().flatten();
    let kind = value.get("kind").and_then(Json::as_str);
    let of_kind = alternatives.filter(|one| schema::kind_of(one).is_some()).find(|one| schema::kind_of(one) == kind);
    of_kind.unwrap_or(schema).get("properties").and_then(Json::as_object).into_iter().flatten()
}

/// What makes two tables the same sort of table: definition and kind.
fn identity(property: &Json, value: &Map<String, Json>) -> String {
    let definition = property.get("$ref").and_then(Json::as_str).unwrap_or_default();
    format!("{definition} {}", value.get("kind").and_then(Json::as_str).unwrap_or_default())
}

fn identity_of(property: &Json, value: &Json) -> String {
    value.as_object().map_or_else(String::new, |value| identity(property, value))
}

/// The items of a list of tables.
fn list_of_tables(property: &'static Json) -> Option<&'static Json> {
    let items = property.get("items")?;
    resolved(schema::complete(), items).get("properties").map(|_| items)
}

fn is_empty(value: &Json) -> bool {
    value.as_array().is_some_and(Vec::is_empty)
}

/// The words, or the kinds, from which a key or a table chooses.
fn choices(schema: &Json) -> Vec<&str> {
    let words = schema.get("enum").and_then(Json::as_array).into_iter().flatten().filter_map(Json::as_str);
    let alternatives = schema.get("oneOf").and_then(Json::as_array).into_iter().flatten();
    let tagged =
        alternatives.filter_map(|one| one.get("const").and_then(Json::as_str).or_else(|| schema::kind_of(one)));
    words.chain(tagged).collect()
}

/// A value as TOML, on one line, a table in the order of its schema.
fn inline(property: &'static Json, value: &Json) -> String {
    let Json::Object(table) = value else { return toml(value) };
    let pairs = keys(property, table).filter_map(|(key, below)| Some((key, below, table.get(key)?)));
    let pairs: Vec<String> = pairs.map(|(key, below, value)| format!("{key} = {}", inline(below, value))).collect();
    format!("{{ {} }}", pairs.join(", "))
}

/// A value as TOML, on one line.
fn toml(value: &Json) -> String {
    match value {
        Json::Null => String::new(),
        Json::Bool(truth) => truth.to_string(),
        Json::Number(number) if number.is_f64() => format!("{:?}", number.as_f64().unwrap_or_default()),
        Json::Number(number) => number.to_string(),
        Json::String(text) => toml::Value::String(text.clone()).to_string(),
        Json::Array(items) => format!("[{}]", items.iter().map(toml).collect::<Vec<_>>().join(", ")),
        Json::Object(table) => {
            let pairs: Vec<String> = table.iter().map(|(key, value)| format!("{key} = {}", toml(value))).collect();
            format!("{{ {} }}", pairs.join(", "))
        }
    }
}
