//! Equilibria of several vehicles: none gains by leaving, by several checks, and what one gains the sum of all costs gains.

mod common;

use common::SplitMix64;
use common::games::joint_problem;
use common::world::{lane_change, run};
use interplay_planners::drivers::human::Style;
use interplay_planners::drivers::nash::diagnostics::{DEVIATION_GAIN, PLAYERS};
use interplay_planners::drivers::nash::{self, Equilibrium, TOLERATED_GAIN, equilibrium};
use interplay_planners::trajectory::HomotopySearch;
use interplay_planners::trajectory::{Iterate, Optimiser, Problem, Robust, Violation};
use interplay_planners::{Driver, Input};

const GAMES: usize = 20;

fn solve(problem: &Problem) -> Equilibrium {
    let mut joint = Optimiser::new(Robust::default()).searching(HomotopySearch::Off);
    let mut responses = joint.clone();
    equilibrium(&mut joint, &mut responses, problem, &[]).expect("a joint optimum")
}

/// The inputs of one player moved at random, by little or by much.
fn moved(random: &mut SplitMix64, iterate: &Iterate, player: usize) -> Vec<Input> {
    let [acceleration, steering] =
        [random.uniform(-3.0, -0.3), random.uniform(-3.5, -1.0)].map(|power| 10f64.powf(power));
    let moved = iterate.inputs[player].iter().map(|input| Input {
        acceleration_mps2: input.acceleration_mps2 + acceleration * random.uniform(-1.0, 1.0),
        steering_rad: input.steering_rad + steering * random.uniform(-1.0, 1.0),
    });
    moved.collect()
}

/// SplitMix64 deviations, which share nothing with the solver: no player gains by any of them.
#[test]
fn no_player_gains_by_a_random_deviation() {
    let mut random = SplitMix64::new(7);
    for players in 2..=3 {
        for game in 0..GAMES {
            let problem = joint_problem(&mut random, players);
            let found = solve(&problem);
            if !found.is_certified() {
                continue;
            }
            let iterate = &found.optimum.iterate;
            for player in 0..players {
                let alone = problem.alone(player, iterate);
                let cost = alone.cost_of(&[iterate.inputs[player].clone()]);
                for _ in 0..100 {
                    let deviation = alone.cost_of(&[moved(&mut random, iterate, player)]);
                    assert!(
                        cost - deviation <= TOLERATED_GAIN,
                        "game {game}: player {player} gains {}",
                        cost - deviation
                    );
                }
            }
        }
    }
}

/// Where the descent of the joint problem is cut short, best responses settle at an equilibrium, and no player gains there by any random
/// deviation.
#[test]
fn best_responses_converge_where_the_joint_descent_is_cut_short() {
    let mut random = SplitMix64::new(13);
    let mut settled = 0;
    for game in 0..GAMES {
        let problem = joint_problem(&mut random, 3);
        let mut joint = Optimiser::new(Robust::default()).searching(HomotopySearch::Off);
        let mut responses = joint.clone();
        joint.tolerances.work_limit = 20;
        let found = equilibrium(&mut joint, &mut responses, &problem, &[]).ok();
        let Some(found) = found.filter(|found| found.by_best_responses) else { continue };
        settled += 1;
        assert!(found.is_certified() && found.optimum.statistics.unfinished == 0, "game {game}: {:?}", found.gains);
        let iterate = &found.optimum.iterate;
        for player in 0..3 {
            let alone = problem.alone(player, iterate);
            let cost = alone.cost_of(&[iterate.inputs[player].clone()]);
            let deviations = (0..100).map(|_| alone.cost_of(&[moved(&mut random, iterate, player)]));
            let least = deviations.fold(f64::INFINITY, f64::min);
            assert!(cost - least <= TOLERATED_GAIN, "game {game}: player {player} gains {}", cost - least);
        }
    }
    assert!(settled >= 5, "responses were needed in {settled} games only");
}

/// Guesses that lead vehicles into one another are moved out of nearly all ellipses, at a lower cost; others stay.
#[test]
fn initial_guesses_of_games_lie_outside_the_safety_ellipses() {
    let mut random = SplitMix64::new(17);
    let (mut moved, mut left_inside) = (0, 0);
    for game in 0..3 * GAMES {
        let problem = joint_problem(&mut random, 2 + game % 3);
        let guess = problem.start(&[]);
        let start = problem.start(&problem.start_outside(&guess.inputs));
        let [before, after] = [&guess, &start].map(|iterate| problem.cost(iterate));
        if start == guess {
            continue;
        }
        moved += 1;
        let entries = [before, after].map(|cost| cost.violation(Violation::Safety));
        assert!(entries[0] > 1e-2 && after.total < before.total, "game {game}: {entries:?}");
        left_inside += usize::from(entries[1] > 1e-2);
    }
    assert!(moved >= GAMES && 10 * left_inside <= moved, "{moved} moved, {left_inside} of them still inside");
}

/// The game has a potential: whatever a player does alone changes its own cost and the joint cost by the same amount.
#[test]
fn a_change_by_one_player_changes_the_joint_cost_equally() {
    let mut random = SplitMix64::new(11);
    for players in [2, 3, 4] {
        let problem = joint_problem(&mut random, players);
        let iterate = problem.start(&[]);
        for player in 0..players {
            let alone = problem.alone(player, &iterate);
            let mut changed = iterate.inputs.clone();
            changed[player] = moved(&mut random, &iterate, player);
            let own = alone.cost_of(&[changed[player].clone()]) - alone.cost_of(&[iterate.inputs[player].clone()]);
            let joint = problem.cost_of(&changed) - problem.cost_of(&iterate.inputs);
            assert!((own - joint).abs() < 1e-9 * (1.0 + problem.cost_of(&changed)), "{own} against {joint}");
        }
    }
}

/// Most games are solved; the share is measured by the example `nash_games`.
#[test]
fn most_random_games_have_a_certified_equilibrium() {
    let mut random = SplitMix64::new(3);
    let certified = (0..GAMES).filter(|_| solve(&joint_problem(&mut random, 2)).is_certified()).count();
    assert!(certified >= GAMES - 1, "{certified} of {GAMES}");
}

/// A motion that is not an equilibrium is not certified: players whose joint descent takes one step for enough would gain by leaving.
#[test]
fn a_game_solution_far_from_an_optimum_is_not_certified() {
    let mut random = SplitMix64::new(5);
    let mut gains = 0;
    for _ in 0..GAMES {
        let problem = joint_problem(&mut random, 2);
        let mut joint = Optimiser::new(Robust::default()).searching(HomotopySearch::Off);
        let mut responses = joint.clone();
        joint.tolerances.residual = f64::INFINITY;
        let guess = vec![Vec::new(), Vec::new()];
        let Ok(found) = equilibrium(&mut joint, &mut responses, &problem, &guess) else { continue };
        gains += usize::from(found.largest_gain() > TOLERATED_GAIN || found.departures > 0);
    }
    assert!(gains > 0, "no player noticed");
}

/// In closed loop among drivers who are not players: no contact, every plan an equilibrium, and the lane is reached.
#[test]
fn a_nash_planner_changes_lane_among_humans() {
    for styles in [[Style::Nice; 2], [Style::Tough; 2]] {
        let run = run(lane_change(Driver::Nash(nash::Settings::default()), styles), 100);
        assert_eq!(run.collision, None, "{styles:?}");
        assert!(run.failures.is_empty(), "{styles:?}: {:?}", run.failures);
        // The whole body is in the left lane.
        let last = run.states.last().expect("states")[0];
        assert!(last.y_m > 0.37 + 0.095 && last.y_m < 0.74 - 0.095, "{styles:?}: {last:?}");
        assert!(run.plans.iter().any(|plan| plan.value_of(&PLAYERS).is_some_and(|players| players >= 2.0)));
        let gains = run.plans.iter().filter_map(|plan| plan.value_of(&DEVIATION_GAIN));
        assert!(gains.clone().all(f64::is_finite) && gains.filter(|gain| *gain > TOLERATED_GAIN).count() <= 5);
    }
}
