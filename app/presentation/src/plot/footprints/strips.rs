//! One strip of road per snapshot, below the one before.

use super::super::axis::Axis;
use super::super::drawing::{
    Drawing, LARGE_TEXT_PX, MARGIN_PX, MEDIUM_TEXT_PX, SMALL_TEXT_PX, Side, TITLE_HEIGHT_PX, WIDTH_PX,
    X_LABEL_HEIGHT_PX,
};
use super::super::style::{Dash, GREY, LineStyle};
use super::body;
use super::data::{FootprintPlot, PATH, SHOULDER_PX};

/// Space at the left of each strip, for the number and the time of its snapshot.
const LEFT_MARGIN_PX: f64 = 150.0;
const STRIP_SPACING_PX: f64 = 16.0;
/// Height of the tick labels of the x axis.
const TICK_LABEL_HEIGHT_PX: f64 = 36.0;
/// Smallest length of a body that is visible. If bodies would be shorter, the strips move along with the ego.
const MIN_BODY_LENGTH_PX: f64 = 40.0;
/// The length of the longest body in strips that move along with the ego.
const FOLLOWED_BODY_LENGTH_PX: f64 = 64.0;
const MAX_STRIP_HEIGHT_PX: f64 = 150.0;

/// The part of the road that the strips show, and its scale.
struct Window {
    scale: f64,
    /// Length of the visible part \[m\].
    length_m: f64,
    /// Where the visible part begins: a coordinate along the road, or relative to the ego if it moves \[m\].
    start_m: f64,
    /// Whether it moves along with the ego.
    moves: bool,
    /// Lateral coordinates of the outermost edges.
    edges_m: [f64; 2],
}

impl Window {
    fn choose(footprints: &FootprintPlot) -> Window {
        let [[from, _], [to, _]] = footprints.bounds();
        let edges_m = footprints.strip_m.unwrap_or([0.0, 1.0]);
        let (margin, longest) = (0.5 * footprints.longest_m(), footprints.longest_m());
        let space = WIDTH_PX - LEFT_MARGIN_PX - MARGIN_PX;
        let whole = space / (to - from + 2.0 * margin);
        let height = MAX_STRIP_HEIGHT_PX / (edges_m[1] - edges_m[0]);
        if whole * longest < MIN_BODY_LENGTH_PX {
            let scale = (FOLLOWED_BODY_LENGTH_PX / longest).min(height);
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
        let window = Window::choose(self);
        let legend = self.legend();
        let head = TITLE_HEIGHT_PX + legend.height(WIDTH_PX - 2.0 * MARGIN_PX) + 22.0;
        let row = window.height() + STRIP_SPACING_PX;
        let bottom = head + self.snapshots.len() as f64 * row;
        let mut drawing = Drawing::new(WIDTH_PX, bottom + TICK_LABEL_HEIGHT_PX + X_LABEL_HEIGHT_PX + 8.0);
        drawing.text([MARGIN_PX, 0.5 * TITLE_HEIGHT_PX], Side::Left, LARGE_TEXT_PX, self.title.as_str());
        legend.draw(&mut drawing, [MARGIN_PX, TITLE_HEIGHT_PX], WIDTH_PX - 2.0 * MARGIN_PX);
        for index in 0..self.snapshots.len() {
            self.draw_strip(&mut drawing, &window, index, head + index as f64 * row);
        }
        let axis = Axis::new(window.start_m..window.start_m + window.length_m, [LEFT_MARGIN_PX, WIDTH_PX - MARGIN_PX]);
        for (value, words) in axis.ticks(105.0) {
            let x = axis.pixel(value);
            drawing.line(
                vec![[x, bottom - STRIP_SPACING_PX], [x, bottom - STRIP_SPACING_PX + 8.0]],
                LineStyle::new(GREY, Dash::Solid).thin(),
            );
            drawing.text([x, bottom + 0.3 * TICK_LABEL_HEIGHT_PX], Side::Middle, SMALL_TEXT_PX, words);
        }
        let across = if window.moves { "place along the road, from the ego [m]" } else { "place along the road [m]" };
        let middle =
            [0.5 * (LEFT_MARGIN_PX + WIDTH_PX - MARGIN_PX), bottom + TICK_LABEL_HEIGHT_PX + 0.4 * X_LABEL_HEIGHT_PX];
        drawing.text(middle, Side::Middle, MEDIUM_TEXT_PX, across);
        drawing
    }

    fn draw_strip(&self, drawing: &mut Drawing, window: &Window, index: usize, top: f64) {
        let snapshot = &self.snapshots[index];
        let centre = |body: &[[f64; 2]; 4]| 0.25 * body.iter().map(|corner| corner[0]).sum::<f64>();
        let shift_m = if window.moves { snapshot.bodies.first().map_or(0.0, centre) } else { 0.0 };
        let bottom = top + window.height();
        let point = |[x, y]: [f64; 2]| {
            let along = LEFT_MARGIN_PX + (x - shift_m - window.start_m) * window.scale;
            [along, bottom - (y - window.edges_m[0]) * window.scale]
        };
        let start_m = window.start_m + shift_m;
        let beyond_m = SHOULDER_PX / window.scale;
        let visible_m =
            [[start_m, window.edges_m[0] - beyond_m], [start_m + window.length_m, window.edges_m[1] + beyond_m]];
        self.draw_road(drawing, visible_m, point);
        let path = self.path_pixels(snapshot.time_s, point).into_iter();
        drawing.line(path.filter(|[x, _]| (LEFT_MARGIN_PX..=WIDTH_PX - MARGIN_PX).contains(x)).collect(), PATH);
        let number = format!("{}", index + 1);
        for (body, vehicle) in snapshot.bodies.iter().zip(&self.vehicles) {
            let x = body.map(|corner| LEFT_MARGIN_PX + (corner[0] - shift_m - window.start_m) * window.scale);
            if x.iter().all(|x| (LEFT_MARGIN_PX..=WIDTH_PX - MARGIN_PX).contains(x)) {
                body::draw(drawing, body.map(point), vehicle.style, vehicle.colour, 1.0);
            }
        }
        let middle = 0.5 * (top + bottom);
        drawing.text([MARGIN_PX, middle], Side::Left, LARGE_TEXT_PX, number);
        drawing.text([LEFT_MARGIN_PX - 14.0, middle], Side::Right, SMALL_TEXT_PX, format!("{:.1} s", snapshot.time_s));
    }
}
