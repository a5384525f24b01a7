//! Numbered footprints of vehicles at equal time steps, on their roads.
//!
//! Where all roads run the same way, each snapshot is a strip below the one before ([`FootprintPlot::strips`]): vehicles
//! in one lane would cover one another otherwise. Where roads cross or turn, all snapshots are in one plan ([`FootprintPlot::plan`]).

mod body;
mod data;
mod plan;
mod strips;

pub use data::{FootprintPlot, FootprintSnapshot, FootprintVehicle};

use super::drawing::Drawing;

impl FootprintPlot {
    /// The picture that suits the roads.
    pub fn drawing(&self) -> Drawing {
        if self.strip_m.is_some() { self.strips() } else { self.plan() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::BodyStyle;
    use crate::palette::{ASPHALT, PAINT};
    use crate::plot::drawing::Mark;
    use crate::plot::style::{BLUE, Colour, ORANGE};
    use crate::rectangle::extent;
    use crate::road_shapes::RoadShapes;

    fn car(label: &str, colour: Colour) -> FootprintVehicle {
        FootprintVehicle { label: label.to_owned(), colour, style: BodyStyle::Car }
    }

    /// Length and width of each body: it is filled, and has an edge.
    fn bodies_px(drawing: &Drawing) -> Vec<[f64; 2]> {
        let body = |marks: &[Mark]| match marks {
            [Mark::Fill { ring, .. }, Mark::Line { points, .. }] if points.starts_with(ring) => {
                let [low, high] = extent(ring.iter().copied());
                let [across, upwards] = [0, 1].map(|axis| high[axis] - low[axis]);
                Some([across.max(upwards), across.min(upwards)])
            }
            _ => None,
        };
        drawing.marks.windows(2).filter_map(body).collect()
    }

    /// A straight road with two lanes along x.
    fn straight([from_m, to_m]: [f64; 2], [right_m, left_m]: [f64; 2]) -> RoadShapes {
        let line = |lateral_m: f64| vec![[from_m, lateral_m], [to_m, lateral_m]];
        let mut road = RoadShapes::default();
        road.surfaces.push(vec![[from_m, right_m], [to_m, right_m], [to_m, left_m], [from_m, left_m]]);
        road.edges.extend([line(right_m), line(left_m)]);
        road.dashes.push(line(0.5 * (right_m + left_m)));
        road
    }

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
            road: straight([-10.0, length_m + 40.0], [0.0, 7.0]),
            strip_m: Some([0.0, 7.0]),
            vehicles: vec![car("ego: human", ORANGE), car("front: human", BLUE)],
            snapshots: (0..8).map(snapshot).collect(),
            path: (0..8).map(|i| (f64::from(i), [place(i), 1.75])).collect(),
        }
    }

    /// The same where the second car drives on a road that crosses.
    fn crossing(length_m: f64) -> FootprintPlot {
        let mut footprints = drive(length_m);
        footprints.strip_m = None;
        footprints
            .snapshots
            .iter_mut()
            .for_each(|snapshot| snapshot.bodies[1] = snapshot.bodies[1].map(|[x, y]| [-y, x]));
        footprints
    }

    /// Footprints are complete and large enough, and numbers legible, for any length of the drive.
    #[test]
    fn every_footprint_of_short_and_long_drives_is_visible() {
        for length_m in [20.0, 100.0, 2000.0] {
            let drawing = drive(length_m).drawing();
            assert_eq!(drawing.illegible(), Vec::<String>::new(), "{length_m} m");
            let lengths: Vec<f64> = bodies_px(&drawing).iter().map(|[length, _]| *length).collect();
            assert_eq!(lengths.len(), 16, "{length_m} m");
            assert!(lengths.iter().all(|length| *length > 25.0), "{length_m} m: {lengths:?}");
            let strips = (1..=8).filter(|number| drawing.words().contains(&number.to_string().as_str())).count();
            assert_eq!(strips, 8, "{length_m} m: a number a strip");
        }
    }

    /// Where roads cross, all snapshots are in one plan with the same scale in x and y.
    #[test]
    fn a_crossing_is_drawn_to_scale() {
        let footprints = crossing(40.0);
        let drawing = footprints.drawing();
        let sizes = bodies_px(&drawing);
        assert_eq!(drawing.illegible(), Vec::<String>::new());
        assert_eq!(sizes.len(), 16);
        assert!(sizes.iter().all(|[length, width]| (length / width - 2.25).abs() < 1e-9), "{sizes:?}");
    }

    /// Overlapping footprints of a car are drawn once, with the numbers of all.
    #[test]
    fn footprints_of_one_car_are_spaced_apart() {
        for (length_m, kept, words) in [(20.0, 4, "1–2"), (10.0, 2, "1–4"), (0.0, 1, "1–8")] {
            let drawing = crossing(length_m).drawing();
            assert_eq!(bodies_px(&drawing).len(), 2 * kept, "{length_m} m");
            assert!(drawing.words().contains(&words), "{length_m} m: {:?}", drawing.words());
            assert_eq!(drawing.illegible(), Vec::<String>::new());
        }
    }

    /// Numbers that would overlap others are left out, the first and the last last.
    #[test]
    fn footprint_numbers_do_not_overlap_where_many_vehicles_pass() {
        let mut footprints = drive(100.0);
        for number in 2..7 {
            footprints.vehicles.push(car(&format!("car {number}"), BLUE));
            let offset = 0.4 * f64::from(number);
            for snapshot in &mut footprints.snapshots {
                let body = snapshot.bodies[1].map(|[x, y]| [x - offset, y]);
                snapshot.bodies.push(body);
            }
        }
        footprints.strip_m = None;
        let drawing = footprints.drawing();
        assert_eq!(drawing.illegible(), Vec::<String>::new());
        let numbers = |number: &str| drawing.words().iter().filter(|words| **words == number).count();
        let [first, middle, last] = ["1", "4", "8"].map(numbers);
        assert!(first.min(last) >= middle.max(1) && middle < 7, "{:?}", drawing.words());
    }

    /// Where a ramp ends, the edge line follows the asphalt.
    #[test]
    fn the_edge_line_follows_a_ramp_that_ends() {
        let mut footprints = drive(20.0);
        footprints.road.edges[0] = vec![[-10.0, 0.0], [8.0, 0.0], [12.0, 2.0], [16.0, 3.5], [60.0, 3.5]];
        let drawing = footprints.drawing();
        let lines = |points: usize| {
            let is_edge = move |mark: &&Mark| matches!(mark, Mark::Line { points: line, style } if line.len() == points && style.colour == PAINT);
            drawing.marks.iter().filter(is_edge).count()
        };
        assert_eq!(
            (lines(5), lines(2)),
            (8, 16),
            "in each strip a tapered edge, a straight one, and the line between the lanes"
        );
    }

    /// A curved road is drawn around the vehicles in one plan, and every word is legible.
    #[test]
    fn a_curved_road_is_clipped_to_the_plan() {
        let arc = |radius: f64| {
            let at = move |i: u32| libm::sincos(0.05 * f64::from(i));
            (0..=30).map(move |i| [radius * at(i).0, 40.0 - radius * at(i).1]).collect::<Vec<_>>()
        };
        let mut road = RoadShapes::default();
        road.surfaces.push(arc(38.0).into_iter().chain(arc(31.0).into_iter().rev()).collect());
        road.edges.extend([arc(38.0), arc(31.0)]);
        let footprints = FootprintPlot { road, strip_m: None, ..drive(10.0) };
        let drawing = footprints.drawing();
        assert_eq!(drawing.illegible(), Vec::<String>::new());
        let is_surface = |mark: &&Mark| matches!(mark, Mark::Fill { colour, .. } if *colour == ASPHALT);
        assert_eq!(drawing.marks.iter().filter(is_surface).count(), 1);
        let [low, high] = footprints.bounds();
        assert_eq!((low, high), ([-2.2, 0.75], [24.3, 6.25]), "the part without vehicles is cut away");
    }
}
