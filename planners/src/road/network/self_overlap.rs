//! Checks whether a lane overlaps itself.

use std::collections::BTreeMap;

use super::lane::Lane;

/// Two places overlap if they are nearer across the lane than this share of its width.
const OVERLAP_RATIO: f64 = 0.9;

/// Least cosine of the angle between two parts of a lane that run side by side: those at a larger angle cross, which can be driven.
const MIN_COS: f64 = 0.866;

/// Most places that are compared.
const MAX_PLACES: f64 = 20_000.0;

/// A place of a lane that is compared with others.
#[derive(Clone, Copy)]
struct LanePart {
    along_m: f64,
    position: [f64; 2],
    heading_rad: f64,
    half_m: f64,
}

/// Two arc lengths at which a lane covers the same place in about the same direction, or the opposite one; none if it does so
/// nowhere \[m\].
///
/// In a turn whose inner edge does not cross itself, places at least `π/2` widths apart are at least a width apart. A lane that is
/// its own successor may end where it begins.
pub(super) fn self_overlap_m(lane: &Lane) -> Option<[f64; 2]> {
    let length_m = lane.centre.length_m();
    let widest_m = lane.width.extremes(0.0, length_m)[1];
    let count = (2.0 * length_m / widest_m).ceil().clamp(1.0, MAX_PLACES);
    let step_m = length_m / count;
    let near_m = 0.5 * std::f64::consts::PI * widest_m + step_m;
    let cell_m = widest_m.max(step_m);
    let is_ring = lane.successors.contains(&lane.name);
    let mut cells: BTreeMap<[i64; 2], Vec<LanePart>> = BTreeMap::new();
    for index in 0..=count as usize {
        let along_m = step_m * index as f64;
        let point = lane.centre.at(along_m);
        let half_m = lane.half_width_m(along_m);
        let part = LanePart { along_m, position: point.position, heading_rad: point.heading_rad, half_m };
        let cell = part.position.map(|coordinate| (coordinate / cell_m).floor() as i64);
        for (x, y) in (-1..=1).flat_map(|x| (-1..=1).map(move |y| (x, y))) {
            let mut others = cells.get(&[cell[0] + x, cell[1] + y]).into_iter().flatten();
            let is_met = |earlier: &&LanePart| {
                let closes = is_ring && length_m - (along_m - earlier.along_m) <= near_m;
                along_m - earlier.along_m > near_m && !closes && overlap(earlier, &part, step_m)
            };
            if let Some(earlier) = others.find(is_met) {
                return Some([earlier.along_m, along_m]);
            }
        }
        cells.entry(cell).or_default().push(part);
    }
    None
}

/// Whether two parts of a lane, no longer than a step, lie on each other and run side by side \[m\].
fn overlap(one: &LanePart, other: &LanePart, step_m: f64) -> bool {
    let (sin, cos) = libm::sincos(one.heading_rad);
    let [x, y] = [other.position[0] - one.position[0], other.position[1] - one.position[1]];
    let (along_m, across_m) = (x * cos + y * sin, y * cos - x * sin);
    libm::cos(other.heading_rad - one.heading_rad).abs() >= MIN_COS
        && along_m.abs() <= step_m
        && across_m.abs() < OVERLAP_RATIO * (one.half_m + other.half_m)
}
