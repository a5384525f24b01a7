//! Wrong scenarios and what is said of them.

use std::fmt::Write as _;
use std::path::Path;

use interplay_scenarios::{LoadError, Scenario, load};
use miette::{GraphicalReportHandler, GraphicalTheme};

/// The error as a reader without colours sees it.
pub fn rendered(error: &LoadError, width: usize) -> String {
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor()).with_width(width);
    handler.render_report(&mut text, error).expect("writing to a string cannot fail");
    // No line may end in blanks, which editors would take away.
    text.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

/// The errors of one test, as they will be read.
#[derive(Default)]
pub struct Catalogue(pub String);

impl Catalogue {
    /// Expects an error whose rendering has all the fragments.
    pub fn add<T>(&mut self, name: &str, result: Result<T, LoadError>, width: usize, fragments: &[&str]) {
        let error = result.err().unwrap_or_else(|| panic!("{name}: accepted"));
        let text = rendered(&error, width);
        for fragment in fragments {
            assert!(text.contains(fragment), "{name}: no {fragment:?} in\n{text}");
        }
        writeln!(self.0, "=== {name}\n{text}").expect("writing to a string cannot fail");
    }

    /// The same at the usual width.
    #[allow(dead_code, reason = "not every file of tests loads from memory")]
    pub fn error(&mut self, name: &str, result: Result<Scenario, LoadError>, fragments: &[&str]) {
        self.add(name, result, 100, fragments);
    }

    /// Expects that a file is refused. Lines are not broken, since that depends on the length of the folder's path.
    #[allow(dead_code, reason = "not every file of tests writes files")]
    pub fn file(&mut self, folder: &Path, file: &str, fragments: &[&str]) {
        let path = folder.join(file);
        self.add(file, load(&path.to_string_lossy(), &[]), 2000, fragments);
        self.0 = self.0.replace(&*folder.to_string_lossy(), "FOLDER");
    }
}
