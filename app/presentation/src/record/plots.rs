//! Plots of speeds, inputs, planner diagnostics, gaps and computing times; and the log of events.

use std::collections::BTreeMap;

use interplay_planners::plan::diagnostic::{DiagnosticQuantity, Explanation};
use interplay_planners::{Diagnostic, PlanEventKind};
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::{Frame, Level, Origin, VehicleFrame};
use rerun::{RecordingStream, RecordingStreamResult};

use super::palette::{self, FAILURE, NEUTRAL, NamedColour};
use super::planner_panels::{place, slug};
use super::re_sdk_types::archetypes::{Scalars, SeriesLines, TextLog};
use super::re_sdk_types::components::{Color, InterpolationMode, TextLogLevel};
use super::{Logged, RecordedTick};
use crate::passing_words::event_text;

/// Path of the events of all vehicles.
pub const LOG: &str = "log";
/// Path of the events of a building and its controller, which have another clock.
pub const BUILDING_LOG: &str = "building/log";
/// Path of the reasons of failed optimisations.
pub const REASONS: &str = "plots/reasons";
/// Path of the smallest distance of the ego to another vehicle.
pub const GAP: &str = "plots/gap";
/// A quantity of every vehicle: its folder below `plots`, and its value.
type Quantity = (&'static str, fn(&VehicleFrame) -> f64);
const QUANTITIES: [Quantity; 4] = [
    ("speed", |vehicle| vehicle.state.speed_mps),
    ("acceleration", |vehicle| vehicle.input.acceleration_mps2),
    ("steering", |vehicle| vehicle.input.steering_rad),
    ("planner-ms", |vehicle| vehicle.plan_ms),
];

/// Paths of the diagnostics of a planner.
struct PlannerPaths {
    /// The folder of all planners of its kind.
    folder: String,
    /// The end of the paths: empty, or the name of the vehicle if several have this kind of planner.
    end: String,
    explanation: &'static Explanation,
}

pub struct Plots {
    /// The paths of each planner, in the scenario's order of vehicles.
    planners: Vec<PlannerPaths>,
    /// The optional series so far, each with its name in legends.
    seen: BTreeMap<String, String>,
    /// Least and greatest speed so far \[m/s\].
    speeds_mps: Option<[f64; 2]>,
    /// Smallest and largest gap of the ego so far \[m\].
    gaps_m: Option<[f64; 2]>,
    /// Whether the run is finished, so that ranges are final.
    is_over: bool,
}

impl Plots {
    /// Logs the names and colours of the series that every vehicle has.
    pub fn begin(
        stream: &RecordingStream,
        scenario: &Scenario,
        vehicle_colours: &[NamedColour],
    ) -> RecordingStreamResult<Plots> {
        let kind = |index: usize| scenario.vehicles[index].driver.kind();
        let mut planners = Vec::new();
        for (index, (vehicle, vehicle_colour)) in scenario.vehicles.iter().zip(vehicle_colours).enumerate() {
            for (quantity, _) in QUANTITIES.iter().filter(|_| vehicle.obstacle.is_none()) {
                let path = format!("plots/{quantity}/{}", vehicle.name);
                style(stream, &path, &vehicle.name, vehicle_colour.solid(), false)?;
            }
            let alone = (0..scenario.vehicles.len()).all(|other| other == index || kind(other) != kind(index));
            let end = if alone { String::new() } else { format!("/{}", vehicle.name) };
            let folder = format!("plots/{}", kind(index));
            planners.push(PlannerPaths { folder, end, explanation: vehicle.driver.explanation() });
        }
        style(stream, GAP, "gap", NEUTRAL.solid(), false)?;
        Ok(Plots { planners, seen: BTreeMap::new(), speeds_mps: None, gaps_m: None, is_over: false })
    }

    pub fn has(&self, path: &str) -> bool {
        self.seen.contains_key(path)
    }

    /// Least and greatest speed of a finished run \[m/s\].
    pub fn speeds_mps(&self) -> Option<[f64; 2]> {
        self.speeds_mps.filter(|_| self.is_over)
    }

    /// Marks the run as finished, so that ranges are final.
    pub fn end(&mut self) {
        self.is_over = true;
    }

    /// Smallest and largest gap of the ego in a finished run \[m\].
    pub fn gaps_m(&self) -> Option<[f64; 2]> {
        self.gaps_m.filter(|_| self.is_over)
    }

    /// The paths of the recorded series of these quantities, of one kind of planner or of all.
    pub fn paths_of(&self, kind: Option<&str>, quantities: &[DiagnosticQuantity]) -> Vec<String> {
        let slugs: Vec<String> = quantities.iter().map(slug).collect();
        let mine = |path: &&String| {
            let mut parts = path.split('/').skip(1);
            let (folder, name) = (parts.next(), parts.next());
            kind.is_none_or(|kind| folder == Some(kind))
                && name.is_some_and(|name| slugs.iter().any(|slug| slug == name))
        };
        self.seen.keys().filter(mine).map(|path| format!("/{path}")).collect()
    }

    /// Number of optional series so far.
    pub fn series_count(&self) -> usize {
        self.seen.len()
    }

    /// Number of letters of the longest name of some series.
    pub fn longest_label(&self, series: &[String]) -> usize {
        let label =
            |path: &String| self.seen.get(path.trim_start_matches('/')).map_or(0, |label| label.chars().count());
        series.iter().map(label).max().unwrap_or(0)
    }

    pub fn log_frame(&mut self, tick: &RecordedTick) -> Logged {
        let RecordedTick { stream, scenario, frame, described, .. } = *tick;
        let drives = |(vehicle, stated): &(&VehicleFrame, &Vehicle)| !vehicle.is_absent && stated.obstacle.is_none();
        let driven = frame.vehicles.iter().zip(&scenario.vehicles).zip(described);
        for ((vehicle, _), _) in driven.filter(|(pair, is_described)| **is_described && drives(pair)) {
            let speed_mps = vehicle.state.speed_mps;
            let [low, high] = self.speeds_mps.unwrap_or([speed_mps; 2]);
            self.speeds_mps = Some([low.min(speed_mps), high.max(speed_mps)]);
            for (quantity, value) in QUANTITIES {
                stream.log(format!("plots/{quantity}/{}", vehicle.name), &Scalars::single(value(vehicle)))?;
            }
        }
        if let Some(gap) = frame.gap_m {
            self.seen.insert(GAP.to_owned(), String::new());
            let least_m = frame.smallest_gap_m.unwrap_or(gap).min(gap);
            let [low, high] = self.gaps_m.unwrap_or([least_m, gap]);
            self.gaps_m = Some([low.min(least_m), high.max(gap)]);
            stream.log(GAP, &Scalars::single(gap))?;
        }
        self.log_diagnostics(tick)?;
        self.log_failures(tick)?;
        self.log_events(tick)
    }

    fn log_diagnostics(&mut self, tick: &RecordedTick) -> Logged {
        let RecordedTick { stream, frame, described, .. } = *tick;
        let all = frame.vehicles.iter().zip(&self.planners).zip(described);
        let present =
            all.filter(|((vehicle, _), is_described)| **is_described && !vehicle.is_absent).map(|(pair, _)| pair);
        for (vehicle, PlannerPaths { folder, end, explanation }) in present {
            for Diagnostic { quantity, value } in &vehicle.plan.diagnostics {
                let path = format!("{folder}/{}{end}", slug(quantity));
                if !self.seen.contains_key(&path) {
                    let name = quantity.name;
                    let label = if end.is_empty() { name.to_owned() } else { format!("{name}, {}", vehicle.name) };
                    let series_colour = palette::series(place(explanation, quantity).unwrap_or_default());
                    style(stream, &path, &label, series_colour.solid(), quantity.is_switch())?;
                    self.seen.insert(path.clone(), label);
                }
                stream.log(path, &Scalars::single(*value))?;
            }
        }
        Ok(())
    }

    fn log_events(&mut self, tick: &RecordedTick) -> Logged {
        let RecordedTick { stream, scenario, frame, .. } = *tick;
        for event in &frame.events {
            let Some(text) = event_text(scenario, frame, event) else { continue };
            let path = if is_vehicle(frame, &event.vehicle) { LOG } else { BUILDING_LOG };
            self.log_text(stream, path, event.level, &event_line(frame, &event.vehicle, &text))?;
        }
        for vehicle in &frame.vehicles {
            let is_logged =
                frame.events.iter().any(|event| event.vehicle == vehicle.name && event.level != Level::Note);
            let fallback = match vehicle.origin {
                Origin::Planned | Origin::Crashed => continue,
                Origin::Continued => "no plan: the previous one continues",
                Origin::Braking => "no plan: full braking",
                Origin::Evading => "no plan: evading",
            };
            if !is_logged {
                self.log_text(stream, LOG, Level::Warning, &event_line(frame, &vehicle.name, fallback))?;
            }
        }
        Ok(())
    }

    /// Logs why optimisers failed, in their own terms, for the tab of the planners.
    fn log_failures(&mut self, tick: &RecordedTick) -> Logged {
        let RecordedTick { stream, frame, .. } = *tick;
        for vehicle in &frame.vehicles {
            for event in &vehicle.plan.events {
                if let PlanEventKind::NoProposal(reason) | PlanEventKind::Fallback(reason) = &event.kind {
                    let text = event_line(frame, &vehicle.name, &format!("{}: {reason}", event.text));
                    self.seen.insert(REASONS.to_owned(), String::new());
                    stream.log(REASONS, &TextLog::new(text).with_level(TextLogLevel::INFO))?;
                }
            }
        }
        Ok(())
    }

    fn log_text(&mut self, stream: &RecordingStream, path: &str, level: Level, text: &str) -> Logged {
        let (level, colour) = match level {
            Level::Note => (TextLogLevel::INFO, NEUTRAL),
            Level::Warning => (TextLogLevel::WARN, FAILURE),
            Level::Alarm => (TextLogLevel::ERROR, FAILURE),
        };
        self.seen.insert(path.to_owned(), String::new());
        stream.log(path, &TextLog::new(text).with_level(level).with_color(colour.solid()))
    }
}

/// A line of the log: time, vehicle or controller, and event. Texts of buildings that begin with their day stay unchanged.
fn event_line(frame: &Frame, source: &str, what: &str) -> String {
    match (is_vehicle(frame, source), what.starts_with("day ")) {
        (true, _) => format!("{:.1} s   {source}: {what}", frame.time_s),
        (false, true) => what.to_owned(),
        (false, false) => format!("{}   {source}: {what}", clock(frame.time_s)),
    }
}

fn is_vehicle(frame: &Frame, name: &str) -> bool {
    frame.vehicles.iter().any(|vehicle| vehicle.name == name)
}

/// A time as a day, counted from 1, and a time of day.
fn clock(time_s: f64) -> String {
    let minutes = (time_s / 60.0).round() as u64;
    format!("day {} {:02}:{:02}", minutes / (24 * 60) + 1, minutes / 60 % 24, minutes % 60)
}

fn style(stream: &RecordingStream, path: &str, name: &str, colour: Color, steps: bool) -> Logged {
    let how = if steps { InterpolationMode::StepAfter } else { InterpolationMode::Linear };
    let line = SeriesLines::new().with_names([name]).with_colors([colour]).with_widths([2.0]);
    stream.log_static(path, &line.with_interpolation_mode(how))
}

#[cfg(test)]
mod tests {
    use super::clock;

    #[test]
    fn a_time_is_written_as_day_and_time_of_day() {
        assert_eq!(clock(0.0), "day 1 00:00");
        assert_eq!(clock(27_000.0), "day 1 07:30");
        assert_eq!(clock(86_400.0 + 3600.0), "day 2 01:00");
    }
}
