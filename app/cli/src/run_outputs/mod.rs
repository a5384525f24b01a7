//! Outputs of `run` besides its report and its recording, for the command and for Python: one value for each flag.

mod commonroad;
mod tables;

use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use interplay_presentation::animation::{AnimationError, AnimationFile};
use interplay_presentation::figures::RecordedRun;
use interplay_scenarios::{LoadError, Override, Registry, Scenario};
use interplay_simulation::watch::Watcher;
use interplay_sweep::TableError;
use thiserror::Error;

use commonroad::CommonRoadFile;
use tables::{DetectorTable, SeriesFile, TrajectoryTable, WrittenFiles};

/// A file, or a pair of files, that a flag of `run` asks for.
pub(crate) trait RunOutput {
    /// The files, each with what it is.
    fn files(&self) -> Vec<(&'static str, &Path)>;

    /// What the scenario lacks, if there is nothing to write of its run.
    fn lacks(&self, _: &Scenario) -> Option<&'static str> {
        None
    }

    /// Whether it is made of all frames of the run.
    fn needs_frames(&self) -> bool {
        false
    }

    /// Begins it before the run of a scenario that was loaded from a name or a path.
    ///
    /// # Errors
    /// [`OutputError`] if it cannot be written.
    fn begin(&self, scenario: &Scenario, loaded_from: &str) -> Result<BegunOutput, OutputError>;
}

/// An output of a run that has not ended.
pub(crate) struct BegunOutput {
    /// Writes during the run.
    watcher: Option<Box<dyn Watcher>>,
    /// Writes after the run, and returns a line that names the files.
    finish: FinishOutput,
}

type FinishOutput = Box<dyn FnOnce(&RecordedRun) -> Result<String, OutputError> + Send>;

/// Why an output could not be written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The scenario cannot be written in the requested format.
    #[error("{0}")]
    Refused(Box<LoadError>),
    /// A moving picture cannot be made or written.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// A table cannot be written.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A file cannot be written.
    #[error("cannot write `{}`: {reason}; choose another place for it", path.display())]
    Unwritable {
        /// Which file.
        path: PathBuf,
        /// The system's reason.
        reason: io::Error,
    },
}

/// Declares the flags: each is a file of its type, which implements [`RunOutput`].
macro_rules! run_outputs {
    ($($(#[$about:meta])* $flag:ident: $File:ty;)*) => {
        /// The requested outputs of a run.
        #[derive(Clone, Debug, Default, Args)]
        pub struct RunOutputs {
            $($(#[$about])* #[arg(long)] $flag: Option<$File>,)*
        }

        impl RunOutputs {
            /// Requests the output of a flag, which is named without its dashes.
            ///
            /// # Errors
            /// If no such flag exists, or the ending of the file is not one of its formats.
            pub fn ask_for(&mut self, flag: &str, path: &str) -> Result<(), String> {
                match flag {
                    $(stringify!($flag) => {
                        self.$flag = Some(path.parse::<$File>().map_err(|error| error.to_string())?);
                        Ok(())
                    })*
                    _ => Err(format!("`{flag}` is not an output of a run")),
                }
            }

            fn asked(&self) -> Vec<(&'static str, &dyn RunOutput)> {
                let outputs = [$((stringify!($flag), self.$flag.as_ref().map(|file| file as &dyn RunOutput)),)*];
                outputs.into_iter().filter_map(|(flag, output)| Some((flag, output?))).collect()
            }
        }
    };
}

run_outputs! {
    /// Draw a moving picture of the run, seen from above: .gif, .webp, .png (a filmstrip), or .mp4 (through ffmpeg)
    #[arg(value_name = "FILE")]
    animate: AnimationFile;
    /// Write what every vehicle did at every tick as a table: .csv or .parquet
    #[arg(value_name = "FILE")]
    trajectories: TrajectoryTable;
    /// Write what the scenario's detectors count as a table: .csv or .parquet
    #[arg(value_name = "FILE")]
    detectors: DetectorTable;
    /// Write what happened in the building at every step as a table, with weather, forecast, sun and price: .csv or .parquet
    #[arg(value_name = "FILE")]
    series: SeriesFile;
    /// Write the run as a scenario of CommonRoad, all but the ego as obstacles, and beside it NAME.solution.xml: the ego's
    /// motion as a solution of its planning problem
    #[arg(value_name = "FILE.xml")]
    export: CommonRoadFile;
}

impl RunOutputs {
    /// Returns why an output must not be written: it would overwrite an input, another output, or a file that Interplay
    /// did not write. The outputs include `recording` and the folder `page`.
    pub fn refused(
        &self,
        recording: Option<&Path>,
        page: Option<&Path>,
        registry: &Registry,
        scenario: &str,
        overrides: &[Override],
    ) -> Option<String> {
        let recording = recording.map(|path| ("recording", path));
        let files = recording.into_iter().chain(self.asked().into_iter().flat_map(|(_, output)| output.files()));
        WrittenFiles { files: files.collect(), page }.refused(registry, scenario, overrides)
    }

    /// The first flag whose output needs a part that the scenario lacks, and the name of that part.
    pub fn without_subject(&self, scenario: &Scenario) -> Option<(&'static str, &'static str)> {
        self.asked().into_iter().find_map(|(flag, output)| Some((flag, output.lacks(scenario)?)))
    }

    /// Whether an output is made of all frames of the run.
    pub(crate) fn needs_frames(&self) -> bool {
        self.asked().into_iter().any(|(_, output)| output.needs_frames())
    }

    /// Begins all outputs before the run of a scenario that was loaded from a name or a path.
    ///
    /// # Errors
    /// [`OutputError`] of the first that cannot be written.
    pub fn begin(&self, scenario: &Scenario, loaded_from: &str) -> Result<BegunOutputs, OutputError> {
        let begun = self.asked().into_iter().map(|(_, output)| output.begin(scenario, loaded_from));
        Ok(BegunOutputs(begun.collect::<Result<Vec<BegunOutput>, OutputError>>()?))
    }
}

/// The outputs of a run in progress. Dropping it removes the outputs that are not finished.
pub struct BegunOutputs(Vec<BegunOutput>);

impl BegunOutputs {
    /// The watchers that write during the run.
    pub fn watchers(&mut self) -> Vec<Box<dyn Watcher>> {
        self.0.iter_mut().filter_map(|output| output.watcher.take()).collect()
    }

    /// Writes the outputs that need the whole run, and hands a line for each, which names its files, to `tell`.
    ///
    /// # Errors
    /// [`OutputError`] of the first that cannot be written.
    pub fn finish(self, run: &RecordedRun, mut tell: impl FnMut(&str)) -> Result<(), OutputError> {
        for output in self.0 {
            tell(&(output.finish)(run)?);
        }
        Ok(())
    }
}

impl RunOutput for AnimationFile {
    fn files(&self) -> Vec<(&'static str, &Path)> {
        vec![("animation", self.path())]
    }

    fn needs_frames(&self) -> bool {
        true
    }

    fn begin(&self, _: &Scenario, _: &str) -> Result<BegunOutput, OutputError> {
        self.check()?;
        let file = self.clone();
        let told = format!("animation in {}", file.path().display());
        Ok(BegunOutput { watcher: None, finish: Box::new(move |run| Ok(file.write(run).map(|()| told)?)) })
    }
}
