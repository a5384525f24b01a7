//! Bars with intervals, one below the other, in groups.

use super::axis::Axis;
use super::backend::width_of;
use super::drawing::{Drawing, LARGE_TEXT_PX, MEDIUM_TEXT_PX, SMALL_TEXT_PX, Side};
use super::style::{BLACK, Dash, LineStyle, PALE, line_styles};

/// Height of a bar \[px\].
const BAR_PX: f64 = 22.0;
/// Space below a bar \[px\].
const SPACE_PX: f64 = 9.0;
/// Height of the heading of a group \[px\].
const HEADING_PX: f64 = 40.0;
/// Height of the title \[px\].
const TITLE_PX: f64 = 60.0;
/// Height of the axis with its numbers and its title \[px\].
const AXIS_PX: f64 = 80.0;
/// Width of the part with the bars \[px\].
const PLOT_PX: f64 = 760.0;
/// Space between two ticks \[px\].
const TICK_PX: f64 = 110.0;
/// Space around everything \[px\].
const MARGIN_PX: f64 = 24.0;

/// Bars in groups. A bar begins at 0; the line on it is its interval.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IntervalBars {
    pub title: String,
    /// Quantity of the axis, with its unit.
    pub axis: String,
    /// The end of the axis, if it is fixed, such as 1 for shares.
    pub end: Option<f64>,
    /// The groups, each with its heading.
    pub groups: Vec<(String, Vec<IntervalBar>)>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct IntervalBar {
    pub name: String,
    /// Length of the bar; `None` without data.
    pub value: Option<f64>,
    /// Lower and upper bound of the interval.
    pub interval: Option<[f64; 2]>,
}

impl IntervalBars {
    pub fn draw(&self) -> Drawing {
        let bars = || self.groups.iter().flat_map(|(_, bars)| bars);
        let labels_px = bars().map(|bar| width_of(&bar.name, SMALL_TEXT_PX)).fold(0.0, f64::max);
        let left = MARGIN_PX + labels_px + 16.0;
        let title_px = width_of(&self.title, LARGE_TEXT_PX).max(width_of(&self.axis, MEDIUM_TEXT_PX));
        let headings_px =
            self.groups.iter().map(|(heading, _)| width_of(heading, MEDIUM_TEXT_PX)).fold(title_px, f64::max);
        let width = (left + PLOT_PX + 60.0).max(headings_px + 2.0 * MARGIN_PX);
        let height_of = |bars: &[IntervalBar]| HEADING_PX + bars.len() as f64 * (BAR_PX + SPACE_PX);
        let bars_px: f64 = self.groups.iter().map(|(_, bars)| height_of(bars)).sum();
        let mut drawing = Drawing::new(width, TITLE_PX + bars_px + AXIS_PX);
        drawing.text([MARGIN_PX, 0.5 * TITLE_PX], Side::Left, LARGE_TEXT_PX, &*self.title);
        let furthest = bars().filter_map(|bar| Some(bar.interval.map_or(bar.value?, |[_, high]| high)));
        let end = self.end.unwrap_or_else(|| furthest.fold(0.0, f64::max));
        let end = if end > 0.0 { end } else { 1.0 };
        let axis = Axis::new(0.0..end, [left, left + PLOT_PX]);
        let at = |value: f64| axis.pixel(value);
        self.draw_axis(&mut drawing, &axis, [left, TITLE_PX + bars_px]);
        let colours: Vec<&str> = self.names();
        let mut top = TITLE_PX;
        for (heading, bars) in &self.groups {
            drawing.text([MARGIN_PX, top + 0.5 * HEADING_PX], Side::Left, MEDIUM_TEXT_PX, &**heading);
            top += HEADING_PX;
            for bar in bars {
                let style = line_styles().nth(colours.iter().position(|name| *name == bar.name).unwrap_or(0));
                let middle = top + 0.5 * BAR_PX;
                drawing.text([left - 8.0, middle], Side::Right, SMALL_TEXT_PX, &*bar.name);
                if let (Some(value), Some(style)) = (bar.value, style) {
                    drawing.block([at(0.0), top], [at(value).max(at(0.0) + 2.0), top + BAR_PX], style.colour);
                }
                if let Some([low, high]) = bar.interval.filter(|_| bar.value.is_some()) {
                    let line = LineStyle::new(BLACK, Dash::Solid).thin();
                    drawing.line(vec![[at(low), middle], [at(high), middle]], line);
                    for end in [low, high] {
                        drawing.line(vec![[at(end), middle - 6.0], [at(end), middle + 6.0]], line);
                    }
                }
                top += BAR_PX + SPACE_PX;
            }
        }
        drawing
    }

    /// The names of all bars without repetition; a name has the same colour in all groups.
    fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for bar in self.groups.iter().flat_map(|(_, bars)| bars) {
            if !names.contains(&bar.name.as_str()) {
                names.push(&bar.name);
            }
        }
        names
    }

    fn draw_axis(&self, drawing: &mut Drawing, axis: &Axis, [left, bottom]: [f64; 2]) {
        for (value, words) in axis.ticks(TICK_PX) {
            let place = axis.pixel(value);
            drawing.line(vec![[place, TITLE_PX], [place, bottom]], LineStyle::new(PALE, Dash::Solid).thin());
            drawing.text([place, bottom + 18.0], Side::Middle, SMALL_TEXT_PX, words);
        }
        let line = LineStyle::new(BLACK, Dash::Solid).thin();
        drawing.line(vec![[left, bottom], [left + PLOT_PX, bottom]], line);
        drawing.text([left + 0.5 * PLOT_PX, bottom + 54.0], Side::Middle, MEDIUM_TEXT_PX, &*self.axis);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_is_legible_and_names_are_listed_once() {
        let bar = |name: &str, value: f64| IntervalBar {
            name: name.to_owned(),
            value: Some(value),
            interval: Some([0.9 * value, (1.1 * value).min(1.0)]),
        };
        let group = |heading: &str| (heading.to_owned(), vec![bar("first", 0.4), bar("a longer name", 0.8)]);
        let bars = IntervalBars {
            title: "Success".to_owned(),
            axis: "share of runs".to_owned(),
            end: Some(1.0),
            groups: vec![group("nice"), group("tough"), ("empty".to_owned(), vec![IntervalBar::default()])],
        };
        let drawing = bars.draw();
        assert_eq!(drawing.illegible(), Vec::<String>::new());
        assert!(drawing.words().contains(&"a longer name"));
        let svg = drawing.svg().expect("drawn");
        assert!(svg.contains("Success"), "{svg}");
        assert_eq!(bars.names(), ["first", "a longer name", ""]);
    }
}
