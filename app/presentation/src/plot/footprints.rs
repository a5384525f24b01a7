//! Numbered footprints of vehicles at equal time steps, on their roads.
//!
//! Where all roads run the same way, each snapshot is a strip below the one before ([`FootprintPlot::strips`]): vehicles
//! in one lane would cover one another otherwise. Where roads cross or turn, all snapshots are in one plan ([`FootprintPlot::plan`]).

mod body;
mod data;
mod plan;
mod strips;

pub use data::{CurvedStrip, FootprintPlot, FootprintSnapshot, Strip};

use super::drawing::Drawing;

impl FootprintPlot {
    /// The picture that suits the roads.
    pub fn drawing(&self) -> Drawing {
        let parallel = self.roads.iter().all(|road| libm::cos(road.heading_rad) > 0.999);
        if parallel && self.curves.is_empty() { self.strips() } else { self.plan() }
    }
}

#[cfg(test)]
mod tests {
    use super::data::distance;
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
            curves: Vec::new(),
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

    /// A road that turns is drawn as a whole, in one plan, and every word can be read.
    #[test]
    fn a_road_that_turns_is_in_the_plan() {
        let arc = |radius: f64| {
            let at = move |i: u32| libm::sincos(0.05 * f64::from(i));
            (0..=30).map(move |i| [radius * at(i).0, 40.0 - radius * at(i).1]).collect::<Vec<_>>()
        };
        let curve = CurvedStrip {
            surfaces_m: vec![[arc(38.0), arc(31.0)]],
            edges_m: vec![arc(38.0), arc(31.0)],
            dividers_m: vec![arc(34.5)],
        };
        let footprints = FootprintPlot { roads: Vec::new(), curves: vec![curve], ..drive(10.0) };
        let drawing = footprints.drawing();
        assert_eq!(drawing.illegible(), Vec::<String>::new());
        let is_surface = |mark: &&Mark| matches!(mark, Mark::Fill { ring, .. } if ring.len() >= 60);
        assert_eq!(drawing.marks.iter().filter(is_surface).count(), 1);
        let [[_, low], [high, _]] = footprints.bounds();
        assert!(low < 2.0 && high > 37.0, "{low}, {high}");
    }
}
