//! The lines of a network of lanes, in world coordinates.

use std::collections::BTreeMap;

use interplay_planners::road::network::{Lane, LaneNeighbour, NeighbourRelation, RightOfWay, RoadNetwork};
use interplay_scenarios::Scenario;

use crate::curved_road::WorldLine;
use crate::rectangle::extent;

/// Largest distance between two points of a line, by the width of the lane.
const POINT_DISTANCE_RATIO: f64 = 0.25;
/// Number of bisections to locate a change of the style of an edge.
const CHANGE_BISECTIONS: usize = 4;
/// Most points of the line of a lane.
const MAX_POINTS: f64 = 2000.0;
/// Edges closer than this share of the lane width are one line.
const SHARED_RATIO: f64 = 0.15;
/// A line is inside a lane if it is further from the edges than this share of the width.
const INSIDE_RATIO: f64 = 0.001;
/// Where edges of lanes of a junction cross, short pieces may be outside all lanes. Pieces shorter than this, in lane widths, are
/// left out.
const MIN_PIECE_RATIO: f64 = 0.5;
/// Length of the dashes of a yield line and of the spaces between them, in lane widths.
const YIELD_DASH_RATIO: f64 = 0.125;

/// The lines of a network of lanes, for drawing.
pub struct NetworkLines<'a> {
    lanes: &'a [Lane],
    numbers: BTreeMap<&'a str, usize>,
    /// The right and the left edge of each lane, with points opposite each other.
    edges: Vec<[WorldLine; 2]>,
    /// Least and greatest coordinates of each lane.
    bounds: Vec<[[f64; 2]; 2]>,
}

#[derive(Clone, Copy, PartialEq)]
enum LaneSide {
    Right,
    Left,
}

/// The style of a part of an edge.
#[derive(Clone, Copy, PartialEq)]
enum EdgeStyle {
    Solid,
    Dashed,
    Hidden,
}

/// A part of the edge of a lane.
struct EdgePart {
    lane: usize,
    side: LaneSide,
    range_m: [f64; 2],
    style: EdgeStyle,
}

impl<'a> NetworkLines<'a> {
    pub fn new(network: &'a RoadNetwork) -> NetworkLines<'a> {
        let lanes = network.lanes();
        let edges: Vec<[WorldLine; 2]> = lanes
            .iter()
            .map(|lane| [LaneSide::Right, LaneSide::Left].map(|side| line(lane, side, [0.0, lane.centre.length_m()])))
            .collect();
        let bounds = edges.iter().map(|edges| extent(edges.iter().flatten().copied())).collect();
        let numbers = lanes.iter().enumerate().map(|(number, lane)| (lane.name.as_str(), number)).collect();
        NetworkLines { lanes, numbers, edges, bounds }
    }

    /// The right and the left edge of each lane \[m\]. Points with the same index are opposite each other.
    pub fn surfaces(&self) -> &[[WorldLine; 2]] {
        &self.edges
    }

    /// The solid lines: at the sides of the network, and between lanes without lane changes \[m\].
    pub fn edges(&self) -> Vec<WorldLine> {
        let is_long = |part: &EdgePart| {
            let least_m = MIN_PIECE_RATIO * self.lanes[part.lane].width.value(part.range_m[0]);
            part.range_m[1] - part.range_m[0] > least_m
        };
        let solid = self.parts().into_iter().filter(|part| part.style == EdgeStyle::Solid).filter(is_long);
        solid.map(|part| line(&self.lanes[part.lane], part.side, part.range_m)).collect()
    }

    /// The dashes between lanes with lane changes, as long as the spaces between them \[m\].
    pub fn dashes(&self, dash_m: f64) -> Vec<WorldLine> {
        let of_part = |part: EdgePart| {
            let [from_m, to_m] = part.range_m;
            let starts = (0..).map(move |dash| from_m + 2.0 * dash_m * f64::from(dash));
            let whole = starts.take_while(move |start_m| start_m + dash_m <= to_m);
            let dash = |start_m: f64| line(&self.lanes[part.lane], part.side, [start_m, start_m + dash_m]);
            whole.map(dash).collect::<Vec<_>>()
        };
        self.parts().into_iter().filter(|part| part.style == EdgeStyle::Dashed).flat_map(of_part).collect()
    }

    /// The stop lines across lanes, and the dashes of yield lines \[m\].
    pub fn stop_lines(&self) -> Vec<WorldLine> {
        let across = |lane: &Lane, [from, to]: [f64; 2]| {
            let end_m = lane.centre.length_m();
            let half_m = lane.half_width_m(end_m);
            [from, to].map(|share| lane.centre.position(end_m, share * half_m)).to_vec()
        };
        let of_lane = |lane: &Lane| match lane.right_of_way {
            RightOfWay::Priority => Vec::new(),
            RightOfWay::Stop | RightOfWay::AllWayStop => vec![across(lane, [-1.0, 1.0])],
            RightOfWay::Yield => {
                let dash = 2.0 * YIELD_DASH_RATIO;
                let starts = (0..4).map(|index| -1.0 + (2.0 * f64::from(index) + 0.5) * dash);
                starts.map(|start| across(lane, [start, start + dash])).collect()
            }
        };
        self.lanes.iter().flat_map(of_lane).collect()
    }

    /// The parts of all edges, in the order of the lanes.
    fn parts(&self) -> Vec<EdgePart> {
        let sides = |lane: usize| [LaneSide::Right, LaneSide::Left].map(|side| (lane, side));
        (0..self.lanes.len()).flat_map(sides).flat_map(|(lane, side)| self.parts_of(lane, side)).collect()
    }

    fn parts_of(&self, lane: usize, side: LaneSide) -> Vec<EdgePart> {
        let mut parts: Vec<EdgePart> = Vec::new();
        let mut last_m = 0.0;
        for range_m in ranges_m(&self.lanes[lane], [0.0, self.lanes[lane].centre.length_m()]).windows(2) {
            let middle_m = 0.5 * (range_m[0] + range_m[1]);
            let style = self.style(lane, side, middle_m);
            match parts.last_mut() {
                Some(last) if last.style == style => last.range_m[1] = range_m[1],
                Some(last) => {
                    let from_m = self.change_m(lane, side, [last_m, middle_m], last.style);
                    last.range_m[1] = from_m;
                    parts.push(EdgePart { lane, side, range_m: [from_m, range_m[1]], style });
                }
                None => parts.push(EdgePart { lane, side, range_m: [range_m[0], range_m[1]], style }),
            }
            last_m = middle_m;
        }
        parts
    }

    /// The arc length between two others at which an edge changes its style, by bisection \[m\].
    fn change_m(&self, lane: usize, side: LaneSide, [mut from_m, mut to_m]: [f64; 2], style: EdgeStyle) -> f64 {
        for _ in 0..CHANGE_BISECTIONS {
            let middle_m = 0.5 * (from_m + to_m);
            if self.style(lane, side, middle_m) == style {
                from_m = middle_m;
            } else {
                to_m = middle_m;
            }
        }
        0.5 * (from_m + to_m)
    }

    /// The style of an edge at an arc length: a line that two lanes share is drawn once, and a line inside another lane is not
    /// drawn.
    fn style(&self, number: usize, side: LaneSide, along_m: f64) -> EdgeStyle {
        let lane = &self.lanes[number];
        let shared_m = SHARED_RATIO * lane.width.value(along_m);
        let at = edge_position(lane, side, along_m, 0.0);
        if let Some((other, relation, is_open)) = self.beside(number, side) {
            let point = self.lanes[other].centre.project(at, None);
            let is_along = (0.0..=self.lanes[other].centre.length_m()).contains(&point.along_m);
            let apart_m = (point.across_m.abs() - self.lanes[other].half_width_m(point.along_m)).abs();
            if is_along && apart_m < shared_m {
                let draws = match relation {
                    NeighbourRelation::SameDirection => side == LaneSide::Left,
                    NeighbourRelation::Oncoming => number < other,
                };
                return match (draws, is_open) {
                    (false, _) => EdgeStyle::Hidden,
                    (true, true) => EdgeStyle::Dashed,
                    (true, false) => EdgeStyle::Solid,
                };
            }
        }
        // The asphalt extends beyond every lane by a shoulder. No line is drawn where the edge lies beside the shoulder of another lane.
        let shoulder_m = SHOULDER_LANES * lane.width.value(along_m);
        let beyond = edge_position(lane, side, along_m, shared_m - shoulder_m);
        // Where one lane joins another, an edge may lie inside the other lane although the point beyond the edge lies outside both.
        let inside_m = INSIDE_RATIO * lane.width.value(along_m);
        let is_inside = (0..self.lanes.len()).any(|other| {
            other != number && (self.holds(other, beyond, -shoulder_m) || self.holds(other, at, inside_m))
        });
        if is_inside { EdgeStyle::Hidden } else { EdgeStyle::Solid }
    }

    /// The neighbour on a side of a lane, if one of both names the other: its index, whether it is oncoming, and whether lane changes
    /// are allowed.
    fn beside(&self, number: usize, side: LaneSide) -> Option<(usize, NeighbourRelation, bool)> {
        let lane = &self.lanes[number];
        let [own, back] = match side {
            LaneSide::Left => [&lane.left, &lane.right],
            LaneSide::Right => [&lane.right, &lane.left],
        };
        let names = |neighbour: &Option<LaneNeighbour>| {
            neighbour.as_ref().filter(|neighbour| neighbour.lane == lane.name).cloned()
        };
        // A lane is also a neighbour if a lane in the same direction names it on the other side, or an oncoming one on the same side.
        let names_back = |other: &Lane| {
            let (same, oncoming) = match side {
                LaneSide::Left => (names(&other.right), names(&other.left)),
                LaneSide::Right => (names(&other.left), names(&other.right)),
            };
            let same = same.filter(|neighbour| neighbour.relation == NeighbourRelation::SameDirection);
            same.or(oncoming.filter(|neighbour| neighbour.relation == NeighbourRelation::Oncoming))
        };
        let is_back = |other: &Lane| back.as_ref().is_some_and(|back| back.lane == other.name);
        let named = own.as_ref().and_then(|own| Some((*self.numbers.get(own.lane.as_str())?, own)));
        if let Some((other, own)) = named {
            let may_return = names_back(&self.lanes[other]).is_some_and(|neighbour| neighbour.may_change);
            return Some((other, own.relation, own.may_change || may_return));
        }
        let found = self.lanes.iter().enumerate().filter(|(_, other)| !is_back(other));
        found
            .filter_map(|(other, lane)| Some((other, names_back(lane)?)))
            .next()
            .map(|(other, neighbour)| (other, neighbour.relation, neighbour.may_change))
    }

    /// Whether a position is on a lane, at more than a distance from its edges \[m\].
    fn holds(&self, number: usize, position: [f64; 2], inside_m: f64) -> bool {
        let [low, high] = self.bounds[number];
        if !(0..2).all(|axis| (low[axis]..=high[axis]).contains(&position[axis])) {
            return false;
        }
        let lane = &self.lanes[number];
        let point = lane.centre.project(position, None);
        point.along_m > 0.0
            && point.along_m < lane.centre.length_m()
            && point.across_m.abs() < lane.half_width_m(point.along_m) - inside_m
    }
}

/// Least and greatest coordinates of the part of the road that the vehicles cover if each drives at its wanted speed \[m\].
pub fn expected_bounds_m(scenario: &Scenario) -> [[f64; 2]; 2] {
    let places = scenario.vehicles.iter().flat_map(|vehicle| {
        let (route, speed_mps) =
            (&vehicle.route, vehicle.start.speed_mps.max(vehicle.target(&scenario.road).speed_mps));
        let start_m = route.along(vehicle.start.position());
        let length_m = speed_mps * scenario.duration_s;
        (0..=100).map(move |part| route.position(start_m + length_m * f64::from(part) / 100.0, 0.0))
    });
    extent(places)
}

/// The position on the edge of a lane, or beyond it by a distance \[m\].
fn edge_position(lane: &Lane, side: LaneSide, along_m: f64, beyond_m: f64) -> [f64; 2] {
    let across_m = lane.half_width_m(along_m) + beyond_m;
    lane.centre.position(along_m, if side == LaneSide::Left { across_m } else { -across_m })
}

/// Arc lengths at which a line is sampled \[m\].
fn ranges_m(lane: &Lane, [from_m, to_m]: [f64; 2]) -> Vec<f64> {
    let wanted = (to_m - from_m) / (POINT_DISTANCE_RATIO * lane.width.value(from_m));
    let count = wanted.ceil().clamp(1.0, MAX_POINTS) as usize;
    (0..=count).map(|index| from_m + (to_m - from_m) * index as f64 / count as f64).collect()
}

fn line(lane: &Lane, side: LaneSide, range_m: [f64; 2]) -> WorldLine {
    ranges_m(lane, range_m).into_iter().map(|along_m| edge_position(lane, side, along_m, 0.0)).collect()
}

/// Width of the lines where vehicles stop or yield, in lane widths.
pub const STOP_LINE_LANES: f64 = 0.11;
/// How far the asphalt reaches beyond the edges, in lane widths.
pub const SHOULDER_LANES: f64 = 0.05;
/// Width of the verge, in lane widths.
pub const VERGE_LANES: f64 = 0.34;
/// Width of the kerb, in lane widths.
pub const KERB_LANES: f64 = 0.07;
/// Width of a line, in lane widths.
pub const LINE_LANES: f64 = 0.035;
/// Width of an arrow, in lane widths.
pub const ARROW_WIDTH_LANES: f64 = 0.07;

#[cfg(test)]
mod tests {
    use interplay_scenarios::from_text;

    use super::*;

    fn scenario(road: &str, lane: &str) -> Scenario {
        let text = format!(
            "title = 'a'\nshows = 'b'\nduration_s = 12.0\n[road]\n{road}\n[[vehicle]]\nname = 'car'\n\
             start = {{ lane = '{lane}', along_m = 10.0, speed_mps = 1.0 }}\nroute = ['{lane}']\n"
        );
        from_text("network.toml", &text, &[]).expect("a scenario without fault")
    }

    fn length_m(lines: &[WorldLine]) -> f64 {
        let apart = |pair: &[[f64; 2]]| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
        lines.iter().flat_map(|line| line.windows(2).map(apart)).sum()
    }

    /// Two edges, and a middle line that is dashed where overtaking is allowed.
    #[test]
    fn a_line_that_two_lanes_share_is_drawn_once() {
        for (overtaking, solid_m, dashed_m) in [(true, 1200.0, 600.0), (false, 1800.0, 0.0)] {
            let scenario = scenario(&format!("kind = 'two-way'\novertaking = {overtaking}"), "east");
            let lines = NetworkLines::new(scenario.network.as_ref().expect("a network"));
            assert!((length_m(&lines.edges()) - solid_m).abs() < 1e-6, "{}", length_m(&lines.edges()));
            assert!((length_m(&lines.dashes(3.0)) - 0.5 * dashed_m).abs() < 3.0);
        }
    }

    /// Beside the acceleration lane the line is dashed, and before and after it the edge is solid.
    #[test]
    fn a_dividing_line_is_drawn_along_a_shorter_adjacent_lane() {
        let scenario = scenario("kind = 'on-ramp'\nlane_count = 1", "ramp");
        let lines = NetworkLines::new(scenario.network.as_ref().expect("a network"));
        let dashes_m = length_m(&lines.dashes(0.5));
        assert!((dashes_m - 90.0).abs() < 1.0, "{dashes_m}");
        let edges = lines.edges();
        let on_right = |from_m: f64, to_m: f64| {
            let is_there = |[x, y]: &[f64; 2]| y.abs() < 1e-6 && (from_m..to_m).contains(x);
            edges.iter().flatten().filter(|point| is_there(point)).count()
        };
        assert!(on_right(-190.0, -60.0) > 50 && on_right(190.0, 400.0) > 50);
        assert_eq!(on_right(5.0, 175.0), 0);
    }

    /// No line is inside a junction, and each lane that must wait has a stop or yield line.
    #[test]
    fn no_lane_lines_are_drawn_inside_junctions() {
        let scenario = scenario("kind = 'all-way-stop'", "west-in");
        let lines = NetworkLines::new(scenario.network.as_ref().expect("a network"));
        assert_eq!(lines.stop_lines().len(), 4);
        let inside = |[x, y]: &[f64; 2]| x.abs() < 3.4 && y.abs() < 3.4;
        assert_eq!(lines.edges().iter().flatten().filter(|point| inside(point)).count(), 0);
        let yields = self::scenario("kind = 'roundabout'", "west-in");
        let lines = NetworkLines::new(yields.network.as_ref().expect("a network"));
        assert_eq!(lines.stop_lines().len(), 16, "four dashes for each arm");
        assert_eq!(lines.dashes(1.0).len(), 0);
        let [low, high] = expected_bounds_m(&yields);
        assert!((low[0] + 90.0).abs() < 1e-6 && (high[0] + 78.0).abs() < 1e-6, "{low:?} {high:?}");
    }
}
