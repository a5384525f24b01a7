//! Reads a JSON Schema that `schemars` has generated, for the checks of settings, mappings and scenarios.

use serde_json::Value as Json;

/// The definition that a schema refers to by `$ref`, or else the schema itself.
pub fn definition_of<'a>(root: &'a Json, schema: &'a Json) -> &'a Json {
    let definition = schema["$ref"].as_str().and_then(|path| root.pointer(path.strip_prefix('#')?));
    definition.unwrap_or(schema)
}

/// The `kind` that an alternative of a tagged table requires.
pub fn kind_of(alternative: &Json) -> Option<&str> {
    alternative["properties"]["kind"]["const"].as_str()
}

/// The words from which a text is chosen; `schema` is without `$ref`.
pub fn words_of(schema: &Json) -> impl Iterator<Item = &str> {
    let plain = schema["enum"].as_array().into_iter().flatten();
    let described = schema["oneOf"].as_array().into_iter().flatten().map(|one| &one["const"]);
    plain.chain(described).filter_map(Json::as_str)
}

/// The name of a JSON type in error messages. A schema without a type describes a number.
pub fn type_in_words(type_name: Option<&str>) -> &'static str {
    match type_name {
        Some("object") => "a table",
        Some("array") => "a list",
        Some("string") => "a text",
        Some("boolean") => "true or false",
        Some("integer") => "a whole number",
        _ => "a number",
    }
}
