//! Random problems for the tests: what planners meet, and worse.
#![allow(dead_code, reason = "each test binary uses its own part")]

pub mod games;
pub mod junction;
pub mod starts;
pub mod world;

pub use interplay_common::random::SplitMix64;
use interplay_planners::trajectory::terms::{Comfort, KeepOut, Persuasion, RoadEdge, Separation, Tracking};
use interplay_planners::trajectory::{Iterate, Participant, Penalty, Problem, QpSubproblem, StageQp, Term};
use interplay_planners::{Axes, Bicycle, Body, Corridor, Input, Limits, SafetyEllipse, State};

pub const HORIZON: usize = 30;

/// A deciding vehicle with what it wants and avoids.
#[derive(Clone, Debug)]
pub struct Vehicle {
    pub participant: Participant,
    pub body: Body,
    pub corridor: Corridor,
    pub tracking: [f64; 4],
    pub axes: Axes,
    pub targets: Vec<State>,
    pub comfort: [f64; 2],
    pub keep_outs: Vec<KeepOut>,
}

impl Vehicle {
    /// Its terms as number `vehicle` of a problem.
    pub fn terms(&self, vehicle: usize) -> Vec<Term> {
        let tracking = Tracking { vehicle, weights: self.tracking, axes: self.axes, targets: self.targets.clone() };
        let mut terms = vec![
            Term::Comfort(Comfort { vehicle, weights: self.comfort }),
            Term::Tracking(tracking),
            Term::RoadEdge(RoadEdge::straight(vehicle, self.body, self.corridor, Penalty::EXACT)),
        ];
        terms.extend(self.keep_outs.iter().map(|keep_out| Term::KeepOut(KeepOut { vehicle, ..keep_out.clone() })));
        terms
    }
}

/// The problem of some vehicles, with terms besides their own.
pub fn problem(vehicles: &[Vehicle], besides: impl IntoIterator<Item = Term>) -> Problem {
    let own = vehicles.iter().enumerate().flat_map(|(index, vehicle)| vehicle.terms(index));
    Problem {
        horizon: HORIZON,
        shared_steps: 0,
        participants: vehicles.iter().map(|vehicle| vehicle.participant.clone()).collect(),
        terms: own.chain(besides).collect(),
    }
}

/// A lane-changing vehicle among one or two others that drive straight on.
pub fn lane_change(random: &mut SplitMix64) -> Vehicle {
    let wanted = State { x_m: 0.0, y_m: 0.555, heading_rad: 0.0, speed_mps: random.uniform(0.8, 1.3) };
    let centre = |x: f64, speed: f64| (1..=HORIZON).map(|t| [x + speed * 0.1 * t as f64, 0.555]).collect();
    let others = [(random.uniform(0.2, 0.9), random.uniform(0.8, 1.4)), (random.uniform(-1.8, -0.8), 1.2)];
    let participant = Participant {
        model: Bicycle::new(&Body::default(), 0.1),
        limits: Limits::default(),
        stage_bounds: Vec::new(),
        start: State {
            x_m: 0.0,
            y_m: 0.185 + random.uniform(-0.05, 0.05),
            heading_rad: random.uniform(-0.1, 0.1),
            speed_mps: random.uniform(0.5, 1.3),
        },
        previous_input: Input { acceleration_mps2: random.uniform(-0.3, 0.3), steering_rad: random.uniform(-0.1, 0.1) },
        known_inputs: Vec::new(),
        route_start: None,
    };
    let ellipse = SafetyEllipse::default().oriented(0.0);
    Vehicle {
        participant,
        body: Body::default(),
        corridor: Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end: None },
        tracking: [0.0, random.uniform(0.5, 4.0), random.uniform(0.5, 1.0), 1.0],
        axes: Axes::WORLD,
        targets: vec![wanted; HORIZON],
        comfort: [0.1, 0.1],
        keep_outs: others
            .map(|(x, speed)| KeepOut {
                vehicle: 0,
                centres: centre(x, speed),
                ellipses: vec![ellipse; HORIZON],
                penalty: Penalty::EXACT,
            })
            .into(),
    }
}

/// A vehicle that follows its plan until `first` and may then be asked to deviate.
pub fn follower(random: &mut SplitMix64, first: usize) -> Vehicle {
    let start = State { x_m: random.uniform(-0.6, 0.1), y_m: 0.555, heading_rad: 0.0, speed_mps: 1.2 };
    let targets = (1..=HORIZON).map(|t| State { x_m: start.x_m + 0.12 * t as f64, ..start }).collect();
    let free = lane_change(random);
    Vehicle {
        participant: Participant {
            start,
            previous_input: Input::default(),
            known_inputs: vec![Input::default(); first],
            ..free.participant
        },
        tracking: [0.005, 0.005, 0.0005, 0.0025],
        targets,
        comfort: [0.01, 0.01],
        keep_outs: Vec::new(),
        ..free
    }
}

/// One vehicle among others.
pub fn alone(seed: u64) -> Problem {
    problem(&[lane_change(&mut SplitMix64::new(seed))], [])
}

/// Two deciding vehicles, the second from step 6 on, with a persuasion constraint of strength `alpha`.
pub fn pair(seed: u64, alpha: f64) -> Problem {
    let random = &mut SplitMix64::new(seed);
    let mut ego = lane_change(random);
    ego.keep_outs.truncate(1);
    let away = (0..HORIZON).map(|t| [0.1 * t as f64, 0.185]).collect();
    let toward = (0..HORIZON).map(|t| [0.105 * t as f64, 0.185 + 0.3 * (t as f64 / 29.0)]).collect();
    let ellipse = SafetyEllipse::default().oriented(0.0);
    let separation = Separation { vehicle: 0, from: 1, ellipses: vec![ellipse; HORIZON], penalty: Penalty::EXACT };
    let penalty = Penalty { linear: 100.0, quadratic: 0.0 };
    let persuasion = Persuasion { vehicle: 0, toward, away, strength: alpha, penalty };
    problem(&[ego, follower(random, 6)], [Term::Separation(separation), Term::Persuasion(persuasion)])
}

/// A lane-changing vehicle in several futures, in each of which the others drive at other speeds, with its first steps shared.
pub fn futures(seed: u64, count: usize, shared_steps: usize) -> Problem {
    let random = &mut SplitMix64::new(seed);
    let ego = lane_change(random);
    let share = 1.0 / count as f64;
    let in_future = |_| {
        let faster_mps = random.uniform(-0.4, 0.4);
        let mut future = ego.clone();
        future.tracking = ego.tracking.map(|weight| share * weight);
        future.comfort = ego.comfort.map(|weight| share * weight);
        for (t, centre) in future.keep_outs.iter_mut().flat_map(|of| of.centres.iter_mut().enumerate()) {
            centre[0] += faster_mps * 0.1 * t as f64;
        }
        future
    };
    let vehicles: Vec<Vehicle> = (0..count).map(in_future).collect();
    Problem { shared_steps, ..problem(&vehicles, []) }
}

/// An iterate of `problem` with small random inputs.
pub fn iterate(problem: &Problem, random: &mut SplitMix64) -> Iterate {
    let guess = problem.participants.iter().map(|_| {
        let input = |t| Input {
            acceleration_mps2: random.uniform(-0.2, 0.2),
            steering_rad: if t < 8 { random.uniform(0.0, 0.1) } else { random.uniform(-0.05, 0.05) },
        };
        (0..problem.horizon).map(input).collect()
    });
    problem.start(&guess.collect::<Vec<_>>())
}

/// The Gauss-Newton QP subproblem at an iterate.
pub fn qp_subproblem(problem: &Problem, iterate: &Iterate) -> StageQp {
    let mut step = QpSubproblem::default();
    step.linearize(problem, iterate);
    step.qp
}

/// Wilson's score interval of a share, at a confidence of 95 %.
pub fn wilson_interval(count: usize, of: usize) -> [f64; 2] {
    const QUANTILE: f64 = 1.959_964;
    let (count, of, z2) = (count as f64, of as f64, QUANTILE * QUANTILE);
    let (middle, scale) = (count + 0.5 * z2, of + z2);
    let half_width = QUANTILE * (count * (of - count) / of + 0.25 * z2).sqrt();
    [(middle - half_width).max(0.0) / scale, (middle + half_width).min(scale) / scale]
}
