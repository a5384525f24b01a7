//! A page: one HTML file that shows pictures and tables, with everything in it and no address outside.
//!
//! Pictures are SVG inside the text; there is no script. A page opens from a folder, offline, in any browser.

mod contents;
mod html;

pub use contents::{Page, Section, SectionStatus};

impl Page {
    /// The whole as HTML.
    pub fn html(&self) -> String {
        html::page(self)
    }
}
