//! Trajectory problems that planners posed in closed loop, kept as text: every number in its shortest exact form, rows of
//! numbers instead of named fields, so that hundreds of problems fit a small file.
#![allow(dead_code, reason = "each binary uses its own part")]

#[path = "minutes.rs"]
mod minutes;

use std::path::{Path, PathBuf};

use interplay_planners::Bicycle;
use interplay_planners::trajectory::{
    DistanceCost, DistancePrice, KeepOut, Leaning, MeanSpeed, Memory, Optimiser, Participant, Penalty, Problem, Robust,
    Separation, Tracking,
};
use interplay_planners::{Axes, Body, Corridor, Input, LaneEnd, Limits, SafetyEllipse, State, negotiation};
use serde::{Deserialize, Serialize};

use minutes::Minutes;

/// The planners whose problems are recorded.
pub const KINDS: [&str; 6] = ["human", "conservative", "negotiation", "bayesian", "game", "cooperative"];

/// What planners of a kind solve their problems with.
pub fn optimiser(kind: &str) -> Optimiser<Robust> {
    match kind {
        "negotiation" => negotiation::optimiser(&Default::default()),
        _ => Optimiser::resuming(Robust::default()),
    }
}

/// A problem, the guess its planner started from, and where it was met: `scenario/tick/vehicle`.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Recorded {
    /// `scenario/tick/vehicle`.
    pub id: String,
    /// Number of steps.
    pub horizon: usize,
    /// Time step \[s\].
    pub step_s: f64,
    /// The deciding vehicles.
    pub vehicles: Vec<Vehicle>,
    /// Pairs of deciding vehicles that keep apart.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub separations: Vec<Apart>,
    /// The persuasion constraint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaning: Option<Lean>,
    /// Per vehicle, `(a, δ)` at `t = 0…N−1`; shorter ones are filled up with zeros.
    pub guess: Vec<Vec<[f64; 2]>>,
    /// What the plan of the step before leaves to this one, if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<Minutes>,
}

/// One deciding vehicle.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Vehicle {
    /// Front, rear, width, front axle, rear axle \[m\].
    pub body: [f64; 5],
    /// Acceleration from, to; steering up to; speed from, to.
    pub limits: [f64; 5],
    /// Heading, right edge, left edge of the road.
    pub road: [f64; 3],
    /// End, height, taper of a lane that ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lane_end: Option<[f64; 3]>,
    /// State at `t = 0`.
    pub start: [f64; 4],
    /// Input before `t = 0`.
    pub previous_input: [f64; 2],
    /// Inputs that are not decided.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub known_inputs: Vec<[f64; 2]>,
    /// Diagonal of `Q`.
    pub weights: [f64; 4],
    /// Desired states at `t = 1…N`; a single one holds throughout.
    pub targets: Vec<[f64; 4]>,
    /// Diagonal of `R`.
    pub comfort: [f64; 2],
    /// Whom it avoids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub keep_outs: Vec<Ellipse>,
    /// What distances cost it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub distance_costs: Vec<Distance>,
    /// Bounds on its mean speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_speed: Option<Mean>,
}

/// The cost of distances from a moving centre.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Distance {
    /// Centres at `t = 1…N`.
    pub centres: Vec<[f64; 2]>,
    /// `M`: xx, xy, yy.
    pub metric: [f64; 3],
    /// What a distance costs.
    pub price: Price,
}

/// `φ(ω)`.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Price {
    /// Weight.
    Linear(f64),
    /// Base, loyalty, aversion.
    Exact([f64; 3]),
}

/// Bounds on a mean speed.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Mean {
    /// Lower and upper bound.
    pub bounds: [Option<f64>; 2],
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

/// A moving ellipse.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Ellipse {
    /// Centres at `t = 1…N`.
    pub centres: Vec<[f64; 2]>,
    /// Direction of the long axis, half axes along and across.
    pub shape: [f64; 3],
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

/// Two vehicles that keep apart.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Apart {
    /// Who keeps out, from whom.
    pub pair: [usize; 2],
    /// Direction of the long axis, half axes along and across.
    pub shape: [f64; 3],
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

/// The persuasion constraint.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Lean {
    /// Reference to lean towards at `t = 0…N−1`.
    pub toward: Vec<[f64; 2]>,
    /// Reference to lean away from at `t = 0…N−1`.
    pub away: Vec<[f64; 2]>,
    /// `α`.
    pub strength: f64,
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

impl Recorded {
    /// The record of a problem with the guess that was used and the memory of the step before.
    pub fn new(id: String, problem: &Problem, guess: &[Vec<Input>], memory: &Memory) -> Self {
        Recorded {
            id,
            horizon: problem.horizon,
            step_s: problem.participants[0].model.step_s(),
            vehicles: problem.participants.iter().map(Vehicle::new).collect(),
            separations: problem.separations.iter().map(Apart::new).collect(),
            leaning: problem.leaning.as_ref().map(Lean::new),
            guess: guess.iter().map(|inputs| inputs.iter().map(|input| input.to_array()).collect()).collect(),
            memory: Minutes::new(memory),
        }
    }

    /// The problem, equal to the recorded one in every bit.
    pub fn problem(&self) -> Problem {
        Problem {
            horizon: self.horizon,
            participants: self.vehicles.iter().map(|vehicle| vehicle.participant(self.horizon, self.step_s)).collect(),
            separations: self.separations.iter().map(Apart::separation).collect(),
            leaning: self.leaning.as_ref().map(Lean::leaning),
        }
    }

    /// The memory; empty if there is none.
    pub fn memory(&self) -> Memory {
        self.memory.as_ref().map(|minutes| minutes.memory(self.horizon)).unwrap_or_default()
    }

    /// The guess.
    pub fn guess(&self) -> Vec<Vec<Input>> {
        self.guess.iter().map(|inputs| inputs.iter().copied().map(Input::from_array).collect()).collect()
    }
}

impl Vehicle {
    fn new(of: &Participant) -> Self {
        let (body, limits) = (&of.body, &of.limits);
        assert_eq!(of.tracking.axes, Axes::WORLD, "problems on slanted roads are not recorded");
        let mut targets: Vec<[f64; 4]> = of.tracking.targets.iter().map(|state| state.to_array()).collect();
        if targets.windows(2).all(|pair| pair[0] == pair[1]) {
            targets.truncate(1);
        }
        Vehicle {
            body: [body.front_m, body.rear_m, body.width_m, body.front_axle_m, body.rear_axle_m],
            limits: [
                limits.acceleration_min_mps2,
                limits.acceleration_max_mps2,
                limits.steering_max_rad,
                limits.speed_min_mps,
                limits.speed_max_mps,
            ],
            road: [of.corridor.heading_rad, of.corridor.right_m, of.corridor.left_m],
            lane_end: of.corridor.end.map(|end| [end.end_m, end.height_m, end.taper_m]),
            start: of.start.to_array(),
            previous_input: of.previous_input.to_array(),
            known_inputs: of.known_inputs.iter().map(|input| input.to_array()).collect(),
            weights: of.tracking.weights,
            targets,
            comfort: of.comfort,
            keep_outs: of.keep_outs.iter().map(Ellipse::new).collect(),
            distance_costs: of.distance_costs.iter().map(Distance::new).collect(),
            mean_speed: of.mean_speed.as_ref().map(Mean::new),
        }
    }

    fn participant(&self, horizon: usize, step_s: f64) -> Participant {
        let [front_m, rear_m, width_m, front_axle_m, rear_axle_m] = self.body;
        let body = Body { front_m, rear_m, width_m, front_axle_m, rear_axle_m };
        let [acceleration_min_mps2, acceleration_max_mps2, steering_max_rad, speed_min_mps, speed_max_mps] =
            self.limits;
        let [heading_rad, right_m, left_m] = self.road;
        let end = self.lane_end.map(|[end_m, height_m, taper_m]| LaneEnd { end_m, height_m, taper_m });
        let target = |t: usize| State::from_array(self.targets[t.min(self.targets.len() - 1)]);
        Participant {
            model: Bicycle::new(&body, step_s),
            body,
            limits: Limits {
                acceleration_min_mps2,
                acceleration_max_mps2,
                steering_max_rad,
                speed_min_mps,
                speed_max_mps,
            },
            corridor: Corridor { heading_rad, right_m, left_m, end },
            start: State::from_array(self.start),
            previous_input: Input::from_array(self.previous_input),
            known_inputs: self.known_inputs.iter().copied().map(Input::from_array).collect(),
            tracking: Tracking {
                weights: self.weights,
                axes: Axes::WORLD,
                targets: (0..horizon).map(target).collect(),
            },
            comfort: self.comfort,
            keep_outs: self.keep_outs.iter().map(Ellipse::keep_out).collect(),
            distance_costs: self.distance_costs.iter().map(Distance::distance_cost).collect(),
            mean_speed: self.mean_speed.as_ref().map(Mean::mean_speed),
        }
    }
}

fn shape(heading_rad: f64, ellipse: SafetyEllipse) -> [f64; 3] {
    [heading_rad, ellipse.along_m, ellipse.across_m]
}

fn ellipse([_, along_m, across_m]: [f64; 3]) -> SafetyEllipse {
    SafetyEllipse { along_m, across_m }
}

fn penalty([linear, quadratic]: [f64; 2]) -> Penalty {
    Penalty { linear, quadratic }
}

impl Ellipse {
    fn new(of: &KeepOut) -> Self {
        let penalty = [of.penalty.linear, of.penalty.quadratic];
        Ellipse { centres: of.centres.clone(), shape: shape(of.heading_rad, of.ellipse), penalty }
    }

    fn keep_out(&self) -> KeepOut {
        KeepOut {
            centres: self.centres.clone(),
            heading_rad: self.shape[0],
            ellipse: ellipse(self.shape),
            penalty: penalty(self.penalty),
        }
    }
}

impl Distance {
    fn new(of: &DistanceCost) -> Self {
        let price = match of.price {
            DistancePrice::Linear { weight } => Price::Linear(weight),
            DistancePrice::Exact { base, loyalty, aversion } => Price::Exact([base, loyalty, aversion]),
        };
        Distance { centres: of.centres.clone(), metric: of.metric, price }
    }

    fn distance_cost(&self) -> DistanceCost {
        let price = match self.price {
            Price::Linear(weight) => DistancePrice::Linear { weight },
            Price::Exact([base, loyalty, aversion]) => DistancePrice::Exact { base, loyalty, aversion },
        };
        DistanceCost { centres: self.centres.clone(), metric: self.metric, price }
    }
}

impl Mean {
    fn new(of: &MeanSpeed) -> Self {
        Mean { bounds: [of.lower_mps, of.upper_mps], penalty: [of.penalty.linear, of.penalty.quadratic] }
    }

    fn mean_speed(&self) -> MeanSpeed {
        MeanSpeed { lower_mps: self.bounds[0], upper_mps: self.bounds[1], penalty: penalty(self.penalty) }
    }
}

impl Apart {
    fn new(of: &Separation) -> Self {
        let penalty = [of.penalty.linear, of.penalty.quadratic];
        Apart { pair: [of.of, of.from], shape: shape(of.heading_rad, of.ellipse), penalty }
    }

    fn separation(&self) -> Separation {
        Separation {
            of: self.pair[0],
            from: self.pair[1],
            heading_rad: self.shape[0],
            ellipse: ellipse(self.shape),
            penalty: penalty(self.penalty),
        }
    }
}

impl Lean {
    fn new(of: &Leaning) -> Self {
        Lean {
            toward: of.toward.clone(),
            away: of.away.clone(),
            strength: of.strength,
            penalty: [of.penalty.linear, of.penalty.quadratic],
        }
    }

    fn leaning(&self) -> Leaning {
        Leaning {
            toward: self.toward.clone(),
            away: self.away.clone(),
            strength: self.strength,
            penalty: penalty(self.penalty),
        }
    }
}

/// Where the problems of a kind are kept.
pub fn path(kind: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(format!("{kind}.json"))
}

/// Reads the problems of a kind.
///
/// # Errors
/// The file cannot be read, or is not what [`save`] writes.
pub fn load(kind: &str) -> Result<Vec<Recorded>, Box<dyn std::error::Error>> {
    Ok(serde_json::from_str(&std::fs::read_to_string(path(kind))?)?)
}

/// Writes the problems of a kind as a JSON array, one problem a line.
///
/// # Errors
/// The file cannot be written.
pub fn save(kind: &str, problems: &[Recorded]) -> Result<(), Box<dyn std::error::Error>> {
    let lines: Result<Vec<String>, serde_json::Error> = problems.iter().map(serde_json::to_string).collect();
    std::fs::write(path(kind), format!("[\n{}\n]\n", lines?.join(",\n")))?;
    Ok(())
}
