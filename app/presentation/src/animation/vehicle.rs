//! A vehicle from above: shadow, wheels that steer, body, windows, lights. Lorries, vans and bicycles look like themselves.

use interplay_planners::{Body, State};
use interplay_scenarios::{Outline, Vehicle};

use super::camera::CameraView;
use super::canvas::{Canvas, Ink, LineEnd};
use super::scene::SeenVehicle;
use crate::body::{
    BodyArea, BodyPart, BodyStyle, RIDER, Wheels, body_parts, indicators, lamp_across, light_depth, place_on,
    rear_lamp, rectangle,
};
use crate::palette::{BRAKE_LIGHT, Colour, HEADLIGHT, INDICATOR, TAIL_LIGHT, TYRE, darker};
use interplay_planners::scene::IndicatorSide;

/// Least width of a pedestrian \[px\].
const LEAST_WALKER_PX: f64 = 7.0;
/// A shorter vehicle is drawn without its parts \[px\].
const LEAST_PARTS_PX: f64 = 16.0;
/// Least length and width of a vehicle from afar \[px\].
const FROM_AFAR_PX: [f64; 2] = [8.0, 4.0];
const SHADOW: Colour = [0x1B, 0x1D, 0x20];
const SKIN: Colour = [0xE8, 0xC3, 0xA0];

/// The map from the frame of a vehicle to pixels.
struct Placed<'a> {
    body: &'a Body,
    state: &'a State,
    view: &'a CameraView,
}

impl Placed<'_> {
    /// A point ahead and to the left of the mass centre \[m\].
    fn place(&self, [ahead, left]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.state.heading_rad);
        self.view.place([self.state.x_m + cos * ahead - sin * left, self.state.y_m + sin * ahead + cos * left])
    }

    /// A place by shares of the body: −1 at the rear and right, 1 at the front and left.
    fn shared(&self, share: [f64; 2]) -> [f64; 2] {
        self.place(place_on(self.body, share))
    }

    fn rectangle(&self, share: BodyArea) -> [[f64; 2]; 4] {
        rectangle(share).map(|corner| self.shared(corner))
    }

    fn px(&self, metres: f64) -> f64 {
        metres * self.view.px_per_m
    }
}

/// Draws the shadow of a vehicle; all shadows lie below all vehicles.
pub fn draw_shadow(canvas: &mut Canvas, view: &CameraView, vehicle: &Vehicle, seen: &SeenVehicle) {
    let placed = Placed { body: &vehicle.body, state: &seen.state, view };
    let off = placed.px(0.16 * vehicle.body.width_m.min(0.2 * vehicle.body.scale));
    let style = BodyStyle::choose(vehicle);
    if seen.is_absent || style == BodyStyle::Plain {
        return;
    }
    let thin = if style == BodyStyle::Bicycle { 0.4 } else { 1.0 };
    let ring = placed.rectangle([-1.0, 1.0, -thin, thin]).map(|[x, y]| [x + off, y + off]);
    canvas.fill_rounded(&ring, placed.px(0.3 * vehicle.body.width_m), Ink::translucent(SHADOW, 0.35));
}

pub fn draw(canvas: &mut Canvas, view: &CameraView, vehicle: &Vehicle, seen: &SeenVehicle) {
    let colour = seen.colour;
    if seen.is_absent {
        return;
    }
    let placed = Placed { body: &vehicle.body, state: &seen.state, view };
    let style = BodyStyle::choose(vehicle);
    let length = placed.px(vehicle.body.front_m + vehicle.body.rear_m);
    if length < LEAST_PARTS_PX && !matches!(style, BodyStyle::Plain | BodyStyle::Walker | BodyStyle::Bicycle) {
        return draw_from_afar(canvas, &placed, colour);
    }
    match style {
        BodyStyle::Bicycle => return draw_bicycle(canvas, &placed, seen, colour),
        BodyStyle::Walker => return draw_walker(canvas, &placed, colour),
        BodyStyle::Plain => return draw_outline(canvas, &placed, vehicle, colour),
        BodyStyle::Car | BodyStyle::Van | BodyStyle::Lorry => {}
    }
    let Wheels { size_m, rings_m } = Wheels::place(&vehicle.body, style, seen.steering_rad);
    for ring in rings_m {
        canvas.fill_rounded(&ring.map(|corner| placed.place(corner)), placed.px(0.3 * size_m[1]), TYRE);
    }
    let width = placed.px(vehicle.body.width_m);
    let parts = body_parts(style);
    for BodyPart { ring, radius, paint } in &parts {
        let ring: Vec<[f64; 2]> = ring.iter().map(|corner| placed.shared(*corner)).collect();
        canvas.fill_rounded(&ring, radius * width, paint.colour(colour));
    }
    let edge = (0.035 * width).max(1.0);
    match style {
        BodyStyle::Car => draw_pillars(canvas, &placed, colour),
        BodyStyle::Van => {
            let door = [placed.shared([0.55, -0.86]), placed.shared([0.55, 0.86])];
            canvas.line(&door, edge, LineEnd::Flat, darker(colour));
        }
        BodyStyle::Lorry | BodyStyle::Bicycle | BodyStyle::Walker | BodyStyle::Plain => {
            let lid = placed.rectangle([-0.97, 0.63, -0.86, 0.86]);
            canvas.outline_rounded(&lid, 1.0, edge, darker(colour));
        }
    }
    let (ring, radius) = (placed.rectangle([-1.0, 1.0, -1.0, 1.0]), parts[0].radius * width);
    canvas.outline_rounded(&ring, radius, edge, darker(colour));
    draw_lights(canvas, &placed, seen);
}

/// The pillars between the side windows of a car.
fn draw_pillars(canvas: &mut Canvas, placed: &Placed, colour: Colour) {
    const ALONG: f64 = -0.15;
    for side in [-1.0, 1.0] {
        let line = [placed.shared([ALONG, side * 0.62]), placed.shared([ALONG, side * 0.86])];
        canvas.line(&line, 0.06 * placed.px(placed.body.width_m), LineEnd::Flat, colour);
    }
}

fn draw_lights(canvas: &mut Canvas, placed: &Placed, seen: &SeenVehicle) {
    let deep = light_depth(placed.body);
    for side in [-1.0_f64, 1.0] {
        let [right, left] = lamp_across(side);
        let head = placed.rectangle([1.0 - 1.3 * deep, 1.0 - 0.3 * deep, right, left]);
        canvas.fill_rounded(&head, 0.08 * placed.px(placed.body.width_m), HEADLIGHT);
        if seen.brakes {
            let behind = placed.shared([-1.0 - 0.3 * deep, side * 0.68]);
            canvas.disc(behind, placed.px(0.3 * placed.body.width_m), brake_glow());
        }
        let colour = if seen.brakes { BRAKE_LIGHT } else { TAIL_LIGHT };
        let tail = placed.rectangle(rear_lamp(placed.body, side, seen.brakes));
        canvas.fill_rounded(&tail, 0.06 * placed.px(placed.body.width_m), colour);
        let lit = seen.blinks && seen.turn == Some(if side > 0.0 { IndicatorSide::Left } else { IndicatorSide::Right });
        if lit {
            for place in indicators(placed.body, side) {
                let at = placed.shared(place);
                canvas.disc(at, placed.px(0.3 * placed.body.width_m), Ink::translucent(INDICATOR, 0.45));
                canvas.disc(at, placed.px(0.19 * placed.body.width_m), TYRE);
                canvas.disc(at, placed.px(0.15 * placed.body.width_m), INDICATOR);
            }
        }
    }
}

/// Draws shoulders and head of a pedestrian, at least [`LEAST_WALKER_PX`] wide.
fn draw_walker(canvas: &mut Canvas, placed: &Placed, colour: Colour) {
    let middle = placed.shared([0.0, 0.0]);
    let width = placed.px(placed.body.width_m).max(LEAST_WALKER_PX);
    let larger = width / placed.px(placed.body.width_m);
    let shoulders = placed.rectangle([-0.7, 0.7, -1.0, 1.0]);
    let shoulders =
        shoulders.map(|[x, y]| [middle[0] + larger * (x - middle[0]), middle[1] + larger * (y - middle[1])]);
    canvas.fill_rounded(&shoulders, 0.35 * width, colour);
    canvas.disc(middle, 0.27 * width, SKIN);
    canvas.disc(middle, 0.2 * width, darker(colour));
}

/// Draws a vehicle whose parts are too small to be seen.
fn draw_from_afar(canvas: &mut Canvas, placed: &Placed, colour: Colour) {
    let half_m = [0.5 * (placed.body.front_m + placed.body.rear_m), 0.5 * placed.body.width_m];
    let [ahead, beside] = [0, 1].map(|axis| (0.5 * FROM_AFAR_PX[axis] / placed.px(half_m[axis])).max(1.0));
    canvas.fill_rounded(&placed.rectangle([-ahead, ahead, -beside, beside]), 1.5, colour);
}

/// Draws an obstacle as its outline.
fn draw_outline(canvas: &mut Canvas, placed: &Placed, vehicle: &Vehicle, colour: Colour) {
    let corners = vehicle.outline().map(Outline::corners_m).unwrap_or_default();
    let ring: Vec<[f64; 2]> = corners.into_iter().map(|corner| placed.place(corner)).collect();
    canvas.fill(&ring, colour);
    canvas.outline(&ring, 1.0, darker(colour));
}

fn draw_bicycle(canvas: &mut Canvas, placed: &Placed, seen: &SeenVehicle, colour: Colour) {
    let width = placed.px(placed.body.width_m);
    let thick = (0.12 * width).max(1.6);
    let (sin, cos) = libm::sincos(seen.steering_rad);
    let front_axle = placed.body.front_axle_m;
    let wheel_m = 0.5 * placed.body.width_m;
    let turned = |along: f64| placed.place([front_axle + cos * along, sin * along]);
    canvas.line(&[placed.shared([-1.0, 0.0]), placed.shared([-0.3, 0.0])], thick, LineEnd::Round, TYRE);
    canvas.line(&[turned(-wheel_m), turned(0.7 * wheel_m)], thick, LineEnd::Round, TYRE);
    canvas.line(&[placed.shared([-0.5, 0.0]), placed.shared([0.45, 0.0])], thick, LineEnd::Round, darker(colour));
    let bar = [placed.shared([0.38, -0.9]), placed.shared([0.45, 0.0]), placed.shared([0.38, 0.9])];
    canvas.line(&bar, thick, LineEnd::Round, TYRE);
    let rider = placed.rectangle(RIDER);
    canvas.fill_rounded(&rider, 0.25 * width, colour);
    for side in [-1.0, 1.0] {
        canvas.line(
            &[placed.shared([0.0, 0.65 * side]), placed.shared([0.38, 0.75 * side])],
            thick,
            LineEnd::Round,
            SKIN,
        );
    }
    canvas.disc(placed.shared([0.02, 0.0]), 0.24 * width, darker(colour));
    if seen.brakes {
        canvas.disc(placed.shared([-1.0, 0.0]), 0.16 * width, BRAKE_LIGHT);
    }
}

/// The glow of a lit brake light on the road.
pub fn brake_glow() -> Ink {
    Ink::translucent(BRAKE_LIGHT, 0.3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::camera::WIDTH_PX;
    use crate::palette::GLASS;
    use interplay_scenarios::load;

    /// A picture of one vehicle at 60 px/m around it, and what has a colour in it.
    fn count(seen: &SeenVehicle, colour: Colour) -> usize {
        let scenario = load("lane-change/front-nice", &[]).expect("embedded");
        let view = CameraView { centre_m: seen.state.position(), px_per_m: 200.0, size_px: [WIDTH_PX, 200.0] };
        let mut canvas = Canvas::new([720, 200], [0x80; 3]).expect("a size");
        draw(&mut canvas, &view, &scenario.vehicles[0], seen);
        canvas.into_rgb().chunks_exact(3).filter(|pixel| *pixel == colour).count()
    }

    fn standing() -> SeenVehicle {
        SeenVehicle {
            colour: [10, 200, 30],
            is_named: true,
            is_absent: false,
            state: State { x_m: 3.0, y_m: 1.0, heading_rad: 0.4, speed_mps: 1.0 },
            steering_rad: 0.0,
            brakes: false,
            turn: None,
            blinks: true,
            plan: Vec::new(),
            plan_colour: [0; 3],
            branches: Vec::new(),
            proposals: Vec::new(),
        }
    }

    #[test]
    fn vehicle_lights_are_drawn_when_they_are_lit() {
        let dark = standing();
        assert_eq!(count(&dark, BRAKE_LIGHT), 0);
        assert_eq!(count(&dark, INDICATOR), 0);
        assert!(count(&SeenVehicle { brakes: true, ..standing() }, BRAKE_LIGHT) > 10);
        let left = SeenVehicle { turn: Some(IndicatorSide::Left), ..standing() };
        assert!(count(&left, INDICATOR) > 10);
        assert_eq!(count(&SeenVehicle { blinks: false, ..left }, INDICATOR), 0);
        assert!(count(&dark, [10, 200, 30]) > 1000 && count(&dark, GLASS) > 100);
    }
}
