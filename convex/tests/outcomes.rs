//! Every way a problem can end: solved, infeasible, unbounded, unsolved, refused.

use interplay_convex::{
    Block, ConicSolution, ProblemError, ProblemPlace, Program, RowPlace, SolveError, Solver, SolverSettings, Status,
    VariablePlace, Variables,
};

fn solver(program: &Program) -> Solver {
    Solver::new(program, &SolverSettings::default()).expect("well-formed")
}

fn refusal(program: &Program) -> ProblemError {
    Solver::new(program, &SolverSettings::default()).expect_err("malformed")
}

/// min ½‖x − (3, 4)‖² within the disc of the given radius.
fn disc(radius: f64) -> (Program, Variables, Block) {
    let mut program = Program::new();
    let x = program.variables("x", 2);
    let disc = program.second_order("disc", 3);
    for (variable, target) in x.iter().zip([3.0, 4.0]) {
        program.quadratic(variable, variable, 1.0);
        program.linear(variable, -target);
    }
    program.row(disc, [], radius);
    program.row(disc, [(x.at(0), -1.0)], 0.0);
    program.row(disc, [(x.at(1), -1.0)], 0.0);
    (program, x, disc)
}

#[test]
fn projection_onto_a_disc_matches_its_closed_form() {
    for radius in [0.5_f64, 1.0, 4.0, 10.0] {
        let (program, x, disc) = disc(radius);
        let solution = solver(&program).solve().expect("solvable");
        let shrink = (radius / 5.0).min(1.0);
        let value = solution.value(x);
        assert!((value[0] - 3.0 * shrink).abs() < 1e-6, "{radius}: {value:?}");
        assert!((value[1] - 4.0 * shrink).abs() < 1e-6, "{radius}: {value:?}");
        // The multiplier of ‖x‖ ≤ r is the distance left over, and bounds that of the vector part.
        let dual = solution.dual(disc);
        assert!((dual[0] - (5.0 - radius).max(0.0)).abs() < 1e-5, "{radius}: {dual:?}");
        assert!((solution.slack(disc)[0] - radius).abs() < 1e-12);
        assert!(!solution.almost);
    }
}

#[test]
fn duals_have_the_documented_sign() {
    // min ½x² with x = 3 has cost ½b², whose derivative at b = 3 is 3 = −z.
    let mut program = Program::new();
    let x = program.variables("x", 1).at(0);
    let fixed = program.equal("fixed");
    program.quadratic(x, x, 1.0);
    program.row(fixed, [(x, 1.0)], 3.0);
    let solution = solver(&program).solve().expect("solvable");
    assert!((solution.dual(fixed)[0] + 3.0).abs() < 1e-6);
    assert!((solution.objective - 4.5).abs() < 1e-6);

    // min −2x with x ≤ 1: raising the bound by one lowers the cost by two.
    let mut program = Program::new();
    let x = program.variables("x", 1).at(0);
    let bound = program.at_most("bound");
    program.linear(x, -2.0);
    program.row(bound, [(x, 1.0)], 1.0);
    let solution = solver(&program).solve().expect("solvable");
    assert!((solution.dual(bound)[0] - 2.0).abs() < 1e-6);
}

#[test]
fn off_diagonal_costs_count_once_and_repeated_entries_add_up() {
    // ½(2x² + 2xy + 2y²) − 3x − 3y has its minimum where 2x + y = 3 = x + 2y.
    let mut program = Program::new();
    let [x, y] = ["x", "y"].map(|name| program.variables(name, 1).at(0));
    for v in [x, y] {
        program.quadratic(v, v, 1.5);
        program.quadratic(v, v, 0.5);
        program.linear(v, -3.0);
    }
    program.quadratic(x, y, 0.25);
    program.quadratic(y, x, 0.75);
    let solution = solver(&program).solve().expect("solvable without rows");
    assert!((solution.at(x) - 1.0).abs() < 1e-7 && (solution.at(y) - 1.0).abs() < 1e-7);
    assert!((solution.objective + 3.0).abs() < 1e-7);
}

#[test]
fn rows_of_several_blocks_may_be_interleaved() {
    // x₀ = 1, xₖ₊₁ = ½xₖ, xₖ ≥ 0.2: least sum.
    let mut program = Program::new();
    let x = program.variables("x", 3);
    let (halving, floor, empty) = (program.at_most("halving"), program.at_most("floor"), program.equal("empty"));
    for k in 0..3 {
        program.linear(x.at(k), 1.0);
        program.row(floor, [(x.at(k), -1.0)], -0.2);
        if k > 0 {
            program.row(halving, [(x.at(k - 1), 0.5), (x.at(k), -1.0)], 0.0);
        } else {
            program.row(halving, [(x.at(0), -1.0)], -1.0);
        }
    }
    let solution = solver(&program).solve().expect("solvable");
    for (value, want) in solution.value(x).iter().zip([1.0, 0.5, 0.25]) {
        assert!((value - want).abs() < 1e-6);
    }
    assert!(solution.slack(floor)[2] > 0.04 && solution.slack(halving)[2].abs() < 1e-6);
    assert!(solution.dual(empty).is_empty());
}

/// x ≥ 2 and x ≤ 1, beside an innocent y ≤ 5.
fn infeasible() -> Program {
    let mut program = Program::new();
    let [x, y] = ["x", "y"].map(|name| program.variables(name, 1).at(0));
    let [floor, ceiling, innocent] = ["floor", "ceiling", "innocent"].map(|name| program.at_most(name));
    program.quadratic(x, x, 1.0);
    program.quadratic(y, y, 1.0);
    program.row(floor, [(x, -1.0)], -2.0);
    program.row(ceiling, [(x, 1.0)], 1.0);
    program.row(innocent, [(y, 1.0)], 5.0);
    program
}

#[test]
fn an_infeasible_problem_names_its_rows_and_has_a_certificate() {
    let error = solver(&infeasible()).solve().expect_err("infeasible");
    let message = error.to_string();
    let SolveError::PrimalInfeasible { conflict, certificate, .. } = error else {
        panic!("wrong error: {message}");
    };
    assert_eq!(conflict, ["floor", "ceiling"]);
    assert!(message.contains("`floor`, `ceiling`"), "{message}");
    // bᵀz = −1 with Aᵀz = 0 and z ≥ 0 has the solution z = (1, 1, 0).
    for (value, want) in certificate.iter().zip([1.0, 1.0, 0.0]) {
        assert!((value - want).abs() < 1e-5, "{certificate:?}");
    }
}

/// x free to fall at constant cost per unit, beside a y that the quadratic cost holds.
fn unbounded() -> Program {
    let mut program = Program::new();
    let [x, y] = ["x", "y"].map(|name| program.variables(name, 1).at(0));
    let ceiling = program.at_most("ceiling");
    program.linear(x, 1.0);
    program.quadratic(y, y, 1.0);
    program.linear(y, -2.0);
    program.row(ceiling, [(x, 1.0)], 1.0);
    program
}

#[test]
fn an_unbounded_problem_names_its_variables_and_has_a_certificate() {
    let error = solver(&unbounded()).solve().expect_err("unbounded");
    let SolveError::DualInfeasible { unbounded, certificate, .. } = &error else {
        panic!("wrong error: {error}");
    };
    assert_eq!(unbounded, &["x"]);
    assert!((certificate[0] + 1.0).abs() < 1e-5 && certificate[1].abs() < 1e-5);
}

#[test]
fn the_iteration_limit_leaves_a_problem_unsolved() {
    let settings = SolverSettings { iteration_limit: 1, ..SolverSettings::default() };
    let outcome = Solver::new(&disc(1.0).0, &settings).expect("well-formed").solve();
    let want = SolveError::Unsolved { status: Status::IterationLimit, iterations: 1 };
    assert_eq!(outcome, Err(want));
}

/// What comes of a problem when the solver is stopped after 1, 2, … iterations, up to the last but one it needs.
fn stopped_early(program: &Program, accepted_tolerance: f64) -> Vec<Result<ConicSolution, SolveError>> {
    let outcome = |iteration_limit| {
        let settings = SolverSettings { iteration_limit, accepted_tolerance, ..SolverSettings::default() };
        Solver::new(program, &settings).expect("well-formed").solve()
    };
    let needed = match outcome(200) {
        Ok(solution) => solution.iterations,
        Err(
            SolveError::PrimalInfeasible { iterations, .. }
            | SolveError::DualInfeasible { iterations, .. }
            | SolveError::Unsolved { iterations, .. },
        ) => iterations,
    };
    (1..needed).map(outcome).collect()
}

fn statuses(outcomes: &[Result<ConicSolution, SolveError>]) -> Vec<Status> {
    let status = |outcome: &Result<_, _>| match outcome {
        Err(SolveError::Unsolved { status, .. }) => Some(*status),
        _ => None,
    };
    outcomes.iter().filter_map(status).collect()
}

#[test]
fn an_almost_solved_problem_is_accepted_by_its_residuals_only() {
    let program = disc(1.0).0;
    let generous = stopped_early(&program, 1e-3);
    let accepted: Vec<_> = generous.iter().flatten().collect();
    assert!(!accepted.is_empty(), "no early stop was accepted: {generous:?}");
    for solution in accepted {
        assert!(solution.almost && solution.residuals.largest() <= 1e-3, "{solution:?}");
    }

    let strict = stopped_early(&program, 1e-15);
    assert!(strict.iter().all(Result::is_err), "{strict:?}");
    assert!(statuses(&strict).contains(&Status::AlmostSolved), "{strict:?}");
}

#[test]
fn an_almost_infeasible_problem_is_accepted_by_its_certificate_only() {
    for (program, status) in
        [(infeasible(), Status::AlmostPrimalInfeasible), (unbounded(), Status::AlmostDualInfeasible)]
    {
        let generous = stopped_early(&program, 0.1);
        let certified = generous
            .iter()
            .flat_map(|outcome| outcome.as_ref().err())
            .any(|error| matches!(error, SolveError::PrimalInfeasible { .. } | SolveError::DualInfeasible { .. }));
        assert!(certified, "no early stop was accepted: {generous:?}");
        let strict = stopped_early(&program, 1e-15);
        assert!(statuses(&strict).contains(&status), "{strict:?}");
    }
}

#[test]
fn malformed_problems_are_refused_by_name() {
    assert_eq!(refusal(&Program::new()), ProblemError::Empty);

    let mut program = Program::new();
    program.variables("x", 2);
    program.variables("x", 1);
    assert_eq!(refusal(&program), ProblemError::DuplicateName { name: "x".into() });

    let mut program = disc(1.0).0;
    let short = program.second_order("short", 3);
    program.row(short, [], 1.0);
    let want = ProblemError::ConeSize { block: "short".into(), rows: 1, dimension: 3 };
    assert_eq!(refusal(&program), want);

    let mut program = Program::new();
    program.variables("x", 1);
    program.second_order("flat", 0);
    let want = ProblemError::ConeSize { block: "flat".into(), rows: 0, dimension: 0 };
    assert_eq!(refusal(&program), want);
}

#[test]
fn variables_of_another_problem_are_refused() {
    let foreign = Program::new().variables("many", 9).at(8);
    let mut program = Program::new();
    let limit = program.at_most("limit");
    let x = program.variables("x", 2);
    program.row(limit, [(x.at(0), 1.0)], 1.0);
    let clean = program.clone();

    program.row(limit, [(x.at(0), 1.0), (foreign, 1.0)], 1.0);
    let place = ProblemPlace::Row(RowPlace { block: "limit".into(), row: 1 });
    assert_eq!(refusal(&program), ProblemError::NoSuchVariable { place, index: 8, count: 2 });

    let mut program = clean.clone();
    program.quadratic(foreign, x.at(0), 1.0);
    let place = ProblemPlace::QuadraticCost;
    assert_eq!(refusal(&program), ProblemError::NoSuchVariable { place, index: 8, count: 2 });

    let mut program = clean;
    program.linear(foreign, 1.0);
    let place = ProblemPlace::LinearCost;
    assert_eq!(refusal(&program), ProblemError::NoSuchVariable { place, index: 8, count: 2 });
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_their_place() {
    let write = |p: f64, q: f64, a: f64, b: f64| {
        let mut program = Program::new();
        let x = program.variables("speed", 2);
        let limit = program.at_most("limit");
        program.quadratic(x.at(0), x.at(1), p);
        program.linear(x.at(1), q);
        program.row(limit, [(x.at(1), a)], b);
        refusal(&program)
    };
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let speed = |index| VariablePlace { group: "speed".into(), index };
    let row = || RowPlace { block: "limit".into(), row: 0 };
    let stands = |error: ProblemError, want: ProblemPlace, shown: &str| {
        assert_eq!(error.to_string(), format!("{shown}: every number of a problem must be finite"));
        assert!(matches!(error, ProblemError::NotFinite { place, .. } if place == want), "not at {want:?}");
    };
    let quadratic = ProblemPlace::QuadraticCostOf(speed(0), speed(1));
    stands(write(nan, 0.0, 0.0, 0.0), quadratic, "the quadratic cost of speed[0] and speed[1] is NaN");
    let linear = ProblemPlace::LinearCostOf(speed(1));
    stands(write(0.0, inf, 0.0, 0.0), linear, "the linear cost of speed[1] is inf");
    let coefficient = ProblemPlace::Coefficient { variable: speed(1), row: row() };
    stands(write(0.0, 0.0, nan, 0.0), coefficient, "the coefficient of speed[1] in row 0 of block `limit` is NaN");
    let right_hand_side = ProblemPlace::RightHandSide(row());
    stands(write(0.0, 0.0, 0.0, inf), right_hand_side, "the right-hand side of row 0 of block `limit` is inf");
}

#[test]
fn a_concave_cost_is_refused() {
    let mut program = Program::new();
    let x = program.variables("x", 3);
    program.quadratic(x.at(2), x.at(2), 1.0);
    program.quadratic(x.at(2), x.at(2), -1.5);
    let want = ProblemError::NegativeCurvature { variable: VariablePlace { group: "x".into(), index: 2 }, value: -0.5 };
    assert_eq!(refusal(&program), want);
}

#[test]
fn settings_out_of_range_are_refused() {
    let program = disc(1.0).0;
    let default = SolverSettings::default();
    let bad = [
        SolverSettings { tolerance: 0.0, ..default },
        SolverSettings { tolerance: f64::NAN, ..default },
        SolverSettings { accepted_tolerance: 2.0, ..default },
        SolverSettings { iteration_limit: 0, ..default },
    ];
    for settings in bad {
        let error = Solver::new(&program, &settings).expect_err("out of range");
        assert!(matches!(error, ProblemError::Setting { .. }), "{error}");
    }
}

#[test]
fn a_solver_may_move_between_threads() {
    fn check<T: Send + Sync>() {}
    check::<Solver>();
}

#[test]
#[should_panic(expected = "variable 2 of a group of 2")]
fn reading_a_variable_beyond_its_group_panics() {
    let _ = Program::new().variables("x", 2).at(2);
}
