//! The files of `run --export`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use interplay_presentation::figures::RecordedRun;
use interplay_scenarios::{CommonRoadExport, Scenario};
use interplay_simulation::driven::driven;
use thiserror::Error;

use crate::output::error::{CommandError, write_file};
use crate::output::exit_status::ExitStatus;
use crate::output::{print_error, print_load_error};

/// A scenario of CommonRoad that a run is written to, and the solution beside it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ExportFile {
    scenario: PathBuf,
    solution: PathBuf,
}

/// A file whose ending is not that of CommonRoad.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{0}` has not the ending of a scenario of CommonRoad; use .xml")]
pub(crate) struct ExportFormatError(String);

impl FromStr for ExportFile {
    type Err = ExportFormatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let scenario = PathBuf::from(text);
        let is_xml = scenario.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xml"));
        let solution = scenario.with_extension("solution.xml");
        is_xml.then_some(ExportFile { scenario, solution }).ok_or_else(|| ExportFormatError(text.to_owned()))
    }
}

impl ExportFile {
    /// Where the scenario goes.
    pub(crate) fn scenario(&self) -> &Path {
        &self.scenario
    }

    /// Where the solution goes.
    pub(crate) fn solution(&self) -> &Path {
        &self.solution
    }

    /// Looks at what is written in every run, and whether it can be written.
    ///
    /// # Errors
    /// How the command ends, with the reason printed.
    pub(crate) fn begin(&self, scenario: &Scenario, loaded_from: &str) -> Result<CommonRoadExport, ExitStatus> {
        for path in [&self.scenario, &self.solution] {
            if let Err(reason) = interplay_files::check(path) {
                print_error(&CommandError::Unwritable { path: path.clone(), reason }.to_string());
                return Err(ExitStatus::Unfinished);
            }
        }
        CommonRoadExport::new(scenario, loaded_from).map_err(|error| {
            print_load_error(error);
            ExitStatus::BadInput
        })
    }

    /// Writes both files.
    ///
    /// # Errors
    /// What the disk says.
    pub(crate) fn write(&self, export: &CommonRoadExport, run: &RecordedRun) -> Result<(), CommandError> {
        let exported = export.export(&driven(&run.scenario, &run.frames, &run.report));
        write_file(&self.scenario, exported.scenario.as_bytes())?;
        write_file(&self.solution, exported.solution.as_bytes())?;
        let reaches = if exported.reaches_goal { "reaches" } else { "does not reach" };
        print_error(&format!(
            "scenario of CommonRoad in {}, solution in {}; the ego {reaches} the goal of its planning problem",
            self.scenario.display(),
            self.solution.display()
        ));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solution_stands_beside_the_scenario() {
        let file: ExportFile = "a/driven.xml".parse().expect("the ending");
        assert_eq!(file.solution(), Path::new("a/driven.solution.xml"));
        assert!("driven.toml".parse::<ExportFile>().is_err());
    }
}
