//! A TOML text as a tree whose every key and value has a place.

use std::{collections::BTreeMap, sync::Arc};

use serde_json::Value as Json;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::text::error::{Document, Fault, Place};
use crate::text::readable::toml;

#[derive(Clone, Debug)]
pub(crate) struct TomlNode {
    pub place: Place,
    pub value: TomlValue,
}

/// A TOML value. Its numbers have a wider range than those of a scenario, so that the check can report bad ones.
#[derive(Clone, Debug)]
pub(crate) enum TomlValue {
    Text(String),
    Integer(i128),
    Float(f64),
    Bool(bool),
    Datetime,
    Array(Vec<TomlNode>),
    Table(Table),
}

pub(crate) type Table = BTreeMap<String, TomlEntry>;

/// A value with the place of its key.
#[derive(Clone, Debug)]
pub(crate) struct TomlEntry {
    pub key: Place,
    pub node: TomlNode,
}

/// The most syntax errors that are reported; later ones tend to follow from the first.
const MAX_SYNTAX_ERRORS: usize = 3;

/// Parses a document. The nesting depth is bounded by the parser.
pub(crate) fn parse(document: &Arc<Document>, text: &str) -> Result<TomlNode, Vec<Fault>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    if errors.is_empty() {
        return Ok(TomlNode { place: Place::new(document, 0..0), value: from_table(document, 0, table.into_inner()) });
    }
    if let Some(fault) = errors.iter().find_map(|error| single_brackets(document, text, error.span()?)) {
        return Err(vec![fault]);
    }
    let faults = errors.iter().take(MAX_SYNTAX_ERRORS).map(|error| {
        let place = Place::new(document, error.span().unwrap_or(0..0));
        let fault = Fault::at(&place, "here", format!("not valid TOML: {}", error.message().replace('\n', ", ")));
        match error.span().and_then(|span| decimal_point(text, span.start)) {
            Some(number) => fault.help(format!("numbers have a decimal point: `{number}`")),
            None => fault,
        }
    });
    Err(faults.collect())
}

/// The number around a decimal comma, written with a point; `None` without such a number.
fn decimal_point(text: &str, comma: usize) -> Option<String> {
    let (before, after) = (text.get(..comma)?, text.get(comma..)?.strip_prefix(',')?);
    let whole = before.rsplit(|character: char| !character.is_ascii_digit()).next()?;
    let fraction = after.split(|character: char| !character.is_ascii_digit()).next()?;
    (!whole.is_empty() && !fraction.is_empty()).then(|| format!("{whole}.{fraction}"))
}

/// The fault of a header such as `[vehicle]` that occurs twice, or beside `[[vehicle]]`: a list needs two brackets. All other
/// errors follow from it.
fn single_brackets(document: &Arc<Document>, text: &str, span: std::ops::Range<usize>) -> Option<Fault> {
    let start = text.get(..span.start)?.rfind('\n').map_or(0, |end| end + 1);
    let line = text[start..].lines().next()?.trim_end();
    let name = line.strip_prefix('[')?.strip_suffix(']')?;
    let name = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
    let (single, double) = (format!("[{name}]"), format!("[[{name}]]"));
    let mut singles = text.split_inclusive('\n').scan(0, |from, line| {
        let begins = std::mem::replace(from, *from + line.len());
        Some((begins, line.trim_end()))
    });
    let is_of_list = text.lines().any(|line| line.trim_end() == double);
    let (begins, _) = singles.by_ref().filter(|(_, line)| *line == single).nth(usize::from(!is_of_list))?;
    let message = if is_of_list {
        format!("`{single}` stands here beside `{double}`")
    } else {
        format!("`{single}` stands here for the second time")
    };
    let place = Place::new(document, begins..begins + single.len());
    Some(Fault::at(&place, "two brackets?", message).help(format!("of each one of several, write `{double}`")))
}

/// Parses a single value that is written at `offset` in the document; `None` if it is not TOML.
pub(crate) fn parse_value(document: &Arc<Document>, offset: usize, text: &str) -> Option<TomlNode> {
    DeValue::parse(text).ok().map(|value| from_value(document, offset, value))
}

fn from_table(document: &Arc<Document>, offset: usize, table: DeTable<'_>) -> TomlValue {
    let entries = table.into_iter().map(|(key, value)| {
        let place = Place::new(document, offset + key.span().start..offset + key.span().end);
        (key.into_inner().into_owned(), TomlEntry { key: place, node: from_value(document, offset, value) })
    });
    TomlValue::Table(entries.collect())
}

fn from_value(document: &Arc<Document>, offset: usize, value: Spanned<DeValue<'_>>) -> TomlNode {
    let place = Place::new(document, offset + value.span().start..offset + value.span().end);
    let value = match value.into_inner() {
        DeValue::String(text) => TomlValue::Text(text.into_owned()),
        DeValue::Integer(integer) => TomlValue::Integer(widened(integer.as_str(), integer.radix())),
        DeValue::Float(float) => TomlValue::Float(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(truth) => TomlValue::Bool(truth),
        DeValue::Datetime(_) => TomlValue::Datetime,
        DeValue::Array(items) => {
            TomlValue::Array(items.into_iter().map(|item| from_value(document, offset, item)).collect())
        }
        DeValue::Table(table) => from_table(document, offset, table),
    };
    TomlNode { place, value }
}

/// The most characters of a value that an error shows.
const MAX_SHOWN: usize = 100;

/// The tree of a scenario made in code. It has no text: the place of a value is the path of its key.
pub(crate) fn of_value(value: &Json) -> TomlNode {
    entry_of_value("", "", value).node
}

/// The value of a key of the table at a path; the whole scenario where both are empty.
fn entry_of_value(table: &str, key: &str, value: &Json) -> TomlEntry {
    let path = if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") };
    let [name, before] = if path.is_empty() { ["scenario", ""] } else { [path.as_str(), " = "] };
    let shown: String = format!("{key}{before}{}", toml(value)).chars().take(MAX_SHOWN).collect();
    let document = Document::of_key(name, &shown, 1);
    let span = (key.len() + before.len()).min(shown.len())..shown.len();
    // An error in a table then points at the whole table and not at its first key.
    let key_place = Place::new(&document.ranked(2), 0..key.len().min(shown.len()));
    let value = match value {
        Json::Object(stated) => {
            let stated = stated.iter().filter(|(_, value)| !value.is_null());
            TomlValue::Table(stated.map(|(key, value)| (key.clone(), entry_of_value(&path, key, value))).collect())
        }
        Json::Array(items) => {
            let label = |index: usize, item: &Json| {
                let name = ["name", "vehicle"].iter().find_map(|key| item.get(key)?.as_str());
                name.map_or_else(|| index.to_string(), str::to_owned)
            };
            let entries = items.iter().enumerate();
            let nodes = entries.map(|(index, item)| entry_of_value(&path, &label(index, item), item).node);
            TomlValue::Array(nodes.collect())
        }
        Json::Number(number) => match number.as_i128() {
            Some(integer) => TomlValue::Integer(integer),
            None => TomlValue::Float(number.as_f64().unwrap_or(f64::NAN)),
        },
        Json::String(text) => TomlValue::Text(text.clone()),
        Json::Bool(truth) => TomlValue::Bool(*truth),
        Json::Null => TomlValue::Text(String::new()),
    };
    TomlEntry { key: key_place, node: TomlNode { place: Place::new(&document, span), value } }
}

/// An integer of any length; one beyond all bounds becomes the largest of its sign.
fn widened(digits: &str, radix: u32) -> i128 {
    let extreme = if digits.starts_with('-') { i128::MIN } else { i128::MAX };
    i128::from_str_radix(digits, radix).unwrap_or(extreme)
}

impl TomlNode {
    /// The entries, if this is a table.
    pub fn table(&self) -> Option<&Table> {
        match &self.value {
            TomlValue::Table(table) => Some(table),
            _ => None,
        }
    }

    pub fn text(&self) -> Option<&str> {
        match &self.value {
            TomlValue::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Sets the place of this value and of all values below it.
    pub fn set_place(&mut self, place: &Place) {
        self.place = place.clone();
        match &mut self.value {
            TomlValue::Table(table) => table.values_mut().for_each(|entry| {
                entry.key = place.clone();
                entry.node.set_place(place);
            }),
            TomlValue::Array(items) => items.iter_mut().for_each(|item| item.set_place(place)),
            _ => {}
        }
    }

    /// The value at a path, mutable.
    pub fn at_mut(&mut self, path: &str) -> Option<&mut TomlNode> {
        path.split('.').try_fold(self, |node, step| match &mut node.value {
            TomlValue::Table(table) => table.get_mut(step).map(|entry| &mut entry.node),
            TomlValue::Array(items) => items.get_mut(step.parse::<usize>().ok()?),
            _ => None,
        })
    }

    /// Whether this is a list without entries.
    pub fn is_empty_list(&self) -> bool {
        matches!(&self.value, TomlValue::Array(items) if items.is_empty())
    }

    /// The node below this one under a key or, in an array, an index.
    fn child(&self, step: &str) -> Option<&TomlNode> {
        match &self.value {
            TomlValue::Table(table) => table.get(step).map(|entry| &entry.node),
            TomlValue::Array(items) => items.get(step.parse::<usize>().ok()?),
            _ => None,
        }
    }

    /// The place of the value at a path such as `vehicle.0.start.x_m`, or of the innermost table around it. The place
    /// of a table is that of the part that was stated last, so that an error points at the flag that changed it.
    pub fn place_of(&self, path: &str) -> &Place {
        let mut node = self;
        for step in path.split('.') {
            match node.child(step) {
                Some(child) => node = child,
                None => return &node.place,
            }
        }
        let parts = node.table().into_iter().flat_map(|table| table.values().map(|entry| &entry.key));
        parts.chain([&node.place]).min_by_key(|place| (place.document.rank, place.span.start)).unwrap_or(&node.place)
    }

    /// The value at a path, if it is stated.
    pub fn at(&self, path: &str) -> Option<&TomlNode> {
        path.split('.').try_fold(self, |node, step| node.child(step))
    }

    /// The word that identifies a table in an array: its `name`, or the `vehicle` that it concerns.
    pub fn label(&self) -> Option<&str> {
        let table = self.table()?;
        ["name", "vehicle"].iter().find_map(|key| table.get(*key)?.node.text())
    }

    /// The value as JSON, for serde. A number that JSON cannot represent becomes null; an earlier check has refused it.
    pub fn to_json(&self) -> Json {
        use serde_json::Number;
        match &self.value {
            TomlValue::Text(text) => Json::String(text.clone()),
            TomlValue::Integer(integer) => Number::from_i128(*integer).map_or(Json::Null, Json::Number),
            TomlValue::Float(float) => Number::from_f64(*float).map_or(Json::Null, Json::Number),
            TomlValue::Bool(truth) => Json::Bool(*truth),
            TomlValue::Datetime => Json::Null,
            TomlValue::Array(items) => items.iter().map(TomlNode::to_json).collect(),
            TomlValue::Table(table) => table.iter().map(|(key, entry)| (key.clone(), entry.node.to_json())).collect(),
        }
    }
}

/// The type of a value, in the words of an error message.
pub(crate) fn kind_of(value: &TomlValue) -> &'static str {
    match value {
        TomlValue::Text(_) => "a text",
        TomlValue::Integer(_) => "a whole number",
        TomlValue::Float(_) => "a number",
        TomlValue::Bool(_) => "true or false",
        TomlValue::Datetime => "a date",
        TomlValue::Array(_) => "a list",
        TomlValue::Table(_) => "a table",
    }
}
