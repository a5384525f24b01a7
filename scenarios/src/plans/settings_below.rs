//! Finds settings below a path, and how later settings remove them.

use std::collections::BTreeMap;

use crate::format::json_schema::SchemaNode;
use crate::format::read::overrides::schema_at;
use crate::format::read::tree::{TomlNode, TomlValue};

/// The paths of the settings that a value replaces when it is merged into a scenario at a path; of a `kind`, with its word.
///
/// Tables, and lists whose entries have names, are merged with existing ones: an empty one replaces nothing.
pub(super) fn settings_below(path: &str, value: &TomlNode, schema: SchemaNode) -> BTreeMap<String, Option<String>> {
    let mut found = BTreeMap::new();
    collect(path, value, schema, &mut found);
    found
}

fn collect(path: &str, value: &TomlNode, schema: SchemaNode, found: &mut BTreeMap<String, Option<String>>) {
    match &value.value {
        TomlValue::Table(table) => {
            table.iter().for_each(|(key, entry)| collect(&format!("{path}.{key}"), &entry.node, schema, found));
        }
        TomlValue::Array(_)
            if schema_at(schema, path.split('.')).is_some_and(|schema| schema.merge_key().is_some()) => {}
        _ => {
            let kind = value.text().filter(|_| path.ends_with(".kind")).map(str::to_owned);
            found.insert(path.to_owned(), kind);
        }
    }
}

/// Whether a path is another or continues below it.
pub(super) fn is_within(above: &str, path: &str) -> bool {
    path.strip_prefix(above).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The ways to remove the setting at a path.
pub(super) struct Rivals<'s> {
    /// The setting itself and all tables around it.
    above: Vec<String>,
    /// Keys that exclude the key of a table on the way to the setting: the key, and the excluding ones.
    excluding: Vec<(String, Vec<String>)>,
    /// The `kind` of a table on the way, and the kinds that do not know the setting.
    kinds: Vec<(String, Vec<&'s str>)>,
}

/// How a setting is removed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Removal {
    /// By a value at this path.
    Replaced(String),
    /// By a key at this path, which excludes it.
    Excluded(String),
    /// By a `kind` at this path, with this word, which does not know it.
    Unknown(String, String),
}

impl<'s> Rivals<'s> {
    /// Finds the ways to remove the setting at a path without `*`.
    pub fn find(path: &str, schema: SchemaNode<'s>) -> Rivals<'s> {
        let words: Vec<&str> = path.split('.').collect();
        let up_to = |count: usize| words[..count].join(".");
        let mut rivals =
            Rivals { above: (1..=words.len()).map(up_to).collect(), excluding: Vec::new(), kinds: Vec::new() };
        for (count, word) in words.iter().enumerate().skip(1) {
            let Some(table) = schema_at(schema, words[..count].iter().copied()) else { continue };
            let others: Vec<String> = excluded(table, word).map(|other| format!("{}.{other}", up_to(count))).collect();
            if !others.is_empty() {
                rivals.excluding.push((up_to(count + 1), others));
            }
            let knows = |kind: &&str| table.of_kind(kind).is_some_and(|table| table.property(word).is_some());
            let others: Vec<&str> = table.kinds().into_iter().filter(|kind| !knows(kind)).collect();
            if *word != "kind" && !others.is_empty() {
                rivals.kinds.push((format!("{}.kind", up_to(count)), others));
            }
        }
        rivals
    }

    /// How later settings remove this one; `None` if they do not.
    pub fn removal(&self, laid: &BTreeMap<String, Option<String>>) -> Option<Removal> {
        let states = |path: &str| {
            laid.contains_key(path)
                || laid.range(format!("{path}.")..).next().is_some_and(|(next, _)| is_within(path, next))
        };
        let replaced =
            self.above.iter().find(|path| laid.contains_key(*path)).map(|path| Removal::Replaced(path.clone()));
        let excluded = || {
            let gone = self.excluding.iter().filter(|(own, _)| !states(own));
            let other = gone.flat_map(|(_, others)| others).find(|other| states(other))?;
            Some(Removal::Excluded(other.clone()))
        };
        let unknown = || {
            self.kinds.iter().find_map(|(path, kinds)| {
                let kind = laid.get(path)?.as_deref().filter(|kind| kinds.contains(kind))?;
                Some(Removal::Unknown(path.clone(), kind.to_owned()))
            })
        };
        replaced.or_else(excluded).or_else(unknown)
    }
}

/// The keys that may not stand beside a key of a table, whatever its kind.
fn excluded<'s>(table: SchemaNode<'s>, key: &str) -> impl Iterator<Item = &'s str> {
    let tables = table.kinds().into_iter().filter_map(move |kind| table.of_kind(kind)).chain([table]);
    let pairs = tables.flat_map(|table| table.exclusions().collect::<Vec<_>>());
    let of_key = pairs.filter_map(move |(one, other)| match key {
        _ if key == one => Some(other),
        _ if key == other => Some(one),
        _ => None,
    });
    of_key.collect::<Vec<_>>().into_iter()
}
