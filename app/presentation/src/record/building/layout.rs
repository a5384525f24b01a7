//! Which panels a building opens with.

use super::super::re_sdk_types::blueprint;
use super::super::re_sdk_types::blueprint::archetypes::{PlotLegend, ScalarAxis, TimeAxis};
use super::super::re_sdk_types::blueprint::components::Corner2D;
use super::super::re_sdk_types::components::Range1D;
use super::super::re_sdk_types::datatypes::{TimeInt, TimeRange, TimeRangeBoundary};

use super::super::blueprint::{Panel, View};
use super::super::panels::{about, events};
use super::{House, design};

/// The words that belong to a recording of a building. Beside vehicles their layout has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Words {
    /// Elsewhere.
    Elsewhere,
    /// What this is; nothing has happened.
    About,
    /// What this is, and what happened.
    AboutAndEvents,
}

/// The layout: the floor plan beside the temperatures, below it inputs, weather and costs; then what the controller says of
/// its plans, if it plans; and the words.
pub fn layout(house: &House, words: Words) -> Panel {
    let mut numbers = vec![
        (1.1, Panel::View(plot(house, "Heating (+), cooling (-) [kW]", inputs(house)))),
        (1.1, Panel::View(plot(house, "Outdoors [°C]", vec!["/building/outdoors/**".to_owned()]))),
        (1.1, Panel::View(plot(house, "Cost J of each day", vec!["/building/iteration/**".to_owned()]))),
    ];
    if words != Words::Elsewhere {
        numbers.push((1.3, about()));
    }
    let top = Panel::Row(vec![(1.0, floor()), (2.3, temperatures(house))]);
    let mut rows = vec![(1.6, top), (1.0, Panel::Row(numbers))];
    let mut said = plans(house);
    if words == Words::AboutAndEvents {
        said.push((1.1, events()));
    }
    if !said.is_empty() {
        // A log alone needs less room than plots.
        let share = if said.len() == 1 { 0.5 } else { 0.9 };
        rows.push((share, Panel::Row(said)));
    }
    Panel::Column(rows)
}

/// What the controller says of its plans.
fn plans(house: &House) -> Vec<(f32, Panel)> {
    let below = |path: &str| vec![format!("/{path}/**")];
    let lines = [
        (design::LEARNED, "Learned extra heat [kW]"),
        (design::GAIN, "Feedback gain K [kW/K]"),
        (design::TAPS, "Feedback Q [kW/K]"),
        (design::CONVERGENCE, "Convergence of the design"),
    ];
    let bars = [(design::COST, "First exchange: log10 J by round"), (design::MESSAGES, "Messages sent by each zone")];
    let lines = lines.into_iter().map(|(path, title)| (path, plot(house, title, below(path))));
    let bars = bars.into_iter().map(|(path, title)| (path, View::new("BarChart", title, vec![format!("/{path}")])));
    lines.chain(bars).filter(|(path, _)| house.plans.has(path)).map(|(_, view)| (1.0, Panel::View(view))).collect()
}

fn floor() -> Panel {
    Panel::View(View::new("2D", "Floor plan by temperature: blue cold, red warm", vec!["/building/plan/**".to_owned()]))
}

/// A panel a zone, two in a row.
fn temperatures(house: &House) -> Panel {
    let panel = |&index: &usize| {
        let paths = ["temperature", "reference", "band/**"];
        let paths = paths.map(|what| format!("/building/zone/{}/{what}", index + 1));
        let title = format!("{}: temperature against what is wanted [°C]", house.names[index]);
        let view = plot(house, &title, paths.to_vec());
        let [low_c, high_c] = house.range_c.unwrap_or([20.0, 30.0]);
        (
            1.0,
            Panel::View(view.with("ScalarAxis", ScalarAxis::new().with_range(Range1D::new(low_c - 1.0, high_c + 1.0)))),
        )
    };
    let rows = house.shown.chunks(2).map(|row| (1.0, Panel::Row(row.iter().map(panel).collect())));
    Panel::Column(rows.collect())
}

fn inputs(house: &House) -> Vec<String> {
    let heat = house.shown.iter().map(|index| format!("/building/zone/{}/heat", index + 1));
    heat.chain(["/building/limit/**".to_owned()]).collect()
}

/// A plot over the whole run.
fn plot(house: &House, title: &str, contents: Vec<String>) -> View {
    let at = |time_s: f64| TimeRangeBoundary::Absolute(TimeInt((time_s * 1e9) as i64));
    let run = TimeRange { start: at(0.0), end: at(house.duration_s) };
    let axis = TimeAxis::new().with_view_range(blueprint::components::TimeRange(run));
    let view = View::new("TimeSeries", title, contents).with("TimeAxis", axis);
    view.with("PlotLegend", PlotLegend::new().with_corner(Corner2D::RightTop))
}
