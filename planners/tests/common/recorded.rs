//! Trajectory problems that planners posed in closed loop, kept as text: every number in its shortest exact form, rows of
//! numbers instead of named fields, so that hundreds of problems fit a small file.
#![allow(dead_code, reason = "each binary uses its own part")]

#[path = "recorded_curve.rs"]
mod recorded_curve;
#[path = "recorded_rows.rs"]
mod recorded_rows;
#[path = "warm_start_record.rs"]
mod warm_start_record;

use std::path::{Path, PathBuf};

use interplay_planners::drivers::negotiation;
use interplay_planners::trajectory::terms::{Comfort, RoadEdge, SpeedMeasure, Tracking};
use interplay_planners::trajectory::{Optimiser, Participant, Penalty, Problem, Robust, RouteStart, Term, WarmStart};
use interplay_planners::{Axes, Bicycle, Body, Corridor, Input, LaneEnd, Limits, State};
use serde::{Deserialize, Serialize};

use recorded_curve::{Curve, RoadGoal, curve_alone};
use recorded_rows::{Apart, Distance, Ellipse, Line, Mean, PersuasionRow};
use warm_start_record::WarmStartRecord;

/// The planners whose problems are recorded.
pub const KINDS: [&str; 6] = ["human", "conservative", "negotiation", "bayesian", "game", "cooperative"];

/// The planners whose problems on curved roads are recorded; each file is named after one, behind [`CURVED`].
pub const CURVED_KINDS: [&str; 3] = ["human", "conservative", "negotiation"];

/// What the names of the files of problems on curved roads begin with.
pub const CURVED: &str = "curved-";

/// What planners of a kind solve their problems with.
pub fn optimiser(kind: &str) -> Optimiser<Robust> {
    match kind.strip_prefix(CURVED).unwrap_or(kind) {
        "negotiation" => negotiation::optimiser(&Default::default()),
        _ => Optimiser::receding_horizon(Robust::default()),
    }
}

/// A problem, the guess its planner started from, and where it was met: `scenario/tick/vehicle`.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Recorded {
    /// `scenario/tick/vehicle`.
    pub id: String,
    pub horizon: usize,
    /// Time step \[s\].
    pub step_s: f64,
    pub vehicles: Vec<Vehicle>,
    /// Pairs of deciding vehicles that keep apart.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub separations: Vec<Apart>,
    /// The persuasion constraint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub persuasion: Option<PersuasionRow>,
    /// Per vehicle, `(a, δ)` at `t = 0…N−1`; shorter ones are filled up with zeros.
    pub guess: Vec<Vec<[f64; 2]>>,
    /// What the plan of the step before leaves to this one, if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<WarmStartRecord>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct Vehicle {
    /// Front, rear, width, front axle, rear axle \[m\].
    pub body: [f64; 5],
    /// Acceleration from, to; steering up to; speed from, to.
    pub limits: [f64; 5],
    /// Heading, right edge, left edge of the road; zeros beside `curve`.
    pub road: [f64; 3],
    /// A curved road.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Curve>,
    /// What the vehicle wants on a curved road; without it, it tracks the targets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub road_goal: Option<RoadGoal>,
    /// Lines that its front stays before.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stop_lines: Vec<Line>,
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
    /// Heading of the axes in which `Q` is diagonal, if they are not those of the world \[rad\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights_heading: Option<f64>,
    /// Desired states at `t = 1…N`; a single one holds throughout. None beside `road_goal`.
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

impl Recorded {
    /// The record of a problem with the guess that was used and the memory of the step before.
    pub fn new(id: String, problem: &Problem, guess: &[Vec<Input>], memory: &WarmStart) -> Self {
        Recorded {
            id,
            horizon: problem.horizon,
            step_s: problem.participants[0].model.step_s(),
            vehicles: (0..problem.participants.len()).map(|vehicle| Vehicle::new(problem, vehicle)).collect(),
            separations: find(problem, Apart::from_term),
            persuasion: find(problem, PersuasionRow::from_term).pop(),
            guess: guess.iter().map(|inputs| inputs.iter().map(|input| input.to_array()).collect()).collect(),
            memory: WarmStartRecord::new(memory),
        }
    }

    /// The problem, equal to the recorded one in every bit. Of curved roads it holds the centre line and the edges, and not the
    /// lanes that they are made of.
    pub fn problem(&self) -> Problem {
        let own = self.vehicles.iter().enumerate().flat_map(|(index, vehicle)| vehicle.terms(index, self.horizon));
        let pairs = self.separations.iter().map(|pair| Term::Separation(pair.separation(self.horizon)));
        let persuasion = self.persuasion.iter().map(|row| Term::Persuasion(row.persuasion()));
        Problem {
            horizon: self.horizon,
            shared_steps: 0,
            participants: self.vehicles.iter().map(|vehicle| vehicle.participant(self.step_s)).collect(),
            terms: own.chain(pairs).chain(persuasion).collect(),
        }
    }

    /// The memory; empty if there is none.
    pub fn memory(&self) -> WarmStart {
        self.memory.as_ref().map(|record| record.warm_start(self.horizon)).unwrap_or_default()
    }

    pub fn guess(&self) -> Vec<Vec<Input>> {
        self.guess.iter().map(|inputs| inputs.iter().copied().map(Input::from_array).collect()).collect()
    }
}

/// A problem with what [`Recorded::problem`] keeps of its roads.
pub fn without_lanes(mut problem: Problem) -> Problem {
    for participant in &mut problem.participants {
        if let Some(start) = &mut participant.route_start {
            start.route = curve_alone(&start.route);
        }
    }
    for term in &mut problem.terms {
        match term {
            Term::RoadEdge(of) => of.route = curve_alone(&of.route),
            Term::StopLine(of) => of.route = curve_alone(&of.route),
            _ => {}
        }
    }
    problem
}

/// What of the terms of a problem is to be kept.
fn find<T>(problem: &Problem, keep: impl Fn(&Term) -> Option<T>) -> Vec<T> {
    problem.terms.iter().filter_map(keep).collect()
}

impl Vehicle {
    /// The record of one vehicle with its own terms.
    fn new(problem: &Problem, vehicle: usize) -> Self {
        let of = &problem.participants[vehicle];
        let mut record = Vehicle {
            limits: [
                of.limits.acceleration_min_mps2,
                of.limits.acceleration_max_mps2,
                of.limits.steering_max_rad,
                of.limits.speed_min_mps,
                of.limits.speed_max_mps,
            ],
            start: of.start.to_array(),
            previous_input: of.previous_input.to_array(),
            known_inputs: of.known_inputs.iter().map(|input| input.to_array()).collect(),
            ..Vehicle::default()
        };
        problem.terms.iter().for_each(|term| record.note(term, vehicle));
        record
    }

    /// Notes a term if it is the vehicle's own.
    fn note(&mut self, term: &Term, vehicle: usize) {
        match term {
            Term::Comfort(of) if of.vehicle == vehicle => self.comfort = of.weights,
            Term::Tracking(of) if of.vehicle == vehicle => {
                self.weights = of.weights;
                self.weights_heading = axes_heading_rad(of);
                self.targets = of.targets.iter().map(|state| state.to_array()).collect();
                if self.targets.windows(2).all(|pair| pair[0] == pair[1]) {
                    self.targets.truncate(1);
                }
            }
            Term::FrenetTracking(of) if of.vehicle == vehicle => {
                self.weights = of.weights;
                self.road_goal = Some(RoadGoal::new(of));
            }
            Term::RoadEdge(of) if of.vehicle == vehicle => {
                let body = &of.body;
                self.body = [body.front_m, body.rear_m, body.width_m, body.front_axle_m, body.rear_axle_m];
                match of.route.straight() {
                    Some(road) => {
                        self.road = [road.heading_rad, road.right_m, road.left_m];
                        self.lane_end = road.end.map(|end| [end.end_m, end.height_m, end.taper_m]);
                    }
                    None => self.curve = Some(Curve::new(of)),
                }
            }
            Term::StopLine(of) if of.vehicle == vehicle => {
                self.stop_lines
                    .push(Line { line_m: of.lines_m.first().copied().unwrap_or_default(), penalty: of.penalty.into() });
            }
            Term::KeepOut(of) if of.vehicle == vehicle => self.keep_outs.push(Ellipse::new(of)),
            Term::DistanceCost(of) if of.vehicle == vehicle => self.distance_costs.push(Distance::new(of)),
            Term::MeanSpeed(of) if of.vehicle == vehicle => {
                assert_eq!(of.measure, SpeedMeasure::Speeds, "recorded problems bound the mean of speeds");
                let penalty = [of.penalty.linear, of.penalty.quadratic];
                let mean = self.mean_speed.get_or_insert(Mean { bounds: [None; 2], penalty });
                mean.bounds[usize::from(of.is_upper)] = Some(of.speed_mps);
            }
            _ => {}
        }
    }

    fn body(&self) -> Body {
        let [front_m, rear_m, width_m, front_axle_m, rear_axle_m] = self.body;
        Body { front_m, rear_m, width_m, front_axle_m, rear_axle_m, ..Body::default() }
    }

    fn participant(&self, step_s: f64) -> Participant {
        let [acceleration_min_mps2, acceleration_max_mps2, steering_max_rad, speed_min_mps, speed_max_mps] =
            self.limits;
        let start = State::from_array(self.start);
        Participant {
            model: Bicycle::new(&self.body(), step_s),
            limits: Limits {
                acceleration_min_mps2,
                acceleration_max_mps2,
                steering_max_rad,
                speed_min_mps,
                speed_max_mps,
                lateral_acceleration_max_mps2: None,
                steering_rate_max_radps: None,
                comfort: None,
            },
            stage_bounds: Vec::new(),
            start,
            previous_input: Input::from_array(self.previous_input),
            known_inputs: self.known_inputs.iter().copied().map(Input::from_array).collect(),
            route_start: self.curve.as_ref().and_then(|curve| RouteStart::new(&curve.route(), &start)),
        }
    }

    /// Its own terms, in the order in which planners pose them.
    fn terms(&self, vehicle: usize, horizon: usize) -> Vec<Term> {
        let mut terms = vec![Term::Comfort(Comfort { vehicle, weights: self.comfort })];
        let mut stop_lines = Vec::new();
        match &self.curve {
            None => terms.extend([self.tracking(vehicle, horizon), self.straight_edge(vehicle)]),
            Some(curve) => {
                let (body, route) = (self.body(), curve.route());
                let in_road = |goal: &RoadGoal| Term::FrenetTracking(goal.tracking(vehicle, self.weights));
                terms.push(self.road_goal.as_ref().map_or_else(|| self.tracking(vehicle, horizon), in_road));
                terms.push(Term::RoadEdge(curve.edge(vehicle, body, &route)));
                let stop_line = |line: &Line| Term::StopLine(curve.stop_line(vehicle, &body, &route, line, horizon));
                stop_lines.extend(self.stop_lines.iter().map(stop_line));
            }
        }
        terms.extend(self.keep_outs.iter().map(|of| Term::KeepOut(of.keep_out(vehicle))));
        terms.extend(self.distance_costs.iter().map(|of| Term::DistanceCost(of.distance_cost(vehicle))));
        terms.extend(self.mean_speed.iter().flat_map(|of| of.mean_speed().bounds(vehicle)).map(Term::MeanSpeed));
        terms.extend(stop_lines);
        terms
    }

    fn tracking(&self, vehicle: usize, horizon: usize) -> Term {
        let axes = self.weights_heading.map_or(Axes::WORLD, Axes::along);
        let target = |t: usize| State::from_array(self.targets[t.min(self.targets.len() - 1)]);
        let targets = (0..horizon).map(target).collect();
        Term::Tracking(Tracking { vehicle, weights: self.weights, axes, targets })
    }

    fn straight_edge(&self, vehicle: usize) -> Term {
        let [heading_rad, right_m, left_m] = self.road;
        let end = self.lane_end.map(|[end_m, height_m, taper_m]| LaneEnd { end_m, height_m, taper_m });
        let corridor = Corridor { heading_rad, right_m, left_m, end };
        Term::RoadEdge(RoadEdge::straight(vehicle, self.body(), corridor, Penalty::ROAD_EDGE))
    }
}

/// The heading of the axes of a tracking cost, nothing for those of the world: planners take the heading of the goal.
fn axes_heading_rad(of: &Tracking) -> Option<f64> {
    (of.axes != Axes::WORLD).then(|| of.targets[0].heading_rad)
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
