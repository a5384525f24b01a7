//! The characters that a text shown on a terminal may contain.

/// Whether a character is only displayed: it is neither a control character, except for the line end and the tab, nor
/// one that changes the direction of the text.
pub fn is_plain(character: char) -> bool {
    match character {
        '\n' | '\t' => true,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => false,
        _ => !character.is_control(),
    }
}
