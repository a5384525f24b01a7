//! The road as filled polygons and lines.

use interplay_planners::Route;
use interplay_scenarios::{Scenario, Vehicle};
use serde::Serialize;

use crate::camera::car_m;
use crate::network_lines::{ARROW_WIDTH_LANES, KERB_LANES, LINE_LANES, SHOULDER_LANES, STOP_LINE_LANES, VERGE_LANES};
use crate::palette::{ARROW, ASPHALT, Colour, KERB, PAINT, PATH, RESERVED_LANE, VERGE, css};
use crate::road_shapes::RoadShapes;

/// The road is traced this far around the routes of all vehicles, in lengths of a car.
const MARGIN_CARS: f64 = 12.0;
/// Number of sampled places on each route.
const ROUTE_SAMPLES: usize = 40;
/// Longest traced part of a route, in lengths of a car.
const MAX_ROUTE_CARS: f64 = 400.0;

/// A part of a road that a page paints.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum RoadShape {
    Fill { ring: Vec<[f64; 2]>, colour: String },
    Outline { ring: Vec<[f64; 2]>, width_m: f64, colour: String },
    Line { points: Vec<[f64; 2]>, width_m: f64, colour: String },
}

/// A traffic light as a page paints it.
#[derive(Clone, Debug, Serialize)]
pub struct StageLight {
    /// The ends of its bar \[m\].
    pub bar: [[f64; 2]; 2],
    /// Successive colours, each with its end \[s\].
    pub colours: Vec<(String, f64)>,
    /// Duration of all colours together \[s\].
    pub cycle_s: f64,
}

/// Sampling time of the cycles of lights \[s\].
const LIGHT_STEP_S: f64 = 0.1;

pub(super) fn shapes(scenario: &Scenario) -> (Vec<RoadShape>, Vec<StageLight>) {
    let road = RoadShapes::trace(scenario, bounds_m(scenario));
    let lane_m = road.lane_m;
    let mut shapes = Vec::new();
    for (colour, beyond) in [(VERGE, VERGE_LANES), (KERB, SHOULDER_LANES + KERB_LANES)] {
        shapes.extend(road.surfaces.iter().map(|ring| outline(ring, 2.0 * beyond * lane_m, colour)));
    }
    shapes.extend(road.surfaces.iter().map(|ring| fill(ring, ASPHALT)));
    shapes.extend(road.surfaces.iter().map(|ring| outline(ring, 2.0 * SHOULDER_LANES * lane_m, ASPHALT)));
    for (rings, colour) in [(&road.reserved_lanes, RESERVED_LANE), (&road.paths, PATH), (&road.zebra_bars, PAINT)] {
        shapes.extend(rings.iter().map(|ring| fill(ring, colour)));
    }
    for (lines, lanes) in [(&road.edges, LINE_LANES), (&road.dashes, LINE_LANES), (&road.stop_lines, STOP_LINE_LANES)] {
        shapes.extend(lines.iter().map(|points| line(points, lanes * lane_m, PAINT)));
    }
    for arrow in road.arrows() {
        shapes.push(line(&arrow.stem, ARROW_WIDTH_LANES * lane_m, ARROW));
        shapes.extend(arrow.bends.iter().map(|bend| line(bend, ARROW_WIDTH_LANES * lane_m, ARROW)));
        shapes.extend(arrow.heads.iter().map(|head| fill(head, ARROW)));
    }
    let lights = road.lights.iter().map(|light| {
        let steps = (scenario.duration_s / LIGHT_STEP_S).ceil() as usize + 1;
        let mut colours: Vec<(String, f64)> = Vec::new();
        for step in 0..steps {
            let (colour, until_s) =
                (css(light.colour_at(step as f64 * LIGHT_STEP_S)), (step + 1) as f64 * LIGHT_STEP_S);
            match colours.last_mut() {
                Some((last, end_s)) if *last == colour => *end_s = until_s,
                _ => colours.push((colour, until_s)),
            }
        }
        StageLight { bar: light.bar, colours, cycle_s: steps as f64 * LIGHT_STEP_S }
    });
    (shapes, lights.collect())
}

fn fill(ring: &[[f64; 2]], colour: Colour) -> RoadShape {
    RoadShape::Fill { ring: ring.to_vec(), colour: css(colour) }
}

fn outline(ring: &[[f64; 2]], width_m: f64, colour: Colour) -> RoadShape {
    RoadShape::Outline { ring: ring.to_vec(), width_m, colour: css(colour) }
}

fn line(points: &[[f64; 2]], width_m: f64, colour: Colour) -> RoadShape {
    RoadShape::Line { points: points.to_vec(), width_m, colour: css(colour) }
}

/// Least and greatest coordinates that vehicles can reach in the time of the scenario \[m\].
fn bounds_m(scenario: &Scenario) -> [[f64; 2]; 2] {
    let car_m = car_m(scenario);
    let way = |vehicle: &Vehicle| {
        let (route, from_m): (&Route, f64) = (&vehicle.route, vehicle.route.along(vehicle.start.position()));
        let reach_m = (scenario.duration_s * vehicle.limits.speed_max_mps).min(MAX_ROUTE_CARS * car_m);
        let end_m = (from_m + reach_m).min(route.end_m());
        let place = move |share: f64| route.position(from_m + share * (end_m - from_m), 0.0);
        (0..=ROUTE_SAMPLES).map(|place_at| place(place_at as f64 / ROUTE_SAMPLES as f64)).collect::<Vec<_>>()
    };
    let places: Vec<[f64; 2]> = scenario.vehicles.iter().flat_map(way).collect();
    let margin_m = MARGIN_CARS * car_m;
    let edge = |axis: usize, side: f64| {
        let farthest = places.iter().map(|place| side * place[axis]).fold(f64::NEG_INFINITY, f64::max);
        side * (farthest + margin_m)
    };
    [[edge(0, -1.0), edge(1, -1.0)], [edge(0, 1.0), edge(1, 1.0)]]
}
