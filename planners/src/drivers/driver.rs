//! The list of all drivers, with the word that a scenario file uses for each.

use std::ops::Deref;
use std::sync::LazyLock;

use interplay_common::foreign::{ForeignSettings, KindTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

use crate::drivers::drive::DriverKind;

/// The settings of a driver whose kind another crate provides.
pub type ForeignDriver = ForeignSettings<dyn DriverKind>;

/// Makes the enumeration of the listed kinds, each with the settings of its folder.
macro_rules! drivers {
    ($($(#[$doc:meta])* $kind:ident($folder:ident),)*) => {
        /// The driver of a vehicle with its settings; `kind` in a scenario file chooses.
        #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
        #[serde(tag = "kind", rename_all = "kebab-case")]
        pub enum Driver {
            $($(#[$doc])* $kind(crate::drivers::$folder::Settings),)*
            /// A kind of another crate. It is read by the registry that knows the kind.
            #[serde(skip)]
            Foreign(ForeignDriver),
        }

        static KINDS: LazyLock<Vec<Driver>> =
            LazyLock::new(|| vec![$(Driver::$kind(crate::drivers::$folder::Settings::default()),)*]);

        /// A table with the `kind` and the settings, as a scenario file has it.
        impl Serialize for Driver {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let kind = self.kind();
                match self {
                    $(Driver::$kind(settings) => KindTable { kind, settings }.serialize(serializer),)*
                    Driver::Foreign(foreign) => foreign.serialize(serializer),
                }
            }
        }

        /// What its kind says of a driver.
        impl Deref for Driver {
            type Target = dyn DriverKind;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Driver::$kind(settings) => settings,)*
                    Driver::Foreign(foreign) => foreign.settings(),
                }
            }
        }
    };
}

drivers! {
    /// A human: model-predictive control with a safety weight, from tough to nice.
    Human(human),
    /// The intelligent driver model with MOBIL: the field's baseline of a human.
    Idm(idm),
    /// Does what the scenario says.
    Scripted(scripted),
    /// Repeats the motion of a recorded vehicle; no other driver knows what comes.
    Recorded(recorded),
    /// A pedestrian: walks along its route, waits at the kerb, and sees cars.
    Walker(walker),
    /// Its inputs come from outside: from a person or another program, through the library.
    External(external),
    /// Repeats inputs that came from outside once: what a person has played.
    Inputs(inputs),
    /// Baseline: keeps out of the safety ellipses around the others' plans (eq. 6.13).
    Conservative(conservative),
    /// Negotiation with concession and persuasion (chapter 6).
    Negotiation(negotiation),
    /// Bayesian persuasion (chapter 7).
    Bayesian(bayesian),
    /// The persuasion game (chapter 8).
    Game(game),
    /// Cooperation: one problem for all vehicles that have this driver (eq. 6.12).
    Cooperative(cooperative),
    /// A general-sum game of up to four vehicles: the ego's part of a generalised Nash equilibrium.
    Nash(nash),
    /// Plans that branch: one continuation for each kind of driver that another may be.
    Contingency(contingency),
}

impl Driver {
    /// The kinds of Interplay, each with the defaults of its settings.
    pub fn kinds() -> &'static [Driver] {
        &KINDS
    }

    /// The driver of a kind that can take the wheel, with the defaults of its settings.
    pub fn at_wheel(kind: &str) -> Option<Driver> {
        let mut able = Driver::kinds().iter().filter(|driver| driver.can_take_wheel());
        able.find(|driver| driver.kind() == kind).cloned()
    }

    /// The kinds that can take the wheel, for messages.
    pub fn wheel_kinds() -> String {
        let able = Driver::kinds().iter().filter(|driver| driver.can_take_wheel());
        able.map(|driver| driver.kind()).collect::<Vec<&str>>().join(", ")
    }
}
