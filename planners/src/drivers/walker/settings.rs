//! The settings of a pedestrian.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::scene::trigger::Trigger;

/// The settings of a pedestrian: how careful, and when.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// How careful it is before it steps on a street.
    pub style: WalkerStyle,
    /// When it begins to walk; by default at once.
    #[schemars(example = json!({ "vehicle": "ego", "reaches": { "lane": "street", "along_m": 40.0 } }))]
    pub when: Option<Trigger>,
}

/// How careful a pedestrian is before it steps on a street.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WalkerStyle {
    /// Wants 4 s between itself and the next vehicle, and steps before one that has the duty to stop only if that brakes with less than
    /// 1 m/s².
    Careful,
    /// 2.5 s, and 2 m/s².
    #[default]
    Normal,
    /// 1 s, and 3.5 m/s².
    Bold,
}

/// The numbers of a style.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Caution {
    /// Time between its leaving the crossing and the vehicle's coming there, of a real one \[s\].
    pub gap_s: f64,
    /// A vehicle that has to let it go is trusted to brake as hard as this \[m/s²\].
    pub trusted_braking_mps2: f64,
}

impl WalkerStyle {
    pub(super) fn caution(self) -> Caution {
        let [gap_s, trusted_braking_mps2] = match self {
            WalkerStyle::Careful => [4.0, 1.0],
            WalkerStyle::Normal => [2.5, 2.0],
            WalkerStyle::Bold => [1.0, 3.5],
        };
        Caution { gap_s, trusted_braking_mps2 }
    }
}
