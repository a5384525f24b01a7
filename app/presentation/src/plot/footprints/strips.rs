//! One strip of road per snapshot, below the one before.

use super::super::axis::Axis;
use super::super::drawing::{Drawing, LARGE, MEDIUM, SMALL, Side};
use super::super::style::{Dash, GREY, LineStyle, PAPER, SURFACE};
use super::{FootprintPlot, MARGIN, PATH, TITLE, WIDTH, body};

/// Space for the number and the time of a snapshot \[px\].
const LEFT: f64 = 150.0;
const BETWEEN: f64 = 16.0;
const TICKS: f64 = 36.0;
const ACROSS: f64 = 38.0;
/// A body shorter than this cannot be seen: the strips then move along with the ego \[px\].
const MIN_BODY_LENGTH: f64 = 40.0;
/// The length of a body in strips that move along with the ego \[px\].
const FOLLOWED_BODY_LENGTH: f64 = 64.0;
/// The highest strip \[px\].
const MAX_STRIP_HEIGHT: f64 = 150.0;

/// What part of the road the strips show, and how large.
struct Window {
    /// Pixels per metre.
    scale: f64,
    /// How much road is visible \[m\].
    length_m: f64,
    /// Where the visible part begins: on the road, or before the ego.
    start_m: f64,
    /// Whether it moves along with the ego.
    moves: bool,
    /// Lateral coordinates of the outermost edges.
    edges_m: [f64; 2],
}

impl Window {
    fn of(footprints: &FootprintPlot) -> Window {
        let [[from, _], [to, _]] = footprints.bounds();
        let edges = footprints.roads.iter().map(|road| road.edges_m);
        let mut edges_m = edges
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [right, left]| [low.min(right), high.max(left)]);
        if edges_m[0] >= edges_m[1] {
            edges_m = [0.0, 1.0];
        }
        let (margin, longest) = (0.5 * footprints.longest_m(), footprints.longest_m());
        let space = WIDTH - LEFT - MARGIN;
        let whole = space / (to - from + 2.0 * margin);
        let height = MAX_STRIP_HEIGHT / (edges_m[1] - edges_m[0]);
        if whole * longest < MIN_BODY_LENGTH {
            let scale = (FOLLOWED_BODY_LENGTH / longest).min(height);
            return Window { scale, length_m: space / scale, start_m: -0.5 * space / scale, moves: true, edges_m };
        }
        let scale = whole.min(height);
        Window { scale, length_m: space / scale, start_m: from - margin, moves: false, edges_m }
    }

    fn height(&self) -> f64 {
        self.scale * (self.edges_m[1] - self.edges_m[0])
    }
}

impl FootprintPlot {
    /// Snapshots one below the other, all of the same part of the road, or of the part around the ego.
    pub fn strips(&self) -> Drawing {
        let window = Window::of(self);
        let legend = self.legend();
        let head = TITLE + legend.height(WIDTH - 2.0 * MARGIN) + 22.0;
        let row = window.height() + BETWEEN;
        let bottom = head + self.snapshots.len() as f64 * row;
        let mut drawing = Drawing::new(WIDTH, bottom + TICKS + ACROSS + 8.0);
        drawing.text([MARGIN, 0.5 * TITLE], Side::Left, LARGE, self.title.as_str());
        legend.draw(&mut drawing, [MARGIN, TITLE], WIDTH - 2.0 * MARGIN);
        for index in 0..self.snapshots.len() {
            self.draw_strip(&mut drawing, &window, index, head + index as f64 * row);
        }
        let axis = Axis::new(window.start_m..window.start_m + window.length_m, [LEFT, WIDTH - MARGIN]);
        for (value, words) in axis.ticks(105.0) {
            let x = axis.pixel(value);
            drawing.line(
                vec![[x, bottom - BETWEEN], [x, bottom - BETWEEN + 8.0]],
                LineStyle::new(GREY, Dash::Solid).thin(),
            );
            drawing.text([x, bottom + 0.3 * TICKS], Side::Middle, SMALL, words);
        }
        let across = if window.moves { "place along the road, from the ego [m]" } else { "place along the road [m]" };
        let middle = [0.5 * (LEFT + WIDTH - MARGIN), bottom + TICKS + 0.4 * ACROSS];
        drawing.text(middle, Side::Middle, MEDIUM, across);
        drawing
    }

    fn draw_strip(&self, drawing: &mut Drawing, window: &Window, index: usize, top: f64) {
        let snapshot = &self.snapshots[index];
        let centre = |body: &[[f64; 2]; 4]| 0.25 * body.iter().map(|corner| corner[0]).sum::<f64>();
        let shift_m = if window.moves { snapshot.bodies.first().map_or(0.0, centre) } else { 0.0 };
        let bottom = top + window.height();
        let point = |[x, y]: [f64; 2]| {
            let along = LEFT + (x - shift_m - window.start_m) * window.scale;
            [along, bottom - (y - window.edges_m[0]) * window.scale]
        };
        let place = |at: [f64; 2]| {
            let [x, y] = point(at);
            [x.clamp(LEFT, WIDTH - MARGIN), y]
        };
        drawing.block([LEFT, top], [WIDTH - MARGIN, bottom], SURFACE);
        for road in &self.roads {
            if !road.shoulder_m.is_empty() {
                drawing.fill(road.shoulder_m.iter().map(|&point| place(point)).collect(), PAPER, 1.0);
            }
            for &lateral_m in &road.dividers_m {
                let y = place([0.0, lateral_m])[1];
                drawing.line(vec![[LEFT, y], [WIDTH - MARGIN, y]], LineStyle::new(GREY, Dash::Long).thin());
            }
        }
        for y in [top, bottom] {
            drawing.line(vec![[LEFT, y], [WIDTH - MARGIN, y]], LineStyle::new(GREY, Dash::Solid).thin());
        }
        let path = self.path_pixels(snapshot.time_s, point).into_iter();
        drawing.line(path.filter(|[x, _]| (LEFT..=WIDTH - MARGIN).contains(x)).collect(), PATH);
        let number = format!("{}", index + 1);
        for (body, (_, colour)) in snapshot.bodies.iter().zip(&self.vehicles) {
            let x = body.map(|corner| LEFT + (corner[0] - shift_m - window.start_m) * window.scale);
            if x.iter().all(|x| (LEFT..=WIDTH - MARGIN).contains(x)) {
                let corners = body.map(place);
                body::draw(drawing, corners, *colour, 1.0);
                body::number(drawing, corners, *colour, &number);
            }
        }
        let middle = 0.5 * (top + bottom);
        drawing.text([MARGIN, middle], Side::Left, LARGE, number);
        drawing.text([LEFT - 14.0, middle], Side::Right, SMALL, format!("{:.1} s", snapshot.time_s));
    }
}
