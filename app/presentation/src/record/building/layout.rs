//! Which panels a building opens with.

use super::super::re_sdk_types::blueprint;
use super::super::re_sdk_types::blueprint::archetypes::{PlotLegend, ScalarAxis, TimeAxis};
use super::super::re_sdk_types::blueprint::components::Corner2D;
use super::super::re_sdk_types::components::Range1D;
use super::super::re_sdk_types::datatypes::{TimeInt, TimeRange, TimeRangeBoundary};

use super::super::blueprint::{LayoutNode, View};
use super::super::panels::{about, events};
use super::{BuildingLayer, design};

/// The words that belong to a recording of a building. Beside vehicles their layout has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextPanels {
    /// Elsewhere.
    Elsewhere,
    /// What this is; nothing has happened.
    About,
    /// What this is, and what happened.
    AboutAndEvents,
}

/// The layout: the floor plan beside the temperatures, below it inputs, weather and costs; then what the controller says of
/// its plans, if it plans; and the words.
pub fn layout(building_layer: &BuildingLayer, words: TextPanels) -> LayoutNode {
    let mut numbers = vec![
        (1.1, LayoutNode::View(plot(building_layer, "Heating (+), cooling (-) [kW]", inputs(building_layer)))),
        (1.1, LayoutNode::View(plot(building_layer, "Outdoors [°C]", vec!["/building/outdoors/**".to_owned()]))),
        (1.1, LayoutNode::View(plot(building_layer, "Cost J of the day", vec!["/building/iteration/**".to_owned()]))),
    ];
    if words != TextPanels::Elsewhere {
        numbers.push((1.3, about()));
    }
    let top = LayoutNode::Row(vec![(1.0, floor()), (2.3, temperatures(building_layer))]);
    let mut rows = vec![(1.6, top), (1.0, LayoutNode::Row(numbers))];
    let mut said = plans(building_layer);
    if words == TextPanels::AboutAndEvents {
        said.push((1.1, events()));
    }
    if !said.is_empty() {
        // A log alone needs less room than plots.
        let share = if said.len() == 1 { 0.5 } else { 0.9 };
        rows.push((share, LayoutNode::Row(said)));
    }
    LayoutNode::Column(rows)
}

/// What the controller says of its plans.
fn plans(building_layer: &BuildingLayer) -> Vec<(f32, LayoutNode)> {
    let below = |path: &str| vec![format!("/{path}/**")];
    let lines = [
        (design::LEARNED, "Learned extra heat [kW]"),
        (design::GAIN, "Feedback gain K [kW/K]"),
        (design::TAPS, "Feedback Q [kW/K]"),
        (design::CONVERGENCE, "Convergence of the design"),
    ];
    let bars = [(design::COST, "First exchange: log10 J by round"), (design::MESSAGES, "Messages sent by each zone")];
    let lines = lines.into_iter().map(|(path, title)| (path, plot(building_layer, title, below(path))));
    let bars = bars.into_iter().map(|(path, title)| (path, View::new("BarChart", title, vec![format!("/{path}")])));
    lines
        .chain(bars)
        .filter(|(path, _)| building_layer.plans.has(path))
        .map(|(_, view)| (1.0, LayoutNode::View(view)))
        .collect()
}

fn floor() -> LayoutNode {
    LayoutNode::View(View::new(
        "2D",
        "Floor plan by temperature: blue cold, red warm",
        vec!["/building/plan/**".to_owned()],
    ))
}

/// A panel a zone, two in a row.
fn temperatures(building_layer: &BuildingLayer) -> LayoutNode {
    let panel = |&index: &usize| {
        let paths = ["temperature", "reference", "band/**"];
        let paths = paths.map(|what| format!("/building/zone/{}/{what}", index + 1));
        let title = format!("{}: temperature against what is wanted [°C]", building_layer.names[index]);
        let view = plot(building_layer, &title, paths.to_vec());
        let [low_c, high_c] = building_layer.range_c.unwrap_or([20.0, 30.0]);
        (
            1.0,
            LayoutNode::View(
                view.with("ScalarAxis", ScalarAxis::new().with_range(Range1D::new(low_c - 1.0, high_c + 1.0))),
            ),
        )
    };
    let rows = building_layer.shown.chunks(2).map(|row| (1.0, LayoutNode::Row(row.iter().map(panel).collect())));
    LayoutNode::Column(rows.collect())
}

fn inputs(building_layer: &BuildingLayer) -> Vec<String> {
    let heat = building_layer.shown.iter().map(|index| format!("/building/zone/{}/heat", index + 1));
    heat.chain(["/building/limit/**".to_owned()]).collect()
}

/// A plot over the whole run.
fn plot(building_layer: &BuildingLayer, title: &str, contents: Vec<String>) -> View {
    let at = |time_s: f64| TimeRangeBoundary::Absolute(TimeInt((time_s * 1e9) as i64));
    let run = TimeRange { start: at(0.0), end: at(building_layer.duration_s) };
    let axis = TimeAxis::new().with_view_range(blueprint::components::TimeRange(run));
    let view = View::new("TimeSeries", title, contents).with("TimeAxis", axis);
    view.with("PlotLegend", PlotLegend::new().with_corner(Corner2D::RightTop))
}
