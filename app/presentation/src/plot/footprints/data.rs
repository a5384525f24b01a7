//! Roads, vehicles and their footprints, and the sizes that all pictures of them share.

use super::super::drawing::Drawing;
use super::super::style::{Colour, Dash, Legend, LineStyle, Sample, VERMILLION};
use crate::body::BodyStyle;
use crate::palette::{ASPHALT, PAINT};
use crate::rectangle::extent;
use crate::road_shapes::RoadShapes;

/// Least distance of points of a path: rounding to pixels would make lines of closer points ragged.
const MIN_PATH_SPACING_PX: f64 = 16.0;
/// How far the asphalt reaches beyond the lines at the edges.
pub(super) const SHOULDER_PX: f64 = 4.0;
/// The path of the ego, as in the dissertation.
pub(super) const PATH: LineStyle = LineStyle::new(VERMILLION, Dash::Solid);

/// Vehicles at equal steps of time. Lengths are in metres of the world; the x axis runs along the main road.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FootprintPlot {
    pub title: String,
    pub road: RoadShapes,
    /// Lateral coordinates of the right and the left edge, if all vehicles drive along x on one straight road.
    pub strip_m: Option<[f64; 2]>,
    pub vehicles: Vec<FootprintVehicle>,
    /// The snapshots, in order of time.
    pub snapshots: Vec<FootprintSnapshot>,
    /// Positions of the ego's centre, each with its time \[s\].
    pub path: Vec<(f64, [f64; 2])>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct FootprintVehicle {
    /// Name of the vehicle in the legend.
    pub label: String,
    pub colour: Colour,
    pub style: BodyStyle,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct FootprintSnapshot {
    /// Time of the snapshot \[s\].
    pub time_s: f64,
    /// The corners of each vehicle's body: front right, front left, rear right, rear left.
    pub bodies: Vec<[[f64; 2]; 4]>,
}

impl FootprintPlot {
    pub(super) fn legend(&self) -> Legend {
        let mut legend = Legend::default();
        for vehicle in &self.vehicles {
            legend.add(Sample::Patch(vehicle.colour), &vehicle.label);
        }
        let ego = self.vehicles.first().map_or("", |first| first.label.split(':').next().unwrap_or(&first.label));
        legend.add(Sample::Line(PATH), &format!("path of {ego}"));
        legend
    }

    /// Smallest and largest x and y of all bodies.
    pub(super) fn bounds(&self) -> [[f64; 2]; 2] {
        let bounds = extent(self.snapshots.iter().flat_map(|snapshot| snapshot.bodies.iter().flatten().copied()));
        if bounds[0][0] <= bounds[1][0] { bounds } else { [[0.0; 2], [1.0; 2]] }
    }

    /// Draws the part of the road between least and greatest coordinates \[m\].
    pub(super) fn draw_road(
        &self,
        drawing: &mut Drawing,
        [low, high]: [[f64; 2]; 2],
        place: impl Fn([f64; 2]) -> [f64; 2],
    ) {
        let shoulder = LineStyle { width: 2 * SHOULDER_PX as u32, ..LineStyle::new(ASPHALT, Dash::Solid) };
        for ring in &self.road.surfaces {
            let ring: Vec<[f64; 2]> = clipped(ring, low, high).into_iter().map(&place).collect();
            let outline = ring.iter().chain(ring.first()).copied().collect();
            drawing.line(outline, shoulder);
            drawing.fill(ring, ASPHALT, 1.0);
        }
        for line in [&self.road.edges, &self.road.stop_lines, &self.road.dashes].into_iter().flatten() {
            for visible in clipped_line(line, low, high) {
                drawing.line(spaced(visible.into_iter().map(&place)), LineStyle::new(PAINT, Dash::Solid).thin());
            }
        }
    }

    /// The path until a time in pixels, without points that are too close.
    pub(super) fn path_pixels(&self, until_s: f64, place: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
        let driven = self.path.iter().take_while(|(time_s, _)| *time_s <= until_s + 1e-9);
        spaced(driven.map(|(_, point)| place(*point)))
    }

    pub(super) fn longest_m(&self) -> f64 {
        let bodies = self.snapshots.iter().flat_map(|snapshot| &snapshot.bodies);
        bodies.map(|body| distance(body[0], body[2])).fold(0.0, f64::max).max(1e-3)
    }
}

/// Points of a line, without points that are too close.
pub(super) fn spaced(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut pixels: Vec<[f64; 2]> = Vec::new();
    let mut end = None;
    for pixel in points {
        end = Some(pixel);
        if pixels.last().is_none_or(|last| distance(*last, pixel) >= MIN_PATH_SPACING_PX) {
            pixels.push(pixel);
        }
    }
    // The last point is always kept.
    if let Some(end) = end.filter(|end| pixels.last() != Some(end)) {
        if pixels.len() > 1 {
            pixels.pop();
        }
        pixels.push(end);
    }
    pixels
}

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

/// The part of a polygon within a rectangle (Sutherland and Hodgman).
pub(super) fn clipped(ring: &[[f64; 2]], low: [f64; 2], high: [f64; 2]) -> Vec<[f64; 2]> {
    let mut ring = ring.to_vec();
    for (axis, bound, sign) in [(0, low[0], 1.0), (0, high[0], -1.0), (1, low[1], 1.0), (1, high[1], -1.0)] {
        let depth = |point: [f64; 2]| sign * (point[axis] - bound);
        let mut kept = Vec::new();
        for (index, &point) in ring.iter().enumerate() {
            let before = ring[(index + ring.len() - 1) % ring.len()];
            if (depth(before) < 0.0) != (depth(point) < 0.0) {
                let share = depth(before) / (depth(before) - depth(point));
                kept.push([0, 1].map(|i| before[i] + share * (point[i] - before[i])));
            }
            if depth(point) >= 0.0 {
                kept.push(point);
            }
        }
        ring = kept;
    }
    ring
}

/// The parts of a line within a rectangle (Liang and Barsky).
pub(super) fn clipped_line(line: &[[f64; 2]], low: [f64; 2], high: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
    for pair in line.windows(2) {
        let Some([from, to]) = clipped_segment([pair[0], pair[1]], low, high) else { continue };
        match parts.last_mut().filter(|part| part.last() == Some(&from)) {
            Some(part) => part.push(to),
            None => parts.push(vec![from, to]),
        }
    }
    parts
}

fn clipped_segment([from, to]: [[f64; 2]; 2], low: [f64; 2], high: [f64; 2]) -> Option<[[f64; 2]; 2]> {
    let (mut begin, mut end) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let delta = to[axis] - from[axis];
        let bounds = [low[axis] - from[axis], high[axis] - from[axis]];
        if delta == 0.0 {
            if bounds[0] > 0.0 || bounds[1] < 0.0 {
                return None;
            }
            continue;
        }
        let shares = bounds.map(|bound| bound / delta);
        begin = begin.max(shares[0].min(shares[1]));
        end = end.min(shares[0].max(shares[1]));
    }
    // Ends inside the rectangle stay exact, so that parts join.
    let at = |share: f64| match share {
        0.0 => from,
        1.0 => to,
        _ => [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis])),
    };
    (begin < end).then(|| [at(begin), at(end)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_is_clipped_to_the_rectangle() {
        let diamond = [[0.0, -2.0], [2.0, 0.0], [0.0, 2.0], [-2.0, 0.0]];
        let inside = clipped(&diamond, [-1.0, -1.0], [1.0, 1.0]);
        let area: f64 = (0..inside.len())
            .map(|i| {
                let ([x, y], [next_x, next_y]) = (inside[i], inside[(i + 1) % inside.len()]);
                0.5 * (x * next_y - next_x * y)
            })
            .sum();
        assert!((area - 4.0).abs() < 1e-12, "the diamond covers the whole square: {area}");
        assert!(clipped(&diamond, [3.0, 3.0], [4.0, 4.0]).is_empty());
    }

    #[test]
    fn a_line_is_clipped_to_the_rectangle() {
        let line = [[-3.0, 0.0], [0.0, 0.0], [0.0, 3.0], [0.5, 3.0], [0.5, -3.0]];
        let parts = clipped_line(&line, [-1.0, -1.0], [1.0, 1.0]);
        assert_eq!(parts, [vec![[-1.0, 0.0], [0.0, 0.0], [0.0, 1.0]], vec![[0.5, 1.0], [0.5, -1.0]]]);
    }
}
