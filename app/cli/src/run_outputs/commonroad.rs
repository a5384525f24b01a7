//! `run --export`

use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use interplay_presentation::figures::RecordedRun;
use interplay_scenarios::{CommonRoadExport, Scenario};
use interplay_simulation::driven::driven;
use thiserror::Error;

use super::{BegunOutput, OutputError, RunOutput};

/// A scenario of CommonRoad that a run is written to, and the solution beside it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommonRoadFile {
    scenario: PathBuf,
    solution: PathBuf,
}

/// A file whose ending is not that of CommonRoad.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{0}` has not the ending of a scenario of CommonRoad; use .xml")]
pub struct CommonRoadFormatError(String);

impl FromStr for CommonRoadFile {
    type Err = CommonRoadFormatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let scenario = PathBuf::from(text);
        let is_xml = scenario.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xml"));
        let solution = scenario.with_extension("solution.xml");
        is_xml.then_some(CommonRoadFile { scenario, solution }).ok_or_else(|| CommonRoadFormatError(text.to_owned()))
    }
}

impl RunOutput for CommonRoadFile {
    fn files(&self) -> Vec<(&'static str, &Path)> {
        vec![("scenario of CommonRoad", &self.scenario), ("solution", &self.solution)]
    }

    fn lacks(&self, scenario: &Scenario) -> Option<&'static str> {
        scenario.vehicles.is_empty().then_some("vehicles")
    }

    fn needs_frames(&self) -> bool {
        true
    }

    fn begin(&self, scenario: &Scenario, loaded_from: &str) -> Result<BegunOutput, OutputError> {
        for path in [&self.scenario, &self.solution] {
            interplay_files::check(path).map_err(unwritable(path))?;
        }
        let export = CommonRoadExport::new(scenario, loaded_from);
        let export = export.map_err(|error| OutputError::Refused(Box::new(error)))?;
        let file = self.clone();
        Ok(BegunOutput { watcher: None, finish: Box::new(move |run| file.write(&export, run)) })
    }
}

impl CommonRoadFile {
    /// Writes both files, and returns in words where they are.
    fn write(&self, export: &CommonRoadExport, run: &RecordedRun) -> Result<String, OutputError> {
        let exported = export.export(&driven(&run.scenario, &run.frames, &run.report));
        for (path, content) in [(&self.scenario, &exported.scenario), (&self.solution, &exported.solution)] {
            interplay_files::write(path, content.as_bytes()).map_err(unwritable(path))?;
        }
        let reaches = if exported.reaches_goal { "reaches" } else { "does not reach" };
        Ok(format!(
            "scenario of CommonRoad in {}, solution in {}; the ego {reaches} the goal of its planning problem",
            self.scenario.display(),
            self.solution.display()
        ))
    }
}

fn unwritable(path: &Path) -> impl Fn(io::Error) -> OutputError {
    move |reason| OutputError::Unwritable { path: path.to_owned(), reason }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solution_file_is_written_beside_the_scenario() {
        let file: CommonRoadFile = "a/driven.xml".parse().expect("the ending");
        assert_eq!(file.solution.as_path(), Path::new("a/driven.solution.xml"));
        assert!("driven.toml".parse::<CommonRoadFile>().is_err());
    }
}
