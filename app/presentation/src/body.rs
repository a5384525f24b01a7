//! The look of vehicles by class or size, and their shapes from above, which animations, figures and recordings share.

use interplay_planners::Body;
use interplay_scenarios::{ObstacleKind, Outline, Vehicle, VehicleClass};

use crate::palette::{Colour, GLASS, TYRE};

/// Length of the longest vehicle at 1/10 scale \[m\].
const MAX_SCALE_MODEL_M: f64 = 1.7;
/// The scale of vehicles of full size.
const FULL_SIZE_SCALE: f64 = 10.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyStyle {
    /// A car with bonnet and boot.
    Car,
    /// A van: the windscreen is far ahead, without a rear window.
    Van,
    /// A lorry: a cab and a box.
    Lorry,
    Bicycle,
    Walker,
    /// An obstacle that is drawn as its outline.
    Plain,
}

impl BodyStyle {
    /// The style of a vehicle: by its class, or without one by its size.
    pub fn choose(vehicle: &Vehicle) -> BodyStyle {
        if let Some(obstacle) = &vehicle.obstacle {
            return match (&obstacle.kind, &obstacle.outline) {
                (ObstacleKind::ParkedCar, Outline::Box { .. }) => BodyStyle::Car,
                (ObstacleKind::ParkedVan, Outline::Box { .. }) => BodyStyle::Van,
                _ => BodyStyle::Plain,
            };
        }
        match vehicle.class {
            Some(VehicleClass::ScaleCar | VehicleClass::Car) => BodyStyle::Car,
            Some(VehicleClass::Van) => BodyStyle::Van,
            Some(VehicleClass::Truck) => BodyStyle::Lorry,
            Some(VehicleClass::Bus) => BodyStyle::Van,
            Some(VehicleClass::Pedestrian) => BodyStyle::Walker,
            Some(VehicleClass::Bicycle) => BodyStyle::Bicycle,
            None => BodyStyle::of_size(&vehicle.body),
        }
    }

    fn of_size(body: &Body) -> BodyStyle {
        let scale = scale(body);
        let (length, width) = ((body.front_m + body.rear_m) / scale, body.width_m / scale);
        match (length, width) {
            (length, _) if length > 0.8 => BodyStyle::Lorry,
            (length, _) if length > 0.52 => BodyStyle::Van,
            (_, width) if width < 0.1 => BodyStyle::Bicycle,
            _ => BodyStyle::Car,
        }
    }
}

/// The size of a vehicle as a multiple of one at 1/10 scale.
///
/// A body with stated lengths may not state its scale. A body longer than any lorry at 1/10 scale has full size.
pub fn scale(body: &Body) -> f64 {
    let is_large = body.front_m + body.rear_m > MAX_SCALE_MODEL_M;
    if body.scale == 1.0 && is_large { FULL_SIZE_SCALE } else { body.scale }
}

/// The material of a part of a vehicle, which decides its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyPaint {
    Own,
    Glass,
    /// Dark material of gaps and tyres.
    Tyre,
}

impl BodyPaint {
    /// The colour of the material on a vehicle of colour `own`.
    pub fn colour(self, own: Colour) -> Colour {
        match self {
            BodyPaint::Own => own,
            BodyPaint::Glass => GLASS,
            BodyPaint::Tyre => TYRE,
        }
    }
}

/// A filled part of a vehicle. Coordinates are shares of the body: −1 at the rear and right, 1 at the front and left.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyPart {
    /// The corners, along and across.
    pub ring: Vec<[f64; 2]>,
    /// Radius of the corners, by the width of the body.
    pub radius: f64,
    pub paint: BodyPaint,
}

/// A rectangle along and across a body: rear, front, right, left, from −1 at the rear and right to 1 at the front and left.
pub type BodyArea = [f64; 4];

pub const RIDER: BodyArea = [-0.28, 0.12, -0.8, 0.8];

const HEAD: BodyArea = [-0.5, 0.5, -0.42, 0.42];

/// The corners of a rectangle along and across a body.
pub fn rectangle([rear, front, right, left]: BodyArea) -> [[f64; 2]; 4] {
    [[rear, right], [front, right], [front, left], [rear, left]]
}

/// The position of a point of a body, given as shares of its length and width: ahead and to the left of the mass centre \[m\].
pub fn place_on(body: &Body, [along, across]: [f64; 2]) -> [f64; 2] {
    let Body { front_m, rear_m, width_m, .. } = *body;
    [0.5 * (front_m - rear_m) + 0.5 * along * (front_m + rear_m), 0.5 * across * width_m]
}

/// Length of the lights as a share of the body. In metres it is the same for all vehicles of one width.
pub fn light_depth(body: &Body) -> f64 {
    0.24 * body.width_m / (body.front_m + body.rear_m)
}

/// The rear lamp of a body on the left (1) or the right (−1), longer while the vehicle brakes.
pub fn rear_lamp(body: &Body, side: f64, brakes: bool) -> BodyArea {
    let depth = if brakes { 1.5 } else { 0.9 } * light_depth(body);
    let [right, left] = lamp_across(side);
    [-1.0, -1.0 + depth, right, left]
}

/// The right and the left edge of a lamp across a body, on the left (1) or the right (−1).
pub fn lamp_across(side: f64) -> [f64; 2] {
    let across = [side * 0.88, side * 0.5];
    [across[0].min(across[1]), across[0].max(across[1])]
}

/// The indicators of a body on the left (1) or the right (−1), the one at the rear first.
pub fn indicators(body: &Body, side: f64) -> [[f64; 2]; 2] {
    [-1.0, 1.0].map(|end| [end * (1.0 - 0.8 * light_depth(body)), side * 0.92])
}

/// The wheels of a vehicle, which stand out a little beside the body.
pub struct Wheels {
    /// Length and thickness of each \[m\].
    pub size_m: [f64; 2],
    /// The corners of each, ahead and to the left of the mass centre \[m\].
    pub rings_m: [[[f64; 2]; 4]; 4],
}

impl Wheels {
    /// The wheels of a body, the front ones turned by the steering angle.
    pub fn place(body: &Body, style: BodyStyle, steering_rad: f64) -> Wheels {
        let Body { width_m, front_m, rear_m, front_axle_m, rear_axle_m, .. } = *body;
        let length_m = if style == BodyStyle::Lorry { 0.42 } else { 0.38 } * width_m;
        let thick_m = 0.15 * width_m;
        // The axles of scale cars are at their bumpers: the wheels are drawn where cars have them.
        let front = front_axle_m.min(front_m - 0.85 * length_m);
        let rear = -rear_axle_m.min(rear_m - 0.75 * length_m);
        let wheel = |(ahead, angle_rad, side): (f64, f64, f64)| {
            let middle = side * (0.5 * width_m - 0.25 * thick_m);
            let (sin, cos) = libm::sincos(angle_rad);
            rectangle([-1.0, 1.0, -1.0, 1.0]).map(|[along, across]| {
                let (along, across) = (0.5 * along * length_m, 0.5 * across * thick_m);
                [ahead + cos * along - sin * across, middle + sin * along + cos * across]
            })
        };
        let places = [(front, steering_rad, -1.0), (front, steering_rad, 1.0), (rear, 0.0, -1.0), (rear, 0.0, 1.0)];
        Wheels { size_m: [length_m, thick_m], rings_m: places.map(wheel) }
    }
}

/// The parts of a vehicle, from the lowest to the highest.
pub fn body_parts(style: BodyStyle) -> Vec<BodyPart> {
    let part = |ring: &[[f64; 2]], radius, paint| BodyPart { ring: ring.to_vec(), radius, paint };
    let body = |radius| part(&rectangle([-1.0, 1.0, -1.0, 1.0]), radius, BodyPaint::Own);
    match style {
        BodyStyle::Car => {
            // The windows surround the roof.
            let (rear, front) = (-0.62, 0.42);
            let windows =
                [[rear, -0.6], [rear, 0.6], [front - 0.06, 0.84], [front, 0.7], [front, -0.7], [front - 0.06, -0.84]];
            let roof = [[rear + 0.17, -0.62], [rear + 0.17, 0.62], [front - 0.26, 0.68], [front - 0.26, -0.68]];
            vec![body(0.3), part(&windows, 0.14, BodyPaint::Glass), part(&roof, 0.1, BodyPaint::Own)]
        }
        BodyStyle::Van => vec![body(0.12), part(&windscreen([0.62, 0.82], [0.88, 0.78]), 0.06, BodyPaint::Glass)],
        BodyStyle::Lorry => vec![
            body(0.12),
            part(&windscreen([0.86, 0.95], [0.9, 0.86]), 0.06, BodyPaint::Glass),
            part(&rectangle([0.66, 0.69, -1.0, 1.0]), 0.0, BodyPaint::Tyre),
        ],
        BodyStyle::Walker => vec![
            part(&rectangle([-0.7, 0.7, -1.0, 1.0]), 0.35, BodyPaint::Own),
            part(&rectangle(HEAD), 0.25, BodyPaint::Tyre),
        ],
        BodyStyle::Plain => vec![body(0.0)],
        BodyStyle::Bicycle => vec![
            part(&rectangle([-1.0, 1.0, -0.12, 0.12]), 0.06, BodyPaint::Tyre),
            part(&rectangle(RIDER), 0.25, BodyPaint::Own),
        ],
    }
}

/// A windscreen between two places along the body, `across` at its rear and at its front edge.
fn windscreen([rear, front]: [f64; 2], across: [f64; 2]) -> [[f64; 2]; 4] {
    [[rear, -across[0]], [rear, across[0]], [front, across[1]], [front, -across[1]]]
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    #[test]
    fn vehicles_look_like_their_class_or_size() {
        let full_size = load("full-size/lane-change", &[]).expect("embedded");
        assert_eq!(BodyStyle::choose(&full_size.vehicles[0]), BodyStyle::Car, "without a class");
        let scenario = load("on-ramp/five", &[]).expect("embedded");
        let style = |name: &str| BodyStyle::choose(scenario.vehicle(name).expect("there"));
        assert_eq!((style("lorry"), style("front")), (BodyStyle::Lorry, BodyStyle::Car));
        let size = |front_m: f64, rear_m: f64, width_m: f64| {
            BodyStyle::of_size(&Body { front_m, rear_m, width_m, scale: 10.0, ..Body::default() })
        };
        assert_eq!(size(2.8, 3.2, 2.0), BodyStyle::Van);
        assert_eq!(size(0.9, 0.9, 0.65), BodyStyle::Bicycle);
        assert_eq!(size(2.2, 2.3, 1.8), BodyStyle::Car);
    }
}
