//! Rules of texts: names, plain text, and numbers in messages.

pub(crate) mod name;
pub(crate) mod pattern;
pub(crate) mod plain_text;
pub(crate) mod readable;
pub(crate) mod toml_value;
