//! Values of flags, with words for those that cannot be.

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};

/// What a number of things must be.
const COUNT: &str = "write a whole number of at least 1";

/// How many of something there are.
///
/// # Errors
/// What would work, if the text is no whole number of at least 1.
pub(crate) fn count(text: &str) -> Result<u64, String> {
    text.parse().map(NonZeroU64::get).map_err(|_| COUNT.to_owned())
}

/// How many run at a time.
///
/// # Errors
/// As [`count`].
pub(crate) fn jobs(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| COUNT.to_owned())
}

/// How many parts there are.
///
/// # Errors
/// As [`count`].
pub(crate) fn parts(text: &str) -> Result<NonZeroU32, String> {
    text.parse().map_err(|_| COUNT.to_owned())
}

/// A change, such as `vehicle.ego.goal.speed_mps=1.2`.
///
/// # Errors
/// What would work, if the path or the `=` is missing.
pub(crate) fn assignment(text: &str) -> Result<String, String> {
    match text.split_once('=') {
        Some((path, _)) if !path.trim().is_empty() => Ok(text.to_owned()),
        _ => Err("write PATH=VALUE, for example `vehicle.ego.goal.speed_mps=1.2`".to_owned()),
    }
}

/// Changes with `;` between them.
///
/// # Errors
/// As [`assignment`], or if there is none.
pub(crate) fn assignments(text: &str) -> Result<String, String> {
    let mut changes = changes_of(text).peekable();
    if changes.peek().is_none() {
        return assignment("");
    }
    changes.try_for_each(|change| assignment(change).map(|_| ()))?;
    Ok(text.to_owned())
}

/// The changes of which several are written with `;` between them.
pub(crate) fn changes_of(text: &str) -> impl Iterator<Item = &str> {
    text.split(';').map(str::trim).filter(|change| !change.is_empty())
}

/// The path of a change that another one before it states, too.
pub(crate) fn stated_twice<'a>(changes: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let mut paths = std::collections::BTreeSet::new();
    let mut path = changes.map(|change| change.split_once('=').map_or(change, |(path, _)| path).trim());
    path.find(|path| !paths.insert(*path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_changes_are_read() {
        assert_eq!(count("7"), Ok(7));
        for wrong in ["0", "-1", "many", "1.5", ""] {
            assert!(count(wrong).is_err() && jobs(wrong).is_err() && parts(wrong).is_err(), "{wrong}");
        }
        assert!(assignment("a.b=1").is_ok() && assignments("a=1; b=[1, 2];").is_ok());
        for wrong in ["", ";", "a", "=1", "a=1; b"] {
            assert!(assignments(wrong).is_err(), "{wrong}");
        }
        assert_eq!(stated_twice(["a=1", "b=1", " a = 2"].into_iter()), Some("a"));
        assert_eq!(stated_twice(changes_of("a=1; b=1")), None);
    }
}
