//! What a scenario file may say about a human driver.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::prediction::Prediction;
use crate::problem::clearance::share_of;
use crate::trajectory::HomotopySearch;

/// The reaction of people in real cars, of whom each needs 0.5 to 1.5 s \[s\].
pub const REACTION_S: f64 = 0.6;

/// Named points on the continuum of safety weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Style {
    /// Yields to vehicles that threaten to enter its safety ellipse: weight 50.
    Nice,
    /// Safety weight 20.
    Considerate,
    /// Safety weight 8.
    Normal,
    /// Safety weight 2.
    Assertive,
    /// Does not yield to vehicles that cut in or cross: weight 0. It still brakes for the vehicle ahead in its lane.
    Tough,
    /// One of the drivers that were measured on real roads: its safety weight and its time gap are drawn from a population, by the seed of
    /// the scenario and the vehicle's name.
    Measured,
}

impl Style {
    /// The styles with a weight of their own, from the highest to the lowest.
    pub const ALL: [Style; 5] = [Style::Nice, Style::Considerate, Style::Normal, Style::Assertive, Style::Tough];

    /// The word for the style in a scenario file.
    pub fn name(self) -> &'static str {
        match self {
            Style::Nice => "nice",
            Style::Considerate => "considerate",
            Style::Normal => "normal",
            Style::Assertive => "assertive",
            Style::Tough => "tough",
            Style::Measured => "measured",
        }
    }

    /// The safety weight of the style; of measured drivers the median.
    pub fn safety_weight(self) -> f64 {
        match self {
            Style::Nice => 50.0,
            Style::Considerate => 20.0,
            Style::Normal => 8.0,
            Style::Assertive => 2.0,
            Style::Tough => 0.0,
            Style::Measured => 3.9,
        }
    }
}

/// A human driver: a model-predictive controller with a weight on safety.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// A word for the safety weight: nice 50, considerate 20, normal 8, assertive 2, tough 0; `measured` draws a driver from those
    /// that were measured on real roads. Without it and without
    /// `safety_weight` the driver is nice.
    #[schemars(example = &"nice", extend("x-excludes" = ["safety_weight"]))]
    pub style: Option<Style>,
    /// Weight of the squared intrusion of vehicles that might cut in or cross into the safety ellipse; 0 does not yield. Any
    /// weight between the styles, below or above them.
    #[schemars(range(min = 0.0), example = 8.0, extend("x-unit" = "dimensionless"))]
    pub safety_weight: Option<f64>,
    /// Least weight of the same kind for the vehicle ahead in the same lane, whatever the style.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub following_weight: f64,
    /// Increase of the wanted speed while a vehicle from another lane is about to cut in ahead of the driver
    /// \[m/s\].
    #[schemars(range(min = 0.0))]
    pub closing_mps: f64,
    /// Which classes of motion (before or behind another vehicle, to its left or to its right) are compared, of which the
    /// cheapest one is driven.
    #[schemars(extend("x-mechanism" = { "passing orders": HomotopySearch::Off }))]
    pub passing_orders: HomotopySearch,
    /// What others are expected to do that might cut in or cross: by default what their present heading and speed say, so
    /// that a nudge is seen, and not what they plan. With `plan` the driver reads plans: it yields to what others plan before
    /// it shows in their motion. The car ahead is always expected to follow its plan.
    pub prediction: Prediction,
    /// How late the driver sees the others \[s\], rounded to ticks: it expects that each has kept its heading and speed
    /// since, and knows plans that old. Its own state is the present one.
    #[schemars(range(min = 0.0), extend("x-mechanism" = { "late reaction": 0.0 }))]
    pub reaction_s: f64,
    /// How long the driver keeps a decision about vehicles that might cut in or cross \[s\], rounded to ticks: until it decides
    /// anew, it expects of them what it expected at the last decision. It watches the vehicle ahead all the time.
    #[schemars(range(min = 0.0), extend("x-mechanism" = { "hesitation": 0.0 }))]
    pub hesitation_s: f64,
    /// By which share of the difference the wanted speed moves towards the mean speed of at most three vehicles ahead in the lane; of
    /// recorded people 0.27.
    #[schemars(range(min = 0.0, max = 1.0), example = 0.27, extend("x-unit" = "dimensionless"))]
    pub adapts_to_leaders: f64,
    /// By which share of the difference the wanted speed moves towards the one that 85 % of the vehicles in the lane do not exceed; of
    /// recorded people 0.1.
    #[schemars(range(min = 0.0, max = 1.0), example = 0.1, extend("x-unit" = "dimensionless"))]
    pub adapts_to_lane: f64,
    /// The time gap that the driver keeps to the vehicle ahead, as a multiple of `limits.comfort.time_gap_s`. Without it 0.6 to 1.4, the
    /// more the more safety weighs.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0), example = 1.0, extend("x-unit" = "dimensionless"))]
    pub time_gap_ratio: Option<f64>,
    /// Which of the measured drivers it is, where the style is `measured`. Without it the seed of the scenario and the name of the vehicle
    /// say so.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(example = 7, extend("x-unit" = "dimensionless"))]
    pub member: Option<u32>,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            style: None,
            safety_weight: None,
            following_weight: 20.0,
            closing_mps: 0.0,
            passing_orders: HomotopySearch::Classes,
            prediction: Prediction::ConstantVelocity,
            reaction_s: 0.0,
            hesitation_s: 0.0,
            adapts_to_leaders: 0.0,
            adapts_to_lane: 0.0,
            time_gap_ratio: None,
            member: None,
        }
    }
}

impl Settings {
    /// The style whose weight the driver has, in a word, or else the weight.
    pub(crate) fn manner(&self) -> String {
        if self.style == Some(Style::Measured) {
            return Style::Measured.name().to_owned();
        }
        let weight = self.weight();
        let style = Style::ALL.into_iter().find(|style| style.safety_weight() == weight);
        style.map_or_else(|| format!("safety weight {weight}"), |style| style.name().to_owned())
    }

    /// The share of the usual time gap that the driver keeps to the vehicle ahead.
    pub(crate) fn gap_share(&self) -> f64 {
        self.time_gap_ratio.unwrap_or_else(|| share_of(self.weight()))
    }

    /// The safety weight: stated, or that of the style, or a nice driver's.
    pub fn weight(&self) -> f64 {
        self.safety_weight.unwrap_or_else(|| self.style.unwrap_or(Style::Nice).safety_weight())
    }
}
