//! The trajectory problem that every planner poses: a cost (eq. 6.6), the bicycle (eq. 6.10), boxes on inputs and speed
//! (eq. 6.9), road edges (eq. 6.7) and ellipses to keep out of (eq. 6.8), for one or more deciding vehicles.
//!
//! Only boxes are hard. They are linear in the inputs (speed is linear in acceleration), so any mixture of two
//! admissible input sequences is admissible. Everything else is a soft row `c(x) + s ≥ 0, s ≥ 0` with the cost
//! `linear·s + quadratic·s²`: with a `linear` weight above the multiplier this is exact, i.e. the row holds at the optimum
//! whenever it can (Nocedal and Wright, section 17.2). The states follow from the inputs. So the cost of an input
//! sequence is one number, and it is its own merit function.

use super::penalty::Penalty;
use super::stage::StateCost;
use super::terms::{DistanceCost, MeanSpeed};
use crate::{Axes, Bicycle, Body, Corridor, Input, Limits, SafetyEllipse, State};

/// Tracking cost `Σ_{t=1…N} ‖x_t − target_t‖²_Q` with diagonal `Q`.
///
/// Deviation from eq. 6.6: as printed the sum runs over `t = 0…N−1`, which leaves the last input idle.
#[derive(Clone, Debug, PartialEq)]
pub struct Tracking {
    /// Diagonal of `Q` on (position along `axes`, across them, θ, v).
    pub weights: [f64; 4],
    /// The axes in which `Q` is diagonal: those of the vehicle's road.
    pub axes: Axes,
    /// Desired state at `t = 1…N`; `N` long.
    pub targets: Vec<State>,
}

impl Tracking {
    /// How far a state at `t + 1` is from the desired one, on (along, across, θ, v).
    fn deviation(&self, t: usize, state: &State) -> [f64; 4] {
        let (state, target) = (state.to_array(), self.targets[t].to_array());
        let [x, y, heading, speed] = std::array::from_fn(|i| state[i] - target[i]);
        let [along, across] = self.axes.components([x, y]);
        [along, across, heading, speed]
    }

    /// Gradient and Hessian of the cost of a state at `t + 1`.
    pub(super) fn cost(&self, t: usize, state: &State) -> StateCost {
        let (missed, weights) = (self.deviation(t, state), self.weights);
        let [along, across, heading, speed] = std::array::from_fn(|i| 2.0 * weights[i] * missed[i]);
        let [x, y] = self.axes.vector([along, across]);
        let [xx, xy, yy] = self.axes.matrix([2.0 * weights[0], 0.0, 2.0 * weights[1]]);
        StateCost {
            gradient: [x, y, heading, speed],
            hessian: [xx, yy, 2.0 * weights[2], 2.0 * weights[3]],
            cross: xy,
            ..StateCost::default()
        }
    }
}

/// An ellipse around a moving centre that a vehicle keeps out of: `d² − 1 + s ≥ 0` at `t = 1…N`.
#[derive(Clone, Debug, PartialEq)]
pub struct KeepOut {
    /// Centres at `t = 1…N`; `N` long \[m\].
    pub centres: Vec<[f64; 2]>,
    /// Direction of the long axis \[rad\].
    pub heading_rad: f64,
    /// Half axes.
    pub ellipse: SafetyEllipse,
    /// What entering costs.
    pub penalty: Penalty,
}

/// One vehicle whose inputs are decided.
#[derive(Clone, Debug, PartialEq)]
pub struct Participant {
    /// Its motion.
    pub model: Bicycle,
    /// Its body, for the corners.
    pub body: Body,
    /// Its hard bounds.
    pub limits: Limits,
    /// The road it may use.
    pub corridor: Corridor,
    /// State at `t = 0`.
    pub start: State,
    /// Input applied before `t = 0`, for the first `Δu`.
    pub previous_input: Input,
    /// Inputs at `t = 0 … first−1` that are not decided but known (eq. 6.15: the human follows the prediction until
    /// `T_n`); empty for a vehicle that decides from the start.
    pub known_inputs: Vec<Input>,
    /// What it wants.
    pub tracking: Tracking,
    /// Diagonal of `R` on (Δa, Δδ).
    pub comfort: [f64; 2],
    /// Whom it avoids.
    pub keep_outs: Vec<KeepOut>,
    /// What distances from others cost it besides.
    pub distance_costs: Vec<DistanceCost>,
    /// Bounds on its mean speed.
    pub mean_speed: Option<MeanSpeed>,
}

impl KeepOut {
    /// How near a motion comes: the largest `1 − d²` over `t = 1…N`, negative outside. `states` begin at `t = 0`.
    pub fn intrusion(&self, states: &[State]) -> f64 {
        let centres = states.iter().skip(1).zip(&self.centres);
        let distances = centres
            .map(|(state, centre)| self.ellipse.oriented(self.heading_rad).distance(state.position(), *centre).squared);
        1.0 - distances.fold(f64::INFINITY, f64::min)
    }
}

/// Two deciding vehicles keep apart: the first stays outside an ellipse around the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Index of the vehicle that keeps out.
    pub of: usize,
    /// Index of the vehicle in the ellipse's centre.
    pub from: usize,
    /// Direction of the long axis \[rad\].
    pub heading_rad: f64,
    /// Half axes.
    pub ellipse: SafetyEllipse,
    /// What entering costs.
    pub penalty: Penalty,
}

/// A trajectory of participant 0 that is nearer to one reference than to another (eq. 6.23, corrected: both norms
/// squared): `α Σ‖p_t − toward_t‖² − Σ‖p_t − away_t‖² ≤ s` over `t = 0…N−1`.
///
/// For `α = 1` a half-space, for `α > 1` the Apollonius ball with centre `(α·toward − away)/(α − 1)` and radius
/// `√α‖toward − away‖/(α − 1)`: convex both ways.
#[derive(Clone, Debug, PartialEq)]
pub struct Leaning {
    /// Reference to lean towards at `t = 0…N−1` \[m\].
    pub toward: Vec<[f64; 2]>,
    /// Reference to lean away from at `t = 0…N−1` \[m\].
    pub away: Vec<[f64; 2]>,
    /// `α ≥ 1`.
    pub strength: f64,
    /// What falling short costs.
    pub penalty: Penalty,
}

impl Leaning {
    /// The left side of the constraint for given positions; at most 0 when the constraint holds \[m²\].
    pub fn value(&self, states: &[State]) -> f64 {
        let squared = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        let references = self.toward.iter().zip(&self.away);
        states
            .iter()
            .zip(references)
            .map(|(state, (toward, away))| {
                self.strength * squared(state.position(), *toward) - squared(state.position(), *away)
            })
            .sum()
    }
}

/// A whole trajectory problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Number of steps `N`.
    pub horizon: usize,
    /// The deciding vehicles, at least one.
    pub participants: Vec<Participant>,
    /// Pairs of deciding vehicles that keep apart.
    pub separations: Vec<Separation>,
    /// The persuasion constraint on participant 0.
    pub leaning: Option<Leaning>,
}

/// The cost of a solution, and by how much its exact rows are violated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Everything, penalties included.
    pub total: f64,
    /// The part of it that is linear in violations, `Σ linear·s`.
    pub steep: f64,
    /// Largest violation of a safety row (`1 − d²` of an ellipse with a linear penalty) \[-\].
    pub safety_slack: f64,
    /// Largest distance of a corner beyond a road edge \[m\].
    pub edge_slack_m: f64,
    /// By how much the persuasion constraint falls short \[m²\].
    pub leaning_slack: f64,
    /// By how much a mean speed is out of its bounds \[m/s\].
    pub mean_speed_slack_mps: f64,
}

/// Inputs and states of every participant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Iterate {
    /// Per participant, `N` inputs.
    pub inputs: Vec<Vec<Input>>,
    /// Per participant, `N + 1` states.
    pub states: Vec<Vec<State>>,
}

impl Participant {
    /// The first step whose input is decided.
    pub fn first(&self) -> usize {
        self.known_inputs.len()
    }

    /// The nearest admissible inputs to a guess: known inputs kept, accelerations and steering clipped to their
    /// bounds, and the speed kept within its own.
    pub fn admissible(&self, guess: &[Input], horizon: usize) -> Vec<Input> {
        let (limits, step) = (&self.limits, self.model.step_s());
        let mut speed = self.start.speed_mps;
        (0..horizon)
            .map(|t| {
                let input = if t < self.first() {
                    self.known_inputs[t]
                } else {
                    let wanted = guess.get(t).copied().unwrap_or_default();
                    let [slowest, fastest] = self.speed_bounds(t + 1);
                    let low = limits.acceleration_min_mps2.max((slowest - speed) / step);
                    let high = limits.acceleration_max_mps2.min((fastest - speed) / step);
                    Input {
                        acceleration_mps2: wanted.acceleration_mps2.min(high).max(low),
                        steering_rad: wanted.steering_rad.clamp(-limits.steering_max_rad, limits.steering_max_rad),
                    }
                };
                speed += step * input.acceleration_mps2;
                input
            })
            .collect()
    }

    /// Bounds on the speed at time `t`. A vehicle that is out of bounds now (a plant that is not the model may leave
    /// it so) is asked to come back no faster than it can.
    pub fn speed_bounds(&self, t: usize) -> [f64; 2] {
        let (limits, elapsed) = (&self.limits, self.model.step_s() * t as f64);
        let reachable_low = self.start.speed_mps + limits.acceleration_max_mps2 * elapsed;
        let reachable_high = self.start.speed_mps + limits.acceleration_min_mps2 * elapsed;
        [limits.speed_min_mps.min(reachable_low), limits.speed_max_mps.max(reachable_high)]
    }

    fn cost(&self, inputs: &[Input], states: &[State], cost: &mut Cost) {
        let mut previous = self.previous_input.to_array();
        for (t, input) in inputs.iter().enumerate() {
            let now = input.to_array();
            if t >= self.first() {
                for i in 0..2 {
                    cost.total += self.comfort[i] * (now[i] - previous[i]).powi(2);
                }
            }
            previous = now;
            let missed = self.tracking.deviation(t, &states[t + 1]);
            for i in 0..4 {
                cost.total += self.tracking.weights[i] * missed[i].powi(2);
            }
            if t >= self.first() {
                for corner in self.corridor.clearances(&self.body, &states[t + 1]) {
                    cost.add_row(&Penalty::EXACT, corner.value);
                    cost.edge_slack_m = cost.edge_slack_m.max(-corner.value);
                }
            }
            for keep_out in &self.keep_outs {
                let distance = keep_out
                    .ellipse
                    .oriented(keep_out.heading_rad)
                    .distance(states[t + 1].position(), keep_out.centres[t]);
                cost.add_safety(&keep_out.penalty, distance.squared - 1.0);
            }
            for distance_cost in &self.distance_costs {
                cost.total += distance_cost.value(t, states[t + 1].position());
            }
        }
        if let Some(bound) = &self.mean_speed {
            for (value, _) in bound.values(states) {
                cost.total += bound.penalty.cost(-value);
                cost.mean_speed_slack_mps = cost.mean_speed_slack_mps.max(value);
            }
        }
    }
}

impl Cost {
    fn add_row(&mut self, penalty: &Penalty, value: f64) {
        self.total += penalty.cost(value);
        self.steep += penalty.linear * (-value).max(0.0);
    }

    fn add_safety(&mut self, penalty: &Penalty, value: f64) {
        self.add_row(penalty, value);
        if penalty.linear > 0.0 {
            self.safety_slack = self.safety_slack.max(-value);
        }
    }
}

impl Problem {
    /// Rolls the inputs of an iterate out into its states.
    pub fn roll_out(&self, iterate: &mut Iterate) {
        iterate.states.resize_with(self.participants.len(), Vec::new);
        for (i, participant) in self.participants.iter().enumerate() {
            participant.model.roll_out(&participant.start, &iterate.inputs[i], &mut iterate.states[i]);
        }
    }

    /// The admissible iterate nearest to a guess (per participant, inputs).
    pub fn start(&self, guess: &[Vec<Input>]) -> Iterate {
        let inputs = self.participants.iter().enumerate().map(|(i, participant)| {
            participant.admissible(guess.get(i).map(Vec::as_slice).unwrap_or_default(), self.horizon)
        });
        let mut iterate = Iterate { inputs: inputs.collect(), states: Vec::new() };
        self.roll_out(&mut iterate);
        iterate
    }

    /// What a guess costs, made admissible.
    pub fn cost_of(&self, guess: &[Vec<Input>]) -> f64 {
        self.cost(&self.start(guess)).total
    }

    /// The cost of an iterate whose states were rolled out.
    pub fn cost(&self, iterate: &Iterate) -> Cost {
        let mut cost = Cost::default();
        for (i, participant) in self.participants.iter().enumerate() {
            participant.cost(&iterate.inputs[i], &iterate.states[i], &mut cost);
        }
        for pair in &self.separations {
            for t in 1..=self.horizon {
                let (of, from) = (iterate.states[pair.of][t], iterate.states[pair.from][t]);
                let distance = pair.ellipse.oriented(pair.heading_rad).distance(of.position(), from.position());
                cost.add_safety(&pair.penalty, distance.squared - 1.0);
            }
        }
        if let Some(leaning) = &self.leaning {
            let value = leaning.value(&iterate.states[0]);
            cost.total += leaning.penalty.cost(-value);
            cost.leaning_slack = value.max(0.0);
        }
        cost
    }
}
