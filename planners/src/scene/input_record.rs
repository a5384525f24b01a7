//! Inputs that were handed in from outside, and when a planner had the wheel instead.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::Input;

/// The settings of a driver that repeats inputs: what was handed in, and when.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct InputRecord {
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

impl InputRecord {
    /// The input that holds at a plan.
    pub fn at(&self, plan: usize) -> Input {
        let row = self.inputs.iter().rev().find(|[from, ..]| *from <= plan as f64);
        row.map_or_else(Input::default, |[_, acceleration, steering]| Input::from_array([*acceleration, *steering]))
    }

    /// The driver that takes over at a plan, if any: the kind of a planner, or the inputs again.
    pub fn handed_over_at(&self, plan: usize) -> Option<Option<&str>> {
        let handed = self.hand_overs.iter().rev().find(|handed| handed.plan as usize == plan)?;
        Some(handed.to.as_deref())
    }
}
