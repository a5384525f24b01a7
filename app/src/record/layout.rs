//! Which panels a recording opens with: only those that have something to show.
//!
//! The close-up and the whole road lie across the window, since roads are long and narrow; below them the numbers,
//! and at the bottom the words.

use super::re_sdk_types;
use super::re_sdk_types::blueprint::archetypes::{
    PlotLegend, ScalarAxis, TextLogColumns, TimeAxis, VisibleTimeRanges, VisualBounds2D,
};
use super::re_sdk_types::blueprint::components::{Corner2D, LinkAxis, VisibleTimeRange};
use super::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};
use super::re_sdk_types::components::Range1D;
use super::re_sdk_types::datatypes::{Range2D, TimeInt, TimeRange, TimeRangeBoundary};
use interplay_scenarios::Scenario;

use super::blueprint::{Panel, View};
use super::plots::{self, Plots};
use super::vehicles::FOLLOW;

/// Width of the close-up as a multiple of its height.
const CLOSE_UP_ASPECT: f64 = 4.8;
/// How much of the close-up lies behind the ego.
const SHARE_BEHIND: f64 = 0.42;

/// The layout for a scenario of which `plots` were recorded between the longitudinal coordinates `road_m`.
pub fn layout(scenario: &Scenario, plots: &Plots, road_m: [f64; 2]) -> Panel {
    let words = [
        Some((1.0, plot("Time to plan [ms]", vec!["/plots/planner-ms/**".to_owned()], None))),
        plots.has(plots::LOG).then(|| (1.2, events())),
        Some((1.3, Panel::View(View::new("TextDocument", "What this is", vec!["/about".to_owned()])))),
    ];
    Panel::Column(vec![
        (1.9, close_up(scenario)),
        (0.75, whole_road(scenario, road_m)),
        (1.7, Panel::Row(numbers(scenario, plots))),
        (1.9, Panel::Row(words.into_iter().flatten().collect())),
    ])
}

fn numbers(scenario: &Scenario, plots: &Plots) -> Vec<(f32, Panel)> {
    let fastest = scenario.vehicles.iter().map(|vehicle| vehicle.limits.speed_max_mps).fold(0.0, f64::max);
    let mut row = vec![(1.0, plot("Speeds [m/s]", vec!["/plots/speed/**".to_owned()], Some([0.0, fastest * 1.05])))];
    let shares = ["acceptance", "concession-weight", "persuasion-active", "safety-filter"];
    let negotiation = among(plots, "plots/negotiation/", &shares);
    let costs = among(plots, "plots/", &["cost", "safety-slack"]);
    if !negotiation.is_empty() {
        row.push((
            1.3,
            plot("Negotiation: does the other accept, does the ego concede", negotiation, Some([0.0, 1.05])),
        ));
    } else if !costs.is_empty() {
        row.push((1.3, plot("Costs of the plans", costs, None)));
    }
    if plots.has(plots::GAP) {
        row.push((1.0, plot("Gap from the ego to the nearest vehicle [m]", vec![format!("/{}", plots::GAP)], None)));
    }
    row
}

/// The recorded series below `folder` that have one of these names in their path.
fn among(plots: &Plots, folder: &str, names: &[&str]) -> Vec<String> {
    let mine = |path: &&String| path.starts_with(folder) && path.split('/').any(|part| names.contains(&part));
    plots.seen().iter().filter(mine).map(|path| format!("/{path}")).collect()
}

fn plot(title: &str, contents: Vec<String>, range: Option<[f64; 2]>) -> Panel {
    let view = View::new("TimeSeries", title, contents)
        .with("PlotLegend", PlotLegend::new().with_corner(Corner2D::RightTop))
        .with("TimeAxis", TimeAxis::new().with_link(LinkAxis::LinkToGlobal));
    Panel::View(match range {
        Some([low, high]) => view.with("ScalarAxis", ScalarAxis::new().with_range(Range1D::new(low, high))),
        None => view,
    })
}

fn events() -> Panel {
    let column = |kind| TextLogColumn { visible: true.into(), kind };
    let columns = [TextLogColumnKind::LogLevel, TextLogColumnKind::Body].map(column);
    let view = View::new("TextLog", "Events", vec![format!("/{}", plots::LOG)]);
    Panel::View(view.with("TextLogColumns", TextLogColumns::new().with_text_log_columns(columns)))
}

fn close_up(scenario: &Scenario) -> Panel {
    let beside = 0.6 * scenario.road.lane_width_m();
    let across = [-scenario.road.width_m() - beside, beside];
    let span = CLOSE_UP_ASPECT * (across[1] - across[0]);
    let along = [-SHARE_BEHIND * span, (1.0 - SHARE_BEHIND) * span];
    Panel::View(traced(scenario, top_view("Around the ego", along, across).from(FOLLOW)))
}

fn whole_road(scenario: &Scenario, road_m: [f64; 2]) -> Panel {
    let view = top_view("The whole road", road_m, [-scenario.road.width_m(), 0.0]);
    let view = scenario.vehicles.iter().fold(view, |view, vehicle| {
        let parts = ["label", "prediction", "safety"];
        parts.iter().fold(view, |view, part| view.without(&format!("/world/vehicle/{}/{part}", vehicle.name)))
    });
    Panel::View(traced(scenario, view))
}

fn top_view(title: &str, [left, right]: [f64; 2], [top, bottom]: [f64; 2]) -> View {
    let bounds = Range2D { x_range: [left, right].into(), y_range: [top, bottom].into() };
    let bounds = re_sdk_types::blueprint::components::VisualBounds2D(bounds);
    View::new("2D", title, vec!["/world/**".to_owned()]).with("VisualBounds2D", VisualBounds2D::new(bounds))
}

/// Shows of each path all pieces up to the time cursor.
fn traced(scenario: &Scenario, view: View) -> View {
    let so_far = || {
        let range =
            TimeRange { start: TimeRangeBoundary::Infinite, end: TimeRangeBoundary::CursorRelative(TimeInt(0)) };
        let on = |timeline: &str| {
            VisibleTimeRange(re_sdk_types::datatypes::VisibleTimeRange {
                timeline: timeline.into(),
                range: range.clone(),
            })
        };
        VisibleTimeRanges::new([on(super::SIM_TIME), on(super::TICK)])
    };
    scenario
        .vehicles
        .iter()
        .fold(view, |view, vehicle| view.with_rule(&format!("world/vehicle/{}/trace", vehicle.name), so_far()))
}
