//! Roads, vehicles and their footprints, and the sizes that all pictures of them share.

use super::super::legend::{Legend, Sample};
use super::super::style::{Colour, Dash, LineStyle, VERMILLION};
use crate::body_style::BodyStyle;
use crate::extent::extent;

/// Width of the picture.
pub(super) const WIDTH_PX: f64 = 1400.0;
/// Space at the sides of the picture.
pub(super) const MARGIN_PX: f64 = 30.0;
/// Height of the line with the title.
pub(super) const TITLE_HEIGHT_PX: f64 = 48.0;
/// Smallest distance of two points of a path: closer points are rounded to whole pixels and make the line ragged.
const MIN_PATH_SPACING_PX: f64 = 16.0;
/// Roads cross if the sine of the angle between them is larger than this.
const LEAST_CROSSING_SIN: f64 = 1e-3;
/// The path of the ego, as the source draws it.
pub(super) const PATH: LineStyle = LineStyle::new(VERMILLION, Dash::Solid);

/// Vehicles at equal steps of time. Lengths are in metres, in a frame whose x axis runs along the main road.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FootprintPlot {
    /// What it shows.
    pub title: String,
    /// The straight roads.
    pub roads: Vec<Strip>,
    /// The roads that turn, and networks.
    pub curves: Vec<CurvedStrip>,
    /// The vehicles.
    pub vehicles: Vec<FootprintVehicle>,
    /// The snapshots, in order of time.
    pub snapshots: Vec<FootprintSnapshot>,
    /// Where the ego's centre was, with the time \[s\].
    pub path: Vec<(f64, [f64; 2])>,
}

/// A straight road.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strip {
    /// Its direction, counter-clockwise from x \[rad\].
    pub heading_rad: f64,
    /// Lateral coordinates of its right and its left edge.
    pub edges_m: [f64; 2],
    /// Lateral coordinates of the lines between its lanes.
    pub dividers_m: Vec<f64>,
    /// Where its right edge leaves the straight line, beside a ramp that ends: points along the road and across it, in the
    /// order of the road. After the last one it keeps its lateral coordinate.
    pub tapered_edge_m: Vec<[f64; 2]>,
}

impl Strip {
    /// The right edge from one place along the road to another.
    pub(super) fn right_edge(&self, [from_m, to_m]: [f64; 2]) -> Vec<[f64; 2]> {
        let inside = self.tapered_edge_m.iter().copied().filter(|[along_m, _]| (from_m..to_m).contains(along_m));
        let ends = [from_m, to_m].map(|along_m| [along_m, self.right_edge_at(along_m)]);
        std::iter::once(ends[0]).chain(inside).chain([ends[1]]).collect()
    }

    fn right_edge_at(&self, along_m: f64) -> f64 {
        let points = &self.tapered_edge_m;
        match points.partition_point(|point| point[0] <= along_m) {
            0 => self.edges_m[0],
            next if next == points.len() => points[next - 1][1],
            next => {
                let [[before_m, before], [after_m, after]] = [points[next - 1], points[next]];
                before + (along_m - before_m) / (after_m - before_m) * (after - before)
            }
        }
    }

    /// The corners of the area that is also on another straight road, where lines end; none beside it.
    pub(super) fn crossing(&self, other: &Strip) -> Option<[[f64; 2]; 4]> {
        let ([sin, cos], [other_sin, other_cos]) = (sin_cos(self.heading_rad), sin_cos(other.heading_rad));
        let across = cos * other_sin - sin * other_cos;
        // A corner is where y cos − x sin is the lateral coordinate of an edge of both.
        let corner = |edge_m: f64, other_m: f64| {
            [other_cos * edge_m - cos * other_m, other_sin * edge_m - sin * other_m].map(|part| part / across)
        };
        let ([right, left], [other_right, other_left]) = (self.edges_m, other.edges_m);
        let pairs = [(right, other_right), (right, other_left), (left, other_left), (left, other_right)];
        (across.abs() > LEAST_CROSSING_SIN).then(|| pairs.map(|(edge_m, other_m)| corner(edge_m, other_m)))
    }

    /// The same road with edges further out.
    pub(super) fn wider(&self, by_m: f64) -> Strip {
        Strip { edges_m: [self.edges_m[0] - by_m, self.edges_m[1] + by_m], ..self.clone() }
    }

    /// The area between the outermost edges that is not road, between two places along the road; it leaves free a margin beside
    /// the edge, and reaches as far beyond the outermost one.
    pub(super) fn shoulder(&self, span_m: [f64; 2], margin_m: f64) -> Vec<[f64; 2]> {
        let lowest_m = self.edges_m[0] - margin_m;
        let straight = [span_m[1], span_m[0]].map(|along_m| [along_m, lowest_m]);
        let edge = self.right_edge(span_m).into_iter().map(|[along_m, edge_m]| [along_m, edge_m - margin_m]);
        edge.chain(straight).collect()
    }
}

/// A road that turns or a network of lanes, in the frame of the picture \[m\].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurvedStrip {
    /// Closed polygons that together cover it.
    pub surfaces_m: Vec<Vec<[f64; 2]>>,
    /// Its edges.
    pub edges_m: Vec<Vec<[f64; 2]>>,
    /// The lines between its lanes.
    pub dividers_m: Vec<Vec<[f64; 2]>>,
}

/// A vehicle that leaves footprints.
#[derive(Clone, Debug, PartialEq)]
pub struct FootprintVehicle {
    /// What the legend calls it.
    pub label: String,
    /// Its colour.
    pub colour: Colour,
    /// What it looks like.
    pub style: BodyStyle,
}

/// The vehicles at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FootprintSnapshot {
    /// When it is \[s\].
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
        let who = self.vehicles.first().map_or("", |first| first.label.split(':').next().unwrap_or(&first.label));
        legend.add(Sample::Line(PATH), &format!("path of {who}"));
        legend
    }

    /// Smallest and largest x and y of all bodies.
    pub(super) fn bounds(&self) -> [[f64; 2]; 2] {
        let bounds = extent(self.snapshots.iter().flat_map(|snapshot| snapshot.bodies.iter().flatten().copied()));
        if bounds[0][0] <= bounds[1][0] { bounds } else { [[0.0; 2], [1.0; 2]] }
    }

    /// The path in pixels until a time, with no two points closer than a line can show.
    pub(super) fn path_pixels(&self, until_s: f64, place: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
        let driven = self.path.iter().take_while(|(time_s, _)| *time_s <= until_s + 1e-9);
        spaced(driven.map(|(_, point)| place(*point)))
    }

    /// Length of the longest body.
    pub(super) fn longest_m(&self) -> f64 {
        let bodies = self.snapshots.iter().flat_map(|snapshot| &snapshot.bodies);
        bodies.map(|body| distance(body[0], body[2])).fold(0.0, f64::max).max(1e-3)
    }
}

/// Points of a line, with no two closer than a line can show.
pub(super) fn spaced(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut pixels: Vec<[f64; 2]> = Vec::new();
    let mut end = None;
    for pixel in points {
        end = Some(pixel);
        if pixels.last().is_none_or(|last| distance(*last, pixel) >= MIN_PATH_SPACING_PX) {
            pixels.push(pixel);
        }
    }
    // It ends where the line ends.
    if let Some(end) = end.filter(|end| pixels.last() != Some(end)) {
        if pixels.len() > 1 {
            pixels.pop();
        }
        pixels.push(end);
    }
    pixels
}

fn sin_cos(angle_rad: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(angle_rad);
    [sin, cos]
}

/// The distance of two points.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}
