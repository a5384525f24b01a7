//! The lines of a curved road, in world coordinates.

use std::sync::Arc;

use interplay_planners::{CentreLine, LaneEnd, Profile, Route};
use interplay_scenarios::{Branch, Road};

/// Largest distance between two points of a line, in lane widths.
const POINT_DISTANCE_LANES: f64 = 0.2;
/// Most points of a line.
const MAX_POINTS: f64 = 4000.0;

/// A line as points in world coordinates \[m\].
pub type WorldLine = Vec<[f64; 2]>;

/// The lines of a curved road.
pub struct CurvedRoad<'a> {
    road: &'a Road,
    route: Arc<Route>,
}

impl<'a> CurvedRoad<'a> {
    /// The lines of a road; `None` if it is straight or a network.
    pub fn new(road: &'a Road) -> Option<CurvedRoad<'a>> {
        let route = road.route(Branch::Main)?;
        route.straight().is_none().then_some(CurvedRoad { road, route })
    }

    /// The right and the left edge between two arc lengths \[m\]. Points with the same index are opposite each other.
    pub fn edges(&self, range_m: [f64; 2]) -> [WorldLine; 2] {
        [&self.route.right, &self.route.left].map(|edge| self.line(edge, range_m))
    }

    /// The dashes between lanes, as long as the spaces between them \[m\]. The line to the left of lane 0 ends with this lane.
    pub fn dashes(&self, dash_m: f64, range_m: [f64; 2]) -> Vec<WorldLine> {
        let of_divider = |between: usize| {
            let ([from_m, to_m], divider) = (self.divided(between, range_m), self.divider(between));
            let starts = (0..).map(move |dash| from_m + 2.0 * dash_m * f64::from(dash));
            let whole = starts.take_while(move |start_m| start_m + dash_m <= to_m);
            whole.map(|start_m| self.line(&divider, [start_m, start_m + dash_m])).collect::<Vec<_>>()
        };
        (1..self.lane_count()).flat_map(of_divider).collect()
    }

    fn lane_count(&self) -> usize {
        self.road.parallel_lanes().map_or(0, |lanes| lanes.count)
    }

    fn divider(&self, between: usize) -> Profile {
        let centre_m = self.road.lane_centre_m(Branch::Main, between).unwrap_or_default();
        Profile::constant(centre_m - 0.5 * self.road.lane_width_m())
    }

    /// The part of an interval with lanes on both sides of a divider.
    fn divided(&self, between: usize, [from_m, to_m]: [f64; 2]) -> [f64; 2] {
        let end = self.road.lane_end().filter(|_| between == 1);
        let until_m = end.map_or(to_m, |end| taper_m(end)[0]);
        [from_m, to_m.min(until_m).max(from_m)]
    }

    fn line(&self, across: &Profile, [from_m, to_m]: [f64; 2]) -> WorldLine {
        let wanted = (to_m - from_m) / (POINT_DISTANCE_LANES * self.road.lane_width_m());
        let count = wanted.ceil().clamp(1.0, MAX_POINTS) as usize;
        let centre: &CentreLine = &self.route.centre;
        let places = (0..=count).map(|index| from_m + (to_m - from_m) * index as f64 / count as f64);
        places.map(|along_m| centre.position(along_m, across.value(along_m))).collect()
    }
}

/// The longitudinal coordinates between which the edge of an ending lane tapers.
pub fn taper_m(end: LaneEnd) -> [f64; 2] {
    [end.end_m - 4.5 * end.taper_m, end.end_m + 0.5 * end.taper_m]
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::from_text;

    use super::*;

    /// A quarter circle to the left with two lanes, of which the right one ends behind it.
    fn quarter() -> Road {
        let text = "title = 'a'\nshows = 'b'\n[road]\nkind = 'curve'\nlane_width_m = 3.5\n\
            pieces = [{ straight_m = 30.0 }, { turn_deg = 90.0, radius_m = 25.0 }, { straight_m = 60.0 }]\n\
            lane_end = { end_m = 110.0, taper_m = 4.0 }\n\
            [[vehicle]]\nname = 'car'\nstart = { lane = 0, along_m = 10.0, speed_mps = 1.0 }\n";
        from_text("quarter.toml", text, &[]).expect("a scenario without fault").road
    }

    #[test]
    fn edge_points_of_a_curve_pair_up_and_narrow_where_a_lane_ends() {
        let road = quarter();
        let curved = CurvedRoad::new(&road).expect("it turns");
        let [right, left] = curved.edges([0.0, 125.0]);
        assert_eq!(right.len(), left.len());
        let widths: Vec<f64> = right.iter().zip(&left).map(|(a, b)| libm::hypot(a[0] - b[0], a[1] - b[1])).collect();
        assert!((widths[0] - 7.0).abs() < 1e-3 && (widths[widths.len() - 1] - 3.5).abs() < 1e-3);
        assert!(widths.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9), "it only narrows: {widths:?}");
        assert_eq!(right[0], [0.0, 0.0], "the right edge begins at the origin");
        let [x, y] = right[right.len() - 1];
        assert!(x > 55.0 && y > 80.0, "{x} {y}");
    }

    #[test]
    fn a_single_lane_has_no_dividing_line_and_a_straight_road_no_curve() {
        let road = quarter();
        let curved = CurvedRoad::new(&road).expect("it turns");
        let route = road.route(Branch::Main).expect("not a network");
        let dashes = curved.dashes(3.0, [0.0, 125.0]);
        assert!(dashes.len() > 10);
        for point in dashes.iter().flatten() {
            let place = route.locate(*point, None);
            assert!(place.across_m.abs() < 1e-6 && place.along_m < 110.0 - 17.9, "{place:?}");
        }
        assert!(CurvedRoad::new(&Road::default()).is_none());
    }
}
