//! A driver whose inputs were handed in from outside once, by a person at the wheel or by another program, and are repeated.
//!
//! It is the external driver with a record. Whoever runs the simulation hands in its rows as they were handed in then; so a run with it is
//! the run in which they were recorded, bit for bit. Where the wheel was handed over to a planner, that planner drives again.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::drive::{Drive, DriverKind};
use crate::external::External;
use crate::predict::Prediction;
use crate::{Driver, DriverSettingError, Input};

/// The settings of a driver that repeats inputs: what was handed in, and when.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Rows of the plan from which an input holds (0 is the first of the run), the acceleration \[m/s²\] and the steering angle \[rad\].
    /// Before the first row both are 0.
    #[schemars(length(max = 1_000_000), example = vec![[0.0, 0.5, 0.0], [12.0, -1.0, 0.1]])]
    pub inputs: Vec<[f64; 3]>,
    /// When the wheel was handed over to a planner, or taken back.
    #[schemars(example = json!([{ "plan": 30, "to": "negotiation" }, { "plan": 60 }]))]
    pub hand_overs: Vec<WheelHandOver>,
}

/// The wheel is handed over.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WheelHandOver {
    /// The plan from which the other drives, counted from 0.
    #[schemars(example = 30, extend("x-unit" = "dimensionless"))]
    pub plan: u32,
    /// The kind of driver that takes over, with the defaults of its settings; without it, the inputs take over again.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"negotiation")]
    pub to: Option<String>,
}

impl Settings {
    /// The input that holds at a plan.
    pub fn at(&self, plan: usize) -> Input {
        let row = self.inputs.iter().rev().find(|[from, ..]| *from <= plan as f64);
        row.map_or_else(Input::default, |[_, acceleration, steering]| Input::from_array([*acceleration, *steering]))
    }

    /// Who takes the wheel at a plan, if anybody does: a planner, or the inputs again.
    pub fn handed_over_at(&self, plan: usize) -> Option<Option<Driver>> {
        let handed = self.hand_overs.iter().rev().find(|handed| handed.plan as usize == plan)?;
        Some(handed.to.as_deref().and_then(Driver::of_kind))
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "inputs"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(External)
    }

    fn prediction(&self) -> Option<Prediction> {
        None
    }

    fn may_be_refused(&self) -> bool {
        false
    }

    fn is_driven_from_outside(&self) -> bool {
        true
    }

    fn inputs(&self) -> Option<&Settings> {
        Some(self)
    }

    fn check(&self, _: usize) -> Result<(), DriverSettingError> {
        let refused = |key, reason: String, remedy: &str| {
            Err(DriverSettingError::Unfit { key, reason, remedy: remedy.to_owned() })
        };
        let is_row = |row: &[f64; 3]| row.iter().all(|number| number.is_finite()) && row[0] >= 0.0;
        if let Some(wrong) = self.inputs.iter().position(|row| !is_row(row)) {
            let reason = format!("row {} of `inputs` is no plan with an input", wrong + 1);
            return refused("inputs", reason, "state rows of plan, acceleration and steering angle");
        }
        if let Some(at) = self.inputs.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
            let reason = format!("row {} of `inputs` is not later than the one before it", at + 2);
            return refused("inputs", reason, "state each row once, the earliest first");
        }
        let unknown = |handed: &&WheelHandOver| handed.to.as_deref().is_some_and(|to| Driver::of_kind(to).is_none());
        match self.hand_overs.iter().find(unknown) {
            Some(handed) => {
                let reason = format!("`{}` is no kind of driver", handed.to.as_deref().unwrap_or_default());
                refused("hand_overs", reason, "choose from human, idm, conservative, negotiation, bayesian, game, nash")
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_holds_until_the_next() {
        let settings = Settings { inputs: vec![[2.0, 1.0, 0.1], [5.0, -1.0, 0.0]], hand_overs: Vec::new() };
        let accelerations: Vec<f64> = (0..7).map(|plan| settings.at(plan).acceleration_mps2).collect();
        assert_eq!(accelerations, [0.0, 0.0, 1.0, 1.0, 1.0, -1.0, -1.0]);
    }

    #[test]
    fn what_could_not_be_repeated_is_refused() {
        let handed = |to: &str| vec![WheelHandOver { plan: 3, to: Some(to.to_owned()) }];
        let checked = |inputs: Vec<[f64; 3]>, hand_overs| Settings { inputs, hand_overs }.check(30).is_ok();
        assert!(checked(vec![[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]], handed("idm")));
        assert!(!checked(vec![[1.0, 1.0, 0.0], [1.0, 0.0, 0.0]], Vec::new()));
        assert!(!checked(vec![[0.0, f64::NAN, 0.0]], Vec::new()));
        assert!(!checked(Vec::new(), handed("nobody")));
    }
}
