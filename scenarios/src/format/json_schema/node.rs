//! A part of the schema, with its keywords as Rust types.

use interplay_common::bounds::Bound;
use interplay_common::json_schema::{definition_of, kind_of, words_of};
use serde_json::{Map, Value as Json, json};

/// The agents that a key needs to mean anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Concern {
    /// `x-concerns = "vehicles"`.
    Vehicles,
    /// `x-concerns = "building"`.
    Building,
}

/// The schema of a value: the keywords beside a reference, and those of the definition that it refers to.
#[derive(Clone, Copy)]
pub(crate) struct SchemaNode<'s> {
    root: &'s Json,
    stated: &'s Json,
    /// The list of which this is an entry.
    list: Option<&'s Json>,
}

impl<'s> SchemaNode<'s> {
    /// The root of the schema.
    pub fn new(root: &'s Json) -> SchemaNode<'s> {
        SchemaNode { root, stated: root, list: None }
    }

    /// The root of the schema that contains this part.
    pub fn whole(self) -> SchemaNode<'s> {
        SchemaNode::new(self.root)
    }

    fn at(self, stated: &'s Json) -> SchemaNode<'s> {
        SchemaNode { stated, list: None, ..self }
    }

    /// The name of the definition that this part refers to.
    pub fn definition_name(self) -> Option<&'s str> {
        self.stated.get("$ref")?.as_str()?.strip_prefix("#/$defs/")
    }

    fn definition(self) -> &'s Json {
        definition_of(self.root, self.stated)
    }

    /// The value of a keyword of this part, or else of its definition.
    pub fn keyword(self, keyword: &str) -> Option<&'s Json> {
        self.stated.get(keyword).or_else(|| self.definition().get(keyword))
    }

    fn text(self, keyword: &str) -> Option<&'s str> {
        self.keyword(keyword)?.as_str()
    }

    /// The type: `object`, `array`, `string`, `boolean`, `integer` or `number`.
    pub fn type_name(self) -> Option<&'s str> {
        self.text("type")
    }

    /// The description of the key, or of the list whose entry this is; empty if there is none.
    pub fn description(self) -> &'s str {
        let of_list = || self.list?.get("description")?.as_str();
        self.text("description").or_else(of_list).unwrap_or_default()
    }

    /// The bounds of a number.
    pub fn bounds(self) -> impl Iterator<Item = Bound> {
        Bound::read(self.definition()).chain(Bound::read(self.stated).filter(move |_| self.definition_name().is_some()))
    }

    pub fn default(self) -> Option<&'s Json> {
        self.stated.get("default")
    }

    /// The bounds of a number that a word may replace.
    pub fn number_beside_words(self) -> Option<SchemaNode<'s>> {
        let is_number = |one: &&Json| one.get("type").is_some_and(|name| name == "number");
        self.alternatives().find(is_number).map(|one| self.at(one))
    }

    /// The default, or else the first example.
    pub fn default_or_example(self) -> Option<&'s Json> {
        self.stated.get("default").or_else(|| self.stated.get("examples")?.get(0))
    }

    /// Whether a value equals the default; `1` equals `1.0`.
    pub fn is_default(self, value: &Json) -> bool {
        self.stated.get("default").is_some_and(|default| same(default, value))
    }

    /// Whether the key is deprecated: accepted, but no longer written.
    pub fn is_deprecated(self) -> bool {
        self.keyword("deprecated").is_some()
    }

    /// The part of a scenario, vehicles or building, without which the key has no meaning.
    pub fn concerns(self) -> Option<Concern> {
        match self.stated.get("x-concerns")?.as_str()? {
            "vehicles" => Some(Concern::Vehicles),
            _ => Some(Concern::Building),
        }
    }

    /// The key by which entries of a list are merged with those of the same name; other lists are replaced.
    pub fn merge_key(self) -> Option<&'s str> {
        self.stated.get("x-merge-by")?.as_str()
    }

    /// Whether the keys of this table are paths of settings, as in `--set`.
    pub fn holds_paths(self) -> bool {
        self.stated.get("x-paths").is_some()
    }

    /// The mechanism of a planner that this setting can switch off: its name, and the value that does so.
    pub fn mechanism(self) -> Option<(&'s str, &'s Json)> {
        let stated = self.stated.get("x-mechanism")?.as_object()?;
        stated.iter().next().map(|(name, off)| (name.as_str(), off))
    }

    /// Pairs of keys of this table that exclude each other. Each pair is stated on its first key.
    pub fn exclusions(self) -> impl Iterator<Item = (&'s str, &'s str)> {
        self.properties().flat_map(|(key, property)| {
            let others = property.stated.get("x-excludes").and_then(Json::as_array).into_iter().flatten();
            others.filter_map(Json::as_str).map(|other| (key.as_str(), other))
        })
    }

    /// The words that a text may be.
    pub fn words(self) -> Vec<&'s str> {
        words_of(self.definition()).collect()
    }

    /// The kinds of a table with alternatives.
    pub fn kinds(self) -> Vec<&'s str> {
        self.alternatives().filter_map(kind_of).collect()
    }

    fn alternatives(self) -> impl Iterator<Item = &'s Json> {
        self.definition().get("oneOf").and_then(Json::as_array).into_iter().flatten()
    }

    /// The table of one kind, if that kind exists.
    pub fn of_kind(self, kind: &str) -> Option<SchemaNode<'s>> {
        self.alternatives().find(|one| kind_of(one) == Some(kind)).map(|one| self.at(one))
    }

    /// The forms that a value may have, if there are several: a number or a text, for example.
    pub fn forms(self) -> impl Iterator<Item = SchemaNode<'s>> {
        let forms = self.definition().get("anyOf").and_then(Json::as_array);
        forms.into_iter().flatten().map(move |form| self.at(form))
    }

    /// The keys of a table, in the order of the fields; empty if this is not a table, or a table of several kinds.
    pub fn properties(self) -> impl Iterator<Item = (&'s String, SchemaNode<'s>)> {
        let properties = self.definition().get("properties").and_then(Json::as_object);
        properties.into_iter().flatten().map(move |(key, stated)| (key, self.at(stated)))
    }

    /// A key of a table; if the kind of the table is not known, the key of the first kind that has it.
    pub fn property(self, key: &str) -> Option<SchemaNode<'s>> {
        let of = |schema: &'s Json| schema.get("properties")?.get(key);
        of(self.definition()).or_else(|| self.alternatives().find_map(of)).map(|stated| self.at(stated))
    }

    /// The keys that a table must have.
    pub fn required(self) -> impl Iterator<Item = &'s str> {
        let required = self.definition().get("required").and_then(Json::as_array);
        required.into_iter().flatten().filter_map(Json::as_str)
    }

    /// The schema of the entries of a list.
    pub fn entries(self) -> Option<SchemaNode<'s>> {
        self.keyword("items").map(|items| SchemaNode { list: Some(self.stated), ..self.at(items) })
    }

    /// The schema of the entries of a list of tables.
    pub fn table_entries(self) -> Option<SchemaNode<'s>> {
        self.entries().filter(|entry| entry.properties().next().is_some())
    }
}

/// Whether two values are the same, whole numbers and others alike.
fn same(one: &Json, other: &Json) -> bool {
    match (one, other) {
        (Json::Number(one), Json::Number(other)) => one.as_f64() == other.as_f64(),
        (Json::Array(one), Json::Array(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(one, other)| same(one, other))
        }
        (Json::Object(one), Json::Object(other)) => {
            let in_other = |(key, value): (&String, &Json)| other.get(key).is_some_and(|other| same(value, other));
            one.len() == other.len() && one.iter().all(in_other)
        }
        _ => one == other,
    }
}

/// The keyword of a twin: the key whose value it gives.
pub(crate) const TWIN_OF: &str = "x-radians";

/// The key in degrees beside one in radians; `None` for other keys.
pub(crate) fn in_degrees(key: &str) -> Option<String> {
    let quantity = key.strip_suffix("_rad").filter(|quantity| !quantity.ends_with("_per"))?;
    Some(format!("{quantity}_deg"))
}

/// Adds a twin in degrees beside every property in radians, which is then deprecated.
pub(super) fn add_twins(properties: &mut Map<String, Json>) {
    let keys: Vec<String> = properties.keys().cloned().collect();
    for key in keys {
        let Some(twin) = in_degrees(&key) else { continue };
        let Some(property) = properties.get_mut(&key) else { continue };
        property["deprecated"] = json!(true);
        let mut described = property.clone();
        if !properties.contains_key(&twin) {
            turn(&mut described, &key);
            properties.insert(twin, described);
        }
    }
}

/// Turns the schema of a key in radians into that of its twin.
fn turn(property: &mut Json, key: &str) {
    let Some(keywords) = property.as_object_mut() else { return };
    keywords.remove("deprecated");
    for bound in ["minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"] {
        if let Some(value) = keywords.get_mut(bound) {
            *value = degrees(value);
        }
    }
    let shown = keywords.remove("default").or_else(|| keywords.get("examples")?.get(0).cloned());
    keywords.insert("examples".to_owned(), json!([shown.as_ref().map(degrees)]));
    keywords.insert("x-unit".to_owned(), json!("deg"));
    keywords.insert("x-excludes".to_owned(), json!([key]));
    keywords.insert(TWIN_OF.to_owned(), json!(key));
    if let Some(Json::String(description)) = keywords.get_mut("description") {
        *description = description.replace("[rad]", "[deg]");
    }
}

fn degrees(radians: &Json) -> Json {
    radians.as_f64().map_or_else(|| radians.clone(), |radians| json!(rounded(radians.to_degrees())))
}

/// Converts a number of an angle in radians to degrees.
pub(crate) fn rounded(angle_deg: f64) -> f64 {
    (1e6 * angle_deg).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_keys_of_angles_have_twins_in_degrees() {
        assert_eq!(in_degrees("steering_max_rad").as_deref(), Some("steering_max_deg"));
        assert_eq!((in_degrees("front_stiffness_per_rad"), in_degrees("rate_radps")), (None, None));
    }
}
