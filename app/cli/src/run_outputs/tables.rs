//! `run --trajectories`, `--detectors` and `--series`: tables that are written during the run.

use std::path::Path;
use std::str::FromStr;

use interplay_scenarios::Scenario;
use interplay_simulation::watch::Watcher;
use interplay_sweep::{DetectorWriter, SeriesWriter, TableFile, TableFormatError, TrajectoryWriter};

use super::{BegunOutput, OutputError, RunOutput};

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
