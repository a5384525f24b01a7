//! A heat pump, or a chiller: the heat that it moves for a kilowatt of electricity.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use interplay_common::bounds::Bound;
use interplay_common::setting::{self, SettingError, SettingKey};

/// Coefficients of performance of the equipment, for heating and for cooling, by outdoor temperature.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HeatPump {
    /// COP while it heats, at rising outdoor temperatures: linear between two points and constant beyond the ends. One point is
    /// a constant COP; none is 1, as of an electric heater.
    #[schemars(length(max = 100))]
    pub heating: Vec<CopPoint>,
    /// COP while it cools, in the same form as `heating`.
    #[schemars(length(max = 100))]
    pub cooling: Vec<CopPoint>,
}

/// The coefficient of performance at an outdoor temperature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CopPoint {
    /// Outdoor temperature \[°C\].
    #[schemars(range(min = -100.0, max = 100.0), example = 7.0)]
    pub outdoor_c: f64,
    /// Heat moved per electric energy taken.
    #[schemars(range(min = 0.1, max = 50.0), example = 3.5, extend("x-unit" = "dimensionless"))]
    pub cop: f64,
}

impl HeatPump {
    /// Refuses settings that are out of range, and points whose temperatures do not rise.
    pub fn check(&self) -> Result<(), SettingError> {
        setting::check(self)?;
        for (curve, points) in [("heating", &self.heating), ("cooling", &self.cooling)] {
            for (index, pair) in points.windows(2).enumerate() {
                if pair[1].outdoor_c <= pair[0].outdoor_c {
                    let key = SettingKey::from(curve).entry(index + 1).key("outdoor_c");
                    let (value, bound) = (pair[1].outdoor_c, Bound::Above(pair[0].outdoor_c));
                    return Err(SettingError { key, value, bound });
                }
            }
        }
        Ok(())
    }

    /// The COP at an outdoor temperature, while it heats or cools.
    pub fn cop(&self, heats: bool, outdoor_c: f64) -> f64 {
        let points = self.points(heats);
        let after = points.partition_point(|point| point.outdoor_c <= outdoor_c);
        match (after.checked_sub(1).map(|before| points[before]), points.get(after)) {
            (None, None) => 1.0,
            (Some(end), None) => end.cop,
            (None, Some(end)) => end.cop,
            (Some(low), Some(high)) => {
                let share = (outdoor_c - low.outdoor_c) / (high.outdoor_c - low.outdoor_c);
                low.cop + share * (high.cop - low.cop)
            }
        }
    }

    /// How the COP counts in the weights of a plan: the mean of the points over the COP, so that a constant COP counts 1.
    pub(super) fn relative(&self, heats: bool, outdoor_c: f64) -> f64 {
        let points = self.points(heats);
        if points.is_empty() {
            return 1.0;
        }
        let mean = points.iter().map(|point| point.cop).sum::<f64>() / points.len() as f64;
        mean / self.cop(heats, outdoor_c)
    }

    fn points(&self, heats: bool) -> &[CopPoint] {
        if heats { &self.heating } else { &self.cooling }
    }
}
