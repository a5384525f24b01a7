//! Digests of a run, exact in every bit, for each phase.
//!
//! Every tick depends on the one before, so if two runs differ anywhere, nearly all digests of the whole runs differ:
//! they show that the runs differ, but not where the difference began. Digests of single ticks ([`Digest::of_tick`])
//! show this: in the first tick that differs, the first phase that differs is the cause.

use interplay_planners::scene::IndicatorSide;
use interplay_planners::{Input, State, Trajectory};
use serde::Serialize;
use xxhash_rust::xxh3::Xxh3;

use crate::state::frame::Frame;

/// Running digests of the results of each phase.
#[derive(Clone, Default)]
pub struct Digest {
    sense: Xxh3,
    predict: Xxh3,
    plan: Xxh3,
    act: Xxh3,
    physics: Xxh3,
}

/// The digests in hexadecimal, in the order of the phases.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PhaseDigests {
    /// Digest of all states at the beginnings of ticks.
    pub sense: String,
    /// Digest of all predictions, except those that are plans of the same tick.
    pub predict: String,
    /// Digest of all plans.
    pub plan: String,
    /// Digest of all applied inputs.
    pub act: String,
    /// Digest of all states, at the beginnings and the ends of ticks: the digest of the run.
    pub physics: String,
}

impl PhaseDigests {
    /// Every phase by name, in order.
    pub fn by_name(&self) -> [(&'static str, &str); 5] {
        let PhaseDigests { sense, predict, plan, act, physics } = self;
        [("sense", sense), ("predict", predict), ("plan", plan), ("act", act), ("physics", physics)]
    }
}

impl std::fmt::Debug for Digest {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.phases().fmt(formatter)
    }
}

impl Digest {
    /// The digests of a single tick and of the states at its end.
    pub fn of_tick(frame: &Frame, after: &[State]) -> PhaseDigests {
        let mut digest = Digest::default();
        digest.observe(frame, after);
        digest.phases()
    }

    /// Adds one tick, and the states at its end, to the digests.
    pub fn observe(&mut self, frame: &Frame, after: &[State]) {
        for vehicle in &frame.vehicles {
            numbers(&mut self.sense, &vehicle.state.to_array());
            if let Some(side) = vehicle.indicator {
                self.sense.update(&[u8::from(side == IndicatorSide::Left)]);
            }
            // The prediction of a vehicle that plans first is its plan, so an error in it comes from the phase Plan.
            if *vehicle.prediction != vehicle.plan.trajectory {
                trajectory(&mut self.predict, &vehicle.prediction);
            }
            trajectory(&mut self.plan, &vehicle.plan.trajectory);
            numbers(&mut self.act, &vehicle.input.to_array());
        }
        self.observe_states(frame, after);
    }

    /// Adds the states at the beginning and the end of one tick to the digest of the run alone.
    pub fn observe_states(&mut self, frame: &Frame, after: &[State]) {
        for (vehicle, state) in frame.vehicles.iter().zip(after) {
            numbers(&mut self.physics, [vehicle.state.to_array(), state.to_array()].as_flattened());
        }
    }

    /// The digests so far.
    pub fn phases(&self) -> PhaseDigests {
        let hex = |hasher: &Xxh3| format!("{:032x}", hasher.digest128());
        PhaseDigests {
            sense: hex(&self.sense),
            predict: hex(&self.predict),
            plan: hex(&self.plan),
            act: hex(&self.act),
            physics: hex(&self.physics),
        }
    }
}

fn trajectory(hasher: &mut Xxh3, trajectory: &Trajectory) {
    trajectory
        .states
        .chunks(CHUNK / 4)
        .for_each(|states| rows(hasher, states.iter().map(|state: &State| state.to_array())));
    trajectory
        .inputs
        .chunks(CHUNK / 2)
        .for_each(|inputs| rows(hasher, inputs.iter().map(|input: &Input| input.to_array())));
}

/// How many numbers are hashed at once: the stream is the same for any, and updates are expensive.
const CHUNK: usize = 64;

/// Adds at most [`CHUNK`] numbers, row by row.
fn rows<const N: usize>(hasher: &mut Xxh3, rows: impl Iterator<Item = [f64; N]>) {
    let (mut values, mut count) = ([0.0; CHUNK], 0);
    for row in rows {
        values[count..count + N].copy_from_slice(&row);
        count += N;
    }
    numbers(hasher, &values[..count]);
}

/// Adds at most [`CHUNK`] numbers.
fn numbers(hasher: &mut Xxh3, values: &[f64]) {
    let mut bytes = [0; 8 * CHUNK];
    for (to, value) in bytes.chunks_exact_mut(8).zip(values) {
        to.copy_from_slice(&value.to_bits().to_le_bytes());
    }
    hasher.update(&bytes[..8 * values.len()]);
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use interplay_planners::Plan;

    use super::*;
    use crate::state::frame::VehicleFrame;

    /// A tick, and the states at its end.
    #[derive(Clone)]
    struct Recorded {
        frame: Frame,
        after: Vec<State>,
    }

    /// A tick of one vehicle that plans with a prediction.
    fn tick(speed_mps: f64) -> Recorded {
        let state = State { speed_mps, ..State::default() };
        let trajectory = |speed_mps| Trajectory { states: vec![State { speed_mps, ..state }; 3], inputs: Vec::new() };
        let plan = Plan { trajectory: trajectory(2.0), ..Plan::default() }.into();
        let vehicle = VehicleFrame { state, plan, prediction: trajectory(1.0).into(), ..VehicleFrame::default() };
        let frame = Frame { vehicles: vec![vehicle], ..Frame::default() };
        Recorded { frame, after: vec![State { speed_mps: 3.0, ..state }] }
    }

    fn differing(a: &Recorded, b: &Recorded) -> Vec<&'static str> {
        let digests = [a, b].map(|Recorded { frame, after }| Digest::of_tick(frame, after));
        let pairs = digests[0].by_name().into_iter().zip(digests[1].by_name());
        pairs.filter(|((_, a), (_, b))| a != b).map(|((name, _), _)| name).collect()
    }

    #[test]
    fn the_digests_of_a_tick_identify_the_phase_that_differs() {
        let one = tick(1.0);
        assert!(differing(&one, &tick(1.0)).is_empty());
        assert_eq!(differing(&one, &tick(1.5)), ["sense", "physics"]);
        let mut other = one.clone();
        Arc::make_mut(&mut other.frame.vehicles[0].prediction).states[1].x_m = 1.0;
        assert_eq!(differing(&one, &other), ["predict"]);
        let mut other = one.clone();
        other.frame.vehicles[0].input.steering_rad = -0.0;
        assert_eq!(differing(&one, &other), ["act"], "bit for bit: even a zero's sign");
        let mut other = one.clone();
        other.after[0].y_m = 1.0;
        assert_eq!(differing(&one, &other), ["physics"]);
    }

    /// The prediction of a vehicle that plans first is its plan, so another plan does not change the digest of Predict.
    #[test]
    fn a_prediction_equal_to_the_plan_belongs_to_the_plan_digest() {
        let told = |x_m: f64| {
            let mut recorded = tick(1.0);
            let vehicle = &mut recorded.frame.vehicles[0];
            Arc::make_mut(&mut vehicle.plan).trajectory.states[1].x_m = x_m;
            vehicle.prediction = vehicle.plan.trajectory.clone().into();
            recorded
        };
        assert_eq!(differing(&told(1.0), &told(2.0)), ["plan"]);
    }
}
