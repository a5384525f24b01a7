//! What a text may hold that is shown on a terminal.

/// Whether a character is shown and does nothing else: no control character but the line end and the tab, and none that turns the
/// direction of the text around it.
pub fn is_plain(character: char) -> bool {
    match character {
        '\n' | '\t' => true,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => false,
        _ => !character.is_control(),
    }
}
