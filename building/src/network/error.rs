//! Errors of described zones and walls, and remarks on a valid network.

use std::fmt;

use interplay_common::setting::{SettingError, SettingKey};

/// A zone or a wall of a described building, by its position in the description, from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A zone.
    Zone(usize),
    /// A wall.
    Wall(usize),
}

/// Why zones and walls do not form a network.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NetworkError {
    /// There is nothing to heat or cool.
    #[error("the building has no zones: name at least one")]
    NoZones,
    /// A zone without a name, or with the name of the air outside.
    #[error(
        "zone {} cannot be called `{name}`: choose a name, other than `ambient`, which is the air outside", .zone + 1
    )]
    BadName {
        /// Position of the zone, from zero.
        zone: usize,
        /// Name of the zone.
        name: String,
    },
    /// Two zones have the same name.
    #[error("two zones are called `{name}`: a wall could not tell them apart")]
    DuplicateZone {
        /// Position of the later one, from zero.
        zone: usize,
        /// The repeated name.
        name: String,
    },
    /// A wall leads to a zone that does not exist.
    #[error("{called} leads to `{name}`, which is not a zone (outdoors is `ambient`): {suggestion}")]
    UnknownZone {
        /// Position of the wall, from zero.
        wall: usize,
        /// The wall, in words.
        called: String,
        /// The unknown name.
        name: String,
        /// The zone that was probably meant, or else all zones, in words.
        suggestion: String,
    },
    /// A wall has the same zone, or the air outside, on both sides.
    #[error("{called} has `{name}` on both sides: heat cannot flow from a place to itself")]
    SamePlace {
        /// Position of the wall, from zero.
        wall: usize,
        /// The wall, in words.
        called: String,
        /// The name of the zone or `ambient`.
        name: String,
    },
    /// The sun falls on a wall that stores no heat.
    #[error("{called} gets sun and stores no heat: state its `capacity_kj_per_k`, or give the aperture to a zone")]
    SunWithoutMass {
        /// Position of the wall, from zero.
        wall: usize,
        /// The wall, in words.
        called: String,
        /// The key that lets the sun in.
        key: &'static str,
    },
    /// A setting of a zone or a wall is out of range.
    #[error("{called}: {error}")]
    Setting {
        /// The zone or wall.
        part: Part,
        /// The zone or wall, in words.
        called: String,
        /// The error of the setting.
        error: SettingError,
    },
    /// A factor of the believed building is out of range.
    #[error("the believed building: {0}")]
    Believed(SettingError),
}

impl NetworkError {
    /// The zone or wall at fault; `None` if the error concerns the building as a whole.
    pub fn part(&self) -> Option<Part> {
        match self {
            Self::NoZones | Self::Believed(_) => None,
            Self::BadName { zone, .. } | Self::DuplicateZone { zone, .. } => Some(Part::Zone(*zone)),
            Self::UnknownZone { wall, .. } | Self::SamePlace { wall, .. } | Self::SunWithoutMass { wall, .. } => {
                Some(Part::Wall(*wall))
            }
            Self::Setting { part, .. } => Some(*part),
        }
    }

    /// The key of the setting at fault, in the table of its zone, wall or believed building.
    pub fn key(&self) -> Option<SettingKey> {
        match self {
            Self::NoZones => None,
            Self::BadName { .. } | Self::DuplicateZone { .. } => Some("name".into()),
            Self::UnknownZone { .. } | Self::SamePlace { .. } => Some("between".into()),
            Self::SunWithoutMass { key, .. } => Some((*key).into()),
            Self::Setting { error, .. } | Self::Believed(error) => Some(error.key.clone()),
        }
    }
}

/// A property of a network that is allowed, but may be a mistake of its author.
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
    const MAX_LISTED_NAMES: usize = 6;
    let mut shown: Vec<String> = names.iter().take(MAX_LISTED_NAMES).map(|name| format!("`{name}`")).collect();
    if names.len() > MAX_LISTED_NAMES {
        shown.push(format!("{} more", names.len() - MAX_LISTED_NAMES));
    }
    shown.join(", ")
}
