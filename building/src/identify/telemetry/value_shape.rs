//! The shape that the value of a key must have.

use std::fmt;

use interplay_common::json_schema::type_in_words;
use interplay_common::spelling::listed;

/// The shape that the value of a key must have. Displays as `a table with …`, `one of …` or `a number`.
pub(super) enum ValueShape {
    /// With the keys that it may have.
    Table(Vec<String>),
    /// A table whose `kind`, one of these, says which other keys it has.
    TableOfAKind(Vec<String>),
    List {
        min_entries: usize,
        max_entries: Option<usize>,
    },
    OneOf(Vec<String>),
    Text,
    Character {
        ascii: bool,
    },
    Truth,
    WholeNumber,
    Number,
}

impl fmt::Display for ValueShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let type_name = match self {
            Self::TableOfAKind(kinds) => {
                return write!(f, "a table whose `kind` is one of {}", listed(kinds));
            }
            Self::OneOf(words) => return write!(f, "one of {}", listed(words)),
            Self::Character { ascii: true } => return write!(f, "a text of one ASCII character"),
            Self::Character { ascii: false } => return write!(f, "a text of one character"),
            Self::Table(_) => "object",
            Self::List { .. } => "array",
            Self::Text => "string",
            Self::Truth => "boolean",
            Self::WholeNumber => "integer",
            Self::Number => "number",
        };
        write!(f, "{}", type_in_words(Some(type_name)))?;
        match self {
            Self::Table(keys) => write!(f, " with {}", listed(keys)),
            Self::List { min_entries: min, max_entries: Some(max) } if min == max => write!(f, " of {}", entries(*min)),
            Self::List { min_entries: min, max_entries: Some(max) } => write!(f, " of {min} to {}", entries(*max)),
            Self::List { min_entries: min @ 1.., max_entries: None } => write!(f, " of at least {}", entries(*min)),
            _ => Ok(()),
        }
    }
}

fn entries(count: usize) -> String {
    if count == 1 { "1 entry".into() } else { format!("{count} entries") }
}
