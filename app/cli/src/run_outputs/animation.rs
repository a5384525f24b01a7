//! `run --animate`

use std::path::Path;

use interplay_presentation::animation::AnimationFile;
use interplay_scenarios::Scenario;

use super::{BegunOutput, OutputError, RunOutput};

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
