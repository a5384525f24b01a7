//! What an update may change, and what it refuses.

use interplay_convex::{Block, Cone, ProblemError, ProblemPlace, Program, Solver, SolverSettings, Variables};

/// min ½(x − target)² + 0·xy with y = x and x ≤ limit.
struct Follow {
    program: Program,
    x: Variables,
    same: Block,
    limit: Block,
}

impl Follow {
    fn new() -> Self {
        let mut program = Program::new();
        let x = program.variables("x", 2);
        let same = program.equal("same");
        let limit = program.at_most("limit");
        let mut follow = Self { program, x, same, limit };
        follow.write(1.0, 2.0, 0.0);
        follow
    }

    fn write(&mut self, target: f64, limit: f64, coupling: f64) {
        let [x, y] = [0, 1].map(|i| self.x.at(i));
        self.program.clear();
        self.program.quadratic(x, x, 1.0);
        self.program.quadratic(x, y, coupling);
        self.program.linear(x, -target);
        self.program.row(self.same, [(x, 1.0), (y, -1.0)], 0.0);
        self.program.row(self.limit, [(x, 1.0), (y, coupling)], limit);
    }

    fn solver(&self) -> Solver {
        Solver::new(&self.program, &SolverSettings::default()).expect("well-formed")
    }
}

#[test]
fn an_updated_solver_tracks_a_moving_target_and_keeps_zero_entries() {
    let mut follow = Follow::new();
    let mut solver = follow.solver();
    for k in 0..20 {
        let target = 0.25 * f64::from(k) - 1.0;
        let coupling = if k % 3 == 0 { 0.0 } else { 0.5 };
        follow.write(target, 2.1, coupling);
        solver.update(&follow.program).expect("the same pattern");
        let solution = solver.solve().expect("solvable");
        // With y = x: ½x² + c x² − t x, and (1 + c) x ≤ 2.1, which is never just met by the free minimum.
        let want = (target / (1.0 + 2.0 * coupling)).min(2.1 / (1.0 + coupling));
        assert!((solution.at(follow.x.at(0)) - want).abs() < 1e-6, "{k}: {solution:?}");
        assert!((solution.at(follow.x.at(1)) - want).abs() < 1e-6, "{k}: {solution:?}");
    }
}

#[test]
fn solving_twice_gives_the_same_bits() {
    let mut solver = Follow::new().solver();
    assert_eq!(solver.solve(), solver.solve());
}

#[test]
fn a_result_does_not_depend_on_earlier_problems() {
    let mut follow = Follow::new();
    let mut solver = follow.solver();
    let want = solver.solve();
    for (target, limit, coupling) in [(1e9, 1e-6, 1e6), (0.0, 0.0, 0.0), (-1e-9, -1e9, 1e-9)] {
        let mut other = Follow::new();
        other.write(target, limit, coupling);
        solver.update(&other.program).expect("the same pattern");
        let _ = solver.solve();
    }
    follow.write(1.0, 2.0, 0.0);
    solver.update(&follow.program).expect("the same pattern");
    assert_eq!(solver.solve(), want);
}

#[test]
fn a_changed_pattern_is_refused_by_its_place_and_leaves_the_solver_unchanged() {
    let follow = Follow::new();
    let mut solver = follow.solver();
    let before = solver.solve();
    let mut refused = |change: &dyn Fn(&mut Program), place: ProblemPlace| {
        let mut program = follow.program.clone();
        change(&mut program);
        assert_eq!(solver.update(&program), Err(ProblemError::PatternChanged { place }));
    };
    let (x, y) = (follow.x.at(0), follow.x.at(1));
    let block = |name: &str| ProblemPlace::Block { name: name.to_owned() };
    refused(
        &|p| {
            p.variables("more", 1);
        },
        ProblemPlace::Variables,
    );
    refused(
        &|p| {
            p.equal("more");
        },
        ProblemPlace::Blocks,
    );
    refused(&|p| p.quadratic(y, y, 0.0), ProblemPlace::QuadraticCost);
    refused(&|p| p.row(follow.limit, [(x, 1.0)], 1.0), block("limit"));
    refused(&|p| p.row(follow.same, [(x, 1.0)], 1.0), block("same"));
    refused(&Program::clear, ProblemPlace::QuadraticCost);
    assert_eq!(solver.solve(), before);
}

#[test]
fn a_changed_cone_with_unchanged_rows_is_refused() {
    let program = |cone| {
        let mut program = Program::new();
        let x = program.variables("x", 1).at(0);
        let limit = program.block("limit", cone);
        program.row(limit, [(x, 1.0)], 1.0);
        program
    };
    let inequality = program(Cone::Nonnegative);
    let mut solver = Solver::new(&inequality, &SolverSettings::default()).expect("well-formed");
    let place = ProblemPlace::Block { name: "limit".to_owned() };
    let refusal = solver.update(&program(Cone::Zero));
    assert_eq!(refusal, Err(ProblemError::PatternChanged { place }));
    assert_eq!(solver.update(&inequality), Ok(()));
}

#[test]
fn a_refused_number_leaves_the_solver_unchanged() {
    let mut follow = Follow::new();
    let mut solver = follow.solver();
    let before = solver.solve();
    follow.write(5.0, f64::INFINITY, 0.0);
    let error = solver.update(&follow.program).expect_err("an infinite limit");
    assert!(matches!(error, ProblemError::NotFinite { .. }), "{error}");
    assert_eq!(solver.solve(), before);
}
