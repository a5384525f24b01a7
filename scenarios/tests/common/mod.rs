//! Wrong scenarios and what is said of them.
#![allow(dead_code, reason = "not every file of tests uses all of it")]

use std::fmt::{Debug, Write as _};
use std::path::Path;

use interplay_scenarios::{LoadError, Override, Scenario, from_text, load};
use miette::{GraphicalReportHandler, GraphicalTheme};

/// The smallest valid scenario.
pub const LEAST: &str =
    "title = 'a'\nshows = 'b'\n[[vehicle]]\nname = 'car'\nstart = { x_m = 0, y_m = 0.2, speed_mps = 1 }\n";

pub fn least(more: &str, overrides: &[Override]) -> Scenario {
    from_text("least.toml", &format!("{more}\n{LEAST}"), overrides).expect("a scenario without fault")
}

pub fn set(assignment: &str) -> Override {
    Override::Set(assignment.to_owned())
}

/// The error as a reader without colours sees it.
pub fn rendered(error: &LoadError, width: usize) -> String {
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor()).with_width(width);
    handler.render_report(&mut text, error).expect("writing to a string cannot fail");
    // No line may end in blanks, which editors would take away.
    text.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

/// Expects an error whose rendering has all the fragments.
#[track_caller]
pub fn refused<T: Debug>(result: Result<T, LoadError>, fragments: &[&str]) {
    let text = rendered(&result.expect_err("must be refused"), 2000);
    fragments.iter().for_each(|fragment| assert!(text.contains(fragment), "no {fragment:?} in\n{text}"));
}

/// The errors of one test, for a snapshot.
#[derive(Default)]
pub struct Catalogue(pub String);

impl Catalogue {
    pub fn add<T>(&mut self, name: &str, result: Result<T, LoadError>, width: usize) {
        let error = result.err().unwrap_or_else(|| panic!("{name}: accepted"));
        writeln!(self.0, "=== {name}\n{}", rendered(&error, width)).expect("writing to a string cannot fail");
    }

    /// Expects that a file is refused. Lines are not broken, since that depends on the length of the folder's path.
    pub fn file(&mut self, folder: &Path, file: &str) {
        let path = folder.join(file);
        self.add(file, load(&path.to_string_lossy(), &[]), 2000);
        self.0 = self.0.replace(&*folder.to_string_lossy(), "FOLDER");
    }
}
