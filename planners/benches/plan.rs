//! What one plan and one quadratic programme cost, on the recorded problems.
//!
//! ```sh
//! cargo bench -p interplay-planners --bench plan
//! ```
//!
//! `plan/KIND/SOLVER`: a descent from the recorded guess (the last plan, shifted) to a local optimum; a sample goes through
//! the problems one after another, so the estimate is a mean over problems. Problems that a solver leaves unsolved count
//! like the others and are announced. `programme/KIND/SOLVER`: the first, Gauss-Newton, programme of a descent, cold.
//! The distribution over problems is printed by `tests/peers/bench.sh`.

#[path = "../tests/common/recorded.rs"]
mod recorded;

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkGroup, Criterion, SamplingMode, criterion_group, criterion_main, measurement::WallTime};
use interplay_planners::Input;
use interplay_planners::trajectory::{
    Optimiser, Problem, QpSubproblem, Sparse, StageQp, StageSolution, StageSolver, Structured,
};

/// Every how many problems the general solver, some hundred times slower, is measured on.
const SPARSE_STRIDE: usize = 20;

type Posed = (Problem, Vec<Vec<Input>>);

fn posed(kind: &str) -> Vec<Posed> {
    let recorded = recorded::load(kind).expect("the recorded problems are part of the repository");
    recorded.iter().map(|recorded| (recorded.problem(), recorded.guess())).collect()
}

fn plans(criterion: &mut Criterion) {
    for kind in recorded::KINDS {
        let all = posed(kind);
        let few: Vec<Posed> = all.iter().step_by(SPARSE_STRIDE).cloned().collect();
        let mut group = criterion.benchmark_group(format!("plan/{kind}"));
        plan(&mut group, "structured", &all, Structured::default());
        slowly(&mut group);
        plan(&mut group, "sparse", &few, Sparse::default());
        group.finish();
    }
}

fn plan<S: StageSolver + Default>(group: &mut BenchmarkGroup<WallTime>, name: &str, posed: &[Posed], solver: S) {
    let mut optimiser = Optimiser::new(solver);
    let failed = posed.iter().filter(|(problem, guess)| optimiser.descend(problem, guess).is_err()).count();
    let name = if failed == 0 { name.to_owned() } else { format!("{name} ({failed} of {} unsolved)", posed.len()) };
    let mut next = posed.iter().cycle();
    group.bench_function(name, |bencher| {
        bencher.iter(|| next.next().map(|(problem, guess)| black_box(optimiser.descend(problem, guess))));
    });
}

fn programmes(criterion: &mut Criterion) {
    for kind in recorded::KINDS {
        let all: Vec<StageQp> = posed(kind).iter().map(first_programme).collect();
        let few: Vec<StageQp> = all.iter().step_by(SPARSE_STRIDE).cloned().collect();
        let mut group = criterion.benchmark_group(format!("programme/{kind}"));
        programme(&mut group, "structured", &all, Structured::default());
        slowly(&mut group);
        programme(&mut group, "sparse", &few, Sparse::default());
        group.finish();
    }
}

fn programme<S: StageSolver>(group: &mut BenchmarkGroup<WallTime>, name: &str, qps: &[StageQp], mut solver: S) {
    let mut solution = StageSolution::default();
    let mut next = qps.iter().cycle();
    group.bench_function(name, |bencher| {
        bencher.iter(|| next.next().map(|qp| black_box(solver.solve(qp, &mut solution, false))));
    });
}

/// The programme that a descent from the guess begins with.
fn first_programme((problem, guess): &Posed) -> StageQp {
    let mut step = QpSubproblem::default();
    step.linearize(problem, &problem.start(guess));
    step.qp
}

fn slowly(group: &mut BenchmarkGroup<WallTime>) {
    group.sampling_mode(SamplingMode::Flat).sample_size(10).measurement_time(Duration::from_secs(3));
}

criterion_group! {
    name = benches;
    config = Criterion::default().without_plots();
    targets = plans, programmes
}
criterion_main!(benches);
