//! `run --trajectories`, `--detectors` and `--series`: tables that are written during the run.

use std::path::Path;
use std::str::FromStr;

use interplay_presentation::page::Page;
use interplay_scenarios::{Override, Registry, Scenario};
use interplay_simulation::watch::Watcher;
use interplay_sweep::{DetectorWriter, SeriesWriter, TableFile, TableFormatError, TrajectoryWriter};

use super::{BegunOutput, OutputError, RunOutput};
use crate::flag_values::files::{destroyed, is_page_file, is_same_file};

/// A table of the trajectories of all vehicles.
#[derive(Clone, Debug)]
pub struct TrajectoryTable(TableFile);

/// A table of the counts of all detectors.
#[derive(Clone, Debug)]
pub struct DetectorTable(TableFile);

/// A table of the building's temperatures, heat and weather over time.
#[derive(Clone, Debug)]
pub struct SeriesFile(TableFile);

impl FromStr for TrajectoryTable {
    type Err = TableFormatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(TrajectoryTable)
    }
}

impl FromStr for DetectorTable {
    type Err = TableFormatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(DetectorTable)
    }
}

impl FromStr for SeriesFile {
    type Err = TableFormatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(SeriesFile)
    }
}

impl RunOutput for TrajectoryTable {
    fn files(&self) -> Vec<(&'static str, &Path)> {
        vec![("table of trajectories", self.0.path())]
    }

    fn lacks(&self, scenario: &Scenario) -> Option<&'static str> {
        scenario.vehicles.is_empty().then_some("vehicles")
    }

    fn begin(&self, _: &Scenario, _: &str) -> Result<BegunOutput, OutputError> {
        Ok(begun(TrajectoryWriter::begin(&self.0)?, "trajectories", &self.0))
    }
}

impl RunOutput for DetectorTable {
    fn files(&self) -> Vec<(&'static str, &Path)> {
        vec![("table of detectors", self.0.path())]
    }

    fn lacks(&self, scenario: &Scenario) -> Option<&'static str> {
        scenario.detectors.is_empty().then_some("a `[[detector]]`")
    }

    fn begin(&self, scenario: &Scenario, _: &str) -> Result<BegunOutput, OutputError> {
        Ok(begun(DetectorWriter::begin(&self.0, scenario)?, "what detectors counted", &self.0))
    }
}

impl RunOutput for SeriesFile {
    fn files(&self) -> Vec<(&'static str, &Path)> {
        vec![("table of series", self.0.path())]
    }

    fn lacks(&self, scenario: &Scenario) -> Option<&'static str> {
        scenario.building.is_none().then_some("a `[building]`")
    }

    fn begin(&self, scenario: &Scenario, _: &str) -> Result<BegunOutput, OutputError> {
        Ok(begun(SeriesWriter::begin(&self.0, scenario)?, "series of the building", &self.0))
    }
}

/// A table whose rows are written by a watcher: when the run is over, the file is there.
fn begun(writer: impl Watcher + 'static, what: &'static str, file: &TableFile) -> BegunOutput {
    let told = format!("{what} in {}", file.path().display());
    BegunOutput { watcher: Some(Box::new(writer)), finish: Box::new(move |_| Ok(told)) }
}

/// The files that a run writes.
pub(crate) struct WrittenFiles<'a> {
    /// Each with what it is.
    pub files: Vec<(&'static str, &'a Path)>,
    pub page: Option<&'a Path>,
}

impl WrittenFiles<'_> {
    /// Why an output must not be written: it would replace an input, another output, or a page that Interplay did not write.
    pub(crate) fn refused(&self, registry: &Registry, scenario: &str, overrides: &[Override]) -> Option<String> {
        self.takes_an_input(registry, scenario, overrides)
            .or_else(|| self.is_of_page())
            .or_else(|| self.are_one_file())
            .or_else(|| self.takes_a_page())
    }

    fn takes_an_input(&self, registry: &Registry, scenario: &str, overrides: &[Override]) -> Option<String> {
        self.files.iter().find_map(|(what, path)| {
            let path = destroyed(registry, path, [scenario].into_iter(), overrides)?;
            let path = path.display();
            Some(format!(
                "the {what} would overwrite `{path}`, of which the scenario is made; choose another name for it"
            ))
        })
    }

    fn is_of_page(&self) -> Option<String> {
        let folder = self.page?;
        let (what, path) = self.files.iter().find(|(_, path)| is_page_file(folder, path))?;
        let path = path.display();
        Some(format!("the {what} and a file of the page cannot both be `{path}`; choose another name for the {what}"))
    }

    fn are_one_file(&self) -> Option<String> {
        self.files.iter().enumerate().find_map(|(index, (what, path))| {
            let (first, _) = self.files[..index].iter().find(|(_, other)| is_same_file(other, path))?;
            let path = path.display();
            Some(format!("the {first} and the {what} cannot both be `{path}`; choose another name for one"))
        })
    }

    fn takes_a_page(&self) -> Option<String> {
        let page = self.page.map(|folder| folder.join("index.html")).filter(|page| Page::is_taken(page))?;
        Some(format!("`{}` is not a page that Interplay wrote; choose another folder for --report", page.display()))
    }
}
