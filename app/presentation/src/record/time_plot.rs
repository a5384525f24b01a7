//! Plots over a whole run. Their legends stand beside the curves: the axis goes on behind the end of the run.

use super::blueprint::{LayoutNode, View};
use super::re_sdk_types::blueprint::archetypes::{PlotLegend, ScalarAxis, TimeAxis};
use super::re_sdk_types::blueprint::components::{Corner2D, TimeRange as ViewRange};
use super::re_sdk_types::components::Range1D;
use super::re_sdk_types::datatypes::{TimeInt, TimeRange, TimeRangeBoundary};

/// Width of a letter of a legend, and of all else in a legend, in points of the screen.
const LETTER: f64 = 6.4;
const EDGES: f64 = 36.0;
/// Most of a plot's width that is left to its legend.
const MAX_LEGEND_RATIO: f64 = 0.5;
/// Space above and below the curves, as a share of their range.
const RANGE_MARGIN_SHARE: f64 = 0.08;

/// A title that says between which values its curves are: on a low plot the viewer may write no numbers at the axis.
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
    /// A plot of some series.
    pub fn new(duration_s: f64, title: &str, contents: Vec<String>) -> TimePlot {
        TimePlot { view: View::new("TimeSeries", title, contents), duration_s }
    }

    /// With a fixed vertical axis, and a little space above and below.
    pub fn around(self, [low, high]: [f64; 2]) -> TimePlot {
        // Curves that hardly change are not drawn as mountains.
        let range = (high - low).max(0.1 * high.abs()).max(1e-3);
        let margin = RANGE_MARGIN_SHARE * range + 0.5 * (range - (high - low));
        self.between([low - margin, high + margin])
    }

    /// With a fixed vertical axis.
    pub fn between(self, [low, high]: [f64; 2]) -> TimePlot {
        TimePlot { view: self.view.with("ScalarAxis", ScalarAxis::new().with_range(Range1D::new(low, high))), ..self }
    }

    /// With a legend of names as long as `letters`, in a window where the plot has a width in points.
    pub fn with_legend(self, letters: usize, width: f64) -> LayoutNode {
        let share = ((LETTER * letters as f64 + EDGES) / width).min(MAX_LEGEND_RATIO);
        let end_s = self.duration_s / (1.0 - share);
        self.until(end_s, PlotLegend::new().with_corner(Corner2D::RightTop))
    }

    /// Of one series that the title names.
    pub fn alone(self) -> LayoutNode {
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
    fn a_title_says_the_range_where_it_is_known() {
        assert_eq!(ranged("Speeds", Some([0.64, 1.28]), "m/s"), "Speeds: 0.6 to 1.3 m/s");
        assert_eq!(ranged("Speeds", None, "m/s"), "Speeds [m/s]");
    }
}
