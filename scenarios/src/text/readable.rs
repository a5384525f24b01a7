//! Numbers in messages, with as many digits as a reader needs.

use serde_json::Value as Json;

/// Numbers that are written with at most this many characters are shown as they are.
const MAX_CHARACTERS: usize = 7;

/// The number rounded to four significant digits, unless it is already short: scaled or measured numbers have fifteen
/// digits, of which a message needs few.
pub fn readable(value: f64) -> f64 {
    if !value.is_finite() || value.abs().to_string().len() <= MAX_CHARACTERS {
        return value;
    }
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// A value as TOML, on one line.
pub(crate) fn toml(value: &Json) -> String {
    match value {
        Json::Null => String::new(),
        Json::Bool(truth) => truth.to_string(),
        Json::Number(number) if number.is_f64() => format!("{:?}", number.as_f64().unwrap_or_default()),
        Json::Number(number) => number.to_string(),
        Json::String(text) => toml::Value::String(text.clone()).to_string(),
        Json::Array(items) => format!("[{}]", items.iter().map(toml).collect::<Vec<_>>().join(", ")),
        Json::Object(table) if table.is_empty() => "{}".to_owned(),
        Json::Object(table) => {
            let pair = |(key, value): (&String, &Json)| {
                let is_bare = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b"_-".contains(&b));
                let key = if is_bare { key.clone() } else { toml(&Json::String(key.clone())) };
                format!("{key} = {}", toml(value))
            };
            format!("{{ {} }}", table.iter().map(pair).collect::<Vec<_>>().join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::readable;

    #[test]
    fn numbers_in_messages_keep_their_significant_digits() {
        let cases = [
            (2.881_197_929_382_324, 2.881),
            (0.316_227_766_016_837_94, 0.3162),
            (-12_345.678_901_2, -12_350.0),
            (24.983_1, 24.983_1),
            (1000.0, 1000.0),
            (0.1, 0.1),
        ];
        for (value, shown) in cases {
            assert_eq!(readable(value), shown);
        }
        assert!(readable(f64::NAN).is_nan());
    }
}
