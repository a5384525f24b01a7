//! Vehicles as filled shapes in their own frame.

use interplay_planners::{Body, Limits};
use interplay_scenarios::{Outline, Vehicle};
use serde::Serialize;

use crate::body::{BodyStyle, Wheels, body_parts, indicators, place_on, rear_lamp, rectangle};
use crate::palette::{Colour, css};

/// A ring of points ahead of the mass centre and to its left \[m\].
type Ring = Vec<[f64; 2]>;

/// A vehicle as a page draws it.
#[derive(Clone, Debug, Serialize)]
pub struct StageVehicle {
    pub name: String,
    pub driver: String,
    pub colour: String,
    pub is_obstacle: bool,
    pub body: Body,
    /// The bounds of its inputs and its speed.
    pub limits: Limits,
    /// Filled parts, from the lowest to the highest.
    pub shape: Vec<StageShape>,
    /// Shadow on the road, unless the vehicle is flat.
    pub shadow: Option<Ring>,
    /// Wheels, if they are visible.
    pub wheels: Option<StageWheels>,
    pub lamps: Option<StageLamps>,
}

/// A filled ring with rounded corners.
#[derive(Clone, Debug, Serialize)]
pub struct StageShape {
    /// The corners \[m\].
    pub ring: Ring,
    /// Radius of the corners \[m\].
    pub radius: f64,
    pub colour: String,
}

/// The wheels of a vehicle without steering: front right, front left, rear right, rear left.
#[derive(Clone, Debug, Serialize)]
pub struct StageWheels {
    /// The corners of each \[m\].
    pub rings: [[[f64; 2]; 4]; 4],
    /// The middle of each, about which it turns \[m\].
    pub axles: [[f64; 2]; 4],
    /// Whether it turns with the steering.
    pub steered: [bool; 4],
}

/// The lamps of a vehicle, those on the right first.
#[derive(Clone, Debug, Serialize)]
pub struct StageLamps {
    /// Tail lamps \[m\].
    pub tail: [Ring; 2],
    /// Tail lamps while the vehicle brakes \[m\].
    pub brake: [Ring; 2],
    /// Indicators on the left \[m\].
    pub indicator_left: [[f64; 2]; 2],
    /// Indicators on the right \[m\].
    pub indicator_right: [[f64; 2]; 2],
    /// Radius of an indicator \[m\].
    pub radius: f64,
}

impl StageVehicle {
    pub(super) fn of(vehicle: &Vehicle, colour: Colour) -> StageVehicle {
        let (body, style) = (&vehicle.body, BodyStyle::choose(vehicle));
        let has_lamps = matches!(style, BodyStyle::Car | BodyStyle::Van | BodyStyle::Lorry);
        let whole: Ring = rectangle([-1.0, 1.0, -1.0, 1.0]).map(|corner| place_on(body, corner)).to_vec();
        StageVehicle {
            name: vehicle.name.clone(),
            driver: vehicle.driver.description(),
            colour: css(colour),
            is_obstacle: vehicle.obstacle.is_some(),
            body: *body,
            limits: vehicle.limits,
            shape: shape(vehicle, style, colour),
            shadow: (style != BodyStyle::Plain).then_some(whole),
            wheels: has_lamps.then(|| wheels(body, style)),
            lamps: has_lamps.then(|| lamps(body)),
        }
    }
}

fn shape(vehicle: &Vehicle, style: BodyStyle, colour: Colour) -> Vec<StageShape> {
    let body = &vehicle.body;
    if style == BodyStyle::Plain {
        let ring = vehicle.outline().map(Outline::corners_m).unwrap_or_default();
        return vec![StageShape { ring, radius: 0.0, colour: css(colour) }];
    }
    let parts = body_parts(style).into_iter().map(|part| StageShape {
        ring: part.ring.iter().map(|corner| place_on(body, *corner)).collect(),
        radius: part.radius * body.width_m,
        colour: css(part.paint.colour(colour)),
    });
    parts.collect()
}

fn wheels(body: &Body, style: BodyStyle) -> StageWheels {
    let rings = Wheels::place(body, style, 0.0).rings_m;
    let middle = |ring: [[f64; 2]; 4]| [0, 1].map(|axis| ring.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0);
    StageWheels { rings, axles: rings.map(middle), steered: [true, true, false, false] }
}

fn lamps(body: &Body) -> StageLamps {
    let ring = |brakes: bool, side: f64| {
        rectangle(rear_lamp(body, side, brakes)).map(|corner| place_on(body, corner)).to_vec()
    };
    let blinking = |side: f64| indicators(body, side).map(|place| place_on(body, place));
    StageLamps {
        tail: [-1.0, 1.0].map(|side| ring(false, side)),
        brake: [-1.0, 1.0].map(|side| ring(true, side)),
        indicator_left: blinking(1.0),
        indicator_right: blinking(-1.0),
        radius: 0.15 * body.width_m,
    }
}
