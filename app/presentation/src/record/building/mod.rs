//! A building in a recording: floor plan, temperatures, inputs, weather, and the cost of each day.
//!
//! Zones are numbered from 1 in the scenario's order, since their names may be any text:
//!
//! ```text
//! building/plan/{rooms,labels}                         the floor plan, coloured by temperature
//! building/zone/<n>/{temperature,reference,band/…}     what it is, what is wanted
//! building/zone/<n>/heat, building/limit/…             inputs and their limits
//! building/outdoors/{real,forecast}
//! building/iteration/{cost,optimum}                    one value a day
//! building/{learned,feedback,convergence,exchange}/…   what the controller says of its plans, see `design.rs`
//! ```

mod about;
mod design;
mod floor_plan;
mod layout;
mod series;

use interplay_scenarios::Scenario;
use rerun::{RecordingStream, RecordingStreamResult};

pub use about::about;
pub use layout::{TextPanels, layout};

use design::DesignPlots;
use floor_plan::FloorPlanLayer;
use interplay_simulation::frame::BuildingFrame;
use series::ZonePlots;

/// The timeline of days, from 1.
pub const ITERATION: &str = "iteration";

/// The most zones whose temperatures have a plot of their own.
const MAX_PLOTTED_ZONES: usize = 4;

/// What a recording must know of a building.
pub struct BuildingLayer {
    /// Names of the zones.
    pub names: Vec<String>,
    /// The zones that have plots, by number from 0.
    pub shown: Vec<usize>,
    /// How long the run is \[s\].
    duration_s: f64,
    /// Coldest and warmest of the zones that have plots \[°C\].
    range_c: Option<[f64; 2]>,
    plan: FloorPlanLayer,
    series: ZonePlots,
    plans: DesignPlots,
}

impl BuildingLayer {
    /// Logs what never changes; `None` without a building.
    ///
    /// # Errors
    /// If Rerun refuses a component.
    pub fn begin(stream: &RecordingStream, scenario: &Scenario) -> RecordingStreamResult<Option<BuildingLayer>> {
        // A scenario whose zones make no network is refused before it is run.
        let network = scenario.building.as_ref().and_then(|building| Some((building, building.network().ok()?)));
        let Some((building, network)) = network else { return Ok(None) };
        let names = network.names()[..network.zone_count()].to_vec();
        let shown = shown(names.len());
        let setpoints = scenario.setpoints.clone().unwrap_or_default();
        let plan = FloorPlanLayer::begin(stream, building.floor_plan(), &setpoints)?;
        let series = ZonePlots::begin(stream, &names, &shown, network.limits(), setpoints.band_k)?;
        let duration_s = building.step_s * (scenario.days() * building.steps_per_day()) as f64;
        let plans = DesignPlots::begin(stream, &names, &shown, scenario.controller().plans())?;
        Ok(Some(BuildingLayer { names, shown, duration_s, range_c: None, plan, series, plans }))
    }

    /// Logs one step.
    ///
    /// # Errors
    /// If Rerun refuses a component.
    pub fn step(&mut self, stream: &RecordingStream, frame: &BuildingFrame) -> RecordingStreamResult<()> {
        stream.set_time_sequence(ITERATION, i64::try_from(frame.day + 1).unwrap_or(i64::MAX));
        for &index in &self.shown {
            let now = &frame.zones[index];
            let [low_c, high_c] = self.range_c.unwrap_or([now.temperature_c; 2]);
            let wanted_c = now.reference_c.unwrap_or(now.temperature_c);
            self.range_c =
                Some([low_c.min(now.temperature_c).min(wanted_c), high_c.max(now.temperature_c).max(wanted_c)]);
        }
        self.plan.step(stream, &self.names, frame)?;
        self.plans.step(stream, &self.shown, frame)?;
        self.series.step(stream, &self.shown, frame)
    }
}

/// The zones that have plots: all of a few, otherwise some from the first to the last.
fn shown(zones: usize) -> Vec<usize> {
    if zones <= MAX_PLOTTED_ZONES {
        return (0..zones).collect();
    }
    (0..MAX_PLOTTED_ZONES).map(|index| index * (zones - 1) / (MAX_PLOTTED_ZONES - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn the_zones_with_plots_are_spread_over_all() {
        assert_eq!(shown(1), [0]);
        assert_eq!(shown(4), [0, 1, 2, 3]);
        assert_eq!(shown(5), [0, 1, 2, 4]);
        assert_eq!(shown(100), [0, 33, 66, 99]);
    }
}
