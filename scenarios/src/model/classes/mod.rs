//! The size of a scenario, and the classes of its vehicles.

use std::borrow::Cow;

use interplay_planners::road::network::LaneUser;
use interplay_planners::{Body, Limits, SafetyEllipse};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

/// The size of a scenario, as a multiple of 1/10 scale.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ScenarioScale {
    /// A named size.
    Named(NamedScale),
    /// Any ratio of lengths to those of a 1/10 scale car.
    Ratio(f64),
}

/// A named size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NamedScale {
    /// Cars of 0.4 m on lanes of 0.37 m.
    Tenth,
    /// Real cars on real roads.
    Full,
}

/// Full size as a multiple of 1/10 scale.
pub(crate) const FULL_SCALE: f64 = Body::REAL_SCALE;

impl ScenarioScale {
    /// The ratio `λ` of lengths to those of 1/10 scale cars.
    pub fn ratio(self) -> f64 {
        match self {
            ScenarioScale::Named(NamedScale::Tenth) => 1.0,
            ScenarioScale::Named(NamedScale::Full) => FULL_SCALE,
            ScenarioScale::Ratio(ratio) => ratio,
        }
    }
}

impl JsonSchema for ScenarioScale {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "ScenarioScale".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "oneOf": [
                { "type": "string", "const": "tenth", "description": "Cars of 0.4 m on lanes of 0.37 m." },
                { "type": "string", "const": "full", "description": "Real cars on real roads." },
                { "type": "number", "minimum": 0.01, "maximum": 1000.0,
                  "description": "Any ratio of lengths to those of a 1/10 scale car." },
            ]
        })
    }
}

/// The class of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum VehicleClass {
    /// A car at 1/10 scale: Tables 6.1 and 6.2 of the dissertation.
    ScaleCar,
    /// A compact car, 4.5 m long.
    Car,
    /// A delivery van, 6 m long.
    Van,
    /// A rigid lorry, 12 m long.
    Truck,
    /// A bus, 12 m long.
    Bus,
    /// A bicycle with its rider, 1.8 m long.
    Bicycle,
    /// A pedestrian.
    Pedestrian,
}

/// Body, limits and safety ellipse of a class.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct ClassDimensions {
    pub body: Body,
    pub limits: Limits,
    pub safety: SafetyEllipse,
}

/// Half axis of the safety ellipse across the road \[m\]: vehicles in the centres of adjacent lanes of 3.5 m are outside.
const FULL_SIZE_ACROSS_M: f64 = 3.3;

impl VehicleClass {
    /// The class of vehicles that do not state one, in a scenario of a scale.
    pub(crate) fn of_scale(is_full: bool) -> VehicleClass {
        if is_full { VehicleClass::Car } else { VehicleClass::ScaleCar }
    }

    /// The ratio of lengths to those of a 1/10 scale car by which settings are scaled.
    ///
    /// It is the same for all full-size vehicles, whatever their own length: settings weigh lane widths, gaps and speeds,
    /// which are those of the traffic.
    pub(crate) fn scale(self) -> f64 {
        match self {
            VehicleClass::ScaleCar => 1.0,
            _ => FULL_SCALE,
        }
    }

    /// The type of road user that restricted lanes admit it as.
    pub(crate) fn lane_user(self) -> LaneUser {
        match self {
            VehicleClass::ScaleCar | VehicleClass::Car | VehicleClass::Van => LaneUser::Car,
            VehicleClass::Truck => LaneUser::Truck,
            VehicleClass::Bus => LaneUser::Bus,
            VehicleClass::Bicycle => LaneUser::Bicycle,
            VehicleClass::Pedestrian => LaneUser::Pedestrian,
        }
    }

    /// The size and the limits of vehicles of the class.
    ///
    /// The ellipse `(a, b)` of a class contains the corner `(l, w)` of the area that two touching parallel bodies cover, with half
    /// the sum of their lengths and half the sum of their widths: `(l/a)² + (w/b)² ≤ 1`, for every other class.
    pub(crate) fn dimensions(self) -> ClassDimensions {
        match self {
            VehicleClass::ScaleCar => {
                ClassDimensions { body: Body::default(), limits: Limits::default(), safety: SafetyEllipse::default() }
            }
            // A compact car such as a VW Golf (4.3 m × 1.8 m) or a Toyota Corolla (4.6 m × 1.8 m), wheelbase 2.6 to 2.7 m.
            // Brakes by UN Regulation 13-H (at least 6.43 m/s²), 100 km/h from rest in 9 s, turning circle 10 m. Tyres of passenger
            // cars on dry roads take 0.7 to 0.9 g sideways.
            VehicleClass::Car => class_values([2.2, 2.3, 1.8, 1.25, 1.45], [-6.4, 3.0, 7.0, 0.55, 50.0], 12.0),
            // A Mercedes Sprinter (5.9 m × 2.0 m, wheelbase 3.7 m). Brakes by UN Regulation 13 for category N1. Its high centre of mass
            // lets its stability control act earlier than a car's.
            VehicleClass::Van => class_values([2.8, 3.2, 2.0, 1.8, 1.9], [-5.0, 2.5, 6.0, 0.6, 40.0], 14.0),
            // The longest and widest rigid lorry of EU Directive 96/53 (12 m × 2.55 m). Brakes by UN Regulation 13 for category
            // N3 (5 m/s²), 1 m/s² as loaded lorries accelerate, and 90 km/h by the limiter of EU Directive 92/6. Loaded lorries roll over
            // from 0.35 to 0.4 g on.
            VehicleClass::Truck => class_values([6.5, 5.5, 2.55, 4.0, 2.0], [-5.0, 1.0, 3.5, 0.7, 25.0], 20.0),
            // A city bus such as a Mercedes Citaro (12.1 m × 2.55 m, wheelbase 5.9 m). Brakes by UN Regulation 13 for category M3; standing
            // passengers bear 1.2 m/s².
            VehicleClass::Bus => class_values([6.3, 5.8, 2.55, 3.4, 2.5], [-5.0, 1.2, 3.5, 0.75, 25.0], 20.0),
            // Brakes 3.4 m/s² and is 1.8 m long in the design guide of AASHTO; handlebars 0.65 m, wheelbase 1.05 m. Leans by
            // at most 22°.
            VehicleClass::Bicycle => class_values([0.9, 0.9, 0.65, 0.55, 0.5], [-3.4, 1.0, 4.0, 0.8, 12.0], 9.0),
            // Shoulders 0.6 m; stops within a step from walking, and runs at 5 m/s at most.
            VehicleClass::Pedestrian => class_values([0.25, 0.25, 0.6, 0.2, 0.2], [-3.0, 1.5, 6.0, 0.9, 5.0], 8.0),
        }
    }
}

/// A full-size vehicle: front, rear, width, front and rear axle \[m\]; braking, acceleration and lateral acceleration \[m/s²\],
/// steering \[rad\] and speed \[m/s\]; half axis of its safety ellipse along the road \[m\].
fn class_values(
    [front_m, rear_m, width_m, front_axle_m, rear_axle_m]: [f64; 5],
    [acceleration_min_mps2, acceleration_max_mps2, lateral_mps2, steering_max_rad, speed_max_mps]: [f64; 5],
    along_m: f64,
) -> ClassDimensions {
    ClassDimensions {
        body: Body { front_m, rear_m, width_m, front_axle_m, rear_axle_m, scale: FULL_SCALE },
        limits: Limits {
            acceleration_min_mps2,
            acceleration_max_mps2,
            steering_max_rad,
            speed_min_mps: 0.0,
            speed_max_mps,
            lateral_acceleration_max_mps2: Some(lateral_mps2),
            steering_rate_max_radps: None,
            comfort: None,
        },
        safety: SafetyEllipse { along_m, across_m: FULL_SIZE_ACROSS_M },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL_SIZE: [VehicleClass; 6] = [
        VehicleClass::Car,
        VehicleClass::Van,
        VehicleClass::Truck,
        VehicleClass::Bus,
        VehicleClass::Bicycle,
        VehicleClass::Pedestrian,
    ];

    /// Parallel vehicles outside each other's ellipses do not touch.
    #[test]
    fn safety_ellipses_keep_bodies_apart() {
        let pairs = FULL_SIZE.iter().flat_map(|own| FULL_SIZE.iter().map(move |other| (*own, *other)));
        for (own, other) in pairs.chain([(VehicleClass::ScaleCar, VehicleClass::ScaleCar)]) {
            let ClassDimensions { body, safety, .. } = own.dimensions();
            let beside = other.dimensions().body;
            let length_m = (body.front_m + beside.rear_m).max(body.rear_m + beside.front_m);
            let width_m = 0.5 * (body.width_m + beside.width_m);
            let corner = (length_m / safety.along_m).powi(2) + (width_m / safety.across_m).powi(2);
            assert!(corner <= 1.0, "{own:?} beside {other:?}: {corner}");
        }
    }

    #[test]
    fn axles_of_every_class_are_below_the_body() {
        for class in FULL_SIZE {
            let body = class.dimensions().body;
            assert!(body.front_axle_m < body.front_m && body.rear_axle_m < body.rear_m, "{class:?}");
        }
    }
}
