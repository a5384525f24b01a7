//! The road: what stands still.

use super::re_sdk_types::archetypes::{LineStrips2D, Transform3D};
use super::re_sdk_types::components::Radius;
use interplay_planners::Corridor;
use interplay_scenarios::{Branch, Road, Scenario};
use rerun::{RecordingStream, RecordingStreamResult};

use super::palette::{ASPHALT, MARKING};
use crate::curved_road::{CurvedRoad, WorldLine, taper_m};
use crate::network_lines::NetworkLines;

/// Length of a lane marking and of the space behind it, in lane widths.
const DASH_LANES: f64 = 0.8;
/// Most dashes of one line: on a longer road they are farther apart.
const MAX_DASHES: usize = 4000;
/// In how many pieces the end of a lane is drawn.
const TAPER_SLICES: usize = 60;

/// Logs the roads, the main one between two longitudinal coordinates \[m\].
///
/// # Errors
/// If Rerun refuses a component.
pub fn road(stream: &RecordingStream, scenario: &Scenario, [from_m, to_m]: [f64; 2]) -> RecordingStreamResult<()> {
    // The viewer's y axis points down; the road's points to the left of who drives along it.
    stream.log_static("world", &Transform3D::from_scale([1.0, -1.0, 1.0]))?;
    let road = &scenario.road;
    if let Some(curved) = CurvedRoad::new(road) {
        let dash_m = DASH_LANES * road.lane_width_m();
        let edges = curved.edges([from_m, to_m]);
        let surface = slices(&edges);
        let edges = edges.iter().map(points).collect();
        let markings = curved.dashes(dash_m, [from_m, to_m]).iter().map(points).collect();
        return log_lines(stream, "world/road", surface, [edges, markings]);
    }
    if let Some(network) = &scenario.network {
        return log_network(stream, &NetworkLines::new(network), DASH_LANES * road.lane_width_m());
    }
    let strip = Strip { road, branch: Branch::Main, from_m, to_m };
    strip.log(stream, "world/road")?;
    if let Some(zone) = road.conflict_zone_m(Branch::Cross) {
        let reach_m = (to_m - from_m).max(zone[1] - zone[0]);
        let strip = Strip { road, branch: Branch::Cross, from_m: zone[0] - reach_m, to_m: zone[1] + reach_m };
        strip.log(stream, "world/road/cross")?;
    }
    Ok(())
}

/// One road between two longitudinal coordinates \[m\].
struct Strip<'a> {
    road: &'a Road,
    branch: Branch,
    from_m: f64,
    to_m: f64,
}

/// Points in the frame of a road: longitudinal, lateral.
type Line = Vec<[f32; 2]>;

impl Strip<'_> {
    fn log(&self, stream: &RecordingStream, path: &str) -> RecordingStreamResult<()> {
        let Some(corridor) = self.road.corridor(self.branch) else { return Ok(()) };
        if self.branch == Branch::Main {
            stream.log_static(path, &Transform3D::from_mat3x3(turn(corridor.heading_rad)))?;
        } else {
            let turned = turn(corridor.heading_rad - self.road.heading_rad(Branch::Main));
            stream.log_static(path, &Transform3D::from_mat3x3(turned))?;
        }
        log_lines(stream, path, self.surface(&corridor), [self.edges(&corridor), self.markings(&corridor)])
    }

    /// Thick lines that cover the road; where its right edge moves, one across for every slice.
    fn surface(&self, corridor: &Corridor) -> (Vec<Line>, Vec<Radius>) {
        let covering = |right_m: f64, [from_m, to_m]: [f64; 2]| {
            let middle = 0.5 * (right_m + corridor.left_m);
            (along(middle, from_m, to_m), Radius::new_scene_units(0.5 * (corridor.left_m - right_m) as f32))
        };
        let Some(end) = corridor.end else {
            return [covering(corridor.right_m, [self.from_m, self.to_m])].into_iter().unzip();
        };
        let [begin_m, end_m] = taper_m(end);
        let slice_m = (end_m - begin_m) / TAPER_SLICES as f64;
        let slices = (0..TAPER_SLICES).map(|slice| {
            let at_m = begin_m + (slice as f64 + 0.5) * slice_m;
            let right = corridor.right_edge_m(at_m) + 0.5 * slice_m;
            let line = vec![[at_m as f32, right as f32], [at_m as f32, (corridor.left_m - 0.5 * slice_m) as f32]];
            (line, Radius::new_scene_units(0.7 * slice_m as f32))
        });
        let before = covering(corridor.right_m, [self.from_m, begin_m.max(self.from_m)]);
        let behind = covering(corridor.right_m + end.height_m, [begin_m.max(self.from_m), self.to_m]);
        [before, behind].into_iter().chain(slices).unzip()
    }

    /// The edges, without the part that lies on the other road.
    fn edges(&self, corridor: &Corridor) -> Vec<Line> {
        let pieces = |lateral_m: f64| match self.road.crossed_m(self.branch, lateral_m) {
            Some([enters_m, leaves_m]) => vec![[self.from_m, enters_m], [leaves_m, self.to_m]],
            None => vec![[self.from_m, self.to_m]],
        };
        let [begin_m, end_m] = corridor.end.map_or([self.from_m; 2], taper_m);
        let right = |[from_m, to_m]: [f64; 2]| -> Line {
            let bend = (0..=TAPER_SLICES).map(|i| begin_m + (end_m - begin_m) * i as f64 / TAPER_SLICES as f64);
            let inside = bend.filter(|at_m| from_m < *at_m && *at_m < to_m);
            let all = [from_m].into_iter().chain(inside).chain([to_m]);
            all.map(|at_m| [at_m as f32, corridor.right_edge_m(at_m) as f32]).collect()
        };
        let left = |[from_m, to_m]: [f64; 2]| along(corridor.left_m, from_m, to_m);
        let (rights, lefts) = (pieces(corridor.right_m), pieces(corridor.left_m));
        rights.into_iter().map(right).chain(lefts.into_iter().map(left)).collect()
    }

    /// Dashes between lanes, as far as there are two of them and no other road.
    fn markings(&self, corridor: &Corridor) -> Vec<Line> {
        let lane = self.road.lane_width_m();
        let length_m = self.to_m - self.from_m;
        let period = (2.0 * DASH_LANES * lane).max(length_m / MAX_DASHES as f64);
        let dashes = ((length_m / period).ceil() as usize).min(MAX_DASHES);
        let lateral_m = |between: usize| corridor.right_m + between as f64 * lane;
        let is_free = |between: usize, start: f64| {
            let ramp = corridor.end.filter(|_| between == 1).is_some_and(|end| start > taper_m(end)[0]);
            let zone = self.road.crossed_m(self.branch, lateral_m(between));
            let crossing = zone.is_some_and(|[from, to]| start + 0.5 * period > from && start < to);
            !ramp && !crossing
        };
        let marking = |between: usize| {
            let starts = (0..dashes).map(|dash| self.from_m + dash as f64 * period);
            let free = starts.filter(|start| is_free(between, *start));
            free.map(|start| along(lateral_m(between), start, start + 0.5 * period)).collect::<Vec<_>>()
        };
        let count = self.road.parallel_lanes().map_or(0, |lanes| lanes.count);
        (1..count).flat_map(marking).collect()
    }
}

/// Logs the surface of a road, as lines with their thickness, and its edges and markings.
fn log_lines(
    stream: &RecordingStream,
    path: &str,
    (surface, radii): (Vec<Line>, Vec<Radius>),
    [edges, markings]: [Vec<Line>; 2],
) -> RecordingStreamResult<()> {
    stream.log_static(
        format!("{path}/surface"),
        &LineStrips2D::new(surface).with_radii(radii).with_colors([ASPHALT.solid()]).with_draw_order(-3.0),
    )?;
    let line = |points: f32| LineStrips2D::update_fields().with_radii([Radius::new_ui_points(points)]);
    let edges = line(1.2).with_strips(edges).with_colors([MARKING.solid()]).with_draw_order(-2.0);
    stream.log_static(format!("{path}/edges"), &edges)?;
    let markings = line(0.8).with_strips(markings).with_colors([MARKING.solid()]).with_draw_order(-2.0);
    stream.log_static(format!("{path}/markings"), &markings)
}

/// Logs the lanes of a network, with dashes of a length \[m\].
fn log_network(stream: &RecordingStream, lines: &NetworkLines, dash_m: f64) -> RecordingStreamResult<()> {
    let (mut surface, mut radii) = (Vec::new(), Vec::new());
    for edges in lines.surfaces() {
        let (slices, widths) = slices(edges);
        surface.extend(slices);
        radii.extend(widths);
    }
    let edges = lines.edges().iter().map(points).collect();
    let markings = lines.dashes(dash_m).iter().map(points).collect();
    log_lines(stream, "world/road", (surface, radii), [edges, markings])?;
    let across: Vec<Line> = lines.stop_lines().iter().map(points).collect();
    let across = LineStrips2D::new(across)
        .with_radii([Radius::new_ui_points(2.0)])
        .with_colors([MARKING.solid()])
        .with_draw_order(-2.0);
    stream.log_static("world/road/stop-lines", &across)
}

fn points(line: &WorldLine) -> Line {
    line.iter().map(|[x, y]| [*x as f32, *y as f32]).collect()
}

/// Thick lines across a road that cover it between its right and its left edge.
fn slices([right, left]: &[WorldLine; 2]) -> (Vec<Line>, Vec<Radius>) {
    let distance = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
    let pairs = right.windows(2).zip(left.windows(2));
    let slice = |(right, left): (&[[f64; 2]], &[[f64; 2]])| {
        let widest_m = distance(right[0], right[1]).max(distance(left[0], left[1]));
        let [begin, end] = [right, left].map(|edge| [0, 1].map(|axis| 0.5 * (edge[0][axis] + edge[1][axis])));
        // Lines have round ends, which are not to reach beyond the edges.
        let share = (0.5 * widest_m / distance(begin, end).max(widest_m)).min(0.5);
        let inside = |from: [f64; 2], to: [f64; 2]| [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        (points(&vec![inside(begin, end), inside(end, begin)]), Radius::new_scene_units(0.7 * widest_m as f32))
    };
    pairs.map(slice).unzip()
}

fn along(lateral_m: f64, from_m: f64, to_m: f64) -> Line {
    vec![[from_m as f32, lateral_m as f32], [to_m as f32, lateral_m as f32]]
}

/// Columns of the matrix that turns by an angle about z.
pub fn turn(angle_rad: f64) -> [[f32; 3]; 3] {
    let (sin, cos) = (angle_rad.sin() as f32, angle_rad.cos() as f32);
    [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]
}

#[cfg(test)]
mod tests {
    use interplay_planners::Corridor;
    use interplay_scenarios::{RampMerge, load};

    use super::{Branch, Line, Road, Strip, slices};

    /// The lines of a road from −5 m to 10 m.
    fn lines(road: &Road, branch: Branch, draw: impl Fn(&Strip) -> Vec<Line>) -> Vec<Line> {
        draw(&Strip { road, branch, from_m: -5.0, to_m: 10.0 })
    }

    fn straight(road: &Road, branch: Branch) -> Corridor {
        road.corridor(branch).expect("a straight road")
    }

    #[test]
    fn the_edge_of_a_ramp_bends_to_the_next_lane_and_stays_there() {
        let road = Road::RampMerge(RampMerge::default());
        let edges = lines(&road, Branch::Main, |strip| strip.edges(&straight(&road, Branch::Main)));
        let [right, left] = edges.as_slice() else { panic!("two edges: {edges:?}") };
        assert!(right.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] <= pair[1][1]));
        assert!(right[0][1] < 1e-6 && (right[right.len() - 1][1] - 0.37).abs() < 1e-6);
        assert!(left.iter().all(|point| point[1] == 0.74));
        let markings = lines(&road, Branch::Main, |strip| strip.markings(&straight(&road, Branch::Main)));
        assert!(markings.iter().flatten().all(|point| point[0] < 3.5), "nothing divides a single lane");
    }

    #[test]
    fn nothing_is_drawn_across_the_other_road() {
        let road = load("intersection/nice", &[]).expect("embedded").road;
        for branch in [Branch::Main, Branch::Cross] {
            let [from, to] = road.conflict_zone_m(branch).expect("they cross");
            let edges = lines(&road, branch, |strip| strip.edges(&straight(&road, branch)));
            assert_eq!(edges.len(), 4);
            for edge in edges {
                let (begin, end) = (f64::from(edge[0][0]), f64::from(edge[edge.len() - 1][0]));
                assert!(end <= from + 1e-6 || begin >= to - 1e-6, "{branch:?}: {begin} to {end}");
            }
        }
    }

    /// Slices of a straight piece of 7 m cover it up to its edges, and no further than a third of a slice.
    #[test]
    fn slices_cover_the_road_between_its_edges() {
        let edge = |y: f64| (0..=10).map(|index| [0.7 * f64::from(index), y]).collect::<Vec<_>>();
        let (lines, radii) = slices(&[edge(-3.5), edge(3.5)]);
        assert_eq!((lines.len(), radii.len()), (10, 10));
        let [begin, end] = [lines[0][0], lines[0][1]].map(|point| f64::from(point[1]));
        assert!((begin + 3.15).abs() < 1e-6 && (end - 3.15).abs() < 1e-6, "{begin} to {end}");
    }
}
