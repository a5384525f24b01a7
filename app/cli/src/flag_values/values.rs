//! Values of flags, with an error message for each kind.

use std::str::FromStr;

/// How many of something there are; `N` is a type of [`NonZero`](std::num::NonZero).
///
/// # Errors
/// What would work, if the text is not a whole number of at least 1.
pub(crate) fn count<N: FromStr>(text: &str) -> Result<N, String> {
    text.parse().map_err(|_| "write a whole number of at least 1".to_owned())
}

/// A seed as it is written on the command line.
///
/// # Errors
/// What would work, if the text is not such a number.
pub(crate) fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("a seed is a whole number from 0 to {}", u64::MAX))
}

/// A time since the beginning of a run \[s\].
///
/// # Errors
/// What would work, if the text is not a finite number of at least 0.
pub(crate) fn time(text: &str) -> Result<f64, String> {
    let found: Option<f64> = text.parse().ok();
    let found = found.filter(|time_s| time_s.is_finite() && *time_s >= 0.0);
    found.ok_or_else(|| "write a number of seconds of at least 0, for example `2.3`".to_owned())
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
    use std::num::NonZeroU64;

    use super::*;

    #[test]
    fn flag_values_are_parsed_as_numbers_and_changes() {
        assert_eq!(count::<NonZeroU64>("7").map(NonZeroU64::get), Ok(7));
        for wrong in ["0", "-1", "many", "1.5", ""] {
            assert!(count::<NonZeroU64>(wrong).is_err(), "{wrong}");
        }
        assert_eq!(time("2.3"), Ok(2.3));
        for wrong in ["-1", "nan", "inf", "soon", ""] {
            assert!(time(wrong).is_err(), "{wrong}");
        }
        assert!(assignment("a.b=1").is_ok() && assignments("a=1; b=[1, 2];").is_ok());
        for wrong in ["", ";", "a", "=1", "a=1; b"] {
            assert!(assignments(wrong).is_err(), "{wrong}");
        }
        assert_eq!(stated_twice(["a=1", "b=1", " a = 2"].into_iter()), Some("a"));
        assert_eq!(stated_twice(changes_of("a=1; b=1")), None);
    }
}
