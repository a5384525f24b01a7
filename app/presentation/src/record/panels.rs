//! Panels that several layouts have: texts, logs, and plots over time with the legend beside the curves.

use super::blueprint::{LayoutNode, View};
use super::re_sdk_types::blueprint::archetypes::{PlotLegend, ScalarAxis, TextLogColumns, TimeAxis};
use super::re_sdk_types::blueprint::components::{Corner2D, TimeRange as ViewRange};
use super::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind, TimelineColumn};
use super::re_sdk_types::components::Range1D;
use super::re_sdk_types::datatypes::{TimeInt, TimeRange, TimeRangeBoundary};
use super::{SIM_TIME, TICK};
use super::{plots, status};

/// The panel with the text about the recording.
pub fn about() -> LayoutNode {
    LayoutNode::View(View::new("TextDocument", "What this is", vec!["/about".to_owned()]))
}

/// The panel with the goals and actions of all drivers.
pub fn status() -> LayoutNode {
    let contents = vec![format!("/{}", status::STATUS)];
    LayoutNode::View(View::new("TextDocument", "What each driver does now", contents))
}

/// The panel of events. Their texts begin with the time, which the viewer's own column would cut off.
pub fn events(path: &str) -> LayoutNode {
    log("What happens", path)
}

/// The panel of the reasons of failed optimisations.
pub fn reasons() -> LayoutNode {
    log("Why optimisers failed", plots::REASONS)
}

fn log(title: &str, path: &str) -> LayoutNode {
    let hidden = |timeline: &str| TimelineColumn { visible: false.into(), timeline: timeline.into() };
    let columns = TextLogColumns::new()
        .with_timeline_columns([SIM_TIME, TICK].map(hidden))
        .with_text_log_columns([TextLogColumn { visible: true.into(), kind: TextLogColumnKind::Body }]);
    let view = View::new("TextLog", title, vec![format!("/{path}")]);
    LayoutNode::View(view.with("TextLogColumns", columns))
}

/// Width of a letter of a legend, and of all else in a legend, in points of the screen.
const LETTER: f64 = 6.4;
const EDGES: f64 = 36.0;
/// Largest share of the width of a plot for its legend.
const MAX_LEGEND_RATIO: f64 = 0.5;
/// Space above and below the curves, as a share of their range.
const RANGE_MARGIN_SHARE: f64 = 0.08;

/// A title with the range of the curves: on a low plot the viewer may omit the numbers of the axis.
pub fn ranged(title: &str, range: Option<[f64; 2]>, unit: &str) -> String {
    match range {
        Some([low, high]) => format!("{title}: {low:.1} to {high:.1} {unit}"),
        None => format!("{title} [{unit}]"),
    }
}

/// A plot over a run of a duration \[s\].
pub struct TimePlot {
    view: View,
    duration_s: f64,
}

impl TimePlot {
    pub fn new(duration_s: f64, title: &str, contents: Vec<String>) -> TimePlot {
        TimePlot { view: View::new("TimeSeries", title, contents), duration_s }
    }

    /// The plot with a fixed vertical axis and a margin above and below.
    pub fn around(self, [low, high]: [f64; 2]) -> TimePlot {
        // The axis of a nearly constant curve keeps a minimum range, so that noise is not magnified.
        let range = (high - low).max(0.1 * high.abs()).max(1e-3);
        let margin = RANGE_MARGIN_SHARE * range + 0.5 * (range - (high - low));
        self.between([low - margin, high + margin])
    }

    /// The plot with a fixed vertical axis.
    pub fn between(self, [low, high]: [f64; 2]) -> TimePlot {
        TimePlot { view: self.view.with("ScalarAxis", ScalarAxis::new().with_range(Range1D::new(low, high))), ..self }
    }

    /// The plot with a legend for names of `letters` letters; `width` is that of the plot in points.
    pub fn with_legend(self, letters: usize, width: f64) -> LayoutNode {
        let share = ((LETTER * letters as f64 + EDGES) / width).min(MAX_LEGEND_RATIO);
        let end_s = self.duration_s / (1.0 - share);
        self.until(end_s, PlotLegend::new().with_corner(Corner2D::RightTop))
    }

    /// The plot without a legend, for one series that the title names.
    pub fn without_legend(self) -> LayoutNode {
        let end_s = self.duration_s;
        self.until(end_s, PlotLegend::new().with_visible(false))
    }

    fn until(self, end_s: f64, legend: PlotLegend) -> LayoutNode {
        let at = |time_s: f64| TimeRangeBoundary::Absolute(TimeInt((time_s * 1e9) as i64));
        let axis = TimeAxis::new().with_view_range(ViewRange(TimeRange { start: at(0.0), end: at(end_s) }));
        LayoutNode::View(self.view.with("TimeAxis", axis).with("PlotLegend", legend))
    }
}

#[cfg(test)]
mod tests {
    use super::ranged;

    #[test]
    fn a_title_contains_the_range_if_it_is_known() {
        assert_eq!(ranged("Speeds", Some([0.64, 1.28]), "m/s"), "Speeds: 0.6 to 1.3 m/s");
        assert_eq!(ranged("Speeds", None, "m/s"), "Speeds [m/s]");
    }
}
