//! Plans with several futures: one vehicle whose first inputs are the same in all of them.

mod common;

use common::{HORIZON, SplitMix64, futures};
use interplay_planners::Input;
use interplay_planners::trajectory::HomotopySearch;
use interplay_planners::trajectory::terms::{Comfort, KeepOut, RoadEdge, Tracking};
use interplay_planners::trajectory::{DescentError, Optimiser, Optimum, Problem, Robust, Term};

fn solve(problem: &Problem) -> Result<Optimum, DescentError> {
    Optimiser::new(Robust::default()).searching(HomotopySearch::Off).optimise(problem, &[])
}

/// The problem of one future, with the weights that it has among all.
fn alone(problem: &Problem, future: usize) -> Problem {
    problem.alone(future, &problem.start(&[]))
}

/// The term of the only vehicle of a problem, as that of another number.
fn moved_to(term: &Term, vehicle: usize) -> Term {
    match term.clone() {
        Term::Comfort(term) => Term::Comfort(Comfort { vehicle, ..term }),
        Term::Tracking(term) => Term::Tracking(Tracking { vehicle, ..term }),
        Term::RoadEdge(term) => Term::RoadEdge(RoadEdge { vehicle, ..term }),
        Term::KeepOut(term) => Term::KeepOut(KeepOut { vehicle, ..term }),
        other => other,
    }
}

#[test]
fn branches_share_their_first_inputs_and_then_differ() {
    let mut differ = 0;
    for seed in 0..20 {
        let shared_steps = 1 + seed as usize % 12;
        let found = solve(&futures(seed, 3, shared_steps)).expect("an optimum");
        let [one, two, three] = &found.iterate.inputs[..] else { panic!("three futures") };
        assert_eq!(one[..shared_steps], two[..shared_steps]);
        assert_eq!(one[..shared_steps], three[..shared_steps]);
        let apart =
            |a: &[Input], b: &[Input]| (a[shared_steps].acceleration_mps2 - b[shared_steps].acceleration_mps2).abs();
        differ += usize::from(apart(one, two) > 1e-3);
    }
    assert!(differ > 5, "{differ} of 20");
}

/// Not knowing the future costs something: knowing it from the begin is never dearer, and having to decide everything now never
/// cheaper.
#[test]
fn learning_the_future_later_costs_more() {
    let mut dearer = 0;
    for seed in 0..20 {
        let known: f64 =
            (0..2).map(|future| solve(&alone(&futures(seed, 2, 0), future)).expect("an optimum").cost.total).sum();
        // Each is started at the one that knows less, whose plan it could follow.
        let mut costs = Vec::new();
        let mut guess = Vec::new();
        for shared_steps in [HORIZON - 1, 12, 4] {
            let problem = futures(seed, 2, shared_steps);
            let found = Optimiser::new(Robust::default())
                .searching(HomotopySearch::Off)
                .optimise(&problem, &guess)
                .expect("an optimum");
            costs.push(found.cost.total);
            guess = found.iterate.inputs;
        }
        let tolerance = 1e-6 * (1.0 + costs[0]);
        assert!(costs.windows(2).all(|pair| pair[1] <= pair[0] + tolerance), "seed {seed}: {costs:?}");
        dearer += usize::from(costs[2] > known + tolerance);
    }
    assert!(dearer > 5, "{dearer} of 20");
}

/// With the same future everywhere the plan is that of one vehicle, whatever is shared.
#[test]
fn equal_futures_give_the_plan_of_one_future() {
    for seed in 0..10 {
        let one = futures(seed, 1, 0);
        let guess = one.start(&[]).inputs[0].clone();
        let single = solve(&one).expect("an optimum");
        let mut twice = futures(seed, 2, 7);
        twice.terms = (0..2).flat_map(|future| one.terms.iter().map(move |term| moved_to(term, future))).collect();
        let found = Optimiser::new(Robust::default())
            .searching(HomotopySearch::Off)
            .optimise(&twice, &[guess.clone(), guess])
            .expect("an optimum");
        assert!((found.cost.total - 2.0 * single.cost.total).abs() < 1e-6 * (1.0 + single.cost.total), "seed {seed}");
        let apart = |t: usize| (found.iterate.states[1][t].x_m - single.iterate.states[0][t].x_m).abs();
        assert!((0..=HORIZON).all(|t| apart(t) < 1e-4), "seed {seed}");
    }
}

/// No small change of the inputs, shared where they are to be, makes an optimum cheaper.
#[test]
fn no_admissible_change_makes_an_optimum_cheaper() {
    let mut random = SplitMix64::new(3);
    for seed in 0..10 {
        let problem = futures(seed, 3, 6);
        let found = solve(&problem).expect("an optimum");
        for _ in 0..200 {
            let size = 10f64.powf(random.uniform(-4.0, -1.0));
            let guess = found.iterate.inputs.iter().map(|inputs| {
                let moved = inputs.iter().map(|input| Input {
                    acceleration_mps2: input.acceleration_mps2 + size * random.uniform(-1.0, 1.0),
                    steering_rad: input.steering_rad + 0.1 * size * random.uniform(-1.0, 1.0),
                });
                moved.collect()
            });
            let cost = problem.cost_of(&guess.collect::<Vec<Vec<Input>>>());
            assert!(cost > found.cost.total - 1e-7, "seed {seed}: {cost} below {}", found.cost.total);
        }
    }
}
