//! The keys of vehicles, each declared once: the key in a file for one vehicle and for all, its value in the run, and the
//! way back.

use interplay_planners::drivers::human;
use interplay_planners::perception::{belief, sensing};
use interplay_planners::rules::RuleKeeping;
use interplay_planners::{Body, Driver, Limits, SafetyEllipse};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Error, json};

use crate::format::start::StartConfig;
use crate::format::stated::Stated;
use crate::model::classes::VehicleClass;
use crate::model::scenario::Vehicle;
use crate::model::traffic::goal::GoalConfig;
use crate::model::traffic::weights::Weights;
use crate::roads::Branch;
use crate::text::name;

/// Declares the keys of vehicles. A key is
///
/// - a field of [`VehicleConfig`], whose comment is its description in the schema and the reference;
/// - `=> place`: the field of [`Vehicle`] that it becomes, by the rule for its type ([`Key`]). A key without a place is resolved
///   by hand (`resolve`) and written by hand (`write`), because it depends on the road or on the registry;
/// - `for_all`: the same key of [`VehicleDefaults`], for all vehicles.
macro_rules! vehicle_keys {
    ($(
        $(#[$about:meta])*
        $key:ident: $Stated:ty $(=> $($place:ident).+)? $(, for_all { $(#[$of_all:meta])* $OfAll:ty })?;
    )*) => {
        /// One vehicle: start, goal, body, limits and driver.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        #[schemars(rename = "Vehicle")]
        pub struct VehicleConfig {
            $($(#[$about])* pub $key: $Stated,)*
        }

        /// Keys for all vehicles that do not state them.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        pub struct VehicleDefaults {
            $($($(#[$of_all])* pub $key: $OfAll,)?)*
        }

        impl VehicleConfig {
            /// Gives a vehicle the value of each key that has a place in it.
            ///
            /// # Errors
            /// The key whose table could not be read, and why.
            pub(crate) fn settle_in(self, vehicle: &mut Vehicle) -> Result<(), (&'static str, Error)> {
                $($(vehicle.$($place).+ = self.$key.settled().map_err(|error| (stringify!($key), error))?;)?)*
                Ok(())
            }

            /// The stated values of the keys that have a place in a vehicle.
            pub(crate) fn of_settled(vehicle: &Vehicle) -> VehicleConfig {
                VehicleConfig { $($($key: Key::of_settled(&vehicle.$($place).+),)?)* ..VehicleConfig::default() }
            }
        }
    };
}

vehicle_keys! {
    /// Its name, unique in the file; it becomes part of paths in the recording.
    #[schemars(extend("pattern" = name::pattern()), example = &"ego")]
    name: String => name;
    /// Its class of vehicle: the default of `body`, `limits` and `safety`, and the size to which the defaults of its
    /// weights and of its driver's settings are scaled. By default a car of the scenario's `scale`, which may follow from the width of
    /// the lanes.
    #[schemars(example = &"car")]
    class: Option<VehicleClass> => class, for_all {
        /// The class of each vehicle that does not state one.
        #[schemars(example = &"car")]
        Option<VehicleClass>
    };
    /// The road it drives on; by default the one along x, and there is another at intersections only.
    #[serde(default)]
    road: Branch => road;
    /// Its start, in a lane or in world coordinates, and its speed there.
    #[schemars(example = json!({ "x_m": 0.0, "y_m": 0.185, "speed_mps": 1.0 }))]
    start: StartConfig;
    /// The names of the lanes on which it drives, from that of its start on, each a successor of the one before or a lane
    /// beside it. By default the shortest route to the lane of its goal, or, without a goal, the only route.
    #[serde(default)]
    #[schemars(length(max = 1000), example = vec!["west-in", "west-to-north", "north-out"])]
    route: Vec<String>;
    /// Its goal; by default to keep its lateral position and its speed.
    #[serde(default)]
    goal: GoalConfig => goal, for_all {
        /// The common keys of the goals of vehicles.
        #[schemars(example = json!({ "speed_mps": 13.9 }))]
        Option<GoalDefaults>
    };
    /// Weights of deviations from its goal and of changes of its inputs. With a `class` of real vehicles, those of angles grow by
    /// default with the speed at the start or of the goal.
    #[schemars(with = "Weights", default = "Weights::default")]
    weights: Option<Stated<Weights>> => weights, for_all {
        /// Weights of deviations from the goal and of changes of the inputs.
        #[schemars(example = json!({ "y": 1.0 }))]
        Option<Stated<Weights>>
    };
    /// Its size and axles; by default those of its class, or Table 6.1.
    #[schemars(with = "Body", default = "Body::default")]
    body: Option<Stated<Body>> => body, for_all {
        /// Size and axles.
        #[schemars(example = json!({ "width_m": 0.19 }))]
        Option<Stated<Body>>
    };
    /// The bounds of its inputs and its speed; by default those of its class, or Table 6.2.
    #[schemars(with = "Limits", default = "Limits::default")]
    limits: Option<Stated<Limits>> => limits, for_all {
        /// The bounds of inputs and speed.
        #[schemars(example = json!({ "speed_max_mps": 1.5 }))]
        Option<Stated<Limits>>
    };
    /// The ellipse around each other vehicle that it keeps out of; by default that of its class, or Table 6.2.
    #[schemars(with = "SafetyEllipse", default = "SafetyEllipse::default")]
    safety: Option<Stated<SafetyEllipse>> => safety, for_all {
        /// The ellipse around each other vehicle that a vehicle keeps out of.
        #[schemars(example = json!({ "along_m": 0.75 }))]
        Option<Stated<SafetyEllipse>>
    };
    /// Its driver; `kind` chooses. By default a nice human.
    #[schemars(with = "Driver", default = "default_driver")]
    driver: Option<Stated<Driver>>, for_all {
        /// The driver. A vehicle with a driver of another `kind` ignores it.
        #[schemars(example = json!({ "kind": "human", "style": "nice" }))]
        Option<Stated<Driver>>
    };
    /// Whether it keeps all rules of roads whose lanes have names, with any driver: speed limits, stop signs and right of way. It then
    /// never exceeds its desired speed, and a human or an IDM driver passes obstacles in its way. Without this key, these two drivers
    /// keep right of way and signs, and planners settle the order themselves.
    #[schemars(example = json!("kept"))]
    rules: Option<RuleKeeping> => rules, for_all {
        /// Whether vehicles keep the rules of the road.
        #[schemars(example = json!("kept"))]
        Option<RuleKeeping>
    };
    /// Whether it publishes its plan, its goal and its wishes to those that know plans: it is *linked* to them. Other drivers see its motion
    /// only, and so does everyone of a vehicle of people, for which this is false by default; in all other files it is true.
    #[schemars(example = true)]
    tells_plan: Option<bool> => tells_plan, for_all {
        /// Whether vehicles publish their plans.
        #[schemars(example = true)]
        Option<bool>
    };
    /// Whether its driver receives the plans of vehicles that tell them, if its kind makes use of plans. Without, it sees the motion of the
    /// others only, late by its reaction time: state, acceleration, indicator and route. False by default among people, else true.
    #[schemars(example = false)]
    knows_plans: Option<bool> => knows_plans, for_all {
        /// Whether drivers receive the plans of vehicles that tell them.
        #[schemars(example = false)]
        Option<bool>
    };
    /// When it enters the road; by default it is there from the start. It waits until there is room: no vehicle ahead is so near
    /// that it would have to brake at once \[s\].
    #[schemars(range(min = 0.0), example = 12.0)]
    enters_s: Option<f64> => stay.enters_s;
    /// When it leaves the road; by default never \[s\].
    #[schemars(range(min = 0.0), example = 30.0)]
    leaves_s: Option<f64> => stay.leaves_s;
    /// Whether it leaves the road where its route ends; by default it drives on straight ahead.
    #[schemars(example = true)]
    leaves_at_end: Option<bool> => stay.leaves_at_end, for_all {
        /// Whether vehicles leave the road where their routes end.
        #[schemars(example = true)]
        Option<bool>
    };
    /// Whether it stops where its route ends, if it keeps the rules; by default it drives on straight ahead.
    #[schemars(example = true)]
    stops_at_end: Option<bool> => stay.stops_at_end;
    /// Its sensing of the other vehicles; without it, it sees the exact states.
    #[schemars(example = json!({ "speed_sd_mps": 0.05, "delay_s": 0.3 }))]
    sensing: Option<Stated<sensing::Settings>> => sensing;
    /// How it infers the others' plans from their motion, if its driver has `prediction = "inferred"`.
    #[schemars(example = json!({ "prior": "tough" }))]
    inference: Option<Stated<belief::Settings>> => inference;
}

impl VehicleConfig {
    /// A vehicle that keeps its lane and its speed, of the size of the scenario, with a nice human as driver.
    pub fn new(name: &str, start: StartConfig) -> VehicleConfig {
        VehicleConfig { name: name.to_owned(), start, ..VehicleConfig::default() }
    }
}

/// The driver of a vehicle that does not state one.
pub(crate) fn default_driver() -> Driver {
    Driver::Human(human::Settings::default())
}

/// The common keys of the goals of vehicles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GoalDefaults {
    /// The desired speed of a vehicle \[m/s\].
    #[schemars(example = 13.9)]
    pub speed_mps: Option<f64>,
}

/// How the value of a key in a file, completed by all size-dependent defaults, becomes that of the vehicle, and back.
trait Key<Settled>: Sized {
    fn settled(self) -> Result<Settled, Error>;

    fn of_settled(settled: &Settled) -> Self;
}

/// A key whose value the vehicle takes over.
impl<T: Clone> Key<T> for T {
    fn settled(self) -> Result<T, Error> {
        Ok(self)
    }

    fn of_settled(settled: &T) -> T {
        settled.clone()
    }
}

/// A table with defaults.
impl<T: Clone + Default + DeserializeOwned + Serialize> Key<T> for Option<Stated<T>> {
    fn settled(self) -> Result<T, Error> {
        self.map_or_else(|| Ok(T::default()), Stated::settings)
    }

    fn of_settled(settled: &T) -> Option<Stated<T>> {
        Some(settled.clone().into())
    }
}

/// A table without which the vehicle lacks the feature that it describes.
impl<T: Clone + DeserializeOwned + Serialize> Key<Option<T>> for Option<Stated<T>> {
    fn settled(self) -> Result<Option<T>, Error> {
        self.map(Stated::settings).transpose()
    }

    fn of_settled(settled: &Option<T>) -> Option<Stated<T>> {
        settled.clone().map(Stated::from)
    }
}

/// A flag that is false by default.
impl Key<bool> for Option<bool> {
    fn settled(self) -> Result<bool, Error> {
        Ok(self.unwrap_or(false))
    }

    fn of_settled(settled: &bool) -> Option<bool> {
        settled.then_some(true)
    }
}
