//! The layout of a recording with a building.

use super::super::blueprint::{LayoutNode, View};
use super::super::layout::rows;
use super::super::panels::{TimePlot, about, events, ranged};
use super::super::plots;
use super::super::re_sdk_types::blueprint::archetypes::{PlotLegend, VisualBounds2D};
use super::super::re_sdk_types::blueprint::components::VisualBounds2D as ViewBounds;
use super::super::re_sdk_types::datatypes::Range2D;
use super::{BuildingLayer, design, series};

/// Most zones with a plot of their own on the first tab.
const MAX_FIRST_ZONES: usize = 4;
/// Widths of plots in a window 1280 points wide.
const QUARTER_WIDTH: f64 = 262.0;
const TEMPERATURE_WIDTH: f64 = 390.0;
const HALF_WIDTH: f64 = 600.0;

/// The text panels on the tab of the building. With vehicles, the tab of the interaction has the text about the recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextPanels {
    None,
    Events,
    About,
    /// The text about the recording, and the events.
    AboutAndEvents,
}

/// The tabs: the floor plan with temperatures of some zones, weather, heat, costs and texts; every zone, if there are more; and
/// the designs of the controller, if it has any.
pub fn tabs(building_layer: &BuildingLayer, words: TextPanels) -> Vec<(&'static str, LayoutNode)> {
    let mut tabs = vec![("The building", overview(building_layer, words))];
    if building_layer.names.len() > MAX_FIRST_ZONES {
        tabs.push(("Every zone", every_zone(building_layer)));
    }
    let plans = plans(building_layer);
    if !plans.is_empty() {
        tabs.push(("Plans of the controller", LayoutNode::Column(rows(plans, 2))));
    }
    tabs
}

fn overview(building_layer: &BuildingLayer, words: TextPanels) -> LayoutNode {
    let run_s = building_layer.duration_s;
    let plot = |title: &str, contents: Vec<String>| TimePlot::new(run_s, title, contents);
    let letters = |names: &[&str]| names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let outdoors =
        plot(&ranged("Outdoors", building_layer.ranges.outdoors(), "°C"), vec!["/building/outdoors/**".to_owned()]);
    let heat = plot("Heat (negative cools, vermillion: limits) [kW]", inputs(building_layer));
    let cost = plot("Cost of each day", vec!["/building/iteration/**".to_owned()]);
    let mut below = vec![
        (1.0, outdoors.with_legend(letters(&["forecast"]), QUARTER_WIDTH)),
        // The legend of the temperatures above already names the rooms.
        (1.0, heat.without_legend()),
        (1.0, cost.with_legend(letters(&["cheapest possible"]), QUARTER_WIDTH)),
    ];
    match words {
        TextPanels::None => {}
        TextPanels::Events => below.push((1.0, events(plots::BUILDING_LOG))),
        TextPanels::About => below.push((1.2, about())),
        TextPanels::AboutAndEvents => {
            below.push((1.7, LayoutNode::Column(vec![(1.3, about()), (1.0, events(plots::BUILDING_LOG))])));
        }
    }
    let above = LayoutNode::Row(vec![(1.0, floor(building_layer)), (1.9, temperatures(building_layer))]);
    LayoutNode::Column(vec![(1.5, above), (1.0, LayoutNode::Row(below))])
}

/// The zones with a plot on the first tab: all, or some from the first to the last.
fn first_zones(building_layer: &BuildingLayer) -> Vec<usize> {
    spread(building_layer.names.len(), MAX_FIRST_ZONES)
}

/// At most `most` indices, spread evenly from 0 to `count` − 1.
fn spread(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|index| index * (count - 1) / (most - 1)).collect()
}

/// Plots of every zone, or of every group of zones if there are many.
fn every_zone(building_layer: &BuildingLayer) -> LayoutNode {
    let single = |&index: &usize| temperature(building_layer, index, None);
    let grouped = |(number, group): (usize, &Vec<usize>)| {
        let (first, last) = (group.first().copied().unwrap_or(0), group.last().copied().unwrap_or(0));
        let title = format!("{} to {}", building_layer.names[first], building_layer.names[last]);
        let title = ranged(&title, building_layer.ranges.spanning(group), "°C");
        let plot = TimePlot::new(building_layer.duration_s, &title, vec![format!("/{}", series::group(number))]);
        around(plot, building_layer).without_legend()
    };
    let panels: Vec<LayoutNode> = if building_layer.groups.is_empty() {
        building_layer.shown.iter().map(single).collect()
    } else {
        building_layer.groups.iter().enumerate().map(grouped).collect()
    };
    LayoutNode::Column(rows(panels, 4))
}

/// The panels of the designs of the controller.
fn plans(building_layer: &BuildingLayer) -> Vec<LayoutNode> {
    let below = |path: &str| vec![format!("/{path}/**")];
    let longest = building_layer.names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let lines = [
        (design::LEARNED, "Heat beyond the forecast that the controller has learned [kW]", longest),
        (design::GAIN, "Feedback gain K: heat for an error of the temperature [kW/K]", longest + 11),
        (design::TAPS, "Feedback Q: heat for an error some steps before [kW/K]", 14),
        (design::CONVERGENCE, "Convergence: below 1, errors fall from day to day", 22),
    ];
    let bars = [
        (design::COST, "First exchange of messages: log10 of the cost J by round"),
        (design::MESSAGES, "Messages sent by each zone"),
    ];
    let line = |(path, title, letters): (&'static str, &str, usize)| {
        (path, TimePlot::new(building_layer.duration_s, title, below(path)).with_legend(letters, HALF_WIDTH))
    };
    let bar = |(path, title): (&'static str, &str)| {
        let view = View::new("BarChart", title, vec![format!("/{path}")]);
        (path, LayoutNode::View(view.with("PlotLegend", PlotLegend::new().with_visible(false))))
    };
    let all = lines.into_iter().map(line).chain(bars.into_iter().map(bar));
    all.filter(|(path, _)| building_layer.plans.has(path)).map(|(_, view)| view).collect()
}

fn floor(building_layer: &BuildingLayer) -> LayoutNode {
    let [width, height] = building_layer.plan.size();
    let bounds = Range2D { x_range: [0.0, width as f64].into(), y_range: [0.0, height as f64].into() };
    let title = "Floor plan: blue is too cold, red too warm";
    let view = View::new("2D", title, vec!["/building/plan/**".to_owned()]);
    LayoutNode::View(view.with("VisualBounds2D", VisualBounds2D::new(ViewBounds(bounds))))
}

/// The temperatures of the first tab, two plots in a row. The first plot has the legend of all.
fn temperatures(building_layer: &BuildingLayer) -> LayoutNode {
    let zones = first_zones(building_layer);
    let width = if zones.len() > 1 { TEMPERATURE_WIDTH } else { 2.0 * TEMPERATURE_WIDTH };
    let plot = |(place, index): (usize, &usize)| temperature(building_layer, *index, (place == 0).then_some(width));
    LayoutNode::Column(rows(zones.iter().enumerate().map(plot).collect(), 2))
}

/// The temperature of a zone with its wanted temperature, with a legend if a width is given.
fn temperature(building_layer: &BuildingLayer, index: usize, width: Option<f64>) -> LayoutNode {
    let paths = ["temperature", "reference", "band/**"];
    let paths = paths.map(|what| format!("/building/zone/{}/{what}", index + 1));
    let title = ranged(&building_layer.names[index], building_layer.ranges.spanning(&[index]), "°C");
    let plot = around(TimePlot::new(building_layer.duration_s, &title, paths.to_vec()), building_layer);
    match width {
        Some(width) => plot.with_legend("comfort, high".len(), width),
        None => plot.without_legend(),
    }
}

/// The plot with an axis for the temperatures of all zones, once they are known.
fn around(plot: TimePlot, building_layer: &BuildingLayer) -> TimePlot {
    match building_layer.ranges.all() {
        Some(range_c) => plot.around(range_c),
        None => plot,
    }
}

fn inputs(building_layer: &BuildingLayer) -> Vec<String> {
    let heat = first_zones(building_layer).into_iter().map(|index| format!("/building/zone/{}/heat", index + 1));
    heat.chain(["/building/limit/**".to_owned()]).collect()
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn the_first_tab_shows_zones_spread_over_the_building() {
        assert_eq!(spread(1, 4), [0]);
        assert_eq!(spread(4, 4), [0, 1, 2, 3]);
        assert_eq!(spread(5, 4), [0, 1, 2, 4]);
        assert_eq!(spread(100, 4), [0, 33, 66, 99]);
    }
}
