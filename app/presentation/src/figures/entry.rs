//! Figures and tables of the dissertation: their specification in `registry.toml`, and their content.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

use serde::Deserialize;

use super::lookup::{EntryDrawing, FigureError};
use super::recorded_run::{RunOutcome, RunSpec};
use crate::plot::{Drawing, TextTable};

/// Whether an entry is a figure or a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Figure,
    Table,
}

/// A figure or table of the dissertation.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Whether it is a figure or a table.
    pub kind: Kind,
    /// Number in the dissertation, such as `6.1`.
    pub number: String,
    /// What the entry shows, in a line.
    pub title: String,
    /// What the dissertation says about the entry.
    pub says: String,
    /// The error of the dissertation that concerns this entry, and its effect.
    pub erratum: Option<String>,
    pub runs: Vec<RunSpec>,
    /// Runs that are measured for comparison, such as another planner or the equations as printed.
    pub beside: Vec<RunSpec>,
    pub(super) drawing: EntryDrawing,
}

/// The content of an entry or of a page about a run: pictures, and tables of measures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureContent {
    /// Pictures, in the order of the page.
    pub pictures: Vec<Drawing>,
    pub tables: Vec<TextTable>,
    /// Results in sentences, each with its heading.
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
    /// The entry that was to be made.
    pub entry: &'static Entry,
    /// Pictures and tables, or the failure.
    pub outcome: Result<FigureContent, FigureError>,
    /// The finished runs of the entry.
    pub runs: Vec<RunOutcome>,
}

impl EntryOutcome {
    /// Whether every run met the expectations of its scenario.
    pub fn held(&self) -> bool {
        self.runs.iter().all(|run| run.held != Some(false))
    }
}

/// Every figure and table, by chapters, figures before tables.
pub fn registry() -> impl Iterator<Item = &'static Entry> {
    static ENTRIES: LazyLock<Vec<Entry>> = LazyLock::new(|| {
        let file = toml::from_str(include_str!("registry.toml"));
        RegistryFile::entries(file.expect("the registry is part of the binary, and tests read it"))
    });
    ENTRIES.iter()
}

/// The file `registry.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RegistryFile {
    run: BTreeMap<String, RunTemplate>,
    errata: BTreeMap<String, String>,
    entry: Vec<EntrySpec>,
}

/// A run that entries refer to by name. Without a scenario it takes that of the entry.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RunTemplate {
    label: String,
    scenario: Option<String>,
    #[serde(default)]
    sets: Vec<String>,
}

/// An entry as it is written. Exactly one of `figure` and `table` is its number.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EntrySpec {
    figure: Option<String>,
    table: Option<String>,
    title: String,
    says: String,
    erratum: Option<String>,
    shared_erratum: Option<String>,
    drawing: EntryDrawing,
    scenario: Option<String>,
    #[serde(default)]
    runs: Vec<String>,
    #[serde(default)]
    beside: Vec<String>,
}

impl RegistryFile {
    fn entries(self) -> Vec<Entry> {
        let RegistryFile { run: templates, errata, entry } = self;
        let resolved = |spec: EntrySpec| {
            let run = |name: &String| {
                let RunTemplate { label, scenario, sets } = &templates[name];
                let scenario = scenario.clone().or_else(|| spec.scenario.clone()).unwrap_or_default();
                RunSpec { label: label.clone(), scenario, sets: sets.clone() }
            };
            let (runs, beside) = (spec.runs.iter().map(run).collect(), spec.beside.iter().map(run).collect());
            let kind = if spec.table.is_some() { Kind::Table } else { Kind::Figure };
            Entry {
                kind,
                number: spec.table.or(spec.figure).unwrap_or_default(),
                title: spec.title,
                says: spec.says,
                erratum: spec.erratum.or_else(|| spec.shared_erratum.map(|name| errata[&name].clone())),
                runs,
                beside,
                drawing: spec.drawing,
            }
        };
        entry.into_iter().map(resolved).collect()
    }
}
