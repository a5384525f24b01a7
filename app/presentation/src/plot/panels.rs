//! Panels: plots of curves over the same x axis, in rows and columns, with one legend for all.

use std::ops::Range;

use super::axis::{Axis, range};
use super::drawing::{
    Drawing, LARGE_TEXT_PX, LEFT_MARGIN_PX, MARGIN_PX, MEDIUM_TEXT_PX, SMALL_TEXT_PX, Side, TICK_LABEL_HEIGHT_PX,
    TITLE_HEIGHT_PX, WIDTH_PX, X_LABEL_HEIGHT_PX,
};
use super::style::{Dash, GREY, LIMIT, Legend, LineStyle, PALE, Sample};

/// Height of the line with the name of a plot, above it.
const PANEL_NAME_HEIGHT_PX: f64 = 40.0;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panels {
    pub title: String,
    /// The name of the x axis with its unit, the same for all plots.
    pub across: String,
    /// The number of columns; 0 counts as 1.
    pub columns: usize,
    /// Distance of the ticks of the x axis, such as 6 for hours of a day. `None`: a round number is chosen.
    pub every: Option<f64>,
    pub panels: Vec<Panel>,
}

/// A plot of curves over the common x axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// The name of the y axis with its unit.
    pub name: String,
    pub curves: Vec<Curve>,
    /// Limits, drawn as horizontal lines, each with its name.
    pub limits: Vec<(f64, String)>,
    /// Vertical lines at events, each with its x value, style and name.
    pub events: Vec<(f64, LineStyle, String)>,
    /// Values that the y axis includes even if no curve reaches them.
    pub reaches: Vec<f64>,
    /// Whether the y axis is logarithmic.
    pub logarithmic: bool,
}

/// How the points of a curve are marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marks {
    /// Points are not marked: a line.
    None,
    /// Each point is a disc on the line.
    OnLine,
    /// Each point is a small dot, without a line.
    Alone,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the legend; an empty one has no entry.
    pub name: String,
    /// Points of the curve; one that is not finite breaks the line.
    pub points: Vec<[f64; 2]>,
    pub style: LineStyle,
    pub marks: Marks,
}

impl Curve {
    pub fn new(name: impl Into<String>, style: LineStyle, points: Vec<[f64; 2]>) -> Curve {
        Curve { name: name.into(), points, style, marks: Marks::None }
    }

    /// This curve with a mark on each point.
    pub fn marked(self) -> Curve {
        Curve { marks: Marks::OnLine, ..self }
    }

    /// This curve with every `nth` point as a small dot and without a line, so that curves below stay visible.
    pub fn dotted(self, nth: usize) -> Curve {
        let points = self.points.iter().copied().step_by(nth.max(1)).collect();
        Curve { marks: Marks::Alone, points, ..self }
    }

    /// A piecewise constant curve: each value holds for `step` from its x value on.
    pub fn held(name: impl Into<String>, style: LineStyle, points: &[[f64; 2]], step: f64) -> Curve {
        Curve::new(name, style, points.iter().flat_map(|&[x, y]| [[x, y], [x + step, y]]).collect())
    }
}

/// The place and the axes of a plot.
struct Frame {
    x: Axis,
    y: Axis,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// Widens the range of nearly constant values, so that tick labels differ.
fn with_room(values: Range<f64>) -> Range<f64> {
    let middle = 0.5 * (values.start + values.end);
    let room = if middle.abs() < 1e-9 { 0.1 } else { 0.1 * middle.abs() };
    let flat = values.end - values.start < 0.02 * middle.abs().max(1e-3);
    if flat { middle - room..middle + room } else { values }
}

impl Panels {
    pub fn drawing(&self) -> Drawing {
        let columns = self.columns.max(1);
        let rows = self.panels.len().div_ceil(columns);
        let plot_height = match rows {
            0 | 1 => 460.0,
            2 => 300.0,
            _ => 200.0,
        };
        let cell = WIDTH_PX / columns as f64;
        let common = self.common_legend();
        let legend = common.clone().unwrap_or_default();
        // Height of the names and legends above each row of plots.
        let names: Vec<f64> = match common {
            Some(_) => vec![PANEL_NAME_HEIGHT_PX; rows],
            None => {
                let highest = |row: &[Panel]| highest_legend(row, cell - LEFT_MARGIN_PX - MARGIN_PX);
                self.panels.chunks(columns).map(|row| PANEL_NAME_HEIGHT_PX + highest(row)).collect()
            }
        };
        let head = TITLE_HEIGHT_PX + legend.height(WIDTH_PX - 2.0 * MARGIN_PX) + 6.0;
        let row_height = |names: &f64| names + plot_height + TICK_LABEL_HEIGHT_PX;
        let height = head + names.iter().map(row_height).sum::<f64>();
        let mut drawing = Drawing::new(WIDTH_PX, height + X_LABEL_HEIGHT_PX + 8.0);
        drawing.text([MARGIN_PX, 0.5 * TITLE_HEIGHT_PX], Side::Left, LARGE_TEXT_PX, self.title.as_str());
        legend.draw(&mut drawing, [MARGIN_PX, TITLE_HEIGHT_PX], WIDTH_PX - 2.0 * MARGIN_PX);
        let values = self.values_across();
        for (index, panel) in self.panels.iter().enumerate() {
            let (row, column) = (index / columns, index % columns);
            let (left, right) = (column as f64 * cell + LEFT_MARGIN_PX, (column + 1) as f64 * cell - MARGIN_PX);
            let names_top = head + names[..row].iter().map(row_height).sum::<f64>();
            let top = names_top + names[row];
            let bottom = top + plot_height;
            let y = Axis::new(panel.values(), [bottom, top]);
            let y = if panel.logarithmic { y.logarithmic() } else { y };
            let x = Axis::new(values.clone(), [left, right]).every(self.every);
            panel.draw(&mut drawing, &Frame { x, y, left, right, top, bottom });
            drawing.text(
                [left - 70.0, names_top + 0.5 * PANEL_NAME_HEIGHT_PX],
                Side::Left,
                MEDIUM_TEXT_PX,
                panel.name.as_str(),
            );
            if common.is_none() {
                panel.legend().draw(&mut drawing, [left, names_top + PANEL_NAME_HEIGHT_PX], right - left);
            }
            if index + columns >= self.panels.len() {
                let middle = [0.5 * (left + right), bottom + TICK_LABEL_HEIGHT_PX + 0.5 * X_LABEL_HEIGHT_PX];
                drawing.text(middle, Side::Middle, MEDIUM_TEXT_PX, self.across.as_str());
            }
        }
        drawing
    }

    /// One legend for all plots; `None` if a line style has different meanings in different plots.
    fn common_legend(&self) -> Option<Legend> {
        let mut legend = Legend::default();
        for panel in &self.panels {
            legend = legend.with(&panel.legend());
        }
        (!legend.is_ambiguous()).then_some(legend)
    }

    /// The range of the x axis: exactly that of the curves.
    fn values_across(&self) -> Range<f64> {
        let points = self.panels.iter().flat_map(|panel| &panel.curves).flat_map(|curve| &curve.points);
        let finite = points.filter(|point| point[1].is_finite()).map(|point| point[0]);
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if low < high { low..high } else { range([low]) }
    }
}

fn highest_legend(panels: &[Panel], width: f64) -> f64 {
    panels.iter().map(|panel| panel.legend().height(width)).fold(0.0, f64::max)
}

impl Panel {
    fn legend(&self) -> Legend {
        let mut legend = Legend::default();
        for curve in &self.curves {
            legend.add(Sample::Line(curve.style), &curve.name);
        }
        for (_, name) in &self.limits {
            legend.add(Sample::Line(LIMIT), name);
        }
        for (_, style, name) in &self.events {
            legend.add(Sample::Line(style.thin()), name);
        }
        legend
    }

    fn values(&self) -> Range<f64> {
        let drawn = self.curves.iter().flat_map(|curve| curve.points.iter().map(|point| point[1]));
        let values = drawn.chain(self.limits.iter().map(|(limit, _)| *limit)).chain(self.reaches.iter().copied());
        if !self.logarithmic {
            return with_room(range(values));
        }
        let finite = values.filter(|value| value.is_finite() && *value > 0.0);
        let (low, high) = finite.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        if low < high { 0.8 * low..1.25 * high } else { 0.1..10.0 }
    }

    fn draw(&self, drawing: &mut Drawing, frame: &Frame) {
        let Frame { x, y, left, right, top, bottom } = frame;
        self.draw_axes(drawing, frame);
        for (at, style, _) in &self.events {
            drawing.line(vec![[x.pixel(*at), *top], [x.pixel(*at), *bottom]], style.thin());
        }
        for (limit, _) in &self.limits {
            drawing.line(vec![[*left, y.pixel(*limit)], [*right, y.pixel(*limit)]], LIMIT);
        }
        for curve in &self.curves {
            let pixels: Vec<[f64; 2]> = curve.points.iter().map(|point| [point[0], point[1]]).collect();
            for piece in pixels.split(|point| !point[1].is_finite()).filter(|piece| !piece.is_empty()) {
                let points: Vec<[f64; 2]> = piece.iter().map(|point| [x.pixel(point[0]), y.pixel(point[1])]).collect();
                match curve.marks {
                    Marks::None => {}
                    Marks::OnLine => points.iter().for_each(|&point| drawing.disc(point, 6, curve.style.colour)),
                    Marks::Alone => {
                        points.iter().for_each(|&point| drawing.disc(point, 3, curve.style.colour));
                        continue;
                    }
                }
                drawing.line(points, curve.style);
            }
        }
    }

    fn draw_axes(&self, drawing: &mut Drawing, frame: &Frame) {
        let Frame { x, y, left, right, top, bottom } = frame;
        let (grid, axis) =
            (LineStyle { width: 1, ..LineStyle::new(PALE, Dash::Solid) }, LineStyle::new(GREY, Dash::Solid).thin());
        for (value, words) in x.ticks(105.0) {
            let at = x.pixel(value);
            drawing.line(vec![[at, *top], [at, *bottom]], grid);
            drawing.text([at, bottom + 0.5 * TICK_LABEL_HEIGHT_PX], Side::Middle, SMALL_TEXT_PX, words);
        }
        for (value, words) in y.ticks(42.0) {
            let at = y.pixel(value);
            drawing.line(vec![[*left, at], [*right, at]], grid);
            drawing.text([left - 10.0, at], Side::Right, SMALL_TEXT_PX, words);
        }
        drawing.line(vec![[*left, *top], [*left, *bottom]], axis);
        drawing.line(vec![[*left, *bottom], [*right, *bottom]], axis);
    }
}
