//! The list of all controllers, with the word that a scenario file uses for each.

use std::ops::Deref;

use interplay_common::foreign::{ForeignSettings, KindTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

use super::interface::ControllerKind;

/// The settings of a controller whose kind another crate provides.
pub type ForeignController = ForeignSettings<dyn ControllerKind>;

/// Makes the enumeration of the listed kinds, each with its settings.
macro_rules! controllers {
    ($($(#[$doc:meta])* $kind:ident($settings:ty),)*) => {
        /// The controller of a building with its settings; `kind` in a scenario file chooses.
        #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
        #[serde(tag = "kind", rename_all = "kebab-case")]
        pub enum Controller {
            $($(#[$doc])* $kind($settings),)*
            /// A kind of another crate. It is read by the registry that knows the kind.
            #[serde(skip)]
            Foreign(ForeignController),
        }

        /// A table with the `kind` and the settings, as a scenario file has it.
        impl Serialize for Controller {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let kind = self.kind();
                match self {
                    $(Controller::$kind(settings) => KindTable { kind, settings }.serialize(serializer),)*
                    Controller::Foreign(foreign) => foreign.serialize(serializer),
                }
            }
        }

        /// What its kind says of a controller.
        impl Deref for Controller {
            type Target = dyn ControllerKind;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Controller::$kind(settings) => settings,)*
                    Controller::Foreign(foreign) => foreign.settings(),
                }
            }
        }
    };
}

controllers! {
    /// A thermostat per zone: full power or none, with a dead band.
    Thermostat(super::thermostat::ThermostatSettings),
    /// A PID controller per zone.
    Pid(super::pid::PidSettings),
    /// Plain iterative learning of P- or PD-type on top of a PID controller, with or without a forecast.
    IterativeLearning(super::learning::LearningSettings),
    /// Model predictive control: the cheapest inputs over a horizon, planned anew at every step.
    ModelPredictive(super::predictive::PredictiveSettings),
    /// Economic model predictive control: the plan that costs the least money within the comfort band, made anew at every step.
    EconomicMpc(super::economic::EconomicSettings),
    /// The day's optimum, computed from the actual disturbances: for comparison.
    Clairvoyant(super::clairvoyant::ClairvoyantSettings),
    /// Feedforward and feedback designed in turn, with an expected cost (chapter 3).
    Iterative(super::iterative::IterativeSettings),
    /// Feedforward and a Youla-parametrised feedback (chapter 4).
    Concurrent(super::concurrent::ConcurrentSettings),
    /// Zones that plan together by exchanging messages with their neighbours (chapter 5).
    Distributed(super::distributed::DistributedSettings),
    /// The problem of the distributed design, solved centrally (eq. 5.12).
    Centralised(super::distributed::CentralisedSettings),
}
