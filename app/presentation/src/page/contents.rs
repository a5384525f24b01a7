//! What a page shows.

use crate::plot::TextTable;

/// A page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Its title.
    pub title: String,
    /// What stands below the title, a paragraph each.
    pub opening: Vec<String>,
    /// What it shows.
    pub sections: Vec<Section>,
}

/// A part of a page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Where links lead, unique on the page.
    pub id: String,
    /// Its heading.
    pub heading: String,
    /// How it turned out.
    pub verdict: SectionStatus,
    /// Paragraphs with a word in front of each.
    pub words: Vec<(String, String)>,
    /// Pictures as SVG, each with what it shows in words.
    pub pictures: Vec<(String, String)>,
    /// Tables.
    pub tables: Vec<TextTable>,
    /// Commands that make the same again.
    pub commands: Vec<String>,
    /// Files beside the page, with what each is.
    pub files: Vec<(String, String)>,
}

/// How a part turned out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SectionStatus {
    /// Nothing was expected.
    #[default]
    Shown,
    /// All that was expected came true.
    Held,
    /// Something that was expected did not come true.
    Missed,
    /// It could not be made, and why.
    Broken(String),
}

impl SectionStatus {
    /// The words for it.
    pub fn word(&self) -> &'static str {
        match self {
            SectionStatus::Shown => "shown",
            SectionStatus::Held => "expectations held",
            SectionStatus::Missed => "an expectation failed",
            SectionStatus::Broken(_) => "could not be made",
        }
    }
}

impl SectionStatus {
    /// A sign for it.
    pub(super) fn sign(&self) -> &'static str {
        match self {
            SectionStatus::Shown => "–",
            SectionStatus::Held => "✓",
            SectionStatus::Missed | SectionStatus::Broken(_) => "✗",
        }
    }
}
