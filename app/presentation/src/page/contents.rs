//! What a page shows.

use crate::plot::TextTable;

/// The content of a page, from which HTML is made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Title of the page.
    pub title: String,
    /// Paragraphs below the title.
    pub opening: Vec<String>,
    /// Parts of the page.
    pub sections: Vec<Section>,
}

/// A part of a page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Anchor of the part for links, unique on the page.
    pub id: String,
    /// Heading of the part.
    pub heading: String,
    /// Whether what was expected of the part came true.
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

/// Whether what was expected of a part came true.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SectionStatus {
    /// Nothing was expected of this part.
    #[default]
    Shown,
    /// All that was expected came true.
    Held,
    /// Something that was expected did not come true.
    Missed,
    /// The part could not be made; the reason.
    Broken(String),
}

impl SectionStatus {
    /// The status in words.
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
