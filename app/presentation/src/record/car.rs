//! Vehicles as solids: wheels, body, cabin, windows and lights, in the frame of the body (x ahead, y to the left, z upwards).

use interplay_planners::Body;
use interplay_scenarios::{Outline, Vehicle};

use super::mesh::Mesh;
use crate::body::{BodyArea, BodyStyle, RIDER, Wheels, light_depth, place_on, rectangle};
use crate::palette::{Colour, GLASS, HEADLIGHT, TAIL_LIGHT, TYRE, darker};
use crate::rectangle::rounded_corners;

/// Space below the body, and the upper edges of bonnet, roof, van, cab and box, in widths of the body.
const CLEARANCE_WIDTHS: f64 = 0.1;
const BONNET_WIDTHS: f64 = 0.42;
const ROOF_WIDTHS: f64 = 0.76;
const VAN_WIDTHS: f64 = 1.0;
const CAB_WIDTHS: f64 = 1.15;
const BOX_WIDTHS: f64 = 1.35;

/// Heights of the shoulders and the head of a pedestrian, in widths of the body.
const SHOULDER_WIDTHS: f64 = 2.4;
const WALKER_WIDTHS: f64 = 2.9;
/// Height of obstacles of real roads \[m\].
const PLAIN_M: f64 = 0.9;

pub fn mesh(vehicle: &Vehicle, colour: Colour) -> Mesh {
    let placed = Placed(&vehicle.body);
    let mut mesh = Mesh::default();
    let style = BodyStyle::choose(vehicle);
    if matches!(style, BodyStyle::Car | BodyStyle::Van | BodyStyle::Lorry) {
        add_wheels(&mut mesh, &vehicle.body, style);
        add_lights(&mut mesh, &placed);
    }
    match style {
        BodyStyle::Bicycle => add_bicycle(&mut mesh, &placed, colour),
        BodyStyle::Walker => {
            mesh.add_block(&placed.rounded([-0.7, 0.7, -1.0, 1.0], 0.3), placed.z([0.0, SHOULDER_WIDTHS]), colour);
            mesh.add_block(
                &placed.rectangle([-0.4, 0.4, -0.35, 0.35]),
                placed.z([SHOULDER_WIDTHS, WALKER_WIDTHS]),
                TYRE,
            );
        }
        BodyStyle::Plain => {
            let corners = vehicle.outline().map(Outline::corners_m).unwrap_or_default();
            mesh.add_block(&corners, [0.0, height_m(vehicle)], colour);
        }
        BodyStyle::Car => {
            mesh.add_block(
                &placed.rounded([-1.0, 1.0, -1.0, 1.0], 0.22),
                placed.z([CLEARANCE_WIDTHS, BONNET_WIDTHS]),
                colour,
            );
            let windows = placed.ring(&[[-0.62, -0.86], [0.42, -0.86], [0.42, 0.86], [-0.62, 0.86]]);
            let roof = placed.ring(&[[-0.45, -0.64], [0.12, -0.7], [0.12, 0.7], [-0.45, 0.64]]);
            mesh.add_solid([&windows, &roof], placed.z([BONNET_WIDTHS, ROOF_WIDTHS]), [GLASS, colour]);
        }
        BodyStyle::Van => {
            mesh.add_block(
                &placed.rounded([-1.0, 1.0, -1.0, 1.0], 0.12),
                placed.z([CLEARANCE_WIDTHS, BONNET_WIDTHS]),
                colour,
            );
            let windows = placed.ring(&[[-0.99, -0.97], [0.82, -0.9], [0.82, 0.9], [-0.99, 0.97]]);
            let roof = placed.ring(&[[-0.98, -0.9], [0.6, -0.86], [0.6, 0.86], [-0.98, 0.9]]);
            mesh.add_solid([&windows, &roof], placed.z([BONNET_WIDTHS, VAN_WIDTHS]), [darker(colour), colour]);
            let screen = placed.ring(&[[0.82, -0.8], [0.83, -0.8], [0.83, 0.8], [0.82, 0.8]]);
            let above = placed.ring(&[[0.62, -0.76], [0.63, -0.76], [0.63, 0.76], [0.62, 0.76]]);
            mesh.add_solid([&screen, &above], placed.z([BONNET_WIDTHS, 0.97 * VAN_WIDTHS]), [GLASS, GLASS]);
        }
        BodyStyle::Lorry => {
            let chassis = placed.rectangle([-0.98, 0.98, -0.7, 0.7]);
            mesh.add_block(&chassis, placed.z([CLEARANCE_WIDTHS, 0.3]), TYRE);
            mesh.add_block(&placed.rectangle([-1.0, 0.63, -1.0, 1.0]), placed.z([0.3, BOX_WIDTHS]), colour);
            mesh.add_block(&placed.rounded([0.69, 1.0, -0.96, 0.96], 0.1), placed.z([0.2, CAB_WIDTHS]), darker(colour));
            mesh.add_block(&placed.rectangle([0.9, 1.004, -0.86, 0.86]), placed.z([0.65, 1.01 * CAB_WIDTHS]), GLASS);
        }
    }
    mesh
}

/// Positions of the brake lights: ahead, left, up \[m\].
pub fn brake_lights(body: &Body) -> [[f64; 3]; 2] {
    let placed = Placed(body);
    [-0.68, 0.68].map(|across| {
        let [x, y] = placed.place([-0.97, across]);
        [x, y, (BONNET_WIDTHS + 0.04) * body.width_m]
    })
}

/// Positions of the indicators of the left or the right side \[m\].
pub fn indicators(body: &Body, is_left: bool) -> [[f64; 3]; 2] {
    let placed = Placed(body);
    let across = if is_left { 0.88 } else { -0.88 };
    [-0.9, 0.9].map(|along| {
        let [x, y] = placed.place([along, across]);
        [x, y, (BONNET_WIDTHS + 0.05) * body.width_m]
    })
}

/// Height of a vehicle \[m\].
pub fn height_m(vehicle: &Vehicle) -> f64 {
    let widths = match BodyStyle::choose(vehicle) {
        BodyStyle::Car => ROOF_WIDTHS,
        BodyStyle::Van => VAN_WIDTHS,
        BodyStyle::Lorry => BOX_WIDTHS,
        BodyStyle::Bicycle => 2.4,
        BodyStyle::Walker => WALKER_WIDTHS,
        BodyStyle::Plain => return PLAIN_M * vehicle.body.real_ratio(),
    };
    widths * vehicle.body.width_m
}

/// Positions by shares of a body.
struct Placed<'a>(&'a Body);

impl Placed<'_> {
    fn place(&self, share: [f64; 2]) -> [f64; 2] {
        place_on(self.0, share)
    }

    fn ring(&self, corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
        corners.iter().map(|corner| self.place(*corner)).collect()
    }

    fn rectangle(&self, share: BodyArea) -> Vec<[f64; 2]> {
        self.ring(&rectangle(share))
    }

    /// A rectangle with corners cut off; `cut` is in widths of the body.
    fn rounded(&self, share: BodyArea, cut: f64) -> Vec<[f64; 2]> {
        let corners = self.rectangle(share);
        rounded_corners(&corners, cut * self.0.width_m).flat_map(|[start, _, end]| [start, end]).collect()
    }

    /// Heights \[m\] from heights in widths of the body.
    fn z(&self, heights: [f64; 2]) -> [f64; 2] {
        heights.map(|height| height * self.0.width_m)
    }
}

fn add_wheels(mesh: &mut Mesh, body: &Body, style: BodyStyle) {
    let Wheels { size_m, rings_m } = Wheels::place(body, style, 0.0);
    rings_m.iter().for_each(|ring| mesh.add_block(ring, [0.0, 0.9 * size_m[0]], TYRE));
}

fn add_lights(mesh: &mut Mesh, placed: &Placed) {
    let deep = light_depth(placed.0);
    for side in [-1.0_f64, 1.0] {
        let across = [side * 0.84, side * 0.5];
        let [right, left] = [across[0].min(across[1]), across[0].max(across[1])];
        let head = placed.rectangle([1.0 - 1.3 * deep, 1.005, right, left]);
        mesh.add_block(&head, placed.z([0.28, BONNET_WIDTHS + 0.01]), HEADLIGHT);
        let tail = placed.rectangle([-1.005, -1.0 + 0.9 * deep, right, left]);
        mesh.add_block(&tail, placed.z([0.28, BONNET_WIDTHS + 0.01]), TAIL_LIGHT);
    }
}

fn add_bicycle(mesh: &mut Mesh, placed: &Placed, colour: Colour) {
    for wheel in [[-1.0, -0.3], [0.3, 1.0]] {
        mesh.add_block(&placed.rectangle([wheel[0], wheel[1], -0.09, 0.09]), placed.z([0.0, 1.0]), TYRE);
    }
    mesh.add_block(&placed.rectangle([-0.5, 0.45, -0.1, 0.1]), placed.z([0.6, 1.1]), darker(colour));
    mesh.add_block(&placed.rectangle([0.36, 0.44, -0.9, 0.9]), placed.z([1.4, 1.5]), TYRE);
    mesh.add_block(&placed.rounded(RIDER, 0.2), placed.z([1.1, 2.1]), colour);
    mesh.add_block(&placed.rounded([-0.1, 0.14, -0.4, 0.4], 0.2), placed.z([2.1, 2.4]), darker(colour));
}
