//! A page: one HTML file that shows pictures and tables, with everything in it and no address outside.
//!
//! Pictures are SVG inside the text; there is no script. A page opens from a folder, offline, in any browser.

mod contents;
mod html;

use std::path::Path;

pub use contents::{Page, Section, SectionStatus};

impl Page {
    /// The page as one HTML file.
    pub fn html(&self) -> String {
        html::page(self)
    }

    /// Whether there is a file at a path that no page of ours may take the place of.
    pub fn is_taken(path: &Path) -> bool {
        let Ok(text) = std::fs::read(path) else { return path.exists() };
        let mark = format!("<meta name=\"generator\" content=\"{}\">", html::GENERATOR);
        !text.windows(mark.len()).any(|part| part == mark.as_bytes())
    }
}
