//! The sequential method as a whole.

mod common;

use common::{alone, pair};
use interplay_planners::Input;
use interplay_planners::mpc::{Optimiser, Problem, Sparse, Structured};

fn guess(problem: &Problem) -> Vec<Vec<Input>> {
    vec![vec![Input::default(); problem.horizon]; problem.participants.len()]
}

#[test]
fn both_solvers_lead_to_optima_of_the_same_cost() {
    for seed in 0..40 {
        for problem in [alone(seed), pair(seed, 1.3)] {
            let start = guess(&problem);
            let clock = std::time::Instant::now();
            let ours = Optimiser::new(Structured::default()).descend(&problem, &start);
            let took = clock.elapsed().as_micros();
            let theirs = Optimiser::new(Sparse::default()).descend(&problem, &start);
            let took2 = clock.elapsed().as_micros() - took;
            match (&ours, &theirs) {
                (Ok(a), Ok(b)) => println!(
                    "{seed} {took} {took2} {:.9} {:.9} {:?} {:?}",
                    a.cost.total, b.cost.total, a.statistics, b.statistics
                ),
                _ => println!(
                    "{seed} {took} {took2} {:?} {:?}",
                    ours.as_ref().map(|o| (o.cost, o.statistics)),
                    theirs.as_ref().map(|o| (o.cost, o.statistics))
                ),
            }
        }
    }
}
