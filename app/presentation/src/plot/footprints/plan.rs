//! All snapshots in one plan, for roads that cross or turn.

use super::super::axis::Axis;
use super::super::drawing::{
    Drawing, LARGE_TEXT_PX, LEFT_MARGIN_PX, MARGIN_PX, MEDIUM_TEXT_PX, SMALL_TEXT_PX, Side, TICK_LABEL_HEIGHT_PX,
    TITLE_HEIGHT_PX, WIDTH_PX, X_LABEL_HEIGHT_PX,
};
use super::super::style::{Colour, Dash, GREY, LineStyle};
use super::body;
use super::data::{FootprintPlot, PATH, distance};
use crate::palette::ASPHALT;
use crate::rectangle::extent;

const MAX_PLAN_HEIGHT_PX: f64 = 900.0;
/// How far the plan reaches beyond all footprints, as a multiple of the longest one.
const ROAD_AROUND_BODIES_RATIO: f64 = 1.5;

/// Opacities of the first and the last footprint of a vehicle.
const OPACITIES: [f64; 2] = [0.55, 0.95];

/// A footprint, which represents all snapshots in which the vehicle still overlaps it.
struct PlanFootprint {
    vehicle: usize,
    /// The first and the last snapshot that it represents.
    snapshots: [usize; 2],
    /// Whether it is the first footprint of the vehicle or the last.
    is_end: bool,
    body: [[f64; 2]; 4],
}

impl PlanFootprint {
    fn words(&self) -> String {
        match self.snapshots {
            [first, last] if first == last => format!("{}", first + 1),
            [first, last] => format!("{}–{}", first + 1, last + 1),
        }
    }
}

/// Whether two bodies overlap, by the separating-axis test.
fn touch(a: &[[f64; 2]; 4], b: &[[f64; 2]; 4]) -> bool {
    let separates = |body: &[[f64; 2]; 4], [from, to]: [usize; 2]| {
        let axis = [0, 1].map(|part| body[to][part] - body[from][part]);
        let span = |body: &[[f64; 2]; 4]| extent(body.iter().map(|[x, y]| [axis[0] * x + axis[1] * y, 0.0]));
        let ([[low, _], [high, _]], [[others_low, _], [others_high, _]]) = (span(a), span(b));
        high < others_low || others_high < low
    };
    ![a, b].iter().any(|body| [[0, 1], [0, 2]].into_iter().any(|side| separates(body, side)))
}

/// Whether a point lies in a body.
fn contains([front_right, front_left, rear_right, rear_left]: &[[f64; 2]; 4], point: [f64; 2]) -> bool {
    let ring = [front_right, front_left, rear_left, rear_right];
    (0..4).all(|i| {
        let ([x, y], [next_x, next_y]) = (*ring[i], *ring[(i + 1) % 4]);
        (next_x - x) * (point[1] - y) - (next_y - y) * (point[0] - x) >= 0.0
    })
}

fn on_asphalt(colour: Colour, opacity: f64) -> Colour {
    let mixed = |part: usize| opacity * f64::from(colour[part]) + (1.0 - opacity) * f64::from(ASPHALT[part]);
    [0, 1, 2].map(|part| mixed(part) as u8)
}

struct Map {
    low_m: [f64; 2],
    high_m: [f64; 2],
    scale: f64,
    left: f64,
    bottom: f64,
}

impl Map {
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.left + (x - self.low_m[0]) * self.scale, self.bottom - (y - self.low_m[1]) * self.scale]
    }

    fn right(&self) -> f64 {
        self.place(self.high_m)[0]
    }

    fn top(&self) -> f64 {
        self.place(self.high_m)[1]
    }
}

impl FootprintPlot {
    /// The roads from above, with every footprint of every snapshot.
    pub fn plan(&self) -> Drawing {
        let margin = ROAD_AROUND_BODIES_RATIO * self.longest_m();
        let [low, high] = self.bounds();
        let (low_m, high_m) = (low.map(|value| value - margin), high.map(|value| value + margin));
        let legend = self.legend();
        let steps = self.snapshots.get(1).map_or(0.0, |snapshot| snapshot.time_s - self.snapshots[0].time_s);
        let head = TITLE_HEIGHT_PX + legend.height(WIDTH_PX - 2.0 * MARGIN_PX) + 84.0;
        let wide = (WIDTH_PX - LEFT_MARGIN_PX - MARGIN_PX) / (high_m[0] - low_m[0]);
        let scale = wide.min(MAX_PLAN_HEIGHT_PX / (high_m[1] - low_m[1]));
        let [across, upwards] = [0, 1].map(|axis| (high_m[axis] - low_m[axis]) * scale);
        let left = LEFT_MARGIN_PX + 0.5 * (WIDTH_PX - LEFT_MARGIN_PX - MARGIN_PX - across);
        let map = Map { low_m, high_m, scale, left, bottom: head + upwards };
        let mut drawing = Drawing::new(WIDTH_PX, head + upwards + TICK_LABEL_HEIGHT_PX + X_LABEL_HEIGHT_PX + 8.0);
        drawing.text([MARGIN_PX, 0.5 * TITLE_HEIGHT_PX], Side::Left, LARGE_TEXT_PX, self.title.as_str());
        legend.draw(&mut drawing, [MARGIN_PX, TITLE_HEIGHT_PX], WIDTH_PX - 2.0 * MARGIN_PX);
        let words =
            format!("footprint 1 at 0 s, then one every {steps:.1} s; a car that has hardly moved has one for several");
        drawing.text([MARGIN_PX, head - 66.0], Side::Left, MEDIUM_TEXT_PX, words);
        self.draw_road(&mut drawing, [low_m, high_m], |point| map.place(point));
        map.draw_axes(&mut drawing);
        drawing.line(self.path_pixels(f64::INFINITY, |point| map.place(point)), PATH);
        self.draw_footprints(&mut drawing, &map);
        drawing
    }

    fn draw_footprints(&self, drawing: &mut Drawing, map: &Map) {
        let last = self.snapshots.len().saturating_sub(1).max(1) as f64;
        let opacity = |index: usize| OPACITIES[0] + (OPACITIES[1] - OPACITIES[0]) * index as f64 / last;
        let mut footprints: Vec<PlanFootprint> =
            (0..self.vehicles.len()).flat_map(|vehicle| self.kept(vehicle)).collect();
        footprints.sort_by_key(|footprint| (footprint.snapshots[0], footprint.vehicle));
        for PlanFootprint { vehicle, snapshots, body, .. } in &footprints {
            let (corners, drawn) = (body.map(|corner| map.place(corner)), &self.vehicles[*vehicle]);
            body::draw(drawing, corners, drawn.style, drawn.colour, opacity(snapshots[0]));
        }
        // If space is short, the first and the last footprint of each vehicle have priority.
        footprints.sort_by_key(|footprint| !footprint.is_end);
        for footprint in &footprints {
            let PlanFootprint { vehicle, snapshots, body, .. } = footprint;
            let (words, corners, mates) =
                (footprint.words(), body.map(|corner| map.place(corner)), self.lane_mates(*vehicle));
            match mates.iter().position(|mate| mate == vehicle) {
                Some(place) if mates.len() > 1 => body::number_beside(drawing, corners, place % 2 == 0, &words),
                _ if self.is_crossed(*vehicle, body) => body::number_beside(drawing, corners, true, &words),
                _ => {
                    let ground = on_asphalt(self.vehicles[*vehicle].colour, opacity(snapshots[0]));
                    body::number(drawing, corners, ground, &words);
                }
            }
        }
    }

    /// The footprints of a vehicle that do not overlap the previous one.
    fn kept(&self, vehicle: usize) -> Vec<PlanFootprint> {
        let bodies: Vec<_> = self.snapshots.iter().filter_map(|snapshot| snapshot.bodies.get(vehicle)).collect();
        let mut kept = Vec::new();
        let mut first = 0;
        while first < bodies.len() {
            let last = first + bodies[first + 1..].iter().take_while(|body| touch(bodies[first], body)).count();
            let is_end = first == 0 || last + 1 == bodies.len();
            kept.push(PlanFootprint { vehicle, snapshots: [first, last], is_end, body: *bodies[first] });
            first = last + 1;
        }
        kept
    }

    /// Whether the middle of a footprint is on one of another vehicle at any time.
    fn is_crossed(&self, vehicle: usize, body: &[[f64; 2]; 4]) -> bool {
        let middle = [0, 1].map(|axis| 0.25 * body.iter().map(|corner| corner[axis]).sum::<f64>());
        let others = self.snapshots.iter().flat_map(|snapshot| snapshot.bodies.iter().enumerate());
        others.filter(|(other, _)| *other != vehicle).any(|(_, other)| contains(other, middle))
    }
}

impl FootprintPlot {
    /// The vehicles that start in the lane of a vehicle. Their footprints overlap, so their numbers are drawn beside them.
    fn lane_mates(&self, vehicle: usize) -> Vec<usize> {
        let Some(start) = self.snapshots.first() else { return Vec::new() };
        let lane = |[front_right, front_left, rear_right, _]: [[f64; 2]; 4]| {
            let length = distance(front_right, rear_right);
            let [cos, sin] = [0, 1].map(|axis| (front_right[axis] - rear_right[axis]) / length);
            let middle = [0, 1].map(|axis| 0.5 * (front_right[axis] + front_left[axis]));
            ([cos, sin], cos * middle[1] - sin * middle[0])
        };
        let width = start.bodies.get(vehicle).map_or(0.0, |body| distance(body[0], body[1]));
        let same = |other: &usize| {
            let (Some(a), Some(b)) = (start.bodies.get(vehicle), start.bodies.get(*other)) else { return false };
            let ((along, lateral), (others, beside)) = (lane(*a), lane(*b));
            distance(along, others) < 0.1 && (lateral - beside).abs() < 0.5 * width
        };
        (0..self.vehicles.len()).filter(same).collect()
    }
}

impl Map {
    fn draw_axes(&self, drawing: &mut Drawing) {
        let [left, right, top, bottom] = [self.left, self.right(), self.top(), self.bottom];
        let axis = LineStyle::new(GREY, Dash::Solid).thin();
        let [x, y] = [0, 1].map(|i| self.low_m[i]..self.high_m[i]);
        let (x, y) = (Axis::new(x, [left, right]), Axis::new(y, [bottom, top]));
        for (value, words) in x.ticks(105.0) {
            drawing.line(vec![[x.pixel(value), bottom], [x.pixel(value), bottom + 8.0]], axis);
            drawing.text([x.pixel(value), bottom + 0.65 * TICK_LABEL_HEIGHT_PX], Side::Middle, SMALL_TEXT_PX, words);
        }
        for (value, words) in y.ticks(80.0) {
            drawing.line(vec![[left - 8.0, y.pixel(value)], [left, y.pixel(value)]], axis);
            drawing.text([left - 14.0, y.pixel(value)], Side::Right, SMALL_TEXT_PX, words);
        }
        drawing.line(vec![[left, top], [left, bottom], [right, bottom]], axis);
        drawing.text([left - 14.0, top - 20.0], Side::Right, MEDIUM_TEXT_PX, "y [m]");
        drawing.text(
            [0.5 * (left + right), bottom + TICK_LABEL_HEIGHT_PX + 0.5 * X_LABEL_HEIGHT_PX],
            Side::Middle,
            MEDIUM_TEXT_PX,
            "x [m]",
        );
    }
}
