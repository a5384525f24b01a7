//! What vehicles look like, by their class or size.

use interplay_planners::Body;
use interplay_scenarios::{ObstacleKind, Outline, Vehicle, VehicleClass};

/// Length of the longest vehicle at 1/10 scale \[m\].
const MAX_SCALE_MODEL_M: f64 = 1.7;
/// The scale of vehicles of full size.
const FULL_SIZE_SCALE: f64 = 10.0;

/// The look of a vehicle in pictures and recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyStyle {
    /// A car with bonnet and boot.
    Car,
    /// A van: the windscreen is far ahead and there is no rear window.
    Van,
    /// A lorry: a cab and a box.
    Lorry,
    /// A bicycle with its rider.
    Bicycle,
    /// Somebody on foot.
    Walker,
    /// Something that has its outline and no parts.
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
/// A body with stated lengths may not say its scale. One that is longer than any lorry at 1/10 scale is of full size.
pub fn scale(body: &Body) -> f64 {
    let is_large = body.front_m + body.rear_m > MAX_SCALE_MODEL_M;
    if body.scale == 1.0 && is_large { FULL_SIZE_SCALE } else { body.scale }
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
