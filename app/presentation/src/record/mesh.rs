//! Surfaces as triangles.
//!
//! The viewer shows triangles without normals in their own colour. Light and shade are therefore part of the colours here, and
//! surfaces seen from above have exactly the colours of the palette.

use super::re_sdk_types::archetypes::Mesh3D;
use super::re_sdk_types::components::Color;
use crate::palette::Colour;

/// Brightness of vertical surfaces facing away from the light and towards it, relative to a horizontal surface.
const SIDE_BRIGHTNESS: [f64; 2] = [0.55, 0.85];
/// Horizontal direction from which the light comes.
const LIGHT: [f64; 2] = [0.6, -0.8];

/// Coloured triangles in a frame of metres, z upwards.
#[derive(Default)]
pub struct Mesh {
    positions: Vec<[f32; 3]>,
    colours: Vec<Color>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds a horizontal polygon at a height.
    pub fn add_polygon(&mut self, ring: &[[f64; 2]], height_m: f64, colour: Colour) {
        let first = self.positions.len() as u32;
        for [x, y] in ring {
            self.add_corner([*x, *y, height_m], colour);
        }
        self.triangles.extend(triangulated(ring).into_iter().map(|corners| corners.map(|index| first + index as u32)));
    }

    /// Adds a solid between a lower and an upper polygon with equally many points, with the colours of its sides and of its top.
    pub fn add_solid(&mut self, [low, high]: [&[[f64; 2]]; 2], heights_m: [f64; 2], [sides, top]: [Colour; 2]) {
        for index in 0..low.len() {
            let next = (index + 1) % low.len();
            let [a, b] = [low[index], low[next]];
            let length = libm::hypot(b[0] - a[0], b[1] - a[1]).max(1e-9);
            let outward = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
            let colour = shaded(sides, outward[0] * LIGHT[0] + outward[1] * LIGHT[1]);
            let first = self.positions.len() as u32;
            for ([x, y], height_m) in
                [(a, heights_m[0]), (b, heights_m[0]), (high[next], heights_m[1]), (high[index], heights_m[1])]
            {
                self.add_corner([x, y, height_m], colour);
            }
            self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        self.add_polygon(high, heights_m[1], top);
    }

    /// Adds a solid with vertical sides.
    pub fn add_block(&mut self, ring: &[[f64; 2]], heights_m: [f64; 2], colour: Colour) {
        self.add_solid([ring, ring], heights_m, [colour; 2]);
    }

    /// The mesh as an archetype of Rerun.
    pub fn to_component(&self) -> Mesh3D {
        Mesh3D::new(self.positions.iter().copied())
            .with_vertex_colors(self.colours.iter().copied())
            .with_triangle_indices(self.triangles.iter().copied())
    }

    fn add_corner(&mut self, position: [f64; 3], [red, green, blue]: Colour) {
        self.positions.push(position.map(|part| part as f32));
        self.colours.push(Color::from_rgb(red, green, blue));
    }
}

/// The colour of a vertical surface; `facing` is −1 away from the light and 1 towards it.
fn shaded(colour: Colour, facing: f64) -> Colour {
    let [dark, bright] = SIDE_BRIGHTNESS;
    let share = dark + 0.5 * (facing + 1.0) * (bright - dark);
    colour.map(|part| (share * f64::from(part)) as u8)
}

/// Triangulates a simple polygon by ear clipping.
///
/// Corners at which the outline overlaps itself are left out.
pub fn triangulated(ring: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..ring.len()).collect();
    if area(ring) < 0.0 {
        left.reverse();
    }
    let mut triangles = Vec::new();
    while left.len() > 2 {
        let corners = |at: usize| [at + left.len() - 1, at, at + 1].map(|place| left[place % left.len()]);
        let ear = (0..left.len()).find(|at| is_ear(ring, &left, corners(*at)));
        // An outline that touches itself may have no ear; then the most convex corner is cut off.
        let widest = || (0..left.len()).max_by(|a, b| turn(ring, corners(*a)).total_cmp(&turn(ring, corners(*b))));
        let Some(at) = ear.or_else(widest) else { break };
        if turn(ring, corners(at)) > 0.0 {
            triangles.push(corners(at));
        }
        left.remove(at);
    }
    triangles
}

/// Whether a corner is convex, or flat, and no other point lies in its triangle.
fn is_ear(ring: &[[f64; 2]], left: &[usize], [before, at, after]: [usize; 3]) -> bool {
    let inside = |index: &usize| {
        let point = ring[*index];
        let is_corner = [before, at, after].iter().any(|corner| ring[*corner] == point);
        let sides = [[before, at], [at, after], [after, before]];
        !is_corner && sides.iter().all(|[from, to]| cross(ring[*from], ring[*to], point) >= 0.0)
    };
    turn(ring, [before, at, after]) >= 0.0 && !left.iter().any(inside)
}

fn turn(ring: &[[f64; 2]], [before, at, after]: [usize; 3]) -> f64 {
    cross(ring[before], ring[at], ring[after])
}

/// Twice the area of a triangle, positive if its corners turn to the left.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The area inside of a closed line, positive if it turns to the left.
fn area(ring: &[[f64; 2]]) -> f64 {
    (1..ring.len().saturating_sub(1)).map(|index| 0.5 * cross(ring[0], ring[index], ring[index + 1])).sum()
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::road_shapes::RoadShapes;

    fn covered(ring: &[[f64; 2]]) -> f64 {
        triangulated(ring).into_iter().map(|[a, b, c]| 0.5 * cross(ring[a], ring[b], ring[c])).sum()
    }

    #[test]
    fn triangles_cover_a_concave_polygon_once() {
        let arrow = [[0.0, 0.0], [2.0, -1.0], [1.0, 0.0], [2.0, 1.0]];
        assert_eq!(triangulated(&arrow).len(), 2);
        assert!((covered(&arrow) - 1.0).abs() < 1e-12);
        let clockwise: Vec<[f64; 2]> = arrow.iter().rev().copied().collect();
        assert!((covered(&clockwise) - 1.0).abs() < 1e-12);
        assert!(triangulated(&[[0.0, 0.0], [1.0, 0.0]]).is_empty());
    }

    /// The triangles of every road have the area that its outlines enclose.
    #[test]
    fn the_surface_of_a_road_has_the_area_within_its_edges() {
        for name in
            ["ramp-merge/nice", "on-ramp/five", "roundabout/nice", "curve/lane-drop", "intersection/slanted-nice"]
        {
            let shapes = RoadShapes::trace(&load(name, &[]).expect("embedded"), [[-20.0, -20.0], [20.0, 20.0]]);
            for ring in &shapes.surfaces {
                let (found, expected) = (covered(ring), area(ring).abs());
                assert!((found - expected).abs() < 1e-6 * expected.max(1.0), "{name}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_block_has_four_sides_and_a_top() {
        let mut mesh = Mesh::default();
        mesh.add_block(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], [0.0, 1.0], [200, 100, 0]);
        assert_eq!((mesh.triangles.len(), mesh.positions.len()), (10, 20));
        let top = mesh.colours[16];
        assert_eq!(top, Color::from_rgb(200, 100, 0));
        assert!(mesh.colours[..16].iter().all(|side| *side != top), "sides are in the shade");
    }
}
