//! Which panels a recording opens with: only those that have something to show.
//!
//! The close-up and the whole road lie across the window, since roads are long and narrow; below them the numbers,
//! and at the bottom the words.

use super::re_sdk_types::blueprint::archetypes::{PlotLegend, ScalarAxis, TimeAxis, VisibleTimeRanges, VisualBounds2D};
use super::re_sdk_types::blueprint::components::{Corner2D, VisibleTimeRange};
use super::re_sdk_types::components::Range1D;
use super::re_sdk_types::datatypes::{Range2D, TimeInt, TimeRange, TimeRangeBoundary};
use super::re_sdk_types::{blueprint, datatypes};
use interplay_scenarios::{Branch, Scenario, Vehicle};

use super::blueprint::{LayoutNode, View};
use super::panels::{about, events};
use super::planner_panels;
use super::plots::{self, Plots};
use super::timelines::{SIM_TIME, TICK};
use super::vehicles::FOLLOW;
use crate::curved_road::CurvedRoad;
use crate::network_lines::expected_bounds_m;

/// Width of the close-up as a multiple of its height.
const CLOSE_UP_ASPECT: f64 = 5.6;
/// How much of the land beside the road the close-up shows on either side, in lane widths.
const BESIDE_LANES: f64 = 0.5;
/// How far the close-up of a road that turns reaches from the ego, in widths of the road and the land beside it.
const AROUND_WIDTHS: f64 = 2.0;
/// The same on a network, where the width is that of one lane.
const AROUND_WIDTHS_ON_NETWORK: f64 = 4.0;
/// How much of the close-up lies behind the ego.
const SHARE_BEHIND: f64 = 0.42;

/// The layout for a scenario of which `plots` were recorded between the longitudinal coordinates `road_m`.
pub fn layout(scenario: &Scenario, plots: &Plots, road_m: [f64; 2]) -> LayoutNode {
    let words = (1.9, LayoutNode::Row(words(scenario, plots)));
    if let Some([from_m, to_m]) = scenario.road.conflict_zone_m(Branch::Main) {
        let beside = LayoutNode::Column(rows(numbers(scenario, plots), 2));
        let above = LayoutNode::Row(vec![(1.0, crossing(scenario, 0.5 * (from_m + to_m))), (1.2, beside)]);
        return LayoutNode::Column(vec![(3.4, above), words]);
    }
    let bounds_m = match (&scenario.network, CurvedRoad::new(&scenario.road)) {
        (Some(_), _) => Some(expected_bounds_m(scenario)),
        (None, curved) => curved.map(|curved| curved.bounds_m(road_m)),
    };
    if let Some(bounds_m) = bounds_m {
        let views = vec![(1.2, around_the_ego(scenario)), (1.0, whole_curve(scenario, bounds_m))];
        let beside = LayoutNode::Column(rows(numbers(scenario, plots), 2));
        let above = LayoutNode::Row(vec![(2.2, LayoutNode::Row(views)), (1.4, beside)]);
        return LayoutNode::Column(vec![(3.4, above), words]);
    }
    let mut parts = vec![(1.7, close_up(scenario)), (0.65, whole_road(scenario, road_m))];
    parts.extend(rows(numbers(scenario, plots), 4).into_iter().map(|(_, row)| (1.5, row)));
    parts.push(words);
    LayoutNode::Column(parts)
}

/// Panels in rows of at most `longest`, all about equally long.
fn rows(panels: Vec<(f32, LayoutNode)>, longest: usize) -> Vec<(f32, LayoutNode)> {
    let count = panels.len().div_ceil(longest).max(1);
    let length = panels.len().div_ceil(count).max(1);
    let mut panels = panels.into_iter().peekable();
    let mut rows = Vec::new();
    while panels.peek().is_some() {
        rows.push((1.0, LayoutNode::Row(panels.by_ref().take(length).collect())));
    }
    rows
}

/// Speeds, what goes on in the planners, and the gap.
fn numbers(scenario: &Scenario, plots: &Plots) -> Vec<(f32, LayoutNode)> {
    let fastest = scenario.vehicles.iter().map(|vehicle| vehicle.limits.speed_max_mps).fold(0.0, f64::max);
    let speeds = Plot::new(scenario, "Speeds [m/s]", vec!["/plots/speed/**".to_owned()]);
    let mut panels = vec![(1.0, speeds.between(0.0, 1.05 * fastest).legend_at(Corner2D::RightBottom))];
    for panel in planner_panels::panels(scenario) {
        let series = plots.among(panel.kind, panel.content.quantities);
        if !series.is_empty() {
            let mut plot = Plot::new(scenario, panel.content.title, series);
            if let Some([low, high]) = panel.axis() {
                plot = plot.between(low, high);
            }
            panels.push((1.0, plot.legend_at(Corner2D::RightTop)));
        }
    }
    if plots.has(plots::GAP) {
        let gap = vec![format!("/{}", plots::GAP)];
        panels.push((1.0, Plot::new(scenario, "Gap from the ego to the nearest vehicle [m]", gap).alone()));
    }
    panels
}

fn words(scenario: &Scenario, plots: &Plots) -> Vec<(f32, LayoutNode)> {
    let computing = Plot::new(scenario, "Time to plan [ms]", vec!["/plots/planner-ms/**".to_owned()]);
    let mut row = vec![(0.8, computing.legend_at(Corner2D::RightTop))];
    if plots.has(plots::LOG) {
        row.push((1.0, events()));
    }
    row.push((1.6, about()));
    row
}

/// A plot over the whole run.
struct Plot(View);

impl Plot {
    fn new(scenario: &Scenario, title: &str, contents: Vec<String>) -> Plot {
        let at = |time_s: f64| TimeRangeBoundary::Absolute(TimeInt((time_s * 1e9) as i64));
        let run = TimeRange { start: at(0.0), end: at(scenario.duration_s) };
        let axis = TimeAxis::new().with_view_range(blueprint::components::TimeRange(run));
        Plot(View::new("TimeSeries", title, contents).with("TimeAxis", axis))
    }

    /// With a fixed vertical axis.
    fn between(self, low: f64, high: f64) -> Plot {
        Plot(self.0.with("ScalarAxis", ScalarAxis::new().with_range(Range1D::new(low, high))))
    }

    fn legend_at(self, corner: Corner2D) -> LayoutNode {
        LayoutNode::View(self.0.with("PlotLegend", PlotLegend::new().with_corner(corner)))
    }

    /// Of one series that the title names.
    fn alone(self) -> LayoutNode {
        LayoutNode::View(self.0.with("PlotLegend", PlotLegend::new().with_visible(false)))
    }
}

/// Length of road in the close-up \[m\].
pub fn close_up_span_m(scenario: &Scenario) -> f64 {
    CLOSE_UP_ASPECT * (scenario.road.width_m() + 2.0 * BESIDE_LANES * scenario.road.lane_width_m())
}

fn close_up(scenario: &Scenario) -> LayoutNode {
    let beside = BESIDE_LANES * scenario.road.lane_width_m();
    let across = [-scenario.road.width_m() - beside, beside];
    let span = close_up_span_m(scenario);
    let along = [-SHARE_BEHIND * span, (1.0 - SHARE_BEHIND) * span];
    LayoutNode::View(traced(scenario, top_view("Around the ego", along, across).from(FOLLOW)))
}

/// A square around the ego on a road that turns.
fn around_the_ego(scenario: &Scenario) -> LayoutNode {
    let widths = if scenario.network.is_some() { AROUND_WIDTHS_ON_NETWORK } else { AROUND_WIDTHS };
    let reach = widths * (scenario.road.width_m() + 2.0 * BESIDE_LANES * scenario.road.lane_width_m());
    LayoutNode::View(traced(scenario, top_view("Around the ego", [-reach, reach], [-reach, reach]).from(FOLLOW)))
}

/// The whole of a road that turns or of a network, between least and greatest coordinates in the world.
fn whole_curve(scenario: &Scenario, [low, high]: [[f64; 2]; 2]) -> LayoutNode {
    let beside = BESIDE_LANES * scenario.road.lane_width_m();
    let across = [-high[1] - beside, -low[1] + beside];
    LayoutNode::View(without_details(scenario, top_view("The whole road", [low[0] - beside, high[0] + beside], across)))
}

/// Where the roads meet, as far around as the vehicles come from.
fn crossing(scenario: &Scenario, centre_m: f64) -> LayoutNode {
    let middle = [centre_m, 0.5 * scenario.road.width_m()];
    let off = |vehicle: &Vehicle| (vehicle.start.x_m - middle[0]).abs().max((vehicle.start.y_m - middle[1]).abs());
    let reach =
        scenario.vehicles.iter().map(off).fold(scenario.road.width_m(), f64::max) + scenario.road.lane_width_m();
    let across = [-middle[1] - reach, -middle[1] + reach];
    let view = top_view("The intersection", [middle[0] - reach, middle[0] + reach], across);
    LayoutNode::View(traced(scenario, view))
}

fn whole_road(scenario: &Scenario, road_m: [f64; 2]) -> LayoutNode {
    let view = top_view("The whole road", road_m, [-scenario.road.width_m(), 0.0]);
    LayoutNode::View(without_details(scenario, view))
}

/// A view from far above: bodies and paths only.
fn without_details(scenario: &Scenario, view: View) -> View {
    let view = scenario.vehicles.iter().fold(view, |view, vehicle| {
        let parts = ["label", "order", "prediction", "safety"];
        parts.iter().fold(view, |view, part| view.without(&format!("/world/vehicle/{}/{part}", vehicle.name)))
    });
    traced(scenario, view)
}

fn top_view(title: &str, [left, right]: [f64; 2], [top, bottom]: [f64; 2]) -> View {
    let bounds = Range2D { x_range: [left, right].into(), y_range: [top, bottom].into() };
    let bounds = blueprint::components::VisualBounds2D(bounds);
    View::new("2D", title, vec!["/world/**".to_owned()]).with("VisualBounds2D", VisualBounds2D::new(bounds))
}

/// Shows of each path all pieces up to the time cursor.
fn traced(scenario: &Scenario, view: View) -> View {
    let so_far = || {
        let range =
            TimeRange { start: TimeRangeBoundary::Infinite, end: TimeRangeBoundary::CursorRelative(TimeInt(0)) };
        let on = |timeline: &str| VisibleTimeRange(datatypes::VisibleTimeRange { timeline: timeline.into(), range });
        VisibleTimeRanges::new([on(SIM_TIME), on(TICK)])
    };
    scenario
        .vehicles
        .iter()
        .fold(view, |view, vehicle| view.with_rule(&format!("world/vehicle/{}/trace", vehicle.name), so_far()))
}
