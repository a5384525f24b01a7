//! Drawing of roads: verge, kerb, asphalt, lines, arrows.

use super::camera::CameraView;
use super::canvas::{Canvas, LineEnd};
use crate::curved_road::WorldLine;
use crate::network_lines::{ARROW_WIDTH_LANES, KERB_LANES, LINE_LANES, SHOULDER_LANES, STOP_LINE_LANES, VERGE_LANES};
use crate::palette::{ARROW, ASPHALT, KERB, PAINT, PATH, RESERVED_LANE, TYRE, VERGE};
use crate::road_shapes::RoadShapes;

/// Thickness of the bar of a traffic light, in lane widths.
const LIGHT_LANES: f64 = 0.14;

/// Draws what traffic lights show at a time \[s\].
pub fn draw_lights(shapes: &RoadShapes, canvas: &mut Canvas, view: &CameraView, time_s: f64) {
    let width = (LIGHT_LANES * shapes.lane_m * view.px_per_m).max(4.0);
    for light in &shapes.lights {
        let bar = light.bar.map(|end| view.place(end));
        canvas.line(&bar, width + 2.0, LineEnd::Round, TYRE);
        canvas.line(&bar, width, LineEnd::Round, light.colour_at(time_s));
    }
}

pub fn draw(shapes: &RoadShapes, canvas: &mut Canvas, view: &CameraView) {
    let lane_px = shapes.lane_m * view.px_per_m;
    let place = |line: &WorldLine| line.iter().map(|point| view.place(*point)).collect::<Vec<_>>();
    let surfaces: Vec<Vec<[f64; 2]>> = shapes.surfaces.iter().map(place).collect();
    for (colour, beyond) in [(VERGE, VERGE_LANES), (KERB, SHOULDER_LANES + KERB_LANES)] {
        surfaces.iter().for_each(|ring| canvas.outline(ring, 2.0 * beyond * lane_px, colour));
    }
    for ring in &surfaces {
        canvas.fill(ring, ASPHALT);
    }
    // Closes the hairlines between lanes that touch, and the small holes between lanes of a junction.
    surfaces.iter().for_each(|ring| canvas.outline(ring, 2.0 * SHOULDER_LANES * lane_px, ASPHALT));
    let areas = [(&shapes.reserved_lanes, RESERVED_LANE), (&shapes.paths, PATH), (&shapes.zebra_bars, PAINT)];
    for (rings, colour) in areas {
        rings.iter().for_each(|ring| canvas.fill(&place(ring), colour));
    }
    let width = (LINE_LANES * lane_px).max(1.3);
    for (lines, width) in
        [(&shapes.edges, width), (&shapes.dashes, width), (&shapes.stop_lines, STOP_LINE_LANES * lane_px)]
    {
        lines.iter().for_each(|line| canvas.line(&place(line), width, LineEnd::Flat, PAINT));
    }
    for arrow in shapes.arrows() {
        let width = ARROW_WIDTH_LANES * lane_px;
        canvas.line(&place(&arrow.stem), width, LineEnd::Flat, ARROW);
        arrow.bends.iter().for_each(|bend| canvas.line(&place(bend), width, LineEnd::Round, ARROW));
        arrow.heads.iter().for_each(|head| canvas.fill(&head.map(|corner| view.place(corner)), ARROW));
    }
}
