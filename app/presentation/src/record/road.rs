//! The road and the ground of a recording, which are static.

use super::re_sdk_types::archetypes::LineStrips3D;
use super::re_sdk_types::components::{Color, Radius};
use super::{Logged, RecordedTick};
use interplay_scenarios::Scenario;
use rerun::RecordingStream;

use super::mesh::Mesh;
use super::palette::opaque;
use crate::curved_road::WorldLine;
use crate::network_lines::STOP_LINE_LANES;
use crate::palette::{ARROW, ASPHALT, Colour, GRASS, PAINT, PATH, RESERVED_LANE};
use crate::road_shapes::RoadShapes;
use crate::signals::LightShape;

/// Heights of the ground and of the lines above the road, in lane widths.
const GROUND_LANES: f64 = -0.02;
const LINES_LANES: f64 = 0.005;
/// How far the asphalt reaches beyond the edges, in lane widths.
const SHOULDER_LANES: f64 = 0.08;
/// How far the road is drawn beyond the vehicles, in lane widths.
const BEYOND_LANES: f64 = 40.0;
/// Length of the pieces of a line, in lane widths, and most of them between two points.
const PIECE_LANES: f64 = 2.0;
const MAX_PIECES: f64 = 2000.0;
/// How far the ground reaches beyond the road, as a share of the larger of the road's extents.
const GROUND_BEYOND_RATIO: f64 = 3.0;

/// Logs the road between least and greatest coordinates of the world \[m\].
pub fn road(stream: &RecordingStream, scenario: &Scenario, bounds_m: [[f64; 2]; 2]) -> Logged {
    let beyond_m = BEYOND_LANES * scenario.road.lane_width_m();
    let bounds_m = [bounds_m[0].map(|part| part - beyond_m), bounds_m[1].map(|part| part + beyond_m)];
    let shapes = RoadShapes::trace(scenario, bounds_m);
    let mut ground = Mesh::default();
    ground.add_polygon(&around(&shapes, bounds_m), GROUND_LANES * shapes.lane_m, GRASS);
    stream.log_static("world/ground", &ground.to_component())?;
    let mut surface = Mesh::default();
    for ring in &shapes.surfaces {
        surface.add_polygon(ring, 0.0, ASPHALT);
        add_shoulder(&mut surface, ring, &shapes);
    }
    let height_m = LINES_LANES * shapes.lane_m;
    for (rings, colour) in [(&shapes.reserved_lanes, RESERVED_LANE), (&shapes.paths, PATH), (&shapes.zebra_bars, PAINT)]
    {
        rings.iter().for_each(|ring| surface.add_polygon(ring, 0.5 * height_m, colour));
    }
    let mut arrows = Vec::new();
    for arrow in shapes.arrows() {
        arrow.heads.iter().for_each(|head| surface.add_polygon(head, height_m, ARROW));
        arrows.extend(arrow.bends.into_iter().chain([arrow.stem]));
    }
    // The dashes are surfaces: a line of the viewer has round ends, which would close the gaps between dashes.
    for line in shapes.stop_lines.iter().flat_map(|line| line.windows(2)) {
        let half_m = 0.5 * STOP_LINE_LANES * shapes.lane_m;
        surface.add_polygon(&strip([line[0], line[1]], half_m, 0.0), height_m, PAINT);
    }
    stream.log_static("world/road/surface", &surface.to_component())?;
    for (part, lines, points, colour) in [
        ("edges", &shapes.edges, 1.1, PAINT),
        ("markings", &shapes.dashes, 0.8, PAINT),
        ("arrows", &arrows, 1.4, ARROW),
    ] {
        if !lines.is_empty() {
            let lines: Vec<WorldLine> = lines.iter().map(|line| in_pieces(line, PIECE_LANES * shapes.lane_m)).collect();
            stream.log_static(format!("world/road/{part}"), &lines_at(&lines, height_m, points, colour))?;
        }
    }
    Ok(())
}

/// Adds a strip along the outline of a surface, slightly below it, which closes holes between the lanes of a junction.
fn add_shoulder(mesh: &mut Mesh, ring: &[[f64; 2]], shapes: &RoadShapes) {
    let half_m = SHOULDER_LANES * shapes.lane_m;
    for index in 0..ring.len() {
        let ends = [ring[index], ring[(index + 1) % ring.len()]];
        if ends[0] != ends[1] {
            mesh.add_polygon(&strip(ends, half_m, 0.5 * half_m), 0.5 * GROUND_LANES * shapes.lane_m, ASPHALT);
        }
    }
}

/// The rectangle along a segment, with half its width and its length beyond the ends \[m\].
fn strip([from, to]: [[f64; 2]; 2], half_m: f64, beyond_m: f64) -> [[f64; 2]; 4] {
    let delta = [0, 1].map(|axis| to[axis] - from[axis]);
    let along = delta.map(|part| part / libm::hypot(delta[0], delta[1]));
    let at = |point: [f64; 2], ahead_m: f64, left_m: f64| {
        [point[0] + ahead_m * along[0] - left_m * along[1], point[1] + ahead_m * along[1] + left_m * along[0]]
    };
    [at(from, -beyond_m, -half_m), at(to, beyond_m, -half_m), at(to, beyond_m, half_m), at(from, -beyond_m, half_m)]
}

/// A line with points at most `longest_m` apart: the viewer draws long segments in perspective with a wrong width.
fn in_pieces(line: &[[f64; 2]], longest_m: f64) -> WorldLine {
    let pieces = line.windows(2).flat_map(|pair| {
        let [from, to] = [pair[0], pair[1]];
        let count = (libm::hypot(to[0] - from[0], to[1] - from[1]) / longest_m).ceil().clamp(1.0, MAX_PIECES) as u32;
        let at = move |part: u32| {
            [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * f64::from(part) / f64::from(count))
        };
        (0..count).map(at)
    });
    pieces.chain(line.last().copied()).collect()
}

/// Lines at a height, with a constant width on the screen.
fn lines_at(lines: &[WorldLine], height_m: f64, points: f32, [red, green, blue]: Colour) -> LineStrips3D {
    let raised = |line: &WorldLine| -> Vec<[f32; 3]> {
        line.iter().map(|[x, y]| [*x as f32, *y as f32, height_m as f32]).collect()
    };
    LineStrips3D::new(lines.iter().map(raised))
        .with_radii([Radius::new_ui_points(points)])
        .with_colors([Color::from_rgb(red, green, blue)])
}

/// A rectangle far around the road.
fn around(shapes: &RoadShapes, [low, high]: [[f64; 2]; 2]) -> [[f64; 2]; 4] {
    let (mut low, mut high) = (low, high);
    for point in shapes.surfaces.iter().flatten() {
        for axis in 0..2 {
            (low[axis], high[axis]) = (low[axis].min(point[axis]), high[axis].max(point[axis]));
        }
    }
    let beyond_m = GROUND_BEYOND_RATIO * (high[0] - low[0]).max(high[1] - low[1]);
    let ([left, bottom], [right, top]) = (low.map(|part| part - beyond_m), high.map(|part| part + beyond_m));
    [[left, bottom], [right, bottom], [right, top], [left, top]]
}

/// Columns of the matrix that rotates by an angle about z.
pub fn rotation(angle_rad: f64) -> [[f32; 3]; 3] {
    let (sin, cos) = (angle_rad.sin() as f32, angle_rad.cos() as f32);
    [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]
}

/// Height and thickness of the bar of a light, in widths of its lane.
const HEIGHT_LANES: f64 = 0.02;
const RADIUS_LANES: f64 = 0.06;

/// The traffic lights of a road.
pub struct LightLayer {
    lights: Vec<LightShape>,
    lane_m: f64,
    /// The colour that each light was logged with.
    shown: Vec<Option<Colour>>,
}

impl LightLayer {
    pub fn begin(scenario: &Scenario) -> LightLayer {
        let lights = scenario.network.as_deref().map(LightShape::all).unwrap_or_default();
        LightLayer { shown: vec![None; lights.len()], lane_m: scenario.road.lane_width_m(), lights }
    }

    /// Logs the lights whose colour has changed.
    pub fn log_frame(&mut self, tick: &RecordedTick) -> Logged {
        for (light, shown) in self.lights.iter().zip(&mut self.shown) {
            let colour = light.colour_at(tick.frame.time_s);
            if shown.replace(colour) != Some(colour) {
                let height = (HEIGHT_LANES * self.lane_m) as f32;
                let bar = light.bar.map(|[x, y]| [x as f32, y as f32, height]);
                let radius = Radius::new_scene_units((RADIUS_LANES * self.lane_m) as f32);
                let strip = LineStrips3D::new([bar]).with_colors([opaque(colour)]).with_radii([radius]);
                tick.stream.log(format!("world/light/{}", light.lane), &strip)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::in_pieces;

    #[test]
    fn splitting_a_line_keeps_its_ends_and_bounds_segment_length() {
        let line = in_pieces(&[[0.0, 0.0], [10.0, 0.0], [10.0, 1.0]], 3.0);
        assert_eq!(line, [[0.0, 0.0], [2.5, 0.0], [5.0, 0.0], [7.5, 0.0], [10.0, 0.0], [10.0, 1.0]]);
    }
}
