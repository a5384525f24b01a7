//! Recordings of runs, with a layout for the viewer. Only this module names Rerun.
//!
//! A recording has two timelines, simulated time ([`SIM_TIME`]) and ticks ([`TICK`]), and no clock of the wall, so
//! that two recordings of one run can be compared. Entities have names, never numbers:
//!
//! ```text
//! world/{ground,road/{surface,edges,markings}}        static
//! world/vehicle/<name>/{body,trace}                   where it is and was; `body/…` are its solids and lights
//! world/vehicle/<name>/{plan,branches,prediction,proposal}     what it will do or may do instead, is expected to do, asks of another
//! world/vehicle/<name>/safety                         where the ego keeps out
//! world/camera/…                                      see `cameras.rs`
//! plots/{speed,acceleration,steering,planner-ms}/<name>
//! plots/<kind of planner>/<diagnostic>[/<name>]       as letters, digits, `-`; the name if several have that planner
//! plots/gap                                           the ego's distance to the nearest footprint
//! plots/reasons                                       why optimisers found nothing
//! status, log, about                                  what each driver does; events; what the recording shows
//! building/…                                          see `building/mod.rs`
//! ```

mod about;
mod again;
mod blueprint;
mod building;
mod cameras;
mod car;
mod crowd;
mod error;
mod labels;
mod layout;
mod lights;
mod live;
mod markdown;
mod mesh;
mod open;
mod palette;
mod panels;
mod planner_panels;
mod plots;
mod road;
mod status;
#[cfg(test)]
mod tests;
mod time_plot;
mod timelines;
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
use rerun::{RecordingStream, RecordingStreamBuilder};

pub use again::record_again;
pub use error::{RecordError, ViewerAddressError};
use lights::LightLayer;
pub use live::Viewer;
pub use open::OpenRecording;
use palette::NamedColour;
use plots::Plots;
use re_sdk_types::blueprint::components::PlayState;
use status::StatusLines;
pub use timelines::{SIM_TIME, TICK};
use vehicles::VehicleLayer;

use crate::answer::Requests;
use crate::network_lines::expected_bounds_m;

use interplay_simulation::frame::Frame;
use interplay_simulation::report::CounterfactualReport;
use interplay_simulation::watch::{WatchError, Watcher};

/// The first bytes of every recording in a file.
pub const MAGIC: [u8; 3] = *b"RRF";

/// The version of the viewer that is sure to show what is recorded here.
pub fn viewer_version() -> String {
    rerun::build_info().version.to_string()
}

/// What the viewer calls the sort of recording; it keeps one layout for each.
const APPLICATION_ID: &str = "interplay";
/// How much faster than real time a building without vehicles is played: three hours a second.
const BUILDING_PLAYBACK_SPEED: f64 = 3.0 * 3600.0;
/// The time that a viewer has to receive the rest of a recording.
const FLUSH_TIMEOUT: Duration = Duration::from_secs(2);
/// Time after which a small piece of a recording is written into a file. It exceeds any run, so that only size counts.
const FLUSH_INTERVAL: Duration = Duration::from_secs(24 * 3600);

/// Where a recording goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sink {
    /// Into a file, usually `*.rrd`, which appears when the recording is finished.
    File(PathBuf),
    /// To a viewer that is running.
    Live(Viewer),
}

/// A recording in the making. Dropped unfinished, it leaves no file.
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
    /// What a reader types to get the run again.
    command: Option<String>,
}

enum Output {
    /// Everything in memory, and where it goes in the end.
    File { path: PathBuf, content: MemorySinkStorage },
    /// To a viewer; with how many series the layout was last sent.
    Live { series: usize },
}

impl Recorder {
    /// Begins a recording of `scenario`, known as `name`, with all that never changes.
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
                viewer.find()?;
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

    /// Adds to the text of the recording what a reader types to get the run again.
    ///
    /// # Errors
    /// [`RecordError::Broken`] if Rerun refuses the text.
    pub fn repeat_with(&mut self, command: &str) -> Result<(), RecordError> {
        self.command = Some(command.to_owned());
        self.describe(&[])
    }

    /// Writes the text of the recording anew, with what became of the counterfactuals.
    fn describe(&self, counterfactuals: &[CounterfactualReport]) -> Result<(), RecordError> {
        let command = self.command.as_deref();
        Ok(about::about(&self.stream, &self.scenario, &self.vehicle_colours, command, counterfactuals)?)
    }

    /// Records one tick.
    ///
    /// # Errors
    /// [`RecordError::Broken`] if Rerun refuses the data.
    pub fn tick(&mut self, frame: &Frame) -> Result<(), RecordError> {
        self.stream.set_duration_secs(SIM_TIME, frame.time_s);
        self.stream.set_time_sequence(TICK, i64::try_from(frame.tick).unwrap_or(i64::MAX));
        self.requests.tick(&self.scenario, frame);
        let told = crowd::told(&self.scenario, frame);
        self.vehicles.tick(&self.stream, (&self.scenario, &told), frame, &self.requests)?;
        self.lights.tick(&self.stream, frame.time_s)?;
        self.status.tick(&self.stream, (&self.scenario, &self.vehicle_colours, &told), frame, &self.requests)?;
        self.plots.tick(&self.stream, (&self.scenario, &told), frame)?;
        if let (Some(building_layer), Some(frame)) = (&mut self.building_layer, &frame.building) {
            building_layer.step(&self.stream, frame)?;
        }
        self.cameras.note(&self.scenario, frame);
        let count = self.plots.seen_count();
        if let Output::Live { series } = &mut self.output {
            let is_new = std::mem::replace(series, count) != count;
            self.cameras.log_last(&self.stream, &self.scenario)?;
            if is_new {
                self.arrange()?;
            }
        }
        Ok(())
    }

    /// Ends the recording: only now a file appears at its place.
    ///
    /// # Errors
    /// [`RecordError::Unwritable`] if the disk refuses the file, [`RecordError::Broken`] if the viewer went away.
    pub fn finish(mut self) -> Result<(), RecordError> {
        self.plots.end();
        if let Some(building_layer) = &mut self.building_layer {
            building_layer.end();
        }
        if matches!(self.output, Output::File { .. }) {
            self.cameras.log_all(&self.stream, &self.scenario)?;
        }
        self.arrange()?;
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

    /// Sends the layout: a tab for each clock, and for what is only looked up.
    fn arrange(&self) -> Result<(), RecordError> {
        let has_vehicles = !self.scenario.vehicles.is_empty();
        let words = match (has_vehicles, self.plots.has(plots::BUILDING_LOG)) {
            (true, true) => building::TextPanels::Events,
            (true, false) => building::TextPanels::Elsewhere,
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
        Ok(Recorder::tick(self, frame)?)
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
