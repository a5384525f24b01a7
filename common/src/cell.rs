//! Cells of tables as error messages show them.

/// Cells longer than this are not shown: the file is probably not a table \[characters\].
const MAX_SHOWN: usize = 40;

/// A cell of a table in backticks, or its length where it is longer than 40 characters.
///
/// ```
/// use interplay_common::cell::shown_cell;
///
/// assert_eq!(shown_cell("21,5 C"), "`21,5 C`");
/// assert_eq!(shown_cell(&"x".repeat(41)), "a text of 41 characters");
/// ```
pub fn shown_cell(text: &str) -> String {
    let length = text.chars().count();
    if length > MAX_SHOWN { format!("a text of {length} characters") } else { format!("`{text}`") }
}
