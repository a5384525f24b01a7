//! The hot loop and nothing else, for counting its instructions (`tests/instructions/count.sh`): the first QP subproblem of
//! every tenth recorded plan, solved from nothing by the structured solver.

#[path = "../tests/common/recorded.rs"]
mod recorded;

use std::error::Error;
use std::hint::black_box;
use std::io::Write;

use interplay_planners::trajectory::{QpSubproblem, StageQp, StageSolution, StageSolver, Structured};

fn main() -> Result<(), Box<dyn Error>> {
    let kind = std::env::args().nth(1).ok_or("usage: hot_loop KIND")?;
    let mut programmes = Vec::new();
    for recorded in recorded::load(&kind)?.iter().step_by(10) {
        let problem = recorded.problem();
        let mut step = QpSubproblem::default();
        step.linearize(&problem, &problem.start(&recorded.guess()));
        programmes.push(step.qp);
    }
    let iterations = solve_all(&programmes)?;
    writeln!(std::io::stdout(), "{iterations}")?;
    Ok(())
}

/// Iterations in all. A function of its own, so that a profiler can count what happens inside it.
#[inline(never)]
fn solve_all(programmes: &[StageQp]) -> Result<usize, Box<dyn Error>> {
    let (mut solver, mut solution) = (Structured::default(), StageSolution::default());
    let mut iterations = 0;
    for qp in programmes {
        solver.solve(black_box(qp), &mut solution, false)?;
        iterations += solution.iterations;
    }
    Ok(iterations)
}
