//! Dates and times as a table writes them.

use jiff::fmt::strtime::BrokenDownTime;

/// An offset from UTC in a format.
pub(super) const OFFSET: &str = "%z";

/// The parts of a time of this format. `%z` reads offsets with and without a colon, and `Z`.
pub(super) fn parsed(format: &str, text: &str) -> Option<BrokenDownTime> {
    let at_greenwich =
        text.strip_suffix('Z').filter(|_| format.ends_with(OFFSET)).map(|local| format!("{local}+00:00"));
    let text = at_greenwich.as_deref().unwrap_or(text);
    BrokenDownTime::parse(format, text).or_else(|_| BrokenDownTime::parse(format.replace(OFFSET, "%:z"), text)).ok()
}

/// The format that reads the time, where the stated one lacks but the offset from UTC at its end.
pub(super) fn format_with_offset(format: &str, text: &str) -> Option<String> {
    if format.contains(OFFSET) {
        return None;
    }
    [format!("{format}{OFFSET}"), format!("{format} {OFFSET}")]
        .into_iter()
        .find(|format| parsed(format, text).is_some())
}

#[cfg(test)]
mod tests {
    use super::{format_with_offset, parsed};

    const FORMAT: &str = "%Y-%m-%dT%H:%M:%S%z";

    #[test]
    fn an_offset_is_written_in_three_ways() {
        for (offset, seconds) in [("Z", 0), ("+0200", 7200), ("+02:00", 7200), ("-05:30", -19_800)] {
            let time = parsed(FORMAT, &format!("2026-07-06T00:15:00{offset}")).expect("a time");
            assert_eq!(time.offset().map(|offset| offset.seconds()), Some(seconds), "{offset}");
        }
        assert!(parsed(FORMAT, "2026-07-06T00:15:00").is_none());
    }

    #[test]
    fn a_format_that_lacks_only_the_offset_is_found() {
        let found = |text| format_with_offset("%Y-%m-%d %H:%M", text);
        assert_eq!(found("2026-07-06 00:15Z").as_deref(), Some("%Y-%m-%d %H:%M%z"));
        assert_eq!(found("2026-07-06 00:15 +0200").as_deref(), Some("%Y-%m-%d %H:%M %z"));
        assert_eq!(found("6.7.2026 00:15Z"), None);
        assert_eq!(format_with_offset(FORMAT, "2026-07-06T00:15:00+02:00"), None);
    }
}
