//! A digest of a run, by phase, bit for bit: if two runs differ, the first phase that differs is the culprit.

use interplay_planners::{Input, State, Trajectory};
use serde::Serialize;
use xxhash_rust::xxh3::Xxh3;

use crate::frame::Frame;

/// Running digests of what each phase produced.
#[derive(Clone, Default)]
pub struct Digest {
    predict: Xxh3,
    plan: Xxh3,
    act: Xxh3,
    physics: Xxh3,
}

/// The digests in hexadecimal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PhaseDigests {
    /// Of all predictions.
    pub predict: String,
    /// Of all plans.
    pub plan: String,
    /// Of all applied inputs.
    pub act: String,
    /// Of all states: the digest of the run.
    pub physics: String,
}

impl std::fmt::Debug for Digest {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.phases().fmt(formatter)
    }
}

impl Digest {
    /// Takes one tick and the states that it led to.
    pub fn observe(&mut self, frame: &Frame, after: &[State]) {
        for (vehicle, state) in frame.vehicles.iter().zip(after) {
            trajectory(&mut self.predict, &vehicle.prediction);
            trajectory(&mut self.plan, &vehicle.plan.trajectory);
            numbers(&mut self.act, &vehicle.input.to_array());
            numbers(&mut self.physics, &vehicle.state.to_array());
            numbers(&mut self.physics, &state.to_array());
        }
    }

    /// The digests so far.
    pub fn phases(&self) -> PhaseDigests {
        let hex = |hasher: &Xxh3| format!("{:032x}", hasher.digest128());
        PhaseDigests {
            predict: hex(&self.predict),
            plan: hex(&self.plan),
            act: hex(&self.act),
            physics: hex(&self.physics),
        }
    }
}

fn trajectory(hasher: &mut Xxh3, trajectory: &Trajectory) {
    trajectory.states.iter().map(|state: &State| state.to_array()).for_each(|state| numbers(hasher, &state));
    trajectory.inputs.iter().map(|input: &Input| input.to_array()).for_each(|input| numbers(hasher, &input));
}

fn numbers(hasher: &mut Xxh3, values: &[f64]) {
    for value in values {
        hasher.update(&value.to_bits().to_le_bytes());
    }
}
