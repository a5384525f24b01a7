//! What commands say: results on stdout, everything else on stderr.

use std::io::Write;

use serde::Serialize;

use crate::error::CommandError;

/// Prints a result. A reader that has gone away (a closed pipe) is no error of ours.
pub(crate) fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// Says what went wrong.
pub(crate) fn print_error(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Says what is wrong with a file, with the place underlined.
pub(crate) fn print_load_error(error: interplay_scenarios::LoadError) {
    print_error(format!("{:?}", miette::Report::new(error)).trim_end());
}

/// One JSON document; an error calls it `what`.
pub(crate) fn json(what: &'static str, value: &impl Serialize) -> Result<String, CommandError> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n").map_err(|reason| CommandError::Json { what, reason })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn what_cannot_be_written_as_json_is_an_error() {
        let pairs = BTreeMap::from([([1, 2], 3)]);
        let error = json("the report", &pairs).expect_err("a key of JSON is a text").to_string();
        assert!(error.starts_with("the report cannot be written as JSON: "), "{error}");
        assert_eq!(json("numbers", &[0.1 + 0.2]).expect("numbers"), "[\n  0.30000000000000004\n]\n");
    }
}
