//! What a scenario file may say about how a driver infers the others' plans.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is believed of a human driver's style before anything has been observed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Prior {
    /// Nice 0.6, normal 0.3, tough 0.1.
    #[default]
    Nice,
    /// Nice, normal and tough with a probability of a third each.
    Even,
    /// Nice 0.1, normal 0.3, tough 0.6.
    Tough,
}

/// Odds of the styles of a human driver; only their ratios count.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StyleOdds {
    /// Odds of a human with safety weight 0.
    #[schemars(extend("exclusiveMinimum" = 0.0), extend("x-unit" = "dimensionless"), example = 1.0)]
    pub tough: f64,
    /// Odds of a human with safety weight 8.
    #[schemars(extend("exclusiveMinimum" = 0.0), extend("x-unit" = "dimensionless"), example = 1.0)]
    pub normal: f64,
    /// Odds of a human with safety weight 50.
    #[schemars(extend("exclusiveMinimum" = 0.0), extend("x-unit" = "dimensionless"), example = 2.0)]
    pub nice: f64,
}

/// How a driver with `prediction = "inferred"` learns from the others' motion what they will do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// What is believed of a human's style before anything has been observed. Where the ego has to decide early this decides:
    /// with `nice` it counts on being let in, with `tough` it waits.
    #[schemars(extend("x-excludes" = ["odds"]))]
    pub prior: Prior,
    /// The belief about a human's style before anything has been observed, as odds instead of a word.
    #[schemars(example = StyleOdds { tough: 1.0, normal: 1.0, nice: 2.0 })]
    pub odds: Option<StyleOdds>,
    /// Whether observed motions change the belief; without it the prior is believed for ever.
    #[schemars(extend("x-mechanism" = { "learning": false }))]
    pub learning: bool,
    /// Standard deviation of a driver's acceleration about that of its model \[m/s²\].
    #[schemars(range(min = 0.001))]
    pub acceleration_sd_mps2: f64,
    /// Standard deviation of its steering angle about that of its model \[rad\].
    #[schemars(range(min = 0.0001))]
    pub steering_sd_rad: f64,
    /// The share of the evidence that is kept from one tick to the next.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub forgetting: f64,
    /// The smallest likelihood of a hypothesis as a ratio to that of the likeliest one, so that no hypothesis is ever excluded.
    #[schemars(range(min = 0.000000001, max = 0.5), extend("x-unit" = "dimensionless"))]
    pub floor: f64,
    /// How many times as likely another hypothesis must be to replace the one that is used for planning.
    #[schemars(range(min = 1.0), extend("x-unit" = "dimensionless"))]
    pub hysteresis: f64,
    /// Whether a driver who was out of sight is remembered by its name; without it the belief begins anew.
    #[schemars(extend("x-mechanism" = { "memory": false }))]
    pub memory: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            prior: Prior::Nice,
            odds: None,
            learning: true,
            acceleration_sd_mps2: 0.3,
            steering_sd_rad: 0.05,
            forgetting: 0.98,
            floor: 0.001,
            hysteresis: 2.0,
            memory: false,
        }
    }
}

impl Settings {
    /// The prior probabilities of the styles, from the lowest weight to the highest; they sum to 1.
    pub(super) fn style_priors(&self) -> [f64; 3] {
        let odds = match (self.odds, self.prior) {
            (Some(StyleOdds { tough, normal, nice }), _) => [tough, normal, nice],
            (None, Prior::Nice) => [0.1, 0.3, 0.6],
            (None, Prior::Even) => [1.0, 1.0, 1.0],
            (None, Prior::Tough) => [0.6, 0.3, 0.1],
        };
        let sum: f64 = odds.iter().sum();
        odds.map(|odds| odds / sum)
    }
}
