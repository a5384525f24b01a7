//! Every driver a vehicle may have, by the word that a scenario file uses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{conservative, human, negotiation};

/// The driver of a vehicle with its settings; `kind` in a scenario file chooses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Driver {
    /// A human: model-predictive control with a safety weight, nice or tough.
    Human(human::Settings),
    /// Baseline: the others' plans are hard constraints (eq. 6.13).
    Conservative(conservative::Settings),
    /// Negotiation with concession and persuasion (chapter 6).
    Negotiation(negotiation::Settings),
}
