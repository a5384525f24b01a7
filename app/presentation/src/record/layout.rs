//! The layout of a recording with vehicles, without empty panels.
//!
//! The first tab shows the interaction from above and from the side, with speeds and texts; the second tab has the numbers of
//! the planners.

use super::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, VisibleTimeRanges, VisualBounds2D,
};
use super::re_sdk_types::blueprint::components::{BackgroundKind, VisibleTimeRange};
use super::re_sdk_types::datatypes::{Range2D, TimeInt, TimeRange, TimeRangeBoundary};
use super::re_sdk_types::{blueprint, datatypes};
use interplay_scenarios::{Branch, Scenario};

use super::blueprint::{LayoutNode, View};
use super::cameras::{self, Cameras};
use super::palette::opaque;
use super::panels::{TimePlot, about, events, ranged, reasons, status};
use super::planner_panels;
use super::plots::{self, Plots};
use super::{SIM_TIME, TICK};
use crate::camera::car_m;
use crate::palette::GRASS;

/// Widths of the plots in a window 1280 points wide: on the first tab, and of three in a row.
const FIRST_WIDTH: f64 = 300.0;
const THIRD_WIDTH: f64 = 390.0;
/// Gaps are drawn up to this, in lengths of a car.
const SHOWN_GAP_CARS: f64 = 5.0;
/// The background colour, beyond the ground.
const SKY: [u8; 3] = [0xC9, 0xDC, 0xEA];
/// A view of the whole road that is lower than this share of its width is a strip below the view from above.
const STRIP_RATIO: f64 = 0.2;

/// The tabs for a scenario with its recorded plots.
pub fn tabs(scenario: &Scenario, plots: &Plots, cameras: &Cameras) -> Vec<(&'static str, LayoutNode)> {
    vec![
        ("The interaction", interaction(scenario, plots, cameras)),
        ("Numbers of the planners", LayoutNode::Column(rows(number_panels(scenario, plots), 3))),
    ]
}

/// Whether the view of the whole road is a strip, by the least and greatest coordinates of the vehicles.
pub fn has_strip(scenario: &Scenario, [low, high]: [[f64; 2]; 2]) -> bool {
    let is_long = (high[1] - low[1]) + 4.0 * scenario.road.lane_width_m() < STRIP_RATIO * (high[0] - low[0]);
    is_long && scenario.network.is_none() && scenario.road.conflict_zone_m(Branch::Main).is_none()
}

fn interaction(scenario: &Scenario, plots: &Plots, cameras: &Cameras) -> LayoutNode {
    let from_above = traced(scenario, from_above("From above", cameras::TOP, cameras.top_px()));
    let whole_px = cameras.whole_px(scenario);
    let whole = traced(scenario, without_details(scenario, from_above_whole(whole_px)));
    let side = LayoutNode::View(traced(scenario, from_the_side()));
    let views = if cameras.has_strip() {
        let above = LayoutNode::Column(vec![(3.0, LayoutNode::View(from_above)), (1.0, LayoutNode::View(whole))]);
        LayoutNode::Row(vec![(1.72, above), (1.0, side)])
    } else {
        let beside = LayoutNode::Tabs(vec![("", side), ("", LayoutNode::View(whole))]);
        LayoutNode::Row(vec![(1.72, LayoutNode::View(from_above)), (1.0, beside)])
    };
    // A long legend needs height.
    let speeds_share = 1.15 + 0.7 * scenario.vehicles.len().saturating_sub(3) as f32;
    let gap = (1.0, gap(scenario, plots));
    let mut words = vec![(1.0, LayoutNode::Column(vec![(speeds_share, speeds(scenario, plots)), gap]))];
    if !plots.has(plots::GAP) {
        words = vec![(1.0, speeds(scenario, plots))];
    }
    words.push((1.25, status()));
    if plots.has(plots::LOG) {
        words.push((1.2, events(plots::LOG)));
    }
    words.push((1.1, about()));
    LayoutNode::Column(vec![(1.4, views), (1.0, LayoutNode::Row(words))])
}

/// Panels in rows of about equal length, at most `longest` each.
pub fn rows(panels: Vec<LayoutNode>, longest: usize) -> Vec<(f32, LayoutNode)> {
    let count = panels.len().div_ceil(longest).max(1);
    let length = panels.len().div_ceil(count).max(1);
    let mut panels = panels.into_iter().map(|panel| (1.0, panel)).peekable();
    let mut rows = Vec::new();
    while panels.peek().is_some() {
        rows.push((1.0, LayoutNode::Row(panels.by_ref().take(length).collect())));
    }
    rows
}

fn longest_name(scenario: &Scenario) -> usize {
    scenario.vehicles.iter().map(|vehicle| vehicle.name.chars().count()).max().unwrap_or(0)
}

fn speeds(scenario: &Scenario, plots: &Plots) -> LayoutNode {
    let title = ranged("Speeds", plots.speeds_mps(), "m/s");
    let plot = TimePlot::new(scenario.duration_s, &title, vec!["/plots/speed/**".to_owned()]);
    let plot = match plots.speeds_mps() {
        Some(range) => plot.around(range),
        None => plot,
    };
    plot.with_legend(longest_name(scenario), FIRST_WIDTH)
}

fn gap(scenario: &Scenario, plots: &Plots) -> LayoutNode {
    let contents = if plots.has(plots::GAP) { vec![format!("/{}", plots::GAP)] } else { Vec::new() };
    let Some([least_m, greatest_m]) = plots.gaps_m() else {
        return TimePlot::new(scenario.duration_s, "Gap [m]", contents).without_legend();
    };
    // Large gaps would flatten the curve where it matters.
    let most_m = (SHOWN_GAP_CARS * car_m(scenario)).max(2.0 * least_m).min(greatest_m);
    let title = format!("Gap of the ego, least {least_m:.2} m");
    TimePlot::new(scenario.duration_s, &title, contents).around([least_m, most_m]).without_legend()
}

/// Panels of planner diagnostics, inputs and planning times.
fn number_panels(scenario: &Scenario, plots: &Plots) -> Vec<LayoutNode> {
    let mut panels = Vec::new();
    for panel in planner_panels::panels(scenario) {
        let series = plots.paths_of(panel.kind, panel.content.quantities);
        if !series.is_empty() {
            let letters = plots.longest_label(&series);
            let mut plot = TimePlot::new(scenario.duration_s, panel.content.title, series);
            if let Some(axis) = panel.axis() {
                plot = plot.between(axis);
            }
            panels.push(plot.with_legend(letters, THIRD_WIDTH));
        }
    }
    for (title, folder) in [
        ("Accelerations [m/s²]", "acceleration"),
        ("Angles of the front wheels [rad]", "steering"),
        ("Time to plan [ms]", "planner-ms"),
    ] {
        let plot = TimePlot::new(scenario.duration_s, title, vec![format!("/plots/{folder}/**")]);
        panels.push(plot.with_legend(longest_name(scenario), THIRD_WIDTH));
    }
    if plots.has(plots::REASONS) {
        panels.push(reasons());
    }
    panels
}

fn from_above(title: &str, camera: &str, [width, height]: [f64; 2]) -> View {
    let bounds = Range2D { x_range: [0.0, width].into(), y_range: [0.0, height].into() };
    let bounds = blueprint::components::VisualBounds2D(bounds);
    View::new("2D", title, vec!["/world/**".to_owned(), format!("- /{}", cameras::SIDE)])
        .from(&format!("/{camera}"))
        .with("VisualBounds2D", VisualBounds2D::new(bounds))
        .with("Background", Background::new(BackgroundKind::SolidColor).with_color(opaque(GRASS)))
}

/// The view of the whole road, without the labels of the other view.
fn from_above_whole(size_px: [f64; 2]) -> View {
    from_above("The whole road", cameras::WHOLE, size_px).without(&format!("/{}/**", cameras::TOP))
}

/// The three-dimensional view, which can be turned with the mouse.
fn from_the_side() -> View {
    let contents = ["/world/**", "- /world/camera/**"].map(str::to_owned).into_iter();
    let eye = format!("/{}", cameras::SIDE);
    View::new("3D", "From the side", contents.chain([format!("+ {eye}")]).collect())
        .with("EyeControls3D", EyeControls3D::new().with_tracking_entity(eye.as_str()))
        .with("LineGrid3D", LineGrid3D::new().with_visible(false))
        .with("Background", Background::new(BackgroundKind::SolidColor).with_color(opaque(SKY)))
}

/// The view with bodies, plans and paths only.
fn without_details(scenario: &Scenario, view: View) -> View {
    scenario.vehicles.iter().fold(view, |view, vehicle| {
        let parts = ["prediction", "proposal", "safety"];
        parts.iter().fold(view, |view, part| view.without(&format!("/world/vehicle/{}/{part}", vehicle.name)))
    })
}

/// The view with all pieces of each path up to the time cursor.
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
        .fold(view, |view, vehicle| view.with_override(&format!("world/vehicle/{}/trace", vehicle.name), so_far()))
}
