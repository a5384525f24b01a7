//! The check of a tree against the JSON Schema: keys, types, ranges, words.
//!
//! It understands the part of JSON Schema that [`schema::complete`] uses (a test holds it to that), and says in the words
//! of the format what is wrong and what would work.

use serde_json::Value as Json;

use crate::error::{Place, Problem, quoted};
use crate::nearest::{listed, suggestion};
use crate::schema;
use crate::tree::{Node, Table, Value, kind_of};

/// No number is larger: beyond, squares and products of what is computed could overflow.
const LARGEST: f64 = 1e9;

/// Units at the end of keys of one word, such as `speed_mps`.
const UNITS: [&str; 12] = ["m", "s", "h", "k", "c", "kw", "deg", "rad", "mps", "mps2", "k_per_kw", "kj_per_k"];

/// A schema that says nothing.
static NULL: Json = Json::Null;

/// Everything that is wrong with the shape of the tree.
pub(crate) fn check(tree: &Node) -> Vec<Problem> {
    let mut checker = Checker { root: schema::complete(), problems: Vec::new() };
    checker.node(tree, checker.root, &Path::default());
    checker.problems
}

/// Where the checker is, as `--set` would address it.
#[derive(Clone, Default)]
struct Path(String);

impl Path {
    fn join(&self, step: &str) -> Path {
        Path(if self.0.is_empty() { step.to_owned() } else { format!("{}.{step}", self.0) })
    }
}

struct Checker {
    root: &'static Json,
    problems: Vec<Problem>,
}

impl Checker {
    fn refuse(&mut self, place: &Place, label: &str, message: String, help: impl Into<String>) {
        let (problem, help) = (Problem::at(place, label, message), help.into());
        self.problems.push(if help.is_empty() { problem } else { problem.help(help) });
    }

    fn node(&mut self, node: &Node, stated: &'static Json, path: &Path) {
        let schema = schema::resolved(self.root, stated);
        if let Some(alternatives) = schema.get("oneOf").and_then(Json::as_array) {
            return self.alternatives(node, alternatives, stated, path);
        }
        if let Some(words) = schema.get("enum").and_then(Json::as_array) {
            let words: Vec<&str> = words.iter().filter_map(Json::as_str).collect();
            return self.word(node, &words, path);
        }
        match (schema.get("type").and_then(Json::as_str), &node.value) {
            (Some("object"), Value::Table(table)) => self.table(node, table, schema, path),
            (Some("array"), Value::Array(items)) => self.list(node, items, schema, path),
            (Some("string"), Value::Text(text)) => self.text(node, text, schema, path),
            (Some("boolean"), Value::Bool(_)) => {}
            (Some("integer"), Value::Integer(integer)) => {
                let largest =
                    if schema.get("format") == Some(&Json::from("uint64")) { u64::MAX.into() } else { 1_000_000_000 };
                if *integer > largest {
                    let message = format!("{} must be at most {largest}", quoted(&path.0));
                    self.refuse(&node.place, "too large", message, described(stated, schema));
                } else {
                    self.range(node, *integer as f64, schema, stated, path);
                }
            }
            (Some("number"), Value::Integer(integer)) => self.number(node, *integer as f64, schema, stated, path),
            (Some("number"), Value::Float(float)) => self.number(node, *float, schema, stated, path),
            (wanted, _) => self.wrong_type(node, wanted, stated, path),
        }
    }

    fn wrong_type(&mut self, node: &Node, wanted: Option<&str>, stated: &'static Json, path: &Path) {
        let wanted = match wanted {
            Some("object") => "a table",
            Some("array") => "a list",
            Some("string") => "a text",
            Some("boolean") => "true or false",
            Some("integer") => "a whole number",
            _ => "a number",
        };
        let got = match &node.value {
            Value::Text(text) => format!("the text {}", quoted(text)),
            Value::Bool(truth) => format!("`{truth}`"),
            Value::Float(float) => format!("{float}"),
            other => kind_of(other).to_owned(),
        };
        let message = format!("{} must be {wanted}, not {got}", quoted(&path.0));
        let help = described(stated, schema::resolved(self.root, stated));
        self.refuse(&node.place, &format!("not {wanted}"), message, help);
    }

    fn table(&mut self, node: &Node, table: &Table, schema: &'static Json, path: &Path) {
        let properties = schema.get("properties").and_then(Json::as_object);
        let property = |key: &str| properties.and_then(|properties| properties.get(key));
        for (key, entry) in table {
            if let Some(schema) = property(key) {
                self.node(&entry.node, schema, &path.join(key));
                continue;
            }
            let known: Vec<&str> = properties.into_iter().flat_map(|all| all.keys()).map(String::as_str).collect();
            let within = if path.0.is_empty() { String::new() } else { format!(" in {}", quoted(&path.0)) };
            let message = format!("unknown key {}{within}", quoted(key));
            let in_another_unit = known.iter().find(|known| differ_by_unit(key, known)).and_then(|known| {
                let stated = property(known)?;
                let said = described(stated, schema::resolved(self.root, stated));
                Some(format!("it is called `{known}` here, after its unit: {said}"))
            });
            let help = in_another_unit.unwrap_or_else(|| suggestion(key, "the keys here are", &known));
            self.refuse(&entry.key, "unknown key", message, help);
        }
        let required = schema.get("required").and_then(Json::as_array).into_iter().flatten();
        for key in required.filter_map(Json::as_str).filter(|key| !table.contains_key(*key)) {
            let stated = property(key).unwrap_or(&NULL);
            let message = format!("{} is missing", quoted(&path.join(key).0));
            let help = described(stated, schema::resolved(self.root, stated));
            self.refuse(&node.place, &format!("has no `{key}`"), message, help);
        }
    }

    fn list(&mut self, node: &Node, items: &[Node], schema: &'static Json, path: &Path) {
        let bound = |keyword: &str| schema.get(keyword).and_then(Json::as_u64);
        let count = items.len() as u64;
        if let Some(least) = bound("minItems").filter(|least| count < *least) {
            let message = format!("{} must have at least {least} {}", quoted(&path.0), entries(least));
            self.refuse(&node.place, "too short", message, "");
        }
        if let Some(most) = bound("maxItems").filter(|most| count > *most) {
            let message = format!("{} must have at most {most} {}, not {count}", quoted(&path.0), entries(most));
            self.refuse(&node.place, "too long", message, "");
        }
        for (index, item) in items.iter().enumerate() {
            let step = item.label().map_or_else(|| index.to_string(), str::to_owned);
            self.node(item, schema.get("items").unwrap_or(&NULL), &path.join(&step));
        }
    }

    fn text(&mut self, node: &Node, text: &str, schema: &'static Json, path: &Path) {
        if schema.get("minLength").is_some() && text.trim().is_empty() {
            let message = format!("{} must not be empty", quoted(&path.0));
            self.refuse(&node.place, "empty", message, "");
        }
        if schema.get("pattern").is_some() && !is_name(text) {
            let message = format!("{} is not a name", quoted(text));
            let help = "a name has 1 to 64 lower-case letters, digits, `_` or `-`";
            self.refuse(&node.place, "not a name", message, help);
        }
    }

    fn number(&mut self, node: &Node, number: f64, schema: &'static Json, stated: &'static Json, path: &Path) {
        if number.is_finite() && number.abs() <= LARGEST {
            return self.range(node, number, schema, stated, path);
        }
        let (label, wanted) =
            if number.is_finite() { ("too large", "between -1e9 and 1e9") } else { ("not finite", "a finite number") };
        let message = format!("{} must be {wanted}", quoted(&path.0));
        self.refuse(&node.place, label, message, described(stated, schema));
    }

    fn range(&mut self, node: &Node, number: f64, schema: &'static Json, stated: &'static Json, path: &Path) {
        let bound = |keyword: &str| schema.get(keyword).or_else(|| stated.get(keyword)).and_then(Json::as_f64);
        let broken = [
            bound("minimum").filter(|least| number < *least).map(|least| format!("at least {least}")),
            bound("maximum").filter(|most| number > *most).map(|most| format!("at most {most}")),
            bound("exclusiveMinimum").filter(|low| number <= *low).map(|low| format!("above {low}")),
            bound("exclusiveMaximum").filter(|high| number >= *high).map(|high| format!("below {high}")),
        ];
        for wanted in broken.into_iter().flatten() {
            let message = format!("{} must be {wanted}, not {number}", quoted(&path.0));
            self.refuse(&node.place, &format!("must be {wanted}"), message, described(stated, schema));
        }
    }

    /// A word of several, or a table whose `kind` says which alternative it is.
    fn alternatives(&mut self, node: &Node, alternatives: &'static [Json], stated: &'static Json, path: &Path) {
        let words: Vec<&str> = alternatives.iter().filter_map(|word| word.get("const")?.as_str()).collect();
        if !words.is_empty() {
            return self.word(node, &words, path);
        }
        let kinds: Vec<&str> = alternatives.iter().filter_map(schema::kind_of).collect();
        if let Some(word) = node.text().filter(|word| kinds.contains(word)) {
            let message = format!("{} must be a table whose `kind` is {}", quoted(&path.0), quoted(word));
            return self.refuse(&node.place, "not a table", message, format!("write `{{ kind = \"{word}\" }}`"));
        }
        let Value::Table(table) = &node.value else {
            return self.wrong_type(node, Some("object"), stated, path);
        };
        let Some(entry) = table.get("kind") else {
            let message = format!("{} is missing", quoted(&path.join("kind").0));
            return self.refuse(&node.place, "has no `kind`", message, format!("choose from: {}", listed(&kinds)));
        };
        match alternatives
            .iter()
            .find(|one| schema::kind_of(one).is_some() && schema::kind_of(one) == entry.node.text())
        {
            Some(schema) => self.table(node, table, schema, path),
            None => self.word(&entry.node, &kinds, &path.join("kind")),
        }
    }

    fn word(&mut self, node: &Node, words: &[&str], path: &Path) {
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

/// Whether two keys are the same quantity in different units, of which the first may be left out: `speed` and `speed_kmh`
/// are `speed_mps`.
fn differ_by_unit(key: &str, known: &str) -> bool {
    let quantity = |word: &str| word.split_once('_').map(|(quantity, unit)| (quantity.to_owned(), unit.to_owned()));
    let Some((quantity_known, unit)) = quantity(known) else { return false };
    let is_unit = UNITS.contains(&unit.as_str());
    is_unit && quantity(key).map_or(key == quantity_known, |(quantity, _)| quantity == quantity_known)
}

/// The description of a key: that beside the reference, or that of what it refers to.
fn described(stated: &Json, schema: &Json) -> String {
    let description = [stated, schema].iter().find_map(|schema| schema.get("description")?.as_str());
    description.unwrap_or_default().to_owned()
}

fn entries(count: u64) -> &'static str {
    if count == 1 { "entry" } else { "entries" }
}

/// Whether a text is what [`schema::NAME_PATTERN`] says.
fn is_name(text: &str) -> bool {
    let fits = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_' || byte == b'-';
    (1..=64).contains(&text.len()) && text.bytes().all(fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keywords that the check obeys, and those that only inform.
    const UNDERSTOOD: &str = "$ref $defs oneOf const enum type properties required additionalProperties items minItems \
        maxItems minLength pattern minimum maximum exclusiveMinimum exclusiveMaximum format default description title \
        examples $schema";

    #[test]
    fn every_keyword_of_the_schema_is_understood() {
        fn walk(schema: &Json) {
            let Json::Object(object) = schema else { return };
            for (keyword, value) in object {
                assert!(UNDERSTOOD.split_whitespace().any(|word| word == keyword), "unknown keyword {keyword}");
                match (keyword.as_str(), value) {
                    ("properties" | "$defs", Json::Object(below)) => below.values().for_each(walk),
                    ("oneOf", Json::Array(alternatives)) => alternatives.iter().for_each(walk),
                    ("items", below) => walk(below),
                    ("additionalProperties", value) => assert_eq!(value, false),
                    ("pattern", value) => assert_eq!(value, schema::NAME_PATTERN),
                    ("type", value) => assert!(value.is_string(), "{value}"),
                    _ => {}
                }
            }
            let closed = object.get("additionalProperties").is_some();
            assert_eq!(object.contains_key("properties"), closed, "a table that takes unknown keys: {schema}");
        }
        walk(schema::complete());
    }
}
