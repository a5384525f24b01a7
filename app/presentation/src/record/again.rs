//! Runs of a sweep that are worth looking at, recorded.

use std::path::Path;

use interplay_scenarios::Scenario;
use interplay_simulation::run::run;
use interplay_sweep::SweepRow;

use super::{OpenRecording, Recorder, Sink};

/// Makes a run of a sweep again, which gives the same, and records it as `recordings/KEY.rrd` in a folder. A run without a result has no
/// recording.
///
/// # Errors
/// Why there is no recording, in words.
pub fn record_again(folder: &Path, row: &SweepRow, scenario: &Scenario) -> Result<(), String> {
    if row.error.is_some() {
        return Ok(());
    }
    let path = folder.join("recordings").join(format!("{}.rrd", row.key));
    let recorder = Recorder::begin(scenario, &row.scenario, &Sink::File(path)).map_err(|error| error.to_string())?;
    let recording = OpenRecording::new(recorder);
    let report = run(&row.scenario, scenario, vec![Box::new(recording.clone())]).map_err(|error| error.to_string())?;
    recording.close(&report).map_err(|error| error.to_string())
}
