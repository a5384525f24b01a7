//! The reference of all keys, as a page of Markdown made from the schema.
//!
//! A section is a table of the scenario file, or one kind of a table that has several. Each definition of the schema is
//! described where it first appears; other places link there.

use std::collections::BTreeMap;

use interplay_common::bounds::Bound;
use serde_json::Value as Json;

use crate::format::json_schema::{SchemaNode, in_degrees};
use crate::format::registry::Registry;
use crate::text::readable::toml;
use crate::write::commented::inline;

/// Defaults and examples longer than this are not shown: the section of the table has them key by key \[characters\].
const MAX_SHOWN: usize = 60;

const HEAD: &str = "# Every key\n\n\
    What a scenario file may state. This page is made of the schema that scenarios are checked against; `interplay schema` prints\n\
    the schema for editors, and `interplay new` writes the same words beside each key of a file.\n\n\
    - *Default*: the value of a key that is left out. **Required** keys have none. Defaults are those of 1/10 scale cars; vehicles of\n  \
    another [size](../guide/authoring.md#full-size) get scaled ones.\n\
    - *Unit* 1: dimensionless. Whole numbers are counts and have none.\n\
    - Where a table has a `kind`, that key chooses which of its sections applies.\n\
    - Every key exists since version 0.1.0, the first, but for the kind `external` of drivers (0.2.0), and those of version 0.3.0: `conduct`,\n  \
    `detail`, `detector`, `flow`, `gains`, `light`, `obstacle`, `planning_period_s`, `expect.metric`, `expect.rules_kept`,\n  \
    `limits.comfort`, `rules`, `enters_s`, `leaves_s`, `leaves_at_end`, `stops_at_end`, `when`, `users`, `zebra`, `window`, `demand_per_kw`,\n  \
    `emissions_kg_per_kwh`, `interval_s`, `budget.processor_s`, and the kinds `walker`, `recorded`, `inputs`, `economic-mpc`, `csv`\n  \
    and `boptest` with all that is in them. Later keys say it themselves.\n";

/// The reference page of all keys as Markdown.
pub fn key_reference() -> String {
    let mut pages = Sections::default();
    let schema = Registry::standard().complete();
    let extends = "| `extends` | text | | | | `\"lane-change/front-nice\"` | Another scenario, from which this one differs in what it \
                   states: [variants](../guide/authoring.md#variants). |\n";
    pages.add("Top level", schema, "The keys outside of any table.");
    let mut page = HEAD.to_owned() + "\n## All tables\n\n| table | what |\n|---|---|\n";
    for section in &pages.sections {
        let title = &section.title;
        page += &format!("| [{title}](#{}) | {} |\n", slug(title), cell(first_sentence(&section.about)));
    }
    for (index, section) in pages.sections.iter().enumerate() {
        page += &format!("\n## {}\n\n{}\n", section.title, section.about);
        if !section.rows.is_empty() {
            page += "\n| key | type | unit | bounds | default | example | what |\n|---|---|---|---|---|---|---|\n";
            page += if index == 0 { extends } else { "" };
            page += &section.rows;
        }
    }
    page
}

/// A table of the file, or one kind of it.
struct Section {
    title: String,
    about: String,
    rows: String,
}

/// The sections so far, and in which of them each definition is described.
#[derive(Default)]
struct Sections<'s> {
    sections: Vec<Section>,
    described: BTreeMap<&'s str, String>,
}

impl<'s> Sections<'s> {
    /// Describes a table, and then the tables below it.
    fn add(&mut self, title: &str, table: SchemaNode<'s>, about: &str) {
        let index = self.sections.len();
        self.sections.push(Section { title: title.to_owned(), about: about.to_owned(), rows: String::new() });
        let prefix = title.split(": ").next().filter(|_| index > 0).map_or(String::new(), |path| format!("{path}."));
        let required: Vec<&str> = table.required().collect();
        let mut rows = String::new();
        for (key, property) in table.properties().filter(|(key, _)| *key != "kind") {
            let link = self.link(&format!("{prefix}{key}"), property);
            rows += &row(key, property, required.contains(&key.as_str()), link.as_deref());
        }
        self.sections[index].rows = rows;
    }

    /// The title of the section that describes the table, or the entries of the list, at a path; described now if it is new.
    fn link(&mut self, path: &str, property: SchemaNode<'s>) -> Option<String> {
        let table = tables(property).find(|node| !node.kinds().is_empty() || node.properties().next().is_some())?;
        if let Some(title) = table.definition_name().and_then(|name| self.described.get(name)) {
            return Some(title.clone());
        }
        if let Some(name) = table.definition_name() {
            self.described.insert(name, path.to_owned());
        }
        let kinds = table.kinds();
        if kinds.is_empty() {
            self.add(path, table, property.description());
            return Some(path.to_owned());
        }
        let titles = kinds.iter().map(|kind| format!("[`{kind}`](#{})", slug(&format!("{path}: {kind}"))));
        let about = format!("{} Kinds: {}.", property.description(), titles.collect::<Vec<_>>().join(", "));
        self.sections.push(Section { title: path.to_owned(), about, rows: String::new() });
        for kind in kinds {
            if let Some(alternative) = table.of_kind(kind) {
                let about = format!("With `kind = \"{kind}\"`. {}", alternative.description());
                self.add(&format!("{path}: {kind}"), alternative, about.trim_end());
            }
        }
        Some(path.to_owned())
    }
}

/// What may be a table at a key: the value itself, one of its forms, or the entries of a list.
fn tables(property: SchemaNode) -> impl Iterator<Item = SchemaNode> {
    let own = [Some(property), property.entries()].into_iter().flatten();
    own.flat_map(|node| std::iter::once(node).chain(node.forms()))
}

/// The row of a key; `link` is the title of the section that describes its table.
fn row(key: &str, property: SchemaNode, required: bool, link: Option<&str>) -> String {
    let shown = |value: &Json| {
        if value.as_object().is_some_and(serde_json::Map::is_empty) {
            return None;
        }
        let text = if value.is_object() { inline(property, value) } else { toml(value) };
        Some(code(&text)).filter(|text| text.chars().count() <= MAX_SHOWN)
    };
    let default = property.default().and_then(shown).unwrap_or_default();
    let default = if required { "**required**".to_owned() } else { default };
    let example = property.keyword("examples").and_then(|all| all.get(0)).and_then(shown).unwrap_or_default();
    let unit = property.keyword("x-unit").and_then(Json::as_str).unwrap_or_default();
    let mut about = property.description().replace(&format!(" [{unit}]"), "");
    if let Some(twin) = in_degrees(key).filter(|_| property.is_deprecated()) {
        about = format!("Older form of `{twin}`. {about}");
    }
    if let Some(version) = property.keyword("x-since").and_then(Json::as_str) {
        about += &format!(" Since version {version}.");
    }
    let unit = if unit == "dimensionless" { "1" } else { unit };
    let cells = [type_of(property, link), unit.to_owned(), bounds(property), default, example, about];
    format!("| `{key}` | {} |\n", cells.map(|text| cell(&text)).join(" | "))
}

/// The type of a value in words, with a link to the section that describes its table.
fn type_of(property: SchemaNode, link: Option<&str>) -> String {
    let table = || link.map_or("table".to_owned(), |title| format!("[table](#{})", slug(title)));
    let forms: Vec<String> = property.forms().map(|form| type_of(form, link)).collect();
    let words: Vec<String> = property.words().iter().map(|word| code(&format!("\"{word}\""))).collect();
    if property.holds_paths() {
        "table of [paths](../guide/authoring.md#variants)".to_owned()
    } else if !property.kinds().is_empty() {
        table()
    } else if !forms.is_empty() {
        forms.join(" or ")
    } else if !words.is_empty() {
        words.join(", ") + if property.number_beside_words().is_some() { ", or a number" } else { "" }
    } else if let Some(entry) = property.entries() {
        format!("list: {}", type_of(entry, link))
    } else {
        match property.type_name() {
            Some("string") => "text".to_owned(),
            Some("boolean") => "true or false".to_owned(),
            Some("integer") => "whole number".to_owned(),
            Some("object") => table(),
            _ => "number".to_owned(),
        }
    }
}

/// The bounds of a number, of the numbers of a list, of a text, and of how many entries a list has.
fn bounds(property: SchemaNode) -> String {
    let numbers = property.number_beside_words().unwrap_or(property);
    let of_numbers = numbers.bounds().chain(property.entries().into_iter().flat_map(SchemaNode::bounds));
    let is_news = |bound: &Bound| *bound != Bound::AtLeast(0.0) || numbers.type_name() != Some("integer");
    let mut all: Vec<String> = of_numbers.filter(is_news).map(|bound| bound.to_string()).collect();
    let count = |keyword: &str| property.keyword(keyword).and_then(Json::as_u64);
    all.extend(count("minItems").map(|least| format!("{least} entries or more")));
    all.extend(count("maxItems").map(|most| format!("{most} entries or fewer")));
    all.extend(property.keyword("pattern").and_then(Json::as_str).map(code));
    all.dedup();
    all.join(", ")
}

/// The place of a heading in the page, as GitHub and mdBook name it.
fn slug(title: &str) -> String {
    let kept = title.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

/// The first sentence, without the one that names the kind; "eq. 6.12" ends none.
fn first_sentence(text: &str) -> &str {
    let text =
        text.split_once("`. ").filter(|(first, _)| first.starts_with("With `kind")).map_or(text, |(_, rest)| rest);
    let ends = |at: usize| text[at + 2..].starts_with(|next: char| next.is_uppercase());
    let end = text.match_indices(". ").map(|(at, _)| at).find(|at| ends(*at));
    end.map_or(text, |at| &text[..at]).trim_end_matches('.')
}

fn code(text: &str) -> String {
    format!("`{text}`")
}

/// A text that does not end its cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::HEAD;

    /// Each new version states which keys came with it.
    #[test]
    fn the_reference_marks_new_keys() {
        assert!(HEAD.contains(concat!("those of version ", env!("CARGO_PKG_VERSION"))), "{HEAD}");
    }
}
