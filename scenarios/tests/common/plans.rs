//! Plans that are refused, and where.

use std::path::Path;

use interplay_scenarios::{LoadError, SweepPlan};

/// The text of a plan, the line and column of its first fault, and words of what is said of it.
pub type WrongPlan = (&'static str, usize, usize, &'static str);

/// A plan as it would be read from the file `plan.toml`.
pub fn read(text: &str) -> Result<SweepPlan, LoadError> {
    SweepPlan::from_text("plan.toml", text, Path::new(""))
}

/// Expects of each plan that it is refused where it is wrong.
pub fn all_are_refused(plans: &[WrongPlan]) {
    let mut wrong = Vec::new();
    for (text, line, column, words) in plans {
        match read(text).err().map(|error| error.faults()[0].clone()) {
            None => wrong.push(format!("accepted: {text}")),
            Some(fault) => {
                let is_there = (fault.file(), fault.line_and_column()) == (Some("plan.toml"), Some((*line, *column)));
                if !is_there || !fault.message().contains(words) {
                    let found = (fault.file(), fault.line_and_column(), fault.message());
                    wrong.push(format!("{text}{found:?} and not {:?}", (line, column, words)));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
