//! Numbered footprints of vehicles at equal time steps, on their roads.
//!
//! Where all roads run the same way, each snapshot is a strip below the one before ([`FootprintPlot::strips`]): vehicles
//! in one lane would cover one another otherwise. Where roads cross, all snapshots are in one plan ([`FootprintPlot::plan`]).

mod body;
mod plan;
mod strips;

use super::drawing::Drawing;
use super::legend::{Legend, Sample};
use super::style::{Colour, Dash, LineStyle, VERMILLION};

/// Width of the picture.
const WIDTH_PX: f64 = 1400.0;
/// Space at the sides of the picture.
const MARGIN_PX: f64 = 30.0;
/// Height of the line with the title.
const TITLE_HEIGHT_PX: f64 = 48.0;
/// Smallest distance of two points of a path: closer points are rounded to whole pixels and make the line ragged.
const MIN_PATH_SPACING_PX: f64 = 16.0;
/// The path of the ego, as the source draws it.
const PATH: LineStyle = LineStyle::new(VERMILLION, Dash::Solid);

/// Vehicles at equal steps of time. Lengths are in metres, in a frame whose x axis runs along the main road.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FootprintPlot {
    /// What it shows.
    pub title: String,
    /// The roads.
    pub roads: Vec<Strip>,
    /// The vehicles, each with its label and colour.
    pub vehicles: Vec<(String, Colour)>,
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
    /// The area between the edges that is not road, beside a ramp that ends: a polygon in the frame of the picture.
    pub shoulder_m: Vec<[f64; 2]>,
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
    /// The picture that suits the roads.
    pub fn drawing(&self) -> Drawing {
        let parallel = self.roads.iter().all(|road| libm::cos(road.heading_rad) > 0.999);
        if parallel { self.strips() } else { self.plan() }
    }

    fn legend(&self) -> Legend {
        let mut legend = Legend::default();
        for (name, colour) in &self.vehicles {
            legend.add(Sample::Patch(*colour), name);
        }
        let who = self.vehicles.first().map_or("", |(name, _)| name.split(':').next().unwrap_or(name));
        legend.add(Sample::Line(PATH), &format!("path of {who}"));
        legend
    }

    /// Smallest and largest x and y of all bodies.
    fn bounds(&self) -> [[f64; 2]; 2] {
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for point in self.snapshots.iter().flat_map(|snapshot| snapshot.bodies.iter().flatten()) {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(point[axis]);
                bounds[1][axis] = bounds[1][axis].max(point[axis]);
            }
        }
        if bounds[0][0] <= bounds[1][0] { bounds } else { [[0.0; 2], [1.0; 2]] }
    }

    /// The path in pixels until a time, with no two points closer than a line can show.
    fn path_pixels(&self, until_s: f64, place: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
        let mut pixels: Vec<[f64; 2]> = Vec::new();
        for (_, point) in self.path.iter().take_while(|(time_s, _)| *time_s <= until_s + 1e-9) {
            let pixel = place(*point);
            if pixels.last().is_none_or(|last| distance(*last, pixel) >= MIN_PATH_SPACING_PX) {
                pixels.push(pixel);
            }
        }
        pixels
    }

    /// Length of the longest body.
    fn longest_m(&self) -> f64 {
        let bodies = self.snapshots.iter().flat_map(|snapshot| &snapshot.bodies);
        bodies.map(|body| distance(body[0], body[2])).fold(0.0, f64::max).max(1e-3)
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::drawing::Mark;
    use crate::plot::style::{BLUE, ORANGE};

    /// Two cars of 4.5 m on a straight road, seen at equal steps while they go `length_m`.
    fn drive(length_m: f64) -> FootprintPlot {
        let body = |x: f64, y: f64| [[x + 2.3, y - 1.0], [x + 2.3, y + 1.0], [x - 2.2, y - 1.0], [x - 2.2, y + 1.0]];
        let place = |i: u32| f64::from(i) * length_m / 7.0;
        let snapshot = |i: u32| FootprintSnapshot {
            time_s: f64::from(i),
            bodies: vec![body(place(i), 1.75), body(place(i) + 12.0, 5.25)],
        };
        FootprintPlot {
            title: "Drive".to_owned(),
            roads: vec![Strip { edges_m: [0.0, 7.0], dividers_m: vec![3.5], ..Strip::default() }],
            vehicles: vec![("ego: human".to_owned(), ORANGE), ("front: human".to_owned(), BLUE)],
            snapshots: (0..8).map(snapshot).collect(),
            path: (0..8).map(|i| (f64::from(i), [place(i), 1.75])).collect(),
        }
    }

    /// However long the drive, every footprint of every snapshot is seen, large enough, and its number can be read.
    #[test]
    fn short_and_long_drives_show_every_footprint() {
        for length_m in [20.0, 100.0, 2000.0] {
            let drawing = drive(length_m).drawing();
            assert_eq!(drawing.illegible(), Vec::<String>::new(), "{length_m} m");
            let bodies = drawing.marks.iter().filter_map(|mark| match mark {
                Mark::Fill { ring, colour, .. } if ring.len() == 4 && [ORANGE, BLUE].contains(colour) => Some(ring),
                _ => None,
            });
            // Two of the patches belong to the legend.
            let lengths: Vec<f64> =
                bodies.map(|ring| distance(ring[0], ring[3]).max(distance(ring[0], ring[1]))).collect();
            assert_eq!(lengths.len(), 2 + 16, "{length_m} m");
            assert!(lengths.iter().all(|length| *length > 25.0), "{length_m} m: {lengths:?}");
            assert_eq!(drawing.words().iter().filter(|words| **words == "8").count(), 3, "{length_m} m");
        }
    }

    /// Where roads cross, all snapshots are in one plan, as large in x as in y.
    #[test]
    fn a_crossing_is_drawn_to_scale() {
        let mut footprints = drive(20.0);
        footprints.roads.push(Strip {
            heading_rad: std::f64::consts::FRAC_PI_2,
            edges_m: [-3.5, 3.5],
            ..Strip::default()
        });
        footprints
            .snapshots
            .iter_mut()
            .for_each(|snapshot| snapshot.bodies[1] = snapshot.bodies[1].map(|[x, y]| [-y, x]));
        let drawing = footprints.drawing();
        let sizes: Vec<[f64; 2]> = drawing
            .marks
            .iter()
            .filter_map(|mark| match mark {
                Mark::Fill { ring, opacity, .. } if *opacity < 1.0 => {
                    Some([distance(ring[0], ring[3]), distance(ring[0], ring[1])])
                }
                _ => None,
            })
            .collect();
        assert_eq!(sizes.len(), 16);
        assert!(sizes.iter().all(|[length, width]| (length / width - 2.25).abs() < 1e-9), "{sizes:?}");
    }
}
