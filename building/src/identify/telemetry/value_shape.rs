//! What the value of a key must be.

use std::fmt;

use crate::nearest::listed;

/// What the value of a key must be, in plain words: `a table with …`, `one of …`, `a number`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ValueShape {
    /// A table.
    Table {
        /// The keys that it may have.
        keys: Vec<String>,
    },
    /// A table whose `kind` says which other keys it has.
    TableOfAKind {
        /// The kinds.
        kinds: Vec<String>,
    },
    /// A list.
    List {
        /// How many entries it has, if that is fixed.
        entries: Option<usize>,
    },
    /// One of several words.
    OneOf {
        /// The words.
        words: Vec<String>,
    },
    /// A text.
    Text,
    /// A text of one character.
    Character,
    /// `true` or `false`.
    Truth,
    /// A whole number.
    WholeNumber,
    /// A number.
    Number,
}

impl fmt::Display for ValueShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Table { keys } => write!(f, "a table with {}", listed(keys)),
            Self::TableOfAKind { kinds } => write!(f, "a table whose `kind` is one of {}", listed(kinds)),
            Self::List { entries: Some(entries) } => write!(f, "a list of {entries} entries"),
            Self::List { entries: None } => write!(f, "a list"),
            Self::OneOf { words } => write!(f, "one of {}", listed(words)),
            Self::Text => write!(f, "a text"),
            Self::Character => write!(f, "a text of one character"),
            Self::Truth => write!(f, "true or false"),
            Self::WholeNumber => write!(f, "a whole number"),
            Self::Number => write!(f, "a number"),
        }
    }
}
