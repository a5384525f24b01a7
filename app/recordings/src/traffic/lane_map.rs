//! A map of lanes, and the way straight on from each lane.

use interplay_scenarios::RecordedLane;

use crate::geometry::LaneLine;

/// Distances by which a way extends beyond its lane and begins before it \[m\].
const REACH_M: [f64; 2] = [300.0, 100.0];
/// Maximum number of lanes of a way in one direction.
const MAX_LANES: usize = 60;
/// A vehicle is in a lane whose direction differs from its own by at most 60°.
const MIN_COS: f64 = 0.5;
/// Maximum distance from which a vehicle outside all lanes follows the nearest one \[m\].
const BESIDE_M: f64 = 4.0;
/// The road beside a lane is sampled in steps of this width, at most [`MAX_PROBES`] times \[m\].
const PROBE_M: f64 = 0.7;
const MAX_PROBES: usize = 15;
/// Lane width of a vehicle outside all lanes \[m\].
const USUAL_WIDTH_M: f64 = 3.5;

#[derive(Clone, Debug, Default)]
pub(crate) struct LaneMap {
    lanes: Vec<MapLane>,
}

#[derive(Clone, Debug)]
struct MapLane {
    stated: RecordedLane,
    /// Its bounding box: least and greatest coordinates \[m\].
    bounds: [[f64; 2]; 2],
    line: LaneLine,
    /// Its line joined with those of the lanes straight on and behind.
    way: LaneLine,
}

impl LaneMap {
    /// A map of lanes; those without length are left out.
    pub(crate) fn new(stated: Vec<RecordedLane>) -> LaneMap {
        let lines: Vec<Option<LaneLine>> =
            stated.iter().map(|lane| LaneLine::between(&lane.left, &lane.right)).collect();
        let ways: Vec<Option<LaneLine>> = (0..stated.len()).map(|index| way(&stated, &lines, index)).collect();
        let lanes = stated.into_iter().zip(lines).zip(ways).filter_map(|((stated, line), way)| {
            let bounds = bounds(&stated);
            Some(MapLane { stated, bounds, line: line?, way: way? })
        });
        LaneMap { lanes: lanes.collect() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.lanes.is_empty()
    }

    pub(crate) fn covers(&self, point: [f64; 2]) -> bool {
        self.lanes.iter().any(|lane| lane.covers(point))
    }

    /// Distances from the centre of a lane to the right and left edges of the road \[m\].
    pub(crate) fn road_m(&self, way: &LaneLine, along_m: f64, width_m: f64) -> [f64; 2] {
        let usual_m = 0.5 * width_m;
        [-1.0, 1.0].map(|side| {
            let beyond = (0..MAX_PROBES).map(|probe| usual_m + PROBE_M * (0.5 + probe as f64));
            let covered = beyond.take_while(|across_m| self.covers(way.position(along_m, side * across_m).0));
            usual_m + PROBE_M * covered.count() as f64
        })
    }

    /// The way straight on for a vehicle at a point with a heading, and the speed limit there: along its lane, or else
    /// beside the nearest lane, or else straight ahead.
    pub(crate) fn way(&self, point: [f64; 2], heading_rad: f64) -> (LaneLine, Option<f64>) {
        let mut best: Option<(bool, f64, &MapLane)> = None;
        for lane in &self.lanes {
            let is_in = lane.covers(point);
            if !is_in && !lane.is_near(point) {
                continue;
            }
            let at = lane.line.project(point);
            let cos = libm::cos(at.heading_rad - heading_rad);
            let is_beyond = at.along_m < -BESIDE_M || at.along_m > lane.line.length_m() + BESIDE_M;
            if cos < MIN_COS || !is_in && (at.across_m.abs() > BESIDE_M + 0.5 * at.width_m || is_beyond) {
                continue;
            }
            // Where lanes overlap, as in junctions, the lane with the direction of the vehicle is chosen.
            let misfit = (1.0 - cos) * 20.0 + at.across_m.abs();
            let is_better = best.is_none_or(|(best_in, best_misfit, _)| (is_in, -misfit) > (best_in, -best_misfit));
            if is_better {
                best = Some((is_in, misfit, lane));
            }
        }
        match best {
            Some((_, _, lane)) => (lane.way.clone(), lane.stated.speed_limit_mps),
            None => (LaneLine::straight(point, heading_rad, USUAL_WIDTH_M), None),
        }
    }
}

impl MapLane {
    fn covers(&self, point: [f64; 2]) -> bool {
        let [low, high] = self.bounds;
        let is_in_box = (0..2).all(|axis| low[axis] <= point[axis] && point[axis] <= high[axis]);
        is_in_box && self.stated.contains(point)
    }

    fn is_near(&self, point: [f64; 2]) -> bool {
        let [low, high] = self.bounds;
        (0..2).all(|axis| low[axis] - BESIDE_M <= point[axis] && point[axis] <= high[axis] + BESIDE_M)
    }
}

fn bounds(lane: &RecordedLane) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for point in lane.left.iter().chain(&lane.right) {
        for axis in 0..2 {
            bounds[0][axis] = bounds[0][axis].min(point[axis]);
            bounds[1][axis] = bounds[1][axis].max(point[axis]);
        }
    }
    bounds
}

/// The line of a lane joined with those of the lanes straight on; of several successors the one that turns least.
fn way(stated: &[RecordedLane], lines: &[Option<LaneLine>], index: usize) -> Option<LaneLine> {
    lines[index].as_ref()?;
    let mut chain = vec![index];
    let ahead: Vec<usize> = followed(lines, index, REACH_M[0], |lane| &stated[lane].successors);
    let behind: Vec<usize> = followed(lines, index, REACH_M[1], |lane| &stated[lane].predecessors);
    chain.splice(0..0, behind.into_iter().rev());
    chain.extend(ahead);
    LaneLine::through(chain.into_iter().filter_map(|lane| lines[lane].as_ref()).flat_map(LaneLine::places))
}

/// The lanes that follow a lane in one direction, until they are long enough.
fn followed<'a>(
    lines: &[Option<LaneLine>],
    first: usize,
    reach_m: f64,
    next: impl Fn(usize) -> &'a [usize],
) -> Vec<usize> {
    let (mut found, mut last, mut length_m) = (Vec::new(), first, 0.0);
    while length_m < reach_m && found.len() < MAX_LANES {
        let known = next(last).iter().filter_map(|lane| Some((*lane, lines.get(*lane)?.as_ref()?)));
        let fresh = known.filter(|(lane, _)| *lane != first && !found.contains(lane));
        let Some((lane, line)) = fresh.min_by(|a, b| a.1.turn_rad().abs().total_cmp(&b.1.turn_rad().abs())) else {
            break;
        };
        found.push(lane);
        length_m += line.length_m();
        last = lane;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lane(from: [f64; 2], to: [f64; 2], successors: &[usize], predecessors: &[usize]) -> RecordedLane {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let length_m = libm::hypot(dx, dy);
        let beside = |point: [f64; 2], side: f64| [point[0] - side * dy / length_m, point[1] + side * dx / length_m];
        RecordedLane {
            left: vec![beside(from, 1.75), beside(to, 1.75)],
            right: vec![beside(from, -1.75), beside(to, -1.75)],
            successors: successors.to_vec(),
            predecessors: predecessors.to_vec(),
            ..RecordedLane::default()
        }
    }

    #[test]
    fn the_path_follows_the_lane_straight_ahead_and_behind() {
        let lanes = vec![
            lane([0.0, 0.0], [50.0, 0.0], &[1, 2], &[]),
            lane([50.0, 0.0], [60.0, 40.0], &[], &[0]),
            lane([50.0, 0.0], [100.0, 0.0], &[], &[0]),
        ];
        let map = LaneMap::new(lanes);
        let (way, _) = map.way([70.0, 0.5], 0.0);
        assert!((way.project([10.0, 0.0]).along_m - 10.0).abs() < 1e-9);
        let (way, _) = map.way([20.0, 0.5], 0.1);
        let at = way.project([90.0, 1.0]);
        assert!((at.along_m - 90.0).abs() < 1e-9 && (at.across_m - 1.0).abs() < 1e-9, "{at:?}");
        assert!(map.covers([20.0, 1.0]) && !map.covers([20.0, 5.0]));
    }

    #[test]
    fn the_path_of_a_vehicle_outside_all_lanes_is_straight() {
        let map = LaneMap::new(vec![lane([0.0, 0.0], [50.0, 0.0], &[], &[])]);
        let (way, _) = map.way([20.0, 30.0], 1.0);
        assert!((way.project([20.0, 30.0]).heading_rad - 1.0).abs() < 1e-12);
        // So is that of a vehicle that drives against the lane.
        let (way, _) = map.way([20.0, 0.0], 3.0);
        assert!((way.project([20.0, 0.0]).heading_rad - 3.0).abs() < 1e-12);
    }
}
