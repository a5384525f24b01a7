//! A figure or table of the source, and what is made of it.

use std::fmt;

use super::error::FigureError;
use super::recorded_run::{RecordedRun, RunOutcome, RunSpec};
use crate::plot::{Drawing, TextTable};

/// What an entry is in the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A figure.
    Figure,
    /// A table.
    Table,
}

/// A figure or table of the source.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Whether it is a figure or a table.
    pub kind: Kind,
    /// Its number, such as `6.1`.
    pub number: &'static str,
    /// What it shows, in a line.
    pub title: &'static str,
    /// What the source says of it.
    pub says: &'static str,
    /// What the source has wrong that concerns it, and what that does.
    pub erratum: Option<&'static str>,
    /// The runs that are drawn.
    pub runs: &'static [RunSpec],
    /// Runs that are measured beside them, such as another planner or the equations as printed.
    pub beside: &'static [RunSpec],
    /// How it is drawn from the runs of `runs`.
    pub draw: Draw,
}

/// How an entry is drawn from its runs.
pub type Draw = fn(&Entry, &[&RecordedRun]) -> Result<FigureContent, FigureError>;

/// What came of an entry, or of a run: pictures, and tables of what was measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureContent {
    /// The pictures.
    pub pictures: Vec<Drawing>,
    /// What was measured.
    pub tables: Vec<TextTable>,
    /// What came of it, in sentences with a word in front of each.
    pub words: Vec<(String, String)>,
}

impl From<Drawing> for FigureContent {
    fn from(picture: Drawing) -> FigureContent {
        FigureContent { pictures: vec![picture], ..FigureContent::default() }
    }
}

impl Entry {
    /// The name of its files, and what the command line calls it: `fig-6.1`, `table-6.1`.
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

/// What became of an entry.
#[derive(Debug)]
pub struct EntryOutcome {
    /// The entry.
    pub entry: &'static Entry,
    /// What was drawn and measured, or why not.
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
