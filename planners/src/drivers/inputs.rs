//! A driver whose inputs were handed in from outside once, by a person at the wheel or by another program, and are repeated.
//!
//! It is the external driver with a record. Whoever runs the simulation hands in its rows as they were handed in then; so a run with it is
//! the run in which they were recorded, bit for bit. Where the wheel was handed over to a planner, that planner drives again.

pub use crate::scene::input_record::{InputRecord as Settings, WheelHandOver};

use crate::drivers::drive::{Drive, DriverKind};
use crate::drivers::external::External;
use crate::prediction::Prediction;
use crate::scene::input_record::{InputRecord, WHEEL_KINDS};
use crate::{DriverSettingError, PlanTime};

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
            let reason = format!("row {} of `inputs` is no plan with an input", wrong + 1);
            return refused("inputs", reason, "state rows of plan, acceleration and steering angle");
        }
        if let Some(at) = self.inputs.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
            let reason = format!("row {} of `inputs` is not later than the one before it", at + 2);
            return refused("inputs", reason, "state each row once, the earliest first");
        }
        let is_unknown = |to: &&str| !WHEEL_KINDS.contains(to);
        match self.hand_overs.iter().filter_map(|handed| handed.to.as_deref()).find(is_unknown) {
            Some(to) => {
                let reason = format!("`{to}` is no driver that takes the wheel");
                refused("hand_overs", reason, &format!("choose from {}", WHEEL_KINDS.join(", ")))
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
    fn whoever_may_take_the_wheel_is_a_driver() {
        for kind in WHEEL_KINDS {
            assert_eq!(crate::Driver::of_kind(kind).map(|driver| driver.kind()), Some(kind));
        }
        assert!(
            ["external", "inputs", "recorded", "walker", "nobody"]
                .iter()
                .all(|kind| crate::Driver::of_kind(kind).is_none())
        );
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
