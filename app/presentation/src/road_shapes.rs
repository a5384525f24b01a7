//! Roads of all forms as shapes in the world: asphalt, lines, arrows. Recordings, animations and figures share them.

use interplay_planners::road::network::{Lane, RoadNetwork};
use interplay_planners::{Axes, Corridor};
use interplay_scenarios::{Branch, Road, Scenario};

use crate::curved_road::{CurvedRoad, WorldLine, taper_m};
use crate::network_lines::NetworkLines;
use crate::signals::LightShape;

/// Length of a dash and of the space behind it, in lane widths.
const DASH_LANES: f64 = 0.8;
/// Most dashes of one line; on a longer road they are farther apart.
const MAX_DASHES: f64 = 4000.0;
/// Number of points of the edge of an ending lane.
const TAPER_POINTS: usize = 48;
/// How far the road continues beyond the ends of a network, in lane widths.
const WAY_OUT_LANES: f64 = 80.0;
/// Tolerance of the simplification of lines, in lane widths.
const TOLERANCE_LANES: f64 = 0.002;
/// Distance of a stop line from the front of a standing vehicle, in lane widths.
const STOP_LINE_AHEAD_LANES: f64 = 0.12;
/// Distance of an arrow from the end of its lane, in lane widths.
const ARROW_LANES: f64 = 2.2;
/// A lane shorter than this has no arrow, in lane widths.
const MIN_ARROW_LANE_LANES: f64 = 5.0;
/// Breadth of a bar of a zebra crossing, by the crossing's width.
const ZEBRA_BAR_RATIO: f64 = 0.16;
/// A successor lane that turns by more than this is a turn \[rad\].
const TURN_RAD: f64 = 0.6;

/// A road, all lengths in metres of the world.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoadShapes {
    /// Width of a lane.
    pub lane_m: f64,
    /// Closed polygons that together cover the road.
    pub surfaces: Vec<WorldLine>,
    pub edges: Vec<WorldLine>,
    pub dashes: Vec<WorldLine>,
    /// Lines across lanes where vehicles stop or yield.
    pub stop_lines: Vec<WorldLine>,
    pub paths: Vec<WorldLine>,
    /// Closed polygons of lanes that are reserved for some users.
    pub reserved_lanes: Vec<WorldLine>,
    /// The bars of zebra crossings, closed polygons.
    pub zebra_bars: Vec<WorldLine>,
    pub lights: Vec<LightShape>,
    /// Arrows: place, direction \[rad\], and the allowed directions.
    arrows: Vec<([f64; 2], f64, Ways)>,
}

/// The allowed directions at the end of a lane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Ways {
    left: bool,
    straight: bool,
    right: bool,
}

impl RoadShapes {
    /// The shapes of a scenario's road between least and greatest coordinates.
    pub fn trace(scenario: &Scenario, bounds_m: [[f64; 2]; 2]) -> RoadShapes {
        let road = &scenario.road;
        let mut shapes = RoadShapes { lane_m: road.lane_width_m(), ..RoadShapes::default() };
        if let Some(network) = &scenario.network {
            shapes.add_network(network, bounds_m);
        } else if let Some(curved) = CurvedRoad::new(road) {
            let along = |corner: [f64; 2]| scenario.main_route().along(corner);
            let [from_m, to_m] = range(corners(bounds_m).map(along), 4.0 * shapes.lane_m);
            let [right, left] = curved.edges([from_m, to_m]);
            shapes.surfaces.push(right.iter().chain(left.iter().rev()).copied().collect());
            shapes.edges.extend([right, left]);
            shapes.dashes.extend(curved.dashes(DASH_LANES * shapes.lane_m, [from_m, to_m]));
        } else {
            for branch in [Branch::Main, Branch::Cross] {
                let corridor = road.corridor(branch);
                let exists = branch == Branch::Main || road.conflict_zone_m(Branch::Cross).is_some();
                if let Some(corridor) = corridor.filter(|_| exists) {
                    shapes.add_strip(road, branch, &corridor, bounds_m);
                }
            }
            shapes.add_stop_lines(scenario);
        }
        let tolerance_m = TOLERANCE_LANES * shapes.lane_m;
        for line in shapes.surfaces.iter_mut().chain(&mut shapes.edges).chain(&mut shapes.dashes) {
            *line = simplified(line, tolerance_m);
        }
        shapes
    }

    fn add_network(&mut self, network: &RoadNetwork, bounds_m: [[f64; 2]; 2]) {
        let ring = |[right, left]: &[WorldLine; 2]| right.iter().chain(left.iter().rev()).copied().collect();
        if network.has_restricted_lanes() || network.lanes().iter().any(|lane| lane.is_zebra) {
            let paths = network.with_lanes(|lane| lane.is_path() && !lane.is_zebra);
            self.paths = NetworkLines::new(&paths).surfaces().iter().map(ring).collect();
            let kept = network.with_lanes(|lane| !lane.users.is_empty() && !lane.is_path());
            self.reserved_lanes = NetworkLines::new(&kept).surfaces().iter().map(ring).collect();
            self.zebra_bars = network.lanes().iter().filter(|lane| lane.is_zebra).flat_map(zebra_bars).collect();
        }
        self.lights = LightShape::all(network);
        let network = &network.with_lanes(|lane| !lane.is_path() && !lane.is_zebra);
        let lines = NetworkLines::new(network);
        self.surfaces.extend(lines.surfaces().iter().map(ring));
        self.edges = lines.edges();
        for (lane, edges) in network.lanes().iter().zip(lines.surfaces()) {
            self.add_ways_out(network, lane, edges, bounds_m);
        }
        self.dashes = lines.dashes(DASH_LANES * self.lane_m);
        self.stop_lines = lines.stop_lines();
        for lane in network.lanes() {
            let ways = ways(network, lane);
            let end_m = lane.centre.length_m();
            let is_choice = ways.left || ways.right;
            if is_choice && end_m > MIN_ARROW_LANE_LANES * self.lane_m {
                let at_m = end_m - ARROW_LANES * self.lane_m;
                let heading_rad = direction(lane, at_m);
                self.arrows.push((lane.centre.position(at_m, 0.0), heading_rad, ways));
            }
        }
    }

    /// Continues the road beyond the ends of the network, at least as far as the bounds, since vehicles continue there.
    fn add_ways_out(
        &mut self,
        network: &RoadNetwork,
        lane: &Lane,
        [right, left]: &[WorldLine; 2],
        bounds_m: [[f64; 2]; 2],
    ) {
        let has_before = network.lanes().iter().any(|other| other.successors.contains(&lane.name));
        let end_m = lane.centre.length_m();
        for (is_open, at_m) in [(lane.successors.is_empty(), end_m), (!has_before, 0.0)] {
            let reached = lane.centre.position(at_m, 0.0);
            let goes_beside = |other: &Lane| {
                let place = other.centre.project(reached, None);
                let inside = self.lane_m..other.centre.length_m() - self.lane_m;
                other.name != lane.name && inside.contains(&place.along_m) && place.across_m.abs() < 1.5 * self.lane_m
            };
            if !is_open || network.lanes().iter().any(goes_beside) {
                continue;
            }
            let sign = if at_m > 0.0 { 1.0 } else { -1.0 };
            let axes = Axes::along(direction(lane, at_m));
            let beyond_m = |corner: [f64; 2]| sign * (axes.components(corner)[0] - axes.components(reached)[0]);
            let length_m = corners(bounds_m).map(beyond_m).into_iter().fold(WAY_OUT_LANES * self.lane_m, f64::max);
            let direction = axes.vector([sign * length_m, 0.0]);
            let [near_right, near_left] = [right, left].map(|edge| if at_m > 0.0 { edge.last() } else { edge.first() });
            let (Some(&near_right), Some(&near_left)) = (near_right, near_left) else { continue };
            let far = |[x, y]: [f64; 2]| [x + direction[0], y + direction[1]];
            self.surfaces.push(vec![near_right, far(near_right), far(near_left), near_left]);
            self.edges.extend([near_right, near_left].map(|near| vec![near, far(near)]));
        }
    }

    fn add_strip(&mut self, road: &Road, branch: Branch, corridor: &Corridor, bounds_m: [[f64; 2]; 2]) {
        let axes = Axes::along(corridor.heading_rad);
        let lane_m = self.lane_m;
        let [from_m, to_m] = range(corners(bounds_m).map(|corner| axes.components(corner)[0]), 4.0 * lane_m);
        let world = |[along, across]: [f64; 2]| axes.vector([along, across]);
        let right_at = |along_m: f64| [along_m, corridor.right_edge_m(along_m)];
        let bend = corridor.end.map(taper_m).unwrap_or([from_m; 2]);
        let between = (0..=TAPER_POINTS).map(|part| bend[0] + (bend[1] - bend[0]) * part as f64 / TAPER_POINTS as f64);
        let inside: Vec<f64> = between.filter(|at| from_m < *at && *at < to_m).collect();
        let right = |from_m: f64, to_m: f64| -> WorldLine {
            let inside = inside.iter().copied().filter(|at| from_m < *at && *at < to_m);
            [from_m].into_iter().chain(inside).chain([to_m]).map(|along_m| world(right_at(along_m))).collect()
        };
        let left = |from_m: f64, to_m: f64| vec![world([from_m, corridor.left_m]), world([to_m, corridor.left_m])];
        let whole = right(from_m, to_m);
        self.surfaces.push(whole.into_iter().chain(left(from_m, to_m).into_iter().rev()).collect());
        let pieces = |lateral_m: f64| match road.crossed_m(branch, lateral_m) {
            Some([enters_m, leaves_m]) => vec![[from_m, enters_m], [leaves_m, to_m]],
            None => vec![[from_m, to_m]],
        };
        self.edges.extend(pieces(corridor.right_m).into_iter().map(|[from_m, to_m]| right(from_m, to_m)));
        self.edges.extend(pieces(corridor.left_m).into_iter().map(|[from_m, to_m]| left(from_m, to_m)));
        for between in 1..road.parallel_lanes().map_or(0, |lanes| lanes.count) {
            let lateral_m = corridor.right_m + between as f64 * lane_m;
            let until_m = corridor.end.filter(|_| between == 1).map_or(to_m, |end| taper_m(end)[0]);
            for [from_m, to_m] in pieces(lateral_m) {
                let dashes = dashes([from_m, to_m.min(until_m)], DASH_LANES * lane_m);
                let line = |[start_m, end_m]: [f64; 2]| vec![world([start_m, lateral_m]), world([end_m, lateral_m])];
                self.dashes.extend(dashes.into_iter().map(line));
            }
        }
        if let Some(end) = corridor.end {
            let centre_m = corridor.right_m + 0.5 * lane_m;
            let ways = Ways { left: true, ..Ways::default() };
            let places = [1.0, 5.0].map(|lanes| taper_m(end)[0] - lanes * lane_m);
            self.arrows.extend(places.map(|along_m| (world([along_m, centre_m]), corridor.heading_rad, ways)));
        }
    }

    /// Adds a stop line ahead of every vehicle that initially stands before the crossing of two roads.
    fn add_stop_lines(&mut self, scenario: &Scenario) {
        for vehicle in scenario.vehicles.iter().filter(|vehicle| vehicle.start.speed_mps == 0.0) {
            let zone = scenario.road.conflict_zone_m(vehicle.road).zip(scenario.road.corridor(vehicle.road));
            let Some(([enters_m, _], corridor)) = zone else { continue };
            let axes = Axes::along(corridor.heading_rad);
            let front_m = axes.components(vehicle.start.position())[0] + vehicle.body.front_m;
            let line_m = front_m + STOP_LINE_AHEAD_LANES * self.lane_m;
            if line_m < enters_m {
                let end = |across_m: f64| axes.vector([line_m, across_m]);
                self.stop_lines.push(vec![end(corridor.right_m), end(corridor.left_m)]);
            }
        }
    }

    /// The arrows before junctions, and away from ending lanes.
    pub fn arrows(&self) -> impl Iterator<Item = ArrowShape> {
        self.arrows.iter().map(|(at_m, heading_rad, ways)| ways.shape(*at_m, *heading_rad, self.lane_m))
    }
}

/// An arrow on the road, all lengths in metres of the world.
pub struct ArrowShape {
    pub stem: WorldLine,
    pub bends: Vec<WorldLine>,
    pub heads: Vec<[[f64; 2]; 3]>,
}

impl Ways {
    /// The shape of the arrow at a place, on a lane of a width.
    fn shape(self, at_m: [f64; 2], heading_rad: f64, lane_m: f64) -> ArrowShape {
        let axes = Axes::along(heading_rad);
        let place = |[along, across]: [f64; 2]| {
            let [dx, dy] = axes.vector([along * lane_m, across * lane_m]);
            [at_m[0] + dx, at_m[1] + dy]
        };
        let stem_end = if self.straight { 0.55 } else { 0.1 };
        let straight = self.straight.then(|| [place([0.95, 0.0]), place([0.5, 0.15]), place([0.5, -0.15])]);
        let sides = || [(self.left, 1.0), (self.right, -1.0)].into_iter().filter(|(turns, _)| *turns);
        let bends = sides().map(|(_, side)| vec![place([0.0, 0.0]), place([0.18, side * 0.2])]).collect();
        let turns =
            sides().map(|(_, side)| [place([0.4, side * 0.42]), place([0.05, side * 0.28]), place([0.3, side * 0.1])]);
        let stem = vec![place([-0.6, 0.0]), place([stem_end, 0.0])];
        ArrowShape { stem, bends, heads: straight.into_iter().chain(turns).collect() }
    }
}

/// A line simplified with a tolerance, by the method of Douglas and Peucker.
fn simplified(line: &[[f64; 2]], distance: f64) -> WorldLine {
    let (Some(first), Some(last)) = (line.first(), line.last()) else { return Vec::new() };
    let mut kept = vec![*first];
    let mut waiting = vec![(0, line.len() - 1)];
    while let Some((from, to)) = waiting.pop() {
        let [[x, y], end] = [line[from], line[to]];
        let (dx, dy) = (end[0] - x, end[1] - y);
        let length = libm::hypot(dx, dy);
        let off = |point: &[f64; 2]| {
            let [px, py] = [point[0] - x, point[1] - y];
            if length > 0.0 { (px * dy - py * dx).abs() / length } else { libm::hypot(px, py) }
        };
        let inner = (from + 1..to).map(|index| (off(&line[index]), index));
        match inner.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(off, _)| *off > distance) {
            Some((_, middle)) => waiting.extend([(middle, to), (from, middle)]),
            None if to < line.len() - 1 => kept.push(line[to]),
            None => {}
        }
    }
    kept.push(*last);
    kept
}

/// The bars of a zebra crossing, across the direction of walking.
fn zebra_bars(lane: &Lane) -> Vec<WorldLine> {
    let bar_m = ZEBRA_BAR_RATIO * lane.width.value(0.0);
    let count = (lane.centre.length_m() / (2.0 * bar_m)) as u32;
    let bar = |index: u32| {
        let from_m = 2.0 * bar_m * f64::from(index) + 0.5 * bar_m;
        let corners = [(from_m, -1.0), (from_m + bar_m, -1.0), (from_m + bar_m, 1.0), (from_m, 1.0)];
        corners.map(|(along_m, side)| lane.centre.position(along_m, side * lane.half_width_m(along_m))).to_vec()
    };
    (0..count).map(bar).collect()
}

/// The directions of the successors of a lane.
fn ways(network: &RoadNetwork, lane: &Lane) -> Ways {
    let end_rad = direction(lane, lane.centre.length_m());
    let mut ways = Ways::default();
    for successor in lane.successors.iter().filter_map(|name| network.lane(name)) {
        let turned = direction(successor, successor.centre.length_m()) - end_rad;
        let turned = libm::atan2(libm::sin(turned), libm::cos(turned));
        match turned {
            left if left > TURN_RAD => ways.left = true,
            right if right < -TURN_RAD => ways.right = true,
            _ => ways.straight = true,
        }
    }
    ways
}

/// The direction of a lane at an arc length \[rad\].
fn direction(lane: &Lane, along_m: f64) -> f64 {
    let step_m = 1e-3 * lane.centre.length_m();
    let before_m = (along_m - step_m).max(0.0);
    let [from, to] = [before_m, before_m + step_m].map(|along_m| lane.centre.position(along_m, 0.0));
    libm::atan2(to[1] - from[1], to[0] - from[0])
}

fn corners([low, high]: [[f64; 2]; 2]) -> [[f64; 2]; 4] {
    [low, [low[0], high[1]], high, [high[0], low[1]]]
}

/// Least and greatest of four coordinates, with a margin.
fn range(values: [f64; 4], beyond: f64) -> [f64; 2] {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    [low - beyond, values.iter().copied().fold(f64::NEG_INFINITY, f64::max) + beyond]
}

/// Dashes at whole multiples of their period, so that they do not move with the camera.
fn dashes([from_m, to_m]: [f64; 2], dash_m: f64) -> Vec<[f64; 2]> {
    let period_m = (2.0 * dash_m).max((to_m - from_m) / MAX_DASHES);
    let first = (from_m / period_m).ceil() as i64;
    let starts = (first..).map(|index| index as f64 * period_m).take_while(|start_m| start_m + dash_m <= to_m);
    starts.map(|start_m| [start_m, start_m + dash_m]).collect()
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    fn shapes(name: &str) -> RoadShapes {
        RoadShapes::trace(&load(name, &[]).expect("embedded"), [[-20.0, -20.0], [20.0, 20.0]])
    }

    #[test]
    fn every_form_of_road_has_a_surface_and_edges() {
        for name in [
            "lane-change/front-nice",
            "ramp-merge/nice",
            "intersection/nice",
            "intersection/slanted-nice",
            "curve/lane-drop",
            "roundabout/nice",
            "left-turn/nice",
            "on-ramp/five",
            "narrow-passage/nice",
            "overtaking/oncoming",
            "all-way-stop/four",
        ] {
            let shapes = shapes(name);
            assert!(!shapes.surfaces.is_empty() && shapes.edges.len() >= 2, "{name}");
            assert!(shapes.surfaces.iter().flatten().flatten().all(|part| part.is_finite()), "{name}");
        }
    }

    #[test]
    fn road_marks_show_permitted_turns_stops_and_lane_changes() {
        let crossing = shapes("left-turn/nice");
        assert!(crossing.arrows.iter().any(|(.., ways)| ways.left && ways.straight), "a choice of ways");
        assert!(!shapes("all-way-stop/four").stop_lines.is_empty());
        let stop = shapes("intersection/stop-sign").stop_lines;
        assert_eq!(stop.len(), 1, "the ego alone stands before the crossing");
        assert!(stop[0].iter().all(|[x, _]| (-0.9..-0.2).contains(x)), "{stop:?}");
        let ramp = shapes("ramp-merge/nice");
        assert!(ramp.arrows.iter().all(|(.., ways)| ways.left && !ways.straight && !ways.right));
        assert_eq!(ramp.arrows.len(), 2);
        assert!(shapes("intersection/nice").arrows.is_empty());
    }

    #[test]
    fn simplified_lines_keep_their_shape_with_few_points() {
        let arc: Vec<[f64; 2]> = (0..=400).map(|i| libm::sincos(f64::from(i) / 400.0)).map(|(x, y)| [x, y]).collect();
        let few = simplified(&arc, 1e-3);
        assert!(few.len() > 5 && few.len() < 40, "{}", few.len());
        assert_eq!((few.first(), few.last()), (arc.first(), arc.last()));
        assert!(few.windows(2).all(|pair| pair[1][0] > pair[0][0]), "in order");
        let middles =
            few.windows(2).map(|pair| libm::hypot(0.5 * (pair[0][0] + pair[1][0]), 0.5 * (pair[0][1] + pair[1][1])));
        assert!(middles.into_iter().all(|radius| (1.0 - radius) < 1.1e-3));
        assert_eq!(simplified(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], 0.1), [[0.0, 0.0], [2.0, 0.0]]);
    }

    #[test]
    fn dash_positions_do_not_depend_on_the_picture_extent() {
        let all = dashes([-10.0, 10.0], 0.8);
        let some = dashes([-3.1, 4.0], 0.8);
        assert!(some.iter().all(|dash| all.contains(dash)) && some.len() > 3);
    }
}
