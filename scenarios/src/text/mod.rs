//! Rules for texts: names, plain text, numbers in messages, and errors with a place in a text.

pub(crate) mod error;
pub(crate) mod name;
pub(crate) mod plain_text;
pub(crate) mod readable;
