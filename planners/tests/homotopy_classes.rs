//! Optima on either side of a vehicle, and a search that finds both.

mod common;

use common::{HORIZON, SplitMix64, Vehicle, alone, iterate, lane_change, pair, problem};
use interplay_planners::trajectory::HomotopySearch;
use interplay_planners::trajectory::terms::KeepOut;
use interplay_planners::trajectory::{Optimiser, Participant, Penalty, Problem, Robust};
use interplay_planners::{Corridor, Input, SafetyEllipse, State};

/// A vehicle stands ahead on a wide road, a little to the left of the way.
fn with_a_vehicle_ahead(left_m: f64) -> Problem {
    let wanted = State { x_m: 0.0, y_m: 0.0, heading_rad: 0.0, speed_mps: 1.2 };
    let keep_out = KeepOut {
        vehicle: 0,
        centres: vec![[1.8, left_m]; HORIZON],
        ellipses: vec![SafetyEllipse::default().oriented(0.0); HORIZON],
        penalty: Penalty::EXACT,
    };
    let free = lane_change(&mut SplitMix64::new(0));
    let vehicle = Vehicle {
        participant: Participant { start: wanted, previous_input: Input::default(), ..free.participant },
        corridor: Corridor { heading_rad: 0.0, right_m: -2.0, left_m: 2.0, end: None },
        tracking: [0.0, 1.0, 0.5, 1.0],
        targets: vec![wanted; HORIZON],
        keep_outs: vec![keep_out],
        ..free
    };
    problem(&[vehicle], [])
}

/// To one side (1 left, −1 right) and straight on.
fn swerve(side: f64) -> Vec<Vec<Input>> {
    let steering = |t: usize| side * [0.3, -0.3, 0.0][(t / 5).min(2)];
    vec![(0..HORIZON).map(|t| Input { acceleration_mps2: 0.0, steering_rad: steering(t) }).collect()]
}

/// The optimum from a guess and what it costs, alone and looking across.
fn optima(problem: &Problem, guess: &[Vec<Input>]) -> Option<[f64; 2]> {
    let mut optimiser = Optimiser::new(Robust::default()).searching(HomotopySearch::Off);
    let alone = optimiser.optimise(problem, guess).ok()?;
    optimiser.homotopy_search = HomotopySearch::Classes;
    let across = optimiser.optimise(problem, guess).ok()?;
    Some([alone.cost.total, across.cost.total])
}

#[test]
fn a_homotopy_search_finds_the_cheaper_side_from_any_guess() {
    for left_m in [-0.12, -0.08, -0.04, -0.02, 0.02, 0.04, 0.08, 0.12] {
        let problem = with_a_vehicle_ahead(left_m);
        let far = -left_m.signum();
        let [cheap, still_cheap] = optima(&problem, &swerve(far)).expect("an optimum");
        let [dear, found] = optima(&problem, &swerve(-far)).expect("an optimum");
        assert!(dear > cheap + 1e-3, "{left_m}: the near side costs {dear}, the far one {cheap}");
        assert!((still_cheap - cheap).abs() <= 1e-7 * cheap, "{left_m}: {cheap} was left for {still_cheap}");
        assert!((found - cheap).abs() <= 1e-7 * cheap, "{left_m}: {found} instead of {cheap}");
    }
}

#[test]
fn a_search_in_other_homotopy_classes_never_raises_the_cost() {
    let (mut gained, mut compared) = (0, 0);
    for seed in 0..60 {
        for problem in [alone(seed), pair(seed, 1.0 + 0.02 * seed as f64)] {
            let guess = iterate(&problem, &mut SplitMix64::new(seed + 7)).inputs;
            let Some([alone, across]) = optima(&problem, &guess) else { continue };
            assert!(across <= alone, "seed {seed}: {across} instead of {alone}");
            gained += usize::from(across < alone * (1.0 - 1e-3));
            compared += 1;
        }
    }
    assert!(gained > 0, "random problems have other sides");
    assert!(compared * 8 >= 120 * 7, "only {compared} of 120 problems were solved");
}
