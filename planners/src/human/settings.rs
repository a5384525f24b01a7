//! What a scenario file may say about a human driver.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::predict::Prediction;

/// How much a human driver minds being crowded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Style {
    /// Yields to whoever threatens to enter its safety ellipse: weight 50.
    Nice,
    /// Iron-nerved, ignores the others: weight 0.
    Tough,
}

impl Style {
    /// The safety weight that the word stands for.
    pub fn safety_weight(self) -> f64 {
        match self {
            Style::Nice => 50.0,
            Style::Tough => 0.0,
        }
    }
}

/// A human driver: a model-predictive controller with a weight on safety.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// A word for the safety weight. Without it and without `safety_weight` the driver is nice.
    #[schemars(example = &"nice", extend("x-excludes" = ["safety_weight"]))]
    pub style: Option<Style>,
    /// Weight of the squared intrusion of others into the safety ellipse, at constant velocity; 0 ignores them.
    #[schemars(range(min = 0.0), example = 8.0, extend("x-unit" = "dimensionless"))]
    pub safety_weight: Option<f64>,
    /// Weight of the same kind for the vehicle ahead in the same lane, whatever the style.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub following_weight: f64,
    /// By how much faster than it wants the driver drives while somebody from another lane is about to cut in ahead of it
    /// \[m/s\].
    #[schemars(range(min = 0.0))]
    pub closing_mps: f64,
    /// Whether the classes of motion (before or behind another vehicle, to its left or to its right) are compared and the
    /// cheapest one is chosen. Without it a plan stays in the class of the plan before.
    #[schemars(extend("x-mechanism" = { "passing orders": false }))]
    pub passing_orders: bool,
    /// What others are expected to do that might cut in or cross: by default what their present heading and speed say, so
    /// that a nudge is seen, and not what they plan. The car ahead is always expected to follow its plan.
    pub prediction: Prediction,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            style: None,
            safety_weight: None,
            following_weight: 20.0,
            closing_mps: 0.0,
            passing_orders: true,
            prediction: Prediction::ConstantVelocity,
        }
    }
}

impl Settings {
    /// The style whose weight the driver has, in a word, or else the weight.
    pub(crate) fn manner(&self) -> String {
        let weight = self.weight();
        match [Style::Nice, Style::Tough].into_iter().find(|style| style.safety_weight() == weight) {
            Some(Style::Nice) => "nice".to_owned(),
            Some(Style::Tough) => "tough".to_owned(),
            None => format!("safety weight {weight}"),
        }
    }

    /// The safety weight: stated, or that of the style, or a nice driver's.
    pub fn weight(&self) -> f64 {
        self.safety_weight.unwrap_or_else(|| self.style.unwrap_or(Style::Nice).safety_weight())
    }
}
