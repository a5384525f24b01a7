//! A driver whose inputs were handed in from outside once, by a person at the wheel or by another program, and are repeated.
//!
//! It is the external driver with a record. The caller of the simulation hands in its rows as they were handed in then; so a run with it is
//! the run in which they were recorded, bit for bit. Where the wheel was handed over to a planner, that planner drives again.

pub use crate::scene::input_record::{InputRecord as Settings, WheelHandOver};

use crate::drivers::drive::{Drive, DriverKind};
use crate::drivers::external::External;
use crate::prediction::Prediction;
use crate::scene::input_record::InputRecord;
use crate::{Driver, DriverSettingError, PlanTime};

impl DriverKind for InputRecord {
    fn kind(&self) -> &'static str {
        "inputs"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(External)
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime::SIMPLE
    }

    fn prediction(&self) -> Option<Prediction> {
        None
    }

    fn inputs(&self) -> Option<&InputRecord> {
        Some(self)
    }

    fn check(&self, _: usize) -> Result<(), DriverSettingError> {
        let refused = |key, reason: String, remedy: &str| {
            Err(DriverSettingError::Unfit { key, reason, remedy: remedy.to_owned() })
        };
        let is_row = |row: &[f64; 3]| row.iter().all(|number| number.is_finite()) && row[0] >= 0.0;
        if let Some(wrong) = self.inputs.iter().position(|row| !is_row(row)) {
            let reason = format!("row {} of `inputs` is not a plan with an input", wrong + 1);
            return refused("inputs", reason, "state rows of plan, acceleration and steering angle");
        }
        if let Some(at) = self.inputs.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
            let reason = format!("row {} of `inputs` is not later than the one before it", at + 2);
            return refused("inputs", reason, "state each row once, the earliest first");
        }
        let is_unknown = |to: &&str| Driver::at_wheel(to).is_none();
        match self.hand_overs.iter().filter_map(|handed| handed.to.as_deref()).find(is_unknown) {
            Some(to) => {
                let reason = format!("`{to}` is not a driver that can take over");
                refused("hand_overs", reason, &format!("choose from {}", Driver::wheel_kinds()))
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
    fn only_kinds_that_drive_may_take_over() {
        let planners = "human, idm, conservative, negotiation, bayesian, game, cooperative, nash, contingency";
        assert_eq!(Driver::wheel_kinds(), planners);
        for kind in planners.split(", ") {
            assert_eq!(Driver::at_wheel(kind).map(|driver| driver.kind()), Some(kind));
        }
        let others = ["external", "inputs", "recorded", "walker", "no-such-kind"];
        assert!(others.iter().all(|kind| Driver::at_wheel(kind).is_none()));
    }

    #[test]
    fn what_could_not_be_repeated_is_refused() {
        let handed = |to: &str| vec![WheelHandOver { plan: 3, to: Some(to.to_owned()) }];
        let checked = |inputs: Vec<[f64; 3]>, hand_overs| Settings { inputs, hand_overs }.check(30).is_ok();
        assert!(checked(vec![[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]], handed("idm")));
        assert!(!checked(vec![[1.0, 1.0, 0.0], [1.0, 0.0, 0.0]], Vec::new()));
        assert!(!checked(vec![[0.0, f64::NAN, 0.0]], Vec::new()));
        assert!(!checked(Vec::new(), handed("no-such-kind")));
    }
}
