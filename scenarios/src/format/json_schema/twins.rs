//! Adds to each key in radians a second key (its twin) for the same angle in degrees.

use serde_json::{Map, Value as Json, json};

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
