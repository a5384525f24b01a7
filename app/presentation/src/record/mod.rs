//! Recordings of runs, with a layout for the viewer. Only this module names Rerun.
//!
//! A recording has two timelines, simulated time (`SIM_TIME`) and ticks (`TICK`). It contains no wall-clock times, so that
//! recordings of one run can be compared. Entities have names, never numbers:
//!
//! ```text
//! world/{ground,road/{surface,edges,markings}}        static
//! world/vehicle/<name>/{body,trace}                   pose and past path; `body/…` are its solids and lights
//! world/vehicle/<name>/{plan,branches,prediction,proposal}     plan, its alternatives, predicted motion, requested motion
//! world/vehicle/<name>/safety                         the safety ellipse that the ego's centre keeps out of
//! world/camera/…                                      see `cameras.rs`
//! plots/{speed,acceleration,steering,planner-ms}/<name>
//! plots/<kind of planner>/<diagnostic>[/<name>]       as letters, digits, `-`; the name if several have that planner
//! plots/gap                                           the ego's distance to the nearest footprint
//! plots/reasons                                       why optimisers failed
//! status, log, about                                  actions of drivers; events; description of the recording
//! building/…                                          see `building/mod.rs`
//! ```

mod about;
mod blueprint;
mod building;
mod cameras;
mod car;
mod labels;
mod layout;
mod live;
mod mesh;
mod open_recording;
mod palette;
mod panels;
mod planner_panels;
mod plots;
mod road;
mod status;
#[cfg(test)]
mod tests;
mod vehicles;

use std::path::PathBuf;
use std::time::Duration;

use ::re_sdk_types;
use blueprint::LayoutNode;
use building::BuildingLayer;
use cameras::Cameras;
use interplay_scenarios::Scenario;
use rerun::log::ChunkBatcherConfig;
use rerun::sink::MemorySinkStorage;
use rerun::{RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

pub use live::Viewer;
pub use open_recording::{OpenRecording, RecordError, record_sweep_run};
use palette::NamedColour;
use plots::Plots;
use re_sdk_types::blueprint::components::PlayState;
use road::LightLayer;
use status::StatusLines;
use vehicles::VehicleLayer;

use crate::network_lines::expected_bounds_m;
use crate::requests::Requests;
use crate::shown_extent;

use interplay_simulation::frame::Frame;
use interplay_simulation::report::CounterfactualReport;
use interplay_simulation::watch::{WatchError, Watcher};

/// Name of the timeline of simulated time.
const SIM_TIME: &str = "sim_time";
/// Name of the timeline of ticks.
const TICK: &str = "tick";
/// The first bytes of every recording in a file.
pub const MAGIC: [u8; 3] = *b"RRF";

/// The version of the Rerun viewer that matches the recordings.
pub fn viewer_version() -> String {
    rerun::build_info().version.to_string()
}

/// The application id of the recordings, for which the viewer keeps one layout.
const APPLICATION_ID: &str = "interplay";
/// Playback speed of a building without vehicles, as a multiple of real time: three hours per second.
const BUILDING_PLAYBACK_SPEED: f64 = 3.0 * 3600.0;
/// Timeout for sending the rest of a recording to a viewer.
const FLUSH_TIMEOUT: Duration = Duration::from_secs(2);
/// Time after which an incomplete chunk is written to a file. It exceeds any run, so that only the size of chunks counts.
const FLUSH_INTERVAL: Duration = Duration::from_secs(24 * 3600);

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sink {
    /// A file, usually `*.rrd`, which is written when the recording is finished.
    File(PathBuf),
    Live(Viewer),
}

/// The result of logging to Rerun.
type Logged = RecordingStreamResult<()>;

struct RecordedTick<'a> {
    stream: &'a RecordingStream,
    scenario: &'a Scenario,
    vehicle_colours: &'a [NamedColour],
    frame: &'a Frame,
    requests: &'a Requests,
    /// For each vehicle whether its plans, numbers and words are logged.
    described: &'a [bool],
}

/// Records a run. Dropped unfinished, it leaves no file.
pub struct Recorder {
    stream: RecordingStream,
    output: Output,
    scenario: Scenario,
    vehicle_colours: Vec<NamedColour>,
    vehicles: VehicleLayer,
    lights: LightLayer,
    cameras: Cameras,
    status: StatusLines,
    requests: Requests,
    plots: Plots,
    building_layer: Option<BuildingLayer>,
    /// The command that repeats the run.
    command: Option<String>,
}

enum Output {
    /// The content in memory, and the path of its file.
    File { path: PathBuf, content: MemorySinkStorage },
    /// A viewer, and the number of series with which the layout was last sent.
    Live { series: usize },
}

impl Recorder {
    /// Begins a recording of `scenario`, called `name`, and logs its static content.
    ///
    /// # Errors
    /// [`RecordError::Unwritable`] or [`RecordError::NoViewer`], before anything is simulated.
    pub fn begin(scenario: &Scenario, name: &str, sink: &Sink) -> Result<Recorder, RecordError> {
        let builder = RecordingStreamBuilder::new(APPLICATION_ID).enabled(true);
        let (stream, output) = match sink {
            Sink::File(path) => {
                interplay_files::check(path).map_err(RecordError::unwritable(path))?;
                let pieces = ChunkBatcherConfig { flush_tick: FLUSH_INTERVAL, ..ChunkBatcherConfig::DEFAULT };
                let (stream, content) =
                    builder.recording_id(identity(scenario, name)).batcher_config(pieces).memory()?;
                (stream, Output::File { path: path.clone(), content })
            }
            Sink::Live(viewer) => {
                viewer.check_reachable()?;
                (builder.send_properties(false).connect_grpc_opts(viewer.to_string())?, Output::Live { series: 0 })
            }
        };
        stream.set_log_time_enabled(false);
        stream.set_log_tick_enabled(false);
        stream.send_recording_name(format!("{name}: {}", scenario.title))?;
        let vehicle_colours = palette::vehicle_colours(scenario);
        let has_vehicles = !scenario.vehicles.is_empty();
        let bounds_m = if has_vehicles { expected_bounds_m(scenario) } else { Default::default() };
        if has_vehicles {
            road::road(&stream, scenario, bounds_m)?;
        }
        about::about(&stream, scenario, &vehicle_colours, None, &[])?;
        let vehicles = VehicleLayer::begin(&stream, scenario, &vehicle_colours)?;
        let lights = LightLayer::begin(scenario);
        let has_strip = layout::has_strip(scenario, bounds_m);
        let cameras = Cameras::begin(&stream, scenario, &vehicle_colours, (has_strip, bounds_m))?;
        let plots = Plots::begin(&stream, scenario, &vehicle_colours)?;
        let building_layer = BuildingLayer::begin(&stream, scenario)?;
        let (scenario, status, requests) = (scenario.clone(), StatusLines::default(), Requests::default());
        Ok(Recorder {
            stream,
            output,
            scenario,
            vehicle_colours,
            vehicles,
            lights,
            cameras,
            status,
            requests,
            plots,
            building_layer,
            command: None,
        })
    }

    /// Adds the command that repeats the run to the text of the recording.
    ///
    /// # Errors
    /// [`RecordError::Broken`] if Rerun refuses the text.
    pub fn set_command(&mut self, command: &str) -> Result<(), RecordError> {
        self.command = Some(command.to_owned());
        self.describe(&[])
    }

    /// Logs the text of the recording with the outcomes of the counterfactuals.
    fn describe(&self, counterfactuals: &[CounterfactualReport]) -> Result<(), RecordError> {
        let command = self.command.as_deref();
        Ok(about::about(&self.stream, &self.scenario, &self.vehicle_colours, command, counterfactuals)?)
    }

    /// Records one tick.
    ///
    /// # Errors
    /// [`RecordError::Broken`] if Rerun refuses the data.
    pub fn log_frame(&mut self, frame: &Frame) -> Result<(), RecordError> {
        self.stream.set_duration_secs(SIM_TIME, frame.time_s);
        self.stream.set_time_sequence(TICK, i64::try_from(frame.tick).unwrap_or(i64::MAX));
        self.requests.observe(&self.scenario, frame);
        let tick = RecordedTick {
            stream: &self.stream,
            scenario: &self.scenario,
            vehicle_colours: &self.vehicle_colours,
            frame,
            requests: &self.requests,
            described: &shown_extent::described(&self.scenario, frame),
        };
        self.vehicles.log_frame(&tick)?;
        self.lights.log_frame(&tick)?;
        self.status.log_frame(&tick)?;
        self.plots.log_frame(&tick)?;
        if let (Some(building_layer), Some(frame)) = (&mut self.building_layer, &frame.building) {
            building_layer.step(&self.stream, frame)?;
        }
        self.cameras.store(&self.scenario, frame);
        let count = self.plots.series_count();
        if let Output::Live { series } = &mut self.output {
            let is_new = std::mem::replace(series, count) != count;
            self.cameras.log_last(&self.stream, &self.scenario)?;
            if is_new {
                self.send_layout()?;
            }
        }
        Ok(())
    }

    /// Finishes the recording and writes its file.
    ///
    /// # Errors
    /// [`RecordError::Unwritable`] if the disk refuses the file, [`RecordError::Broken`] if the viewer is gone.
    pub fn finish(mut self) -> Result<(), RecordError> {
        self.plots.end();
        if let Some(building_layer) = &mut self.building_layer {
            building_layer.end();
        }
        if matches!(self.output, Output::File { .. }) {
            self.cameras.log_all(&self.stream, &self.scenario)?;
        }
        self.send_layout()?;
        match &self.output {
            Output::File { path, content } => {
                let content = content.drain_as_bytes().map_err(|error| RecordError::Broken(Box::new(error)))?;
                interplay_files::write(path, &content).map_err(RecordError::unwritable(path))
            }
            Output::Live { .. } => {
                self.stream.flush_with_timeout(FLUSH_TIMEOUT).map_err(|error| RecordError::Broken(Box::new(error)))
            }
        }
    }

    /// Sends the layout of the viewer.
    fn send_layout(&self) -> Result<(), RecordError> {
        let has_vehicles = !self.scenario.vehicles.is_empty();
        let words = match (has_vehicles, self.plots.has(plots::BUILDING_LOG)) {
            (true, true) => building::TextPanels::Events,
            (true, false) => building::TextPanels::None,
            (false, true) => building::TextPanels::AboutAndEvents,
            (false, false) => building::TextPanels::About,
        };
        let mut tabs = Vec::new();
        if has_vehicles {
            tabs.extend(layout::tabs(&self.scenario, &self.plots, &self.cameras));
        }
        if let Some(building_layer) = &self.building_layer {
            tabs.extend(building::tabs(building_layer, words));
        }
        let panel = LayoutNode::Tabs(tabs);
        let speed = if self.scenario.vehicles.is_empty() { BUILDING_PLAYBACK_SPEED } else { 1.0 };
        let play = match self.output {
            Output::File { .. } => PlayState::Playing,
            Output::Live { .. } => PlayState::Following,
        };
        Ok(blueprint::send(&self.stream, APPLICATION_ID, &panel, (play, speed))?)
    }
}

impl Watcher for Recorder {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        Ok(self.log_frame(frame)?)
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(Recorder::finish(*self)?)
    }
}

/// The name of the recording, which distinguishes runs of one scenario with different drivers.
fn identity(scenario: &Scenario, name: &str) -> String {
    let mut drivers: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.driver.kind()).collect();
    let controller = scenario.controller();
    drivers.extend(scenario.building.is_some().then(|| controller.kind()));
    format!("{name} ({}; seed {})", drivers.join(", "), scenario.seed)
}
