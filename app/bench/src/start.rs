//! A start with what every planner is compared with on it.

use interplay_scenarios::{Encounter, LoadError, Override, Registry, Scenario};

use crate::error::BenchError;
use crate::formula::{EGO, MOST_LOST_S};
use crate::planner::{PlannerSpec, Wheel};
use crate::score::{StartScore, caused};
use crate::trace::{EgoTrace, Trace, trace};

/// The reference driver reaches every goal alone within this time \[s\].
const ALONE_S: f64 = 60.0;
/// The others are known for this time beyond the limit of the ego, so that delays at its end can be told \[s\].
const MARGIN_S: f64 = 6.0;

/// A start with the run without the ego and the time that the reference driver needs alone.
#[derive(Debug)]
pub struct Start {
    id: String,
    alone_s: f64,
    without: Trace,
}

/// What a planner did on a start.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub score: StartScore,
    pub ego: EgoTrace,
    pub delay_s: f64,
    pub braking_mps: f64,
    pub digest: String,
    pub wheel: Option<Wheel>,
}

impl Start {
    /// Makes the two reference runs of a start. The reference driver is the ego's own, a human of normal style.
    ///
    /// # Errors
    /// If one of the runs fails.
    pub fn new(registry: &Registry, encounter: Encounter) -> Result<Start, BenchError> {
        let id = encounter.to_string();
        let scenario = loaded(registry, &id, &[])?;
        let unfinished = |reason| BenchError::Run { id: id.clone(), reason: Box::new(reason) };
        let mut alone = scenario.clone();
        alone.vehicles.retain(|vehicle| vehicle.name == EGO || vehicle.obstacle.is_some());
        let driven = trace(&alone, ALONE_S, None).map_err(unfinished)?;
        let completed_s = driven.ego.and_then(|ego| ego.completed_s.filter(|_| ego.failure.is_none()));
        let alone_s = completed_s.ok_or_else(|| BenchError::NoReference { id: id.clone() })?;
        let mut others = scenario;
        others.vehicles.retain(|vehicle| vehicle.name != EGO);
        let without = trace(&others, alone_s + MOST_LOST_S + MARGIN_S, None).map_err(unfinished)?;
        Ok(Start { id, alone_s, without })
    }

    /// The id of the start.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// The time that the reference driver needs alone \[s\].
    pub fn alone_s(&self) -> f64 {
        self.alone_s
    }

    /// Lets a planner drive.
    pub(crate) fn drive(&self, registry: &Registry, planner: &PlannerSpec) -> Result<Outcome, BenchError> {
        let mut scenario = loaded(registry, &self.id, &planner.overrides())?;
        planner.record_into(&mut scenario);
        let mut wheel = planner.wheel(&scenario)?;
        let limit_s = self.alone_s + MOST_LOST_S;
        let driven = trace(&scenario, limit_s, wheel.as_mut());
        let with = driven.map_err(|reason| BenchError::Run { id: self.id.clone(), reason: Box::new(reason) })?;
        let mut ego = with.ego.clone().unwrap_or_default();
        let score = StartScore::of_run(&ego, &with, &self.without, self.alone_s);
        if ego.completed_s.is_none() && ego.failure.is_none() {
            ego.failure = Some("no goal in time".to_owned());
        }
        let [delay_s, braking_mps] = caused(&with, &self.without);
        Ok(Outcome { score, ego, delay_s, braking_mps, digest: with.digest, wheel })
    }
}

/// The scenario of a start, changed.
pub(crate) fn loaded(registry: &Registry, id: &str, overrides: &[Override]) -> Result<Scenario, BenchError> {
    registry.load(id, overrides).map_err(|error: LoadError| BenchError::Planner(Box::new(error)))
}
