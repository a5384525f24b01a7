//! A line of a journal: a row as a JSON object, whose last field is a checksum of the text before it.

use std::fmt::Write;

/// Beginning and end of the field.
const FIELD: &str = ",\"checksum\":\"";
const END: &str = "\"}";
/// Hexadecimal digits of a checksum.
const DIGITS: usize = 8;

#[derive(Debug, PartialEq, Eq)]
pub(crate) enum JournalLine {
    /// A row that matches its checksum.
    Sound,
    /// A line without a checksum, as versions before 0.3 wrote them, or text of another program.
    Unchecked,
    /// A line that does not match its checksum.
    Damaged,
}

/// The line of a row, with its line break.
pub(crate) fn line_of(row_json: &str) -> String {
    let fields = row_json.strip_suffix('}').unwrap_or(row_json);
    let mut line = String::with_capacity(row_json.len() + FIELD.len() + DIGITS + END.len());
    // Writing to a string cannot fail.
    let _ = writeln!(line, "{fields}{FIELD}{:08x}{END}", crc32fast::hash(fields.as_bytes()));
    line
}

/// Checks a line, with or without its line break.
pub(crate) fn judged(line: &[u8]) -> JournalLine {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    let length = FIELD.len() + DIGITS + END.len();
    let Some((fields, field)) = line.split_at_checked(line.len().saturating_sub(length)) else {
        return JournalLine::Unchecked;
    };
    let digits = field.strip_prefix(FIELD.as_bytes()).and_then(|rest| rest.strip_suffix(END.as_bytes()));
    match digits {
        None => JournalLine::Unchecked,
        Some(digits) if digits == format!("{:08x}", crc32fast::hash(fields)).as_bytes() => JournalLine::Sound,
        Some(_) => JournalLine::Damaged,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_journal_line_with_a_flipped_bit_fails_its_checksum() {
        let line = line_of("{\"key\":1,\"smallest_gap_m\":0.25}").into_bytes();
        assert_eq!(judged(&line), JournalLine::Sound);
        for bit in 0..8 * (line.len() - 1) {
            let mut flipped = line.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert_ne!(judged(&flipped), JournalLine::Sound, "bit {bit}");
        }
        assert_eq!(judged(b"{\"key\":1}\n"), JournalLine::Unchecked);
        assert_eq!(judged(b""), JournalLine::Unchecked);
    }
}
