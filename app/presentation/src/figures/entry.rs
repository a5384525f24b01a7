//! A figure or table of the source, and what is made of it.

use std::fmt;

use super::error::FigureError;
use super::recorded_run::{RecordedRun, RunOutcome, RunSpec};
use crate::plot::{Drawing, TextTable};

/// The kind of an entry in the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A figure of the source.
    Figure,
    /// A table of the source.
    Table,
}

/// A figure or table of the source.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Whether it is a figure or a table.
    pub kind: Kind,
    /// Number in the source, such as `6.1`.
    pub number: &'static str,
    /// What the entry shows, in a line.
    pub title: &'static str,
    /// What the source says about the entry.
    pub says: &'static str,
    /// The error of the source that concerns this entry and its effect, if there is one.
    pub erratum: Option<&'static str>,
    /// The runs that are drawn.
    pub runs: &'static [RunSpec],
    /// Runs that are measured beside them, such as another planner or the equations as printed.
    pub beside: &'static [RunSpec],
    /// The function that draws the entry from its `runs`.
    pub draw: Draw,
}

/// A function that draws an entry from its runs.
pub type Draw = fn(&Entry, &[&RecordedRun]) -> Result<FigureContent, FigureError>;

/// The content of an entry or of a page about a run: pictures, and tables of measures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureContent {
    /// The pictures.
    pub pictures: Vec<Drawing>,
    /// Tables of measures.
    pub tables: Vec<TextTable>,
    /// Results in sentences, with a word in front of each.
    pub words: Vec<(String, String)>,
}

impl From<Drawing> for FigureContent {
    fn from(picture: Drawing) -> FigureContent {
        FigureContent { pictures: vec![picture], ..FigureContent::default() }
    }
}

impl Entry {
    /// The name of the entry's files and on the command line: `fig-6.1`, `table-6.1`.
    pub fn id(&self) -> String {
        let kind = match self.kind {
            Kind::Figure => "fig",
            Kind::Table => "table",
        };
        format!("{kind}-{}", self.number)
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.kind {
            Kind::Figure => "Fig.",
            Kind::Table => "Table",
        };
        write!(f, "{kind} {}", self.number)
    }
}

/// An entry with its content, or with the reason why it was not made.
#[derive(Debug)]
pub struct EntryOutcome {
    /// The entry.
    pub entry: &'static Entry,
    /// Pictures and tables, or why there are none.
    pub outcome: Result<FigureContent, FigureError>,
    /// How each run went that was asked of it and could be finished.
    pub runs: Vec<RunOutcome>,
}

impl EntryOutcome {
    /// Whether every run did what its scenario expects.
    pub fn held(&self) -> bool {
        self.runs.iter().all(|run| run.held != Some(false))
    }
}
