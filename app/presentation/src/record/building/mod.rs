//! A building in a recording: floor plan, temperatures, inputs, weather, and the cost of each day.
//!
//! Zones are numbered from 1 in the scenario's order, since their names may be any text:
//!
//! ```text
//! building/plan/{rooms,labels}                         the floor plan, coloured by temperature
//! building/zone/<n>/{temperature,reference,band/…}     actual and wanted temperature
//! building/zone/<n>/heat, building/limit/…             inputs and their limits
//! building/group/<g>                                   of many zones: the temperatures of some of them
//! building/outdoors/{real,forecast}
//! building/iteration/{cost,optimum}                    one value a day
//! building/{learned,feedback,convergence,exchange}/…   designs of the controller, see `design.rs`
//! ```

mod design;
mod floor_plan;
mod layout;
mod series;

use interplay_scenarios::Scenario;
use rerun::{RecordingStream, RecordingStreamResult};

use super::Logged;

pub use layout::{TextPanels, tabs};

use design::DesignPlots;
use floor_plan::FloorPlanLayer;
use interplay_simulation::frame::BuildingFrame;
use series::ZonePlots;

use crate::palette::usual_wanted_c;

/// The timeline of days, from 1.
pub const ITERATION: &str = "iteration";

/// Most zones that are recorded in full.
const MAX_SHOWN_ZONES: usize = 16;
/// Most groups of zones, each with one plot.
const MAX_GROUPS: usize = 12;

pub struct BuildingLayer {
    pub names: Vec<String>,
    /// Indices of the zones that are recorded in full: all, or some of many.
    pub shown: Vec<usize>,
    /// All zones in groups, if there are many.
    groups: Vec<Vec<usize>>,
    /// Duration of the run \[s\].
    duration_s: f64,
    ranges: TemperatureRanges,
    plan: FloorPlanLayer,
    series: ZonePlots,
    plans: DesignPlots,
}

impl BuildingLayer {
    /// Logs the static content; `None` without a building.
    pub fn begin(stream: &RecordingStream, scenario: &Scenario) -> RecordingStreamResult<Option<BuildingLayer>> {
        // A scenario with an invalid network is refused before it is run.
        let network = scenario.building.as_ref().and_then(|building| Some((building, building.network().ok()?)));
        let Some((building, network)) = network else { return Ok(None) };
        let names = network.names()[..network.zone_count()].to_vec();
        let shown = shown(names.len());
        let groups = groups(names.len(), building.floor_plan().columns);
        let setpoints = scenario.setpoints.clone().unwrap_or_default();
        series::begin_groups(stream, &names, &groups)?;
        let plan = FloorPlanLayer::begin(stream, building.floor_plan(), usual_wanted_c(scenario, &names))?;
        let series = ZonePlots::begin(stream, &names, &shown, network.limits(), setpoints.band_k)?;
        let duration_s = building.step_s * (scenario.days() * building.steps_per_day()) as f64;
        let plans = DesignPlots::begin(stream, &names, &shown, scenario.controller().plans())?;
        Ok(Some(BuildingLayer {
            names,
            shown,
            groups,
            duration_s,
            ranges: TemperatureRanges::default(),
            plan,
            series,
            plans,
        }))
    }

    /// Marks the run as finished, so that ranges are final.
    pub fn end(&mut self) {
        self.ranges.are_final = true;
    }

    pub fn step(&mut self, stream: &RecordingStream, frame: &BuildingFrame) -> Logged {
        stream.set_time_sequence(ITERATION, i64::try_from(frame.day + 1).unwrap_or(i64::MAX));
        self.ranges.widen(frame);
        self.plan.step(stream, &self.names, frame)?;
        self.plans.step(stream, &self.shown, frame)?;
        series::step_groups(stream, &self.groups, frame)?;
        self.series.step(stream, &self.shown, frame)
    }
}

/// Coldest and warmest temperatures so far.
#[derive(Default)]
struct TemperatureRanges {
    /// Of all zones, wanted temperatures included \[°C\].
    all_c: Option<[f64; 2]>,
    /// Of each zone \[°C\].
    zones_c: Vec<[f64; 2]>,
    /// Outdoors \[°C\].
    outdoors_c: Option<[f64; 2]>,
    /// Whether the run is finished, so that ranges are final.
    are_final: bool,
}

impl TemperatureRanges {
    fn widen(&mut self, frame: &BuildingFrame) {
        let widened = |range: [f64; 2], value: f64| [range[0].min(value), range[1].max(value)];
        self.outdoors_c = Some(widened(self.outdoors_c.unwrap_or([frame.ambient_c; 2]), frame.ambient_c));
        if self.zones_c.is_empty() {
            self.zones_c = frame.zones.iter().map(|now| [now.temperature_c; 2]).collect();
        }
        for (range, now) in self.zones_c.iter_mut().zip(&frame.zones) {
            *range = widened(*range, now.temperature_c);
            let all_c = widened(self.all_c.unwrap_or([now.temperature_c; 2]), now.temperature_c);
            self.all_c = Some(widened(all_c, now.reference_c.unwrap_or(now.temperature_c)));
        }
    }

    /// Of some zones, once it is known \[°C\].
    fn spanning(&self, zones: &[usize]) -> Option<[f64; 2]> {
        let ranges = zones.iter().filter_map(|zone| self.zones_c.get(*zone).copied()).filter(|_| self.are_final);
        ranges.reduce(|[low, high], [l, h]| [low.min(l), high.max(h)])
    }

    /// Of all zones, once it is known \[°C\].
    fn all(&self) -> Option<[f64; 2]> {
        self.all_c.filter(|_| self.are_final)
    }

    /// Outdoors, once it is known \[°C\].
    fn outdoors(&self) -> Option<[f64; 2]> {
        self.outdoors_c.filter(|_| self.are_final)
    }
}

/// The zones that are recorded in full: all of a few, otherwise four from the first to the last.
fn shown(zones: usize) -> Vec<usize> {
    if zones <= MAX_SHOWN_ZONES {
        return (0..zones).collect();
    }
    (0..4).map(|index| index * (zones - 1) / 3).collect()
}

/// Groups of zones, each of whole rows of the floor plan; empty for a few zones.
fn groups(zones: usize, columns: usize) -> Vec<Vec<usize>> {
    if zones <= MAX_SHOWN_ZONES {
        return Vec::new();
    }
    let columns = columns.max(1);
    let rows = zones.div_ceil(columns).div_ceil(MAX_GROUPS);
    (0..zones).collect::<Vec<_>>().chunks(rows * columns).map(<[usize]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::{groups, shown};

    #[test]
    fn every_zone_is_recorded_individually_or_in_a_group() {
        assert_eq!(shown(16).len(), 16);
        assert!(groups(16, 4).is_empty());
        assert_eq!(shown(100), [0, 33, 66, 99]);
        for (zones, columns) in [(17, 5), (100, 10), (1000, 10), (23, 23)] {
            let groups = groups(zones, columns);
            assert!(groups.len() <= 12, "{zones}");
            assert_eq!(groups.concat(), (0..zones).collect::<Vec<_>>());
        }
    }
}
