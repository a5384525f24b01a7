//! The derivatives of every cost and constraint, each alone in a problem, by one checker.

mod common;

use common::{HORIZON, SplitMix64, Vehicle, follower, iterate, lane_change, problem};
use interplay_planners::trajectory::terms::{
    CostOfState, DistanceCost, DistancePrice, ForeignTerm, KeepOut, MeanSpeed, Persuasion, RowOnPose, RowOnTrajectory,
    Separation, SpeedMeasure,
};
use interplay_planners::trajectory::{
    DerivativeError, Optimiser, Participant, Penalty, Problem, Robust, StateCost, Term, TrajectoryRow,
    check_derivatives,
};
use interplay_planners::vehicle::{OrientedEllipse, PoseExpansion};
use interplay_planners::{Axes, Corridor, LaneEnd, SafetyEllipse, State};

const SEEDS: u64 = 20;

/// A vehicle on a wide road that nothing costs anything.
fn indifferent(random: &mut SplitMix64) -> Vehicle {
    Vehicle {
        tracking: [0.0; 4],
        targets: vec![State::default(); HORIZON],
        comfort: [0.0; 2],
        corridor: Corridor { heading_rad: 0.0, right_m: -9.0, left_m: 9.0, end: None },
        keep_outs: Vec::new(),
        ..lane_change(random)
    }
}

fn alone(vehicle: Vehicle) -> Problem {
    problem(&[vehicle], [])
}

/// Checks what `pose` makes of random numbers, and that it was there to be checked.
fn check_all(pose: impl Fn(&mut SplitMix64) -> Problem) {
    let (mut first, mut second) = (0.0_f64, 0.0_f64);
    for seed in 0..SEEDS {
        let random = &mut SplitMix64::new(seed);
        let problem = pose(random);
        let seen = check_derivatives(&problem, &iterate(&problem, random)).unwrap_or_else(|error| panic!("{error}"));
        (first, second) = (first.max(seen.first), second.max(seen.second));
    }
    assert!(first > 1e-3 && second > 1e-3, "nothing costs anything here");
}

/// Centres beside which the vehicle drives, well inside their ellipses.
fn beside(random: &mut SplitMix64) -> Vec<[f64; 2]> {
    let (x, speed) = (random.uniform(-0.2, 0.2), random.uniform(0.6, 1.2));
    (1..=HORIZON).map(|t| [x + 0.1 * speed * t as f64, 0.25]).collect()
}

fn ellipse(heading_rad: f64) -> OrientedEllipse {
    // Large enough that no stage is near its edge, where the penalty has a kink.
    SafetyEllipse { along_m: 4.0, across_m: 2.0 }.oriented(heading_rad)
}

#[test]
fn tracking_derivatives_match_differences() {
    check_all(|random| {
        let target = State { x_m: 1.0, y_m: 0.5, heading_rad: 0.2, speed_mps: 1.3 };
        let axes = Axes::along(random.uniform(-3.0, 3.0));
        let tracking = [0.3, 1.0, 0.7, 2.0];
        alone(Vehicle { tracking, axes, targets: vec![target; HORIZON], ..indifferent(random) })
    });
}

#[test]
fn comfort_derivatives_match_differences() {
    check_all(|random| alone(Vehicle { comfort: [0.2, 0.5], ..indifferent(random) }));
}

#[test]
fn road_edges_derivatives_match_differences() {
    // Every right corner is beyond its edge and every left one is inside.
    let end = LaneEnd { end_m: 2.0, height_m: 0.5, taper_m: 0.6 };
    let corridor = Corridor { heading_rad: 0.1, right_m: 1.0, left_m: 9.0, end: Some(end) };
    check_all(|random| alone(Vehicle { corridor, ..indifferent(random) }));
}

#[test]
fn keep_out_derivatives_match_differences() {
    for penalty in [Penalty::EXACT, Penalty::hinge(50.0)] {
        check_all(|random| {
            let keep_out =
                KeepOut { vehicle: 0, centres: beside(random), ellipses: vec![ellipse(0.4); HORIZON], penalty };
            alone(Vehicle { keep_outs: vec![keep_out], ..indifferent(random) })
        });
    }
}

#[test]
fn separation_derivatives_match_differences() {
    check_all(|random| {
        let known_inputs = follower(random, 6).participant.known_inputs;
        let free = indifferent(random);
        let other = Vehicle { participant: Participant { known_inputs, ..free.participant.clone() }, ..free };
        let separation =
            Separation { vehicle: 0, from: 1, ellipses: vec![ellipse(0.3); HORIZON], penalty: Penalty::EXACT };
        problem(&[indifferent(random), other], [Term::Separation(separation)])
    });
}

#[test]
fn persuasion_derivatives_match_differences() {
    for strength in [1.0, 1.6] {
        check_all(|random| {
            // Nearer to the reference that it should leave.
            let toward = (0..HORIZON).map(|t| [0.2 * t as f64, 0.9]).collect();
            let away = (0..HORIZON).map(|t| [0.1 * t as f64, 0.185]).collect();
            let penalty = Penalty { linear: 100.0, quadratic: 3.0 };
            let persuasion = Persuasion { vehicle: 0, toward, away, strength, penalty };
            problem(&[indifferent(random)], [Term::Persuasion(persuasion)])
        });
    }
}

#[test]
fn mean_speed_derivatives_match_differences() {
    // A road that turns by a twentieth of a radian a step.
    let directions = (0..HORIZON).map(|t| 0.05 * t as f64).map(|turn| [turn.cos(), turn.sin()]).collect();
    let measures = [SpeedMeasure::Speeds, SpeedMeasure::AlongRoad { directions, step_s: 0.1 }];
    for (lower_mps, upper_mps) in [(Some(1.6), None), (None, Some(0.1)), (Some(1.6), Some(0.1))] {
        for measure in &measures {
            check_all(|random| {
                let penalty = Penalty { linear: 75.0, quadratic: 2.0 };
                let mean_speed = MeanSpeed { measure: measure.clone(), lower_mps, upper_mps, penalty };
                problem(&[indifferent(random)], mean_speed.bounds(0).map(Term::MeanSpeed))
            });
        }
    }
}

#[test]
fn distance_price_derivatives_match_differences() {
    let prices = [
        DistancePrice::Linear { weight: 0.9 },
        DistancePrice::Exact { base: 1.0, loyalty: 0.5, aversion: 0.3 },
        DistancePrice::Exact { base: 1.05, loyalty: 5.0, aversion: 0.3 },
    ];
    for price in prices {
        check_all(|random| {
            let centres = beside(random).into_iter().map(|[x, y]| [x + 0.4, y + 0.3]).collect();
            let cost = DistanceCost { vehicle: 0, centres, metrics: vec![[1.9, 0.4, 8.0]; HORIZON], price };
            problem(&[indifferent(random)], [Term::DistanceCost(cost)])
        });
    }
}

/// `w (v − v_0)² + w x y`: a cost that another crate might have, with a Hessian that is not convex.
#[derive(Debug)]
struct OwnCost {
    weight: f64,
    /// What is added to the stated slope over the speed.
    error: f64,
}

impl CostOfState for OwnCost {
    fn value(&self, t: usize, state: &State) -> f64 {
        let excess_mps = state.speed_mps - 0.1 * t as f64;
        self.weight * (excess_mps * excess_mps + state.x_m * state.y_m)
    }

    fn expand(&self, t: usize, state: &State) -> StateCost {
        let slope = 2.0 * (state.speed_mps - 0.1 * t as f64);
        StateCost {
            gradient: [state.y_m, state.x_m, 0.0, slope + self.error].map(|slope| self.weight * slope),
            hessian: [0.0, 0.0, 0.0, 2.0 * self.weight],
            curvature: [0.0, self.weight, 0.0],
            ..StateCost::default()
        }
    }
}

/// `y + cos θ ≥ 3`, which is violated everywhere here.
#[derive(Debug)]
struct OwnRow;

impl RowOnPose for OwnRow {
    fn penalty(&self) -> Penalty {
        Penalty { linear: 2.0, quadratic: 0.5 }
    }

    fn expand(&self, _: usize, state: &State) -> PoseExpansion {
        let (sin, cos) = libm::sincos(state.heading_rad);
        PoseExpansion {
            value: state.y_m + cos - 3.0,
            gradient: [0.0, 1.0, -sin],
            hessian: [0.0, 0.0, 0.0, 0.0, 0.0, -cos],
        }
    }
}

/// `Σ (x² + y²)/2 ≤ 0`.
#[derive(Debug)]
struct OwnTrajectoryRow;

impl RowOnTrajectory for OwnTrajectoryRow {
    fn penalty(&self) -> Penalty {
        Penalty { linear: 0.3, quadratic: 0.01 }
    }

    fn excess(&self, states: &[State]) -> f64 {
        let later = states.iter().skip(1);
        later.map(|state| (state.x_m * state.x_m + state.y_m * state.y_m) / 2.0).sum::<f64>()
    }

    fn expand(&self, states: &[State], row: &mut TrajectoryRow) {
        for ((state, gradient), bend) in states.iter().skip(1).zip(&mut row.gradients).zip(&mut row.bends) {
            (*gradient, *bend) = ([state.x_m, state.y_m, 0.0], 0.5);
        }
    }
}

#[test]
fn derivatives_of_terms_of_another_crate_match_differences() {
    check_all(|random| {
        let cost = OwnCost { weight: random.uniform(0.5, 2.0), error: 0.0 };
        problem(&[indifferent(random)], [Term::Foreign(ForeignTerm::cost(0, cost))])
    });
    check_all(|random| problem(&[indifferent(random)], [Term::Foreign(ForeignTerm::row(0, OwnRow))]));
    check_all(|random| {
        problem(&[indifferent(random)], [Term::Foreign(ForeignTerm::trajectory_row(0, OwnTrajectoryRow))])
    });
}

#[test]
fn a_wrong_derivative_in_a_term_of_another_crate_is_detected() {
    let random = &mut SplitMix64::new(1);
    let wrong = OwnCost { weight: 1.0, error: 0.1 };
    let problem = problem(&[indifferent(random)], [Term::Foreign(ForeignTerm::cost(0, wrong))]);
    let found = check_derivatives(&problem, &iterate(&problem, random));
    assert!(matches!(found, Err(DerivativeError::Differs { which: "first", .. })), "{found:?}");
}

/// A vehicle that pays for its place to the left drives further right, also as the second of two that decide.
#[test]
fn terms_of_another_crate_move_the_optimum_of_their_vehicle() {
    let random = &mut SplitMix64::new(2);
    let vehicles = [follower(random, 0), lane_change(random)];
    let plain = problem(&vehicles, []);
    let left_m = |problem: &Problem| {
        let optimum = Optimiser::new(Robust::default()).descend(problem, &[]).expect("an optimum");
        [0, 1].map(|vehicle| optimum.trajectory(vehicle).states.iter().map(|state| state.y_m).sum::<f64>())
    };
    #[derive(Debug)]
    struct PriceOfLeft;
    impl CostOfState for PriceOfLeft {
        fn value(&self, _: usize, state: &State) -> f64 {
            state.y_m
        }
        fn expand(&self, _: usize, _: &State) -> StateCost {
            StateCost { gradient: [0.0, 1.0, 0.0, 0.0], ..StateCost::default() }
        }
    }
    let priced = problem(&vehicles, [Term::Foreign(ForeignTerm::cost(1, PriceOfLeft))]);
    let (before, after) = (left_m(&plain), left_m(&priced));
    assert!(after[1] < before[1] - 0.1 && (after[0] - before[0]).abs() < 1e-3, "{before:?} {after:?}");
    let own = priced.alone(1, &priced.start(&[]));
    assert_eq!(own.terms.iter().filter(|term| matches!(term, Term::Foreign(_))).count(), 1);
    assert!(priced.alone(0, &priced.start(&[])).terms.iter().all(|term| !matches!(term, Term::Foreign(_))));
}
