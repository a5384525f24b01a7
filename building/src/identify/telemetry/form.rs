//! Checks keys, types, words and bounds of a mapping against the JSON Schema of its type.
//!
//! The schema is generated from the type, so that each key is described on its field and nowhere else.

use interplay_common::bounds::Bound;
use interplay_common::json_schema::{definition_of, kind_of, words_of};
use interplay_common::setting::SettingKey;
use interplay_common::spelling::suggestion;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::Value as Json;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::Problem;
use super::units::ValueShape;

/// Checks a document against the schema of `T`.
///
/// Returns the problems in the order of the text, each with the byte offset at which it stands. A missing key is not reported if its
/// table has an unknown key, which is probably the missing one misspelt.
pub(super) fn check<T: JsonSchema>(document: &Spanned<DeTable<'_>>) -> Vec<(usize, Problem)> {
    let root = SchemaGenerator::default().into_root_schema_for::<T>().to_value();
    let mut checker = Checker::default();
    checker.table(document.span().start, document.get_ref(), Schema::new(&root, &root), &SettingKey::default());
    let Checker { mut problems, missing_keys, tables_with_unknown_keys } = checker;
    let is_reported = |table: &SettingKey| !tables_with_unknown_keys.contains(table);
    problems.extend(
        missing_keys.into_iter().filter(|(table, ..)| is_reported(table)).map(|(_, offset, problem)| (offset, problem)),
    );
    problems.sort_by_key(|(offset, _)| *offset);
    problems
}

/// The byte at which the value of a key such as `zone.0.heat.1.factor` is written; `None` if the document does not state it.
pub(super) fn place_of(document: &DeTable<'_>, key: &str) -> Option<usize> {
    let (first, rest) = key.split_once('.').map_or((key, None), |(first, rest)| (first, Some(rest)));
    let mut value = document.get(first)?;
    for step in rest.into_iter().flat_map(|rest| rest.split('.')) {
        value = match value.get_ref() {
            DeValue::Table(table) => table.get(step)?,
            DeValue::Array(items) => items.get(step.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(value.span().start)
}

/// The remedy of a mapping that is not understood at all.
pub(super) const SEE_EXAMPLES: &str =
    "`interplay identify --help` shows a mapping, docs/guide/identification.md every key";

/// A part of the schema, without references and without the alternative of being absent.
#[derive(Clone, Copy)]
struct Schema<'a> {
    root: &'a Json,
    stated: &'a Json,
}

impl<'a> Schema<'a> {
    fn new(root: &'a Json, stated: &'a Json) -> Self {
        let present = stated["anyOf"].as_array().and_then(|all| all.iter().find(|one| one["type"] != "null"));
        let stated = present.unwrap_or(stated);
        Self { root, stated: definition_of(root, stated) }
    }

    fn type_name(self) -> Option<&'a str> {
        let present = |types: &'a Vec<Json>| types.iter().filter_map(Json::as_str).find(|name| *name != "null");
        self.stated["type"].as_str().or_else(|| self.stated["type"].as_array().and_then(present))
    }

    fn number(self, keyword: &str) -> Option<usize> {
        usize::try_from(self.stated[keyword].as_u64()?).ok()
    }

    fn keys(self) -> Vec<String> {
        self.stated["properties"].as_object().into_iter().flatten().map(|(key, _)| key.clone()).collect()
    }

    fn property(self, key: &str) -> Option<Self> {
        self.stated["properties"].get(key).map(|stated| Self::new(self.root, stated))
    }

    fn required(self) -> impl Iterator<Item = &'a str> {
        self.stated["required"].as_array().into_iter().flatten().filter_map(Json::as_str)
    }

    fn alternatives(self) -> impl Iterator<Item = Self> {
        let all = self.stated["oneOf"].as_array().into_iter().flatten();
        all.map(move |stated| Self { stated, ..self })
    }

    /// The words from which a text is chosen.
    fn words(self) -> Vec<String> {
        words_of(self.stated).map(str::to_owned).collect()
    }

    /// The `kind` of a table that has several, where this is one of them.
    fn kind(self) -> Option<&'a str> {
        kind_of(self.stated)
    }

    fn kinds(self) -> Vec<String> {
        self.alternatives().filter_map(Self::kind).map(str::to_owned).collect()
    }

    /// What a value must be.
    fn shape(self) -> ValueShape {
        let (words, kinds) = (self.words(), self.kinds());
        match self.type_name() {
            _ if !words.is_empty() => ValueShape::OneOf(words),
            _ if !kinds.is_empty() => ValueShape::TableOfAKind(kinds),
            Some("object") => ValueShape::Table(self.keys()),
            Some("array") => {
                let min_entries = self.number("minItems").unwrap_or_default();
                ValueShape::List { min_entries, max_entries: self.number("maxItems") }
            }
            Some("string") if self.number("maxLength") == Some(1) => {
                ValueShape::Character { ascii: self.stated["x-ascii"] == true }
            }
            Some("string") => ValueShape::Text,
            Some("boolean") => ValueShape::Truth,
            Some("integer") => ValueShape::WholeNumber,
            _ => ValueShape::Number,
        }
    }
}

/// Collects the problems of a document.
#[derive(Default)]
struct Checker {
    problems: Vec<(usize, Problem)>,
    /// The table that lacks the key, the offset of the table, and the problem.
    missing_keys: Vec<(SettingKey, usize, Problem)>,
    tables_with_unknown_keys: Vec<SettingKey>,
}

impl Checker {
    fn value(&mut self, value: &Spanned<DeValue<'_>>, schema: Schema<'_>, key: &SettingKey) {
        let offset = value.span().start;
        match (schema.shape(), value.get_ref()) {
            (ValueShape::OneOf(words), DeValue::String(word)) => self.word(offset, word, words, key),
            (ValueShape::TableOfAKind(kinds), DeValue::Table(table)) => {
                self.table_of_a_kind(offset, table, schema, kinds, key);
            }
            (ValueShape::Table(_), DeValue::Table(table)) => self.table(offset, table, schema, key),
            (ValueShape::List { min_entries, max_entries }, DeValue::Array(items))
                if (min_entries..=max_entries.unwrap_or(usize::MAX)).contains(&items.len()) =>
            {
                let schema = Schema::new(schema.root, &schema.stated["items"]);
                for (index, item) in items.iter().enumerate() {
                    self.value(item, schema, &entry_key(key, index, item.get_ref()));
                }
            }
            (ValueShape::Character { ascii }, DeValue::String(text))
                if text.chars().count() == 1 && (text.is_ascii() || !ascii) => {}
            (ValueShape::Text, DeValue::String(_)) | (ValueShape::Truth, DeValue::Boolean(_)) => {}
            (ValueShape::WholeNumber | ValueShape::Number, DeValue::Integer(integer)) => {
                let number =
                    i128::from_str_radix(integer.as_str(), integer.radix()).map_or(f64::INFINITY, |whole| whole as f64);
                self.number(offset, number, schema, key);
            }
            (ValueShape::Number, DeValue::Float(float)) => {
                self.number(offset, float.as_str().parse().unwrap_or(f64::NAN), schema, key);
            }
            (wanted, other) => {
                self.problems.push((offset, wrong_type(key, &wanted, other)));
            }
        }
    }

    fn table(&mut self, offset: usize, table: &DeTable<'_>, schema: Schema<'_>, key: &SettingKey) {
        for (name, value) in table {
            match schema.property(name.get_ref()) {
                Some(property) => self.value(value, property, &key.key(name.get_ref())),
                None => {
                    let unknown = name.get_ref();
                    let within = if *key == SettingKey::default() { String::new() } else { format!(" in `{key}`") };
                    let remedy = suggestion(unknown, "the keys here are", &schema.keys());
                    let problem = Problem::new(format!("unknown key `{unknown}`{within}"), remedy);
                    self.problems.push((name.span().start, problem));
                    self.tables_with_unknown_keys.push(key.clone());
                }
            }
        }
        for name in schema.required().filter(|name| !table.contains_key(*name)) {
            let wanted = schema.property(name).map_or(ValueShape::Text, Schema::shape);
            self.missing(offset, key, name, &wanted);
        }
    }

    fn missing(&mut self, offset: usize, table: &SettingKey, name: &str, wanted: &ValueShape) {
        let problem = Problem::new(format!("`{}` is missing", table.key(name)), format!("it must be {wanted}"));
        self.missing_keys.push((table.clone(), offset, problem));
    }

    /// A table whose `kind` says which keys it has.
    fn table_of_a_kind(
        &mut self,
        offset: usize,
        table: &DeTable<'_>,
        schema: Schema<'_>,
        kinds: Vec<String>,
        key: &SettingKey,
    ) {
        let Some(kind) = table.get("kind") else {
            let wanted = ValueShape::OneOf(kinds);
            return self.missing(offset, key, "kind", &wanted);
        };
        let fitting =
            kind.get_ref().as_str().and_then(|word| schema.alternatives().find(|one| one.kind() == Some(word)));
        match (fitting, kind.get_ref()) {
            (Some(schema), _) => self.table(offset, table, schema, key),
            (None, DeValue::String(word)) => self.word(kind.span().start, word, kinds, &key.key("kind")),
            (None, other) => {
                let wanted = ValueShape::OneOf(kinds);
                self.problems.push((kind.span().start, wrong_type(&key.key("kind"), &wanted, other)));
            }
        }
    }

    fn word(&mut self, offset: usize, word: &str, known: Vec<String>, key: &SettingKey) {
        if !known.iter().any(|known| known == word) {
            self.problems.push((offset, unknown_word(key, word, &known)));
        }
    }

    fn number(&mut self, offset: usize, value: f64, schema: Schema<'_>, key: &SettingKey) {
        // For a finite number beyond its own bounds, the error states these bounds and not the limits of all numbers.
        let mut bounds = [Bound::Finite].into_iter().chain(Bound::read(schema.stated)).chain(Bound::of_every_setting());
        if let Some(bound) = bounds.find(|bound| !bound.admits(value)) {
            self.problems.push((offset, Problem::out_of_bounds(key, value, bound)));
        }
    }
}

/// A text is none of the words from which it is chosen.
pub(super) fn unknown_word(key: &SettingKey, word: &str, known: &[String]) -> Problem {
    Problem::new(format!("`{key}` cannot be `{word}`"), suggestion(word, "choose from", known))
}

/// A value has another type than its key needs.
fn wrong_type(key: &SettingKey, wanted: &ValueShape, value: &DeValue<'_>) -> Problem {
    Problem::new(format!("`{key}` must be {wanted}, not {}", written(value, wanted)), SEE_EXAMPLES)
}

/// The key of an entry of a list: a table is called by its `name`, anything else by its number.
fn entry_key(list: &SettingKey, index: usize, entry: &DeValue<'_>) -> SettingKey {
    let name = entry.as_table().and_then(|table| table.get("name")?.get_ref().as_str());
    name.map_or_else(|| list.entry(index), |name| list.key(name))
}

/// A value of the wrong type, in the words of an error.
fn written(value: &DeValue<'_>, wanted: &ValueShape) -> String {
    match value {
        DeValue::String(text) => format!("the text `{text}`"),
        DeValue::Integer(integer) => format!("the number {}", integer.as_str()),
        DeValue::Float(float) => format!("the number {}", float.as_str()),
        DeValue::Boolean(truth) => format!("`{truth}`"),
        DeValue::Datetime(_) => "a date".into(),
        DeValue::Array(items) if matches!(wanted, ValueShape::List { .. }) => format!("of {}", items.len()),
        DeValue::Array(_) => "a list".into(),
        DeValue::Table(_) => "a table".into(),
    }
}
