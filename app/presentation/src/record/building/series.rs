//! Plots of temperatures, heat, weather and cost of a building.

use interplay_building::network::PowerLimits;
use interplay_simulation::frame::BuildingFrame;
use rerun::{RecordingStream, RecordingStreamResult};

use super::super::Logged;
use super::super::palette::{self, FAILURE, MARKING, NEUTRAL};
use super::super::re_sdk_types::archetypes::{Clear, Scalars, SeriesLines};
use super::super::re_sdk_types::components::{Color, InterpolationMode};

pub struct ZonePlots {
    /// The comfort band of zones without a schedule \[K\].
    band_k: f64,
    /// The largest cooling and heating power of any zone that is shown \[kW\].
    limits_kw: [f64; 2],
    /// Whether each shown zone had a wanted temperature at the last step.
    wanted: Vec<bool>,
}

/// The path of a quantity of a zone.
fn zone(index: usize, what: &str) -> String {
    format!("building/zone/{}/{what}", index + 1)
}

impl ZonePlots {
    pub fn begin(
        stream: &RecordingStream,
        names: &[String],
        shown: &[usize],
        limits: &PowerLimits,
        band_k: f64,
    ) -> RecordingStreamResult<ZonePlots> {
        for (place, &index) in shown.iter().enumerate() {
            let series_colour = palette::zone(place);
            style(stream, &zone(index, "temperature"), "temperature", series_colour.solid(), 2.0)?;
            style(stream, &zone(index, "reference"), "wanted", NEUTRAL.solid(), 1.5)?;
            style(stream, &zone(index, "band/low"), "comfort, low", MARKING.translucent(150), 1.0)?;
            style(stream, &zone(index, "band/high"), "comfort, high", MARKING.translucent(150), 1.0)?;
            style(stream, &zone(index, "heat"), &names[index], series_colour.solid(), 1.5)?;
        }
        for (end, name) in [("low", "limit, cooling"), ("high", "limit, heating")] {
            style(stream, &format!("building/limit/{end}"), name, FAILURE.solid(), 1.0)?;
        }
        let (real, forecast) = (palette::series(1), palette::series(2));
        style(stream, "building/outdoors/real", "real", real.solid(), 2.0)?;
        style(stream, "building/outdoors/forecast", "forecast", forecast.solid(), 1.5)?;
        style(stream, "building/iteration/cost", "cost of the day", palette::series(1).solid(), 2.0)?;
        style(stream, "building/iteration/optimum", "cheapest possible", palette::series(0).solid(), 1.5)?;
        let largest = |kw: &[f64]| shown.iter().map(|&index| kw[index]).fold(0.0, f64::max);
        let limits_kw = [&limits.cooling_kw, &limits.heating_kw].map(|kw| largest(kw));
        Ok(ZonePlots { band_k, limits_kw, wanted: vec![false; shown.len()] })
    }

    pub fn step(&mut self, stream: &RecordingStream, shown: &[usize], frame: &BuildingFrame) -> Logged {
        let log = |path: &str, value: f64| stream.log(path, &Scalars::single(value));
        for (place, &index) in shown.iter().enumerate() {
            let now = &frame.zones[index];
            log(&zone(index, "temperature"), now.temperature_c)?;
            log(&zone(index, "heat"), now.heat_kw)?;
            let band_k = now.band_k.unwrap_or(self.band_k);
            let lines = [("reference", 0.0), ("band/low", -band_k), ("band/high", band_k)];
            for (what, beside_k) in lines {
                match now.reference_c {
                    Some(wanted_c) => log(&zone(index, what), wanted_c + beside_k)?,
                    None if self.wanted[place] => stream.log(zone(index, what), &Clear::flat())?,
                    None => {}
                }
            }
            self.wanted[place] = now.reference_c.is_some();
        }
        log("building/limit/low", -self.limits_kw[0])?;
        log("building/limit/high", self.limits_kw[1])?;
        log("building/outdoors/real", frame.ambient_c)?;
        log("building/outdoors/forecast", frame.forecast_c)?;
        if let Some(day) = &frame.figures {
            log("building/iteration/cost", day.figures.cost)?;
            if let Some(regret) = day.regret {
                log("building/iteration/optimum", day.figures.cost - regret)?;
            }
        }
        Ok(())
    }
}

/// The path of the temperatures of a group of zones.
pub fn group(number: usize) -> String {
    format!("building/group/{}", number + 1)
}

/// Logs the names and colours of the zones of each group.
pub fn begin_groups(stream: &RecordingStream, names: &[String], groups: &[Vec<usize>]) -> Logged {
    for (number, zones) in groups.iter().enumerate() {
        let lines = SeriesLines::new()
            .with_names(zones.iter().map(|zone| names[*zone].as_str()))
            .with_colors((0..zones.len()).map(|place| palette::zone(place).solid()))
            .with_widths(vec![1.0; zones.len()]);
        stream.log_static(group(number), &lines.with_interpolation_mode(InterpolationMode::StepAfter))?;
    }
    Ok(())
}

/// Logs the temperatures of each group.
pub fn step_groups(stream: &RecordingStream, groups: &[Vec<usize>], frame: &BuildingFrame) -> Logged {
    for (number, zones) in groups.iter().enumerate() {
        let temperatures: Vec<f64> = zones.iter().map(|zone| frame.zones[*zone].temperature_c).collect();
        stream.log(group(number), &Scalars::new(temperatures))?;
    }
    Ok(())
}

/// Logs the name and the style of a series.
pub fn style(stream: &RecordingStream, path: &str, name: &str, colour: Color, width: f32) -> Logged {
    let line = SeriesLines::new().with_names([name]).with_colors([colour]).with_widths([width]);
    stream.log_static(path, &line.with_interpolation_mode(InterpolationMode::StepAfter))
}
