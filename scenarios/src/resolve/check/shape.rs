//! The check of a tree against the JSON Schema: keys, types, ranges, words.
//!
//! It understands the part of JSON Schema that the scenario's schema uses (a test checks this), and its errors use the words
//! of the format.

use std::rc::Rc;

use interplay_common::bounds::Bound;
use interplay_common::json_schema::type_in_words;
use interplay_common::spelling::{listed, nearest, suggestion};
use serde_json::Value as Json;

use super::unknown_key;
use crate::format::json_schema::SchemaNode;
use crate::format::read::tree::{Table, TomlNode, TomlValue, kind_of};
use crate::text::error::{Fault, Place, quoted};
use crate::text::name;
use crate::text::plain_text::is_plain;

/// All faults of the shape of a whole file.
pub(crate) fn check(tree: &TomlNode, schema: SchemaNode) -> Vec<Fault> {
    let mut checker = Checker::default();
    checker.node(tree, schema, &Path::default());
    checker.faults
}

/// All faults of the shape of one table of the file, at `key`.
pub(crate) fn check_table(node: &TomlNode, key: &str, schema: SchemaNode) -> Vec<Fault> {
    let mut checker = Checker::default();
    if let Some(schema) = schema.property(key) {
        checker.node(node, schema, &Path(key.to_owned()));
    }
    checker.faults
}

/// The largest whole number of a setting, unless its type is `u64`.
const MAX_INTEGER: i128 = 1_000_000_000;
/// The most names with which a name is compared, so that a long list is refused at once.
const MAX_SUGGESTED_FROM: usize = 200;

/// Whether a number is within the bounds of its own key. If not, the error states these and not the limit of
/// all settings.
fn admits(schema: SchemaNode, number: f64) -> bool {
    schema.bounds().all(|bound| bound.admits(number))
}

/// The path of the value under check, as for `--set`.
#[derive(Clone, Default)]
struct Path(String);

impl Path {
    fn join(&self, step: &str) -> Path {
        Path(if self.0.is_empty() { step.to_owned() } else { format!("{}.{step}", self.0) })
    }
}

#[derive(Default)]
struct Checker {
    faults: Vec<Fault>,
    /// Names of the complete entries of the list under check, if its entries are merged by name: an incomplete one
    /// may be meant to change one of them.
    complete_entries: Rc<[String]>,
}

impl Checker {
    fn refuse(&mut self, place: &Place, label: &str, message: String, help: impl Into<String>) {
        let (fault, help) = (Fault::at(place, label, message), help.into());
        self.faults.push(if help.is_empty() { fault } else { fault.help(help) });
    }

    fn node(&mut self, node: &TomlNode, schema: SchemaNode, path: &Path) {
        let (words, kinds) = (schema.words(), schema.kinds());
        if !words.is_empty() {
            return match (schema.number_beside_words(), &node.value) {
                (Some(schema), TomlValue::Integer(integer)) => self.number(node, *integer as f64, schema, path),
                (Some(schema), TomlValue::Float(float)) => self.number(node, *float, schema, path),
                _ => self.word(node, &words, path),
            };
        }
        if !kinds.is_empty() {
            return self.table_of_a_kind(node, &kinds, schema, path);
        }
        let mut forms = schema.forms().peekable();
        if forms.peek().is_some() {
            return self.one_of_several_forms(node, forms, schema, path);
        }
        match (schema.type_name(), &node.value) {
            // Its keys are checked as paths.
            (Some("object"), TomlValue::Table(_)) if schema.holds_paths() => {}
            (Some("object"), TomlValue::Table(table)) => self.table(node, table, schema, path),
            (Some("array"), TomlValue::Array(items)) => self.list(node, items, schema, path),
            (Some("string"), TomlValue::Text(text)) => self.text(node, text, schema, path),
            (Some("boolean"), TomlValue::Bool(_)) => {}
            (Some("integer"), TomlValue::Integer(integer)) => self.integer(node, *integer, schema, path),
            (Some("number"), TomlValue::Integer(integer)) => self.number(node, *integer as f64, schema, path),
            (Some("number"), TomlValue::Float(float)) => self.number(node, *float, schema, path),
            (wanted, _) => self.wrong_type(node, wanted, schema, path),
        }
    }

    /// A value with several forms, for example a number or a text: the form of its type applies.
    fn one_of_several_forms<'s>(
        &mut self,
        node: &TomlNode,
        forms: impl Iterator<Item = SchemaNode<'s>>,
        schema: SchemaNode,
        path: &Path,
    ) {
        let mut wanted = Vec::new();
        for form in forms {
            let type_name = form.type_name().or_else(|| form.properties().next().map(|_| "object"));
            if is_of_type(node, type_name) {
                return self.node(node, form, path);
            }
            wanted.push(type_in_words(type_name));
        }
        let (wanted, got) = (wanted.join(" or "), kind_of(&node.value));
        let message = format!("{} must be {wanted}, not {got}", quoted(&path.0));
        self.refuse(&node.place, &format!("not {wanted}"), message, schema.description());
    }

    fn wrong_type(&mut self, node: &TomlNode, wanted: Option<&str>, schema: SchemaNode, path: &Path) {
        let wanted = type_in_words(wanted);
        let got = match &node.value {
            TomlValue::Text(text) => format!("the text {}", quoted(text)),
            TomlValue::Bool(truth) => format!("`{truth}`"),
            TomlValue::Float(float) => format!("{float}"),
            other => kind_of(other).to_owned(),
        };
        let message = format!("{} must be {wanted}, not {got}", quoted(&path.0));
        let help = match schema.merge_key() {
            Some(key) if matches!(node.value, TomlValue::Table(_)) => format!(
                "state each entry as `[[{}]]` with its `{key}`; `{0}.NAME.…` is for `--set` and counterfactuals",
                path.0
            ),
            _ => schema.description().to_owned(),
        };
        self.refuse(&node.place, &format!("not {wanted}"), message, help);
    }

    fn table(&mut self, node: &TomlNode, table: &Table, schema: SchemaNode, path: &Path) {
        let complete_entries = std::mem::take(&mut self.complete_entries);
        for (key, entry) in table {
            match schema.property(key) {
                Some(property) => self.node(&entry.node, property, &path.join(key)),
                None => self.unknown_key(key, &entry.key, schema, path),
            }
        }
        // A misspelt key is reported once.
        let unknown = table.keys().filter(|key| schema.property(key).is_none());
        let meant: Vec<&str> = unknown.filter_map(|key| unknown_key::meant(key, schema)).collect();
        for key in schema.required().filter(|key| !table.contains_key(*key) && !meant.contains(key)) {
            let message = format!("{} is missing", quoted(&path.join(key).0));
            let help = schema.property(key).map(SchemaNode::description).unwrap_or_default();
            let meant = node.label().and_then(|name| nearest(name, complete_entries.iter().map(String::as_str)));
            match (meant, table.get("name")) {
                (Some(meant), Some(name)) if name.node.text() == Some(meant) => {
                    let message = format!("{} stands there twice", quoted(&path.0));
                    let help = "join them, or give one of them another name";
                    self.refuse(&name.node.place, "the same name again", message, help);
                }
                (Some(meant), Some(name)) => {
                    let help = format!("did you mean `{meant}`? An entry with a new name needs `{key}`: {help}");
                    self.refuse(&name.node.place, "a new name", message, help);
                }
                _ => self.refuse(&node.place, &format!("has no `{key}`"), message, help),
            }
        }
        let stated = |key: &str| table.get(key).filter(|entry| !entry.node.is_empty_list());
        let mut blamed: Vec<&str> = Vec::new();
        for (one, other) in schema.exclusions() {
            if let (Some(_), Some(second), false) = (stated(one), stated(other), blamed.contains(&other)) {
                blamed.push(other);
                let message = format!("{} states both `{one}` and `{other}`", quoted(&path.0));
                let said = schema.property(one).map(SchemaNode::description).unwrap_or_default();
                let help = format!("state the one or the other; of `{one}`: {said}");
                self.refuse(&second.node.place, &format!("beside `{one}`"), message, help);
            }
        }
    }

    fn unknown_key(&mut self, key: &str, place: &Place, schema: SchemaNode, path: &Path) {
        let within = if path.0.is_empty() { String::new() } else { format!(" in {}", quoted(&path.0)) };
        let message = format!("unknown key {}{within}", quoted(key));
        let help = unknown_key::help(key, schema);
        self.refuse(place, "unknown key", message, help);
    }

    fn list(&mut self, node: &TomlNode, items: &[TomlNode], schema: SchemaNode, path: &Path) {
        let bound = |keyword: &str| schema.keyword(keyword).and_then(Json::as_u64);
        let count = items.len() as u64;
        if let Some(least) = bound("minItems").filter(|least| count < *least) {
            let message = format!("{} must have at least {least} {}", quoted(&path.0), entries(least));
            self.refuse(&node.place, "too short", message, schema.description());
        }
        if let Some(most) = bound("maxItems").filter(|most| count > *most) {
            let message = format!("{} must have at most {most} {}, not {count}", quoted(&path.0), entries(most));
            self.refuse(&node.place, "too long", message, schema.description());
        }
        let is_merged = schema.merge_key().is_some();
        let Some(schema) = schema.entries() else { return };
        let is_complete =
            |item: &&TomlNode| item.table().is_some_and(|table| schema.required().all(|key| table.contains_key(key)));
        let complete = items.iter().filter(is_complete).filter_map(TomlNode::label).filter(|_| is_merged);
        let complete: Rc<[String]> = complete.take(MAX_SUGGESTED_FROM).map(str::to_owned).collect();
        for (index, item) in items.iter().enumerate() {
            self.complete_entries = Rc::clone(&complete);
            let step = item.label().map_or_else(|| index.to_string(), str::to_owned);
            self.node(item, schema, &path.join(&step));
        }
    }

    fn text(&mut self, node: &TomlNode, text: &str, schema: SchemaNode, path: &Path) {
        if let Some(character) = text.chars().find(|character| !is_plain(*character)) {
            let message = format!("{} has the control character U+{:04X}", quoted(&path.0), u32::from(character));
            return self.refuse(&node.place, "not plain", message, "a terminal would obey it; write plain text");
        }
        if schema.keyword("minLength").is_some() && text.trim().is_empty() {
            let message = format!("{} must not be empty", quoted(&path.0));
            self.refuse(&node.place, "empty", message, "");
        }
        if schema.keyword("pattern").is_some() && !name::is_name(text) {
            let message = format!("{} is not a name", quoted(text));
            self.refuse(&node.place, "not a name", message, name::in_words());
        }
    }

    fn integer(&mut self, node: &TomlNode, integer: i128, schema: SchemaNode, path: &Path) {
        let is_long = schema.keyword("format").is_some_and(|format| format == "uint64");
        let largest = if is_long { u64::MAX.into() } else { MAX_INTEGER };
        if integer > largest && admits(schema, integer as f64) {
            let message = format!("{} must be at most {largest}", quoted(&path.0));
            self.refuse(&node.place, "too large", message, schema.description());
        } else {
            self.range(node, integer as f64, schema, path);
        }
    }

    fn number(&mut self, node: &TomlNode, number: f64, schema: SchemaNode, path: &Path) {
        match Bound::of_every_setting().into_iter().find(|bound| !bound.admits(number)) {
            Some(bound) if bound == Bound::Finite || admits(schema, number) => {
                let label = if bound == Bound::Finite { "not finite" } else { "too large" };
                let message = format!("{} must be {bound}", quoted(&path.0));
                self.refuse(&node.place, label, message, schema.description());
            }
            _ => self.range(node, number, schema, path),
        }
    }

    fn range(&mut self, node: &TomlNode, number: f64, schema: SchemaNode, path: &Path) {
        for bound in schema.bounds().filter(|bound| !bound.admits(number)) {
            // All digits are shown where there are few zeros.
            let is_plain = number == 0.0 || (1e-6..1e12).contains(&number.abs());
            let shown = if is_plain { number.to_string() } else { format!("{number:e}") };
            let message = format!("{} must be {bound}, not {shown}", quoted(&path.0));
            self.refuse(&node.place, &format!("must be {bound}"), message, schema.description());
        }
    }

    /// A table whose `kind` determines its keys.
    fn table_of_a_kind(&mut self, node: &TomlNode, kinds: &[&str], schema: SchemaNode, path: &Path) {
        if let Some(word) = node.text().filter(|word| kinds.contains(word)) {
            let message = format!("{} must be a table whose `kind` is {}", quoted(&path.0), quoted(word));
            return self.refuse(&node.place, "not a table", message, format!("write `{{ kind = \"{word}\" }}`"));
        }
        let TomlValue::Table(table) = &node.value else {
            return self.wrong_type(node, Some("object"), schema, path);
        };
        let Some(entry) = table.get("kind") else {
            let message = format!("{} is missing", quoted(&path.join("kind").0));
            return self.refuse(&node.place, "has no `kind`", message, format!("choose from: {}", listed(kinds)));
        };
        match entry.node.text().and_then(|kind| schema.of_kind(kind)) {
            Some(schema) => self.table(node, table, schema, path),
            None => self.word(&entry.node, kinds, &path.join("kind")),
        }
    }

    fn word(&mut self, node: &TomlNode, words: &[&str], path: &Path) {
        match node.text() {
            Some(text) if words.contains(&text) => {}
            Some(text) => {
                let message = format!("{} cannot be {}", quoted(&path.0), quoted(text));
                self.refuse(&node.place, "unknown word", message, suggestion(text, "choose from", words));
            }
            None => {
                let message = format!("{} must be a text, not {}", quoted(&path.0), kind_of(&node.value));
                self.refuse(&node.place, "not a text", message, format!("choose from: {}", listed(words)));
            }
        }
    }
}

/// Whether a value has a type of the schema.
fn is_of_type(node: &TomlNode, type_name: Option<&str>) -> bool {
    match node.value {
        TomlValue::Table(_) => type_name == Some("object"),
        TomlValue::Array(_) => type_name == Some("array"),
        TomlValue::Text(_) => type_name == Some("string"),
        TomlValue::Bool(_) => type_name == Some("boolean"),
        TomlValue::Integer(_) => matches!(type_name, Some("integer" | "number")),
        TomlValue::Float(_) => type_name == Some("number"),
        TomlValue::Datetime => false,
    }
}

fn entries(count: u64) -> &'static str {
    if count == 1 { "entry" } else { "entries" }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keywords that the check obeys, and those that only inform.
    const UNDERSTOOD: &str = "$ref $defs oneOf anyOf const enum type properties required additionalProperties items minItems \
        maxItems minLength pattern minimum maximum exclusiveMinimum exclusiveMaximum format default description title \
        examples $schema x-unit x-excludes x-concerns x-mechanism x-merge-by x-paths \
        x-radians deprecated";

    #[test]
    fn every_keyword_of_the_schema_is_understood() {
        fn walk(schema: &Json) {
            let Json::Object(object) = schema else { return };
            if object.contains_key("x-paths") {
                return;
            }
            for (keyword, value) in object {
                assert!(UNDERSTOOD.split_whitespace().any(|word| word == keyword), "unknown keyword {keyword}");
                match (keyword.as_str(), value) {
                    ("properties" | "$defs", Json::Object(below)) => below.values().for_each(walk),
                    ("oneOf" | "anyOf", Json::Array(alternatives)) => alternatives.iter().for_each(walk),
                    ("items", below) => walk(below),
                    ("additionalProperties", value) => assert_eq!(value, false),
                    ("pattern", value) => assert_eq!(value, &name::pattern()),
                    ("type", value) => assert!(value.is_string(), "{value}"),
                    _ => {}
                }
            }
            let closed = object.get("additionalProperties").is_some();
            assert_eq!(object.contains_key("properties"), closed, "a table that takes unknown keys: {schema}");
        }
        walk(&crate::format::registry::complete(&Default::default()));
    }
}
