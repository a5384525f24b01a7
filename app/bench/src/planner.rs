//! What drives the ego: a kind of driver, another program, or inputs that were recorded.

use std::time::Instant;

use interplay_planners::drivers::inputs;
use interplay_planners::prediction::steady_inputs;
use interplay_planners::{Driver, Input};
use interplay_scenarios::{Override, Scenario};
use interplay_simulation::Simulation;
use interplay_simulation::run::RunError;
use serde::{Deserialize, Serialize};

use crate::error::BenchError;
use crate::formula::EGO;
use crate::observation::Observer;
use crate::pipe::Pipe;

/// An input that holds from a plan on: the plan, counted from 0, the acceleration \[µm/s²\] and the steering angle \[nrad\]. Whole numbers
/// are read from a file exactly as they were written.
pub type InputRow = [i64; 3];

/// Parts of 1 m/s² and of 1 rad in which inputs from outside are applied.
const PARTS: [f64; 2] = [1e6, 1e9];

/// What drives the ego.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlannerSpec {
    /// A kind of driver of this program: its word, and settings such as `headway_s=1.2`.
    Kind {
        /// The word of the kind.
        kind: String,
        /// Settings that differ from the defaults.
        #[serde(default)]
        settings: Vec<String>,
    },
    /// Another program, which answers each line with a line.
    Command {
        /// The command line, for a shell.
        command: String,
    },
    /// Inputs that were recorded.
    #[serde(skip)]
    Inputs(Vec<InputRow>),
}

impl PlannerSpec {
    /// The changes of a scenario that let this planner drive its ego.
    pub(crate) fn overrides(&self) -> Vec<Override> {
        match self {
            PlannerSpec::Kind { kind, settings } => {
                let set = |setting: &String| Override::Set(format!("vehicle.{EGO}.driver.{setting}"));
                [Override::Planner(kind.clone())].into_iter().chain(settings.iter().map(set)).collect()
            }
            PlannerSpec::Command { .. } | PlannerSpec::Inputs(_) => {
                vec![Override::Set(format!("vehicle.{EGO}.driver={{ kind = 'external' }}"))]
            }
        }
    }

    /// Writes recorded inputs into a scenario.
    pub(crate) fn record_into(&self, scenario: &mut Scenario) {
        let PlannerSpec::Inputs(rows) = self else { return };
        let row = |[plan, acceleration, steering]: &InputRow| {
            let Input { acceleration_mps2, steering_rad } = whole([*acceleration, *steering]);
            [*plan as f64, acceleration_mps2, steering_rad]
        };
        let record = inputs::Settings { inputs: rows.iter().map(row).collect(), hand_overs: Vec::new() };
        if let Some(index) = scenario.index_of(EGO) {
            scenario.vehicles[index].driver = Driver::Inputs(record);
        }
    }

    /// What hands in inputs during a run; `None` for kinds and records.
    pub(crate) fn wheel(&self, scenario: &Scenario) -> Result<Option<Wheel>, BenchError> {
        let PlannerSpec::Command { command } = self else { return Ok(None) };
        let (pipe, observer) = (Pipe::start(command)?, Observer::new(scenario));
        Ok(Some(Wheel { pipe, observer, record: Vec::new(), failures: Vec::new(), planning_s: 0.0 }))
    }
}

/// Another program at the wheel.
#[derive(Debug)]
pub(crate) struct Wheel {
    pipe: Pipe,
    observer: Observer,
    record: Vec<InputRow>,
    failures: Vec<String>,
    planning_s: f64,
}

impl Wheel {
    /// Remembers the present states for the history of observations.
    pub fn watch(&mut self, world: &Simulation) {
        self.observer.watch(world);
    }

    /// The input for a plan: that of the program, or of last-resort braking if it has none.
    ///
    /// # Errors
    /// If the world has no ego.
    pub fn input(&mut self, world: &Simulation, plan: usize) -> Result<Input, RunError> {
        let observation = self.observer.observation(world);
        let began = Instant::now();
        let answer = self.pipe.ask(&observation);
        self.planning_s += began.elapsed().as_secs_f64();
        let wanted = match answer {
            Ok(input) => input,
            Err(reason) => {
                self.failures.push(format!("plan {plan}: {reason}"));
                last_resort(world)?
            }
        };
        let parts =
            [wanted.acceleration_mps2 * PARTS[0], wanted.steering_rad * PARTS[1]].map(|part| part.round() as i64);
        if self.record.last().is_none_or(|[_, acceleration, steering]| [*acceleration, *steering] != parts) {
            self.record.push([plan as i64, parts[0], parts[1]]);
        }
        Ok(whole(parts))
    }

    /// Wall time of the answers \[s\].
    pub fn planning_s(&self) -> f64 {
        self.planning_s
    }

    /// The inputs that were applied, and what went wrong.
    pub fn into_record(self) -> (Vec<InputRow>, Vec<String>) {
        (self.record, self.failures)
    }
}

fn whole([acceleration, steering]: [i64; 2]) -> Input {
    Input { acceleration_mps2: acceleration as f64 / PARTS[0], steering_rad: steering as f64 / PARTS[1] }
}

/// The strongest braking along the route.
fn last_resort(world: &Simulation) -> Result<Input, RunError> {
    let scene = world.observe(EGO)?.scene;
    let braking_mps2 = scene.ego.limits.acceleration_min_mps2;
    Ok(steady_inputs(&scene, braking_mps2).first().copied().unwrap_or_default())
}
