//! Random problems for the tests: what planners meet, and worse.
#![allow(dead_code, reason = "each test binary uses its own part")]

pub mod derivatives;
pub mod world;

use interplay_planners::Bicycle;
use interplay_planners::trajectory::{Iterate, KeepOut, Leaning, Participant, Penalty, Problem, Separation, Tracking};
use interplay_planners::{Axes, Body, Corridor, Input, Limits, SafetyEllipse, State};

/// SplitMix64: small, seeded, the same everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

pub const HORIZON: usize = 30;

/// A lane-changing vehicle among one or two others that drive straight on.
pub fn lane_change(random: &mut Random) -> Participant {
    let wanted = State { x_m: 0.0, y_m: 0.555, heading_rad: 0.0, speed_mps: random.between(0.8, 1.3) };
    let centre = |x: f64, speed: f64| (1..=HORIZON).map(|t| [x + speed * 0.1 * t as f64, 0.555]).collect();
    let keep_outs = [(random.between(0.2, 0.9), random.between(0.8, 1.4)), (random.between(-1.8, -0.8), 1.2)];
    Participant {
        model: Bicycle::new(&Body::default(), 0.1),
        body: Body::default(),
        limits: Limits::default(),
        corridor: Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end: None },
        start: State {
            x_m: 0.0,
            y_m: 0.185 + random.between(-0.05, 0.05),
            heading_rad: random.between(-0.1, 0.1),
            speed_mps: random.between(0.5, 1.3),
        },
        previous_input: Input { acceleration_mps2: random.between(-0.3, 0.3), steering_rad: random.between(-0.1, 0.1) },
        known_inputs: Vec::new(),
        tracking: Tracking {
            weights: [0.0, random.between(0.5, 4.0), random.between(0.5, 1.0), 1.0],
            axes: Axes::WORLD,
            targets: vec![wanted; HORIZON],
        },
        comfort: [0.1, 0.1],
        keep_outs: keep_outs
            .map(|(x, speed)| KeepOut {
                centres: centre(x, speed),
                heading_rad: 0.0,
                ellipse: SafetyEllipse::default(),
                penalty: Penalty::EXACT,
            })
            .into(),
        distance_costs: Vec::new(),
        mean_speed: None,
    }
}

/// A vehicle that follows its plan until `first` and may then be asked to deviate.
pub fn follower(random: &mut Random, first: usize) -> Participant {
    let start = State { x_m: random.between(-0.6, 0.1), y_m: 0.555, heading_rad: 0.0, speed_mps: 1.2 };
    let targets = (1..=HORIZON).map(|t| State { x_m: start.x_m + 0.12 * t as f64, ..start }).collect();
    Participant {
        start,
        previous_input: Input::default(),
        known_inputs: vec![Input::default(); first],
        tracking: Tracking { weights: [0.005, 0.005, 0.0005, 0.0025], axes: Axes::WORLD, targets },
        comfort: [0.01, 0.01],
        keep_outs: Vec::new(),
        ..lane_change(random)
    }
}

/// One vehicle among others.
pub fn alone(seed: u64) -> Problem {
    let participant = lane_change(&mut Random(seed));
    Problem { horizon: HORIZON, participants: vec![participant], separations: Vec::new(), leaning: None }
}

/// Two deciding vehicles, the second from step 6 on, with a persuasion constraint of strength `alpha`.
pub fn pair(seed: u64, alpha: f64) -> Problem {
    let random = &mut Random(seed);
    let mut ego = lane_change(random);
    ego.keep_outs.truncate(1);
    let away = (0..HORIZON).map(|t| [0.1 * t as f64, 0.185]).collect();
    let toward = (0..HORIZON).map(|t| [0.105 * t as f64, 0.185 + 0.3 * (t as f64 / 29.0)]).collect();
    Problem {
        horizon: HORIZON,
        participants: vec![ego, follower(random, 6)],
        separations: vec![Separation {
            of: 0,
            from: 1,
            heading_rad: 0.0,
            ellipse: SafetyEllipse::default(),
            penalty: Penalty::EXACT,
        }],
        leaning: Some(Leaning { toward, away, strength: alpha, penalty: Penalty { linear: 100.0, quadratic: 0.0 } }),
    }
}

/// An iterate of `problem` with small random inputs.
pub fn iterate(problem: &Problem, random: &mut Random) -> Iterate {
    let inputs = problem.participants.iter().map(|participant| {
        let guess: Vec<Input> = (0..problem.horizon)
            .map(|t| Input {
                acceleration_mps2: random.between(-0.2, 0.2),
                steering_rad: if t < 8 { random.between(0.0, 0.1) } else { random.between(-0.05, 0.05) },
            })
            .collect();
        participant.admissible(&guess, problem.horizon)
    });
    let mut iterate = Iterate { inputs: inputs.collect(), states: Vec::new() };
    problem.roll_out(&mut iterate);
    iterate
}
