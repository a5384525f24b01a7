//! Why zones and walls are no network, and what is odd about one that is.

use std::fmt;

/// Zones and walls that make no network.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NetworkError {
    /// There is nothing to heat or cool.
    #[error("the building has no zones: name at least one")]
    NoZones,
    /// A zone without a name, or with the name of the air outside.
    #[error("zone {number} cannot be called `{name}`: choose a name, other than `ambient`, which is the air outside")]
    BadName {
        /// Position among the zones, from one.
        number: usize,
        /// Its name.
        name: String,
    },
    /// Two zones bear one name.
    #[error("two zones are called `{name}`: a wall could not tell them apart")]
    DuplicateZone {
        /// The repeated name.
        name: String,
    },
    /// A wall leads to a zone that does not exist.
    #[error("{wall} leads to `{name}`, which is no zone; the nearest name is `{nearest}`, and outdoors is `ambient`")]
    UnknownZone {
        /// The wall.
        wall: String,
        /// The unknown name.
        name: String,
        /// The zone whose name is most like it.
        nearest: String,
    },
    /// A wall has the same place on both sides.
    #[error("{wall} has `{name}` on both sides: heat cannot flow from a place to itself")]
    SamePlace {
        /// The wall.
        wall: String,
        /// The place.
        name: String,
    },
    /// A quantity is zero, negative, infinite or not a number where it must be a positive number.
    #[error("{place}: {quantity} is {value}; it must be {wanted}")]
    OutOfRange {
        /// The zone or wall.
        place: String,
        /// The field.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What would work.
        wanted: &'static str,
    },
}

/// Something that is allowed, and that the author may not have meant.
#[derive(Clone, Debug, PartialEq)]
pub enum Remark {
    /// Heat put into these zones never leaves the building.
    NoWayOut {
        /// Names of the zones, in the order of the network.
        zones: Vec<String>,
    },
    /// No heat passes between these groups of zones: they are separate buildings.
    Apart {
        /// Names of the zones of each group.
        groups: Vec<Vec<String>>,
    },
    /// A zone follows its surroundings within minutes, as it does when resistances are read in a wrong unit.
    Fast {
        /// Name of the zone.
        zone: String,
        /// Capacity over total conductance \[s\].
        time_constant_s: f64,
    },
    /// A zone needs months to follow its surroundings.
    Slow {
        /// Name of the zone.
        zone: String,
        /// Capacity over total conductance \[s\].
        time_constant_s: f64,
    },
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoWayOut { zones } => write!(f, "heat never leaves {}: no wall leads outdoors", quoted(zones)),
            Self::Apart { groups } => {
                let groups: Vec<String> = groups.iter().map(|group| format!("({})", quoted(group))).collect();
                write!(f, "no heat passes between {}", groups.join(" and "))
            }
            Self::Fast { zone, time_constant_s } => write!(
                f,
                "`{zone}` settles in {time_constant_s:.0} s: are its resistances in K/kW (1 K·min/kJ is 60 K/kW) and \
                 its capacity in kJ/K?"
            ),
            Self::Slow { zone, time_constant_s } => write!(
                f,
                "`{zone}` settles in {:.0} days: are its resistances in K/kW and its capacity in kJ/K?",
                time_constant_s / 86_400.0
            ),
        }
    }
}

/// The first names of a list, for a message.
fn quoted(names: &[String]) -> String {
    const SHOWN: usize = 6;
    let mut shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect();
    if names.len() > SHOWN {
        shown.push(format!("{} more", names.len() - SHOWN));
    }
    shown.join(", ")
}
