//! What the solution of one persuasion game costs, over stakes as they arise from random intentions.
//!
//! ```sh
//! cargo bench -p interplay-planners --bench game
//! ```

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use interplay_planners::drivers::game::equilibrium::{GameSolution, leader_follower, nash};
use interplay_planners::drivers::game::payoff::{Player, Stakes, TabulatedTheory};
use interplay_planners::drivers::game::prospect::ProspectTheory;

type Solve = fn(&Player, &Player) -> GameSolution;

/// Stakes of ego and other for intentions on a grid: own, seen, the other's.
fn games() -> Vec<[Stakes; 2]> {
    let levels = [0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95];
    let stakes = |own: f64, seen: f64, theirs: f64| {
        [Stakes { turn: own / theirs, accident: 2.0 }, Stakes { turn: theirs / seen, accident: 2.0 }]
    };
    let pairs = levels.into_iter().flat_map(|own| levels.into_iter().map(move |seen| (own, seen)));
    pairs.flat_map(|(own, seen)| levels.into_iter().map(move |theirs| stakes(own, seen, theirs))).collect()
}

fn solutions(criterion: &mut Criterion) {
    let (theory, games) = (TabulatedTheory::new(ProspectTheory::default()), games());
    let solvers: [(&str, Solve); 2] = [("leader-follower", leader_follower), ("nash", nash)];
    for (name, solve) in solvers {
        let mut next = games.iter().cycle();
        criterion.bench_function(&format!("game/{name}"), |bencher| {
            bencher.iter(|| {
                let stakes = next.next().map(|stakes| stakes.map(|stakes| theory.player(stakes)));
                stakes.map(|[ego, other]| black_box(solve(&ego, &other)))
            });
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().without_plots();
    targets = solutions
}
criterion_main!(benches);
