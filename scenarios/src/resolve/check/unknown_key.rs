//! Suggestions for an unknown key.

use interplay_common::spelling::{nearest, suggestion};
use interplay_common::units::{quantity_of, unit_of};

use crate::format::json_schema::SchemaNode;

/// How many tables deep a misplaced key is searched for.
const SEARCHED_DEPTH: usize = 3;
/// The most places of it that an error lists.
const MOST_PLACES: usize = 3;

/// Endings of keys in unsupported units, the ending of the same quantity here, and the conversion of a value.
const CONVERSIONS: [(&str, &str, &str); 16] = [
    ("_per_w", "_per_kw", "multiply by 1000"),
    ("_per_mwh", "_per_kwh", "divide by 1000"),
    ("_kmh", "_mps", "divide km/h by 3.6"),
    ("_kph", "_mps", "divide km/h by 3.6"),
    ("_mph", "_mps", "multiply mph by 0.44704"),
    ("_km", "_m", "multiply km by 1000"),
    ("_cm", "_m", "divide cm by 100"),
    ("_mm", "_m", "divide mm by 1000"),
    ("_min", "_s", "multiply minutes by 60"),
    ("_ms", "_s", "divide ms by 1000"),
    ("_h", "_s", "multiply hours by 3600"),
    ("_deg", "_rad", "multiply degrees by 0.0174533"),
    ("_w", "_kw", "divide W by 1000"),
    ("_wh", "_kwh", "divide Wh by 1000"),
    ("_mwh", "_kwh", "multiply MWh by 1000"),
    ("_f", "_c", "subtract 32 from °F and divide by 1.8"),
];

/// The key of this table that was probably meant: another unit, or a slip.
pub(super) fn meant<'s>(key: &str, schema: SchemaNode<'s>) -> Option<&'s str> {
    let known = || schema.properties().map(|(known, _)| known.as_str());
    let mut longer = known().filter(|known| has_as_words(known, key));
    let longer = longer.next().filter(|_| longer.next().is_none());
    known().find(|known| differ_by_unit(key, known)).or(longer).or_else(|| nearest(key, known()))
}

/// Whether a longer key begins or ends with these words: `start_jitter` with `jitter`.
fn has_as_words(known: &str, words: &str) -> bool {
    let rest = known.strip_suffix(words).map(|before| before.ends_with('_'));
    rest.or_else(|| known.strip_prefix(words).map(|after| after.starts_with('_'))).unwrap_or(false)
}

/// The help for an unknown key of a table; `whole` is the schema of the file.
pub(super) fn help(key: &str, schema: SchemaNode) -> String {
    let renamed = schema.properties().find(|(known, _)| differ_by_unit(key, known));
    if let Some((known, property)) = renamed {
        let convert = conversion(key, known).map_or_else(String::new, |convert| format!(" ({convert})"));
        return format!("it is called `{known}` here, after its unit{convert}: {}", property.description());
    }
    let below = places_below(key, schema);
    if !below.is_empty() {
        return format!("it stands deeper: {}", below.join(", "));
    }
    let near = || {
        let near = meant(key, schema)?;
        let convert = conversion(key, near).map_or_else(String::new, |convert| format!("; {convert}"));
        Some(format!("did you mean `{near}`?{convert}"))
    };
    near().unwrap_or_else(|| {
        let known: Vec<&str> = schema.properties().map(|(key, _)| key.as_str()).collect();
        let all = suggestion(key, "the keys here are", &known);
        let elsewhere = places_below(key, schema.whole());
        if elsewhere.is_empty() { all } else { format!("{all}; elsewhere there is {}", elsewhere.join(", ")) }
    })
}

/// Whether an unknown key names the quantity of a known one with another unit, or with none: `speed` and `speed_kmh` are
/// `speed_mps`.
fn differ_by_unit(key: &str, known: &str) -> bool {
    let quantity = quantity_of(known);
    unit_of(known).is_some() && key.strip_prefix(quantity).is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
}

fn conversion(key: &str, known: &str) -> Option<&'static str> {
    // In a quotient the whole quotient is converted.
    let ends_with = |key: &str, ending: &str| key.strip_suffix(ending).is_some_and(|stem| !stem.ends_with("_per"));
    let fits = |(from, to, _): &&(&str, &str, &str)| ends_with(key, from) && ends_with(known, to);
    CONVERSIONS.iter().find(fits).map(|(.., convert)| *convert)
}

/// The paths of a key in the tables within a table, as for `--set`; the shallowest first, and at most [`MOST_PLACES`].
fn places_below(key: &str, schema: SchemaNode) -> Vec<String> {
    let (mut places, mut tables) = (Vec::new(), vec![(String::new(), schema)]);
    for _ in 0..SEARCHED_DEPTH {
        tables = tables.iter().flat_map(|(path, table)| tables_of(path, *table)).collect();
        let has_key = |(_, table): &&(String, SchemaNode)| table.properties().any(|(known, _)| known == key);
        places.extend(tables.iter().filter(has_key).map(|(path, _)| format!("`{path}{key}`")));
    }
    places.truncate(MOST_PLACES);
    places
}

/// The tables of a table, and their paths with a point at the end.
fn tables_of<'s>(path: &str, schema: SchemaNode<'s>) -> Vec<(String, SchemaNode<'s>)> {
    let tables = schema.properties().filter(|(_, property)| !property.holds_paths());
    let below = tables.map(|(name, property)| match property.table_entries() {
        Some(entry) => (format!("{path}{name}.NAME."), entry),
        None => (format!("{path}{name}."), property),
    });
    below.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_in_another_unit_or_table_gets_a_suggestion() {
        let whole = crate::format::registry::complete(&Default::default());
        let file = SchemaNode::new(&whole);
        let vehicle = file.property("vehicle").and_then(SchemaNode::entries).expect("vehicles");
        let start = vehicle.property("start").expect("a start");
        assert!(
            help("speed_kmh", start)
                .starts_with("it is called `speed_mps` here, after its unit (divide km/h by 3.6): ")
        );
        assert_eq!(help("acceleration_max_mps2", vehicle), "it stands deeper: `limits.acceleration_max_mps2`");
        assert_eq!(
            help("speed_mps", file),
            "it stands deeper: `start_jitter.speed_mps`, `flow.NAME.speed_mps`, `vehicle.NAME.start.speed_mps`"
        );
        assert!(help("lane_count", start).starts_with("the keys here are: "));
        assert!(help("first_day", start).ends_with("; elsewhere there is `calendar.first_day`"));
        assert_eq!(help("sped_mps", start), "did you mean `speed_mps`?");
        assert_eq!(meant("durations_s", file), Some("duration_s"));
        assert_eq!(meant("elephant", file), None);
        assert_eq!(meant("jitter", file), Some("start_jitter"));
        assert_eq!(help("jitter", file), "did you mean `start_jitter`?");
    }
}
