//! The semidefinite cone on problems whose answers are known.

use interplay_convex::{Program, SolveError, Solver, SolverSettings, residuals, triangle};
use nalgebra::DMatrix;
use proptest::prelude::*;

fn symmetric(order: usize, values: &[f64]) -> DMatrix<f64> {
    let raw = DMatrix::from_column_slice(order, order, values);
    (&raw + raw.transpose()) * 0.5
}

/// min λ s.t. λ I − C ⪰ 0.
fn largest_eigenvalue(c: &DMatrix<f64>) -> Program {
    let mut program = Program::new();
    let lambda = program.variables("λ", 1).at(0);
    program.linear(lambda, 1.0);
    let block = program.semidefinite("λ I − C", c.nrows());
    for (i, j, weight) in triangle(c.nrows()) {
        let own = if i == j { -1.0 } else { 0.0 };
        program.row(block, [(lambda, own)], -weight * c[(i, j)]);
    }
    program
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn semidefinite_programming_finds_the_largest_eigenvalue(order in 1..8_usize, values in proptest::collection::vec(-3.0..3.0, 49)) {
        let c = symmetric(order, &values[..order * order]);
        let program = largest_eigenvalue(&c);
        let mut solver = Solver::new(&program, &SolverSettings::default()).expect("well-formed");
        let solution = solver.solve().expect("solvable");
        prop_assert!((solution.objective - c.symmetric_eigenvalues().max()).abs() < 1e-6);
        prop_assert!(residuals(&program, &solution).expect("well-formed").largest() < 1e-6);
    }

    #[test]
    fn the_nearest_semidefinite_matrix_drops_negative_eigenvalues(order in 2..7_usize, values in proptest::collection::vec(-3.0..3.0, 36)) {
        let c = symmetric(order, &values[..order * order]);
        let mut program = Program::new();
        let x = program.variables("X", order * (order + 1) / 2);
        let block = program.semidefinite("X", order);
        for ((i, j, weight), x) in triangle(order).zip(x.iter()) {
            program.quadratic(x, x, 1.0);
            program.linear(x, -weight * c[(i, j)]);
            program.row(block, [(x, -1.0)], 0.0);
        }
        let solution = Solver::new(&program, &SolverSettings::default()).expect("well-formed").solve().expect("solvable");
        let eigen = c.clone().symmetric_eigen();
        let positive = DMatrix::from_diagonal(&eigen.eigenvalues.map(|v| v.max(0.0)));
        let nearest = &eigen.eigenvectors * positive * eigen.eigenvectors.transpose();
        // ½ ‖X − C‖² is strongly convex: half of the squared distance to its optimum is at most what the cost is above it.
        let distance2: f64 = (triangle(order).zip(x.iter()))
            .map(|((i, j, weight), x)| (solution.at(x) - weight * nearest[(i, j)]).powi(2))
            .sum();
        let size = 1.0 + c.norm_squared();
        prop_assert!(0.5 * distance2 < 1e-7 * size, "{distance2:e}");
    }

    #[test]
    fn an_updated_semidefinite_problem_matches_a_new_one(one in proptest::collection::vec(-3.0..3.0, 25), other in proptest::collection::vec(-3.0..3.0, 25)) {
        let (one, other) = (largest_eigenvalue(&symmetric(5, &one)), largest_eigenvalue(&symmetric(5, &other)));
        let mut solver = Solver::new(&one, &SolverSettings::default()).expect("well-formed");
        solver.solve().expect("solvable");
        solver.update(&other).expect("same pattern");
        let updated = solver.solve().expect("solvable");
        let fresh = Solver::new(&other, &SolverSettings::default()).expect("well-formed").solve().expect("solvable");
        prop_assert_eq!(updated, fresh);
    }
}

/// The Lovász number of a cycle of five is √5.
#[test]
fn the_lovasz_number_of_the_pentagon_is_the_square_root_of_five() {
    let order = 5;
    let mut program = Program::new();
    let x = program.variables("X", order * (order + 1) / 2);
    let block = program.semidefinite("X", order);
    let (trace, edges) = (program.equal("trace"), program.equal("edges"));
    let mut diagonal = Vec::new();
    for ((i, j, weight), x) in triangle(order).zip(x.iter()) {
        program.linear(x, -weight);
        program.row(block, [(x, -1.0)], 0.0);
        if i == j {
            diagonal.push((x, 1.0));
        } else if j - i == 1 || j - i == order - 1 {
            program.row(edges, [(x, 1.0)], 0.0);
        }
    }
    program.row(trace, diagonal, 1.0);
    let solution = Solver::new(&program, &SolverSettings::default()).expect("well-formed").solve().expect("solvable");
    assert!((solution.objective + 5.0_f64.sqrt()).abs() < 1e-6, "{}", solution.objective);
    assert!(solution.residuals.largest() < 1e-6, "{:?}", solution.residuals);
}

/// A Lyapunov inequality AᵀPA − P ⪯ −I has a solution exactly when A is stable.
#[test]
fn a_lyapunov_inequality_is_feasible_for_a_stable_matrix_only() {
    let solve = |a: [[f64; 2]; 2]| {
        let mut program = Program::new();
        let p = program.variables("P", 3);
        let decrease = program.semidefinite("P − AᵀPA − I", 2);
        let positive = program.semidefinite("P", 2);
        // P = Σ p_k E_k over the symmetric units; the coefficient of p_k in −(P − AᵀPA).
        let unit = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [1.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]]];
        for (i, j, weight) in triangle(2) {
            let coefficient = |e: [[f64; 2]; 2]| {
                let mut moved = 0.0;
                for k in 0..2 {
                    for l in 0..2 {
                        moved += a[k][i] * e[k][l] * a[l][j];
                    }
                }
                weight * (moved - e[i][j])
            };
            let identity = if i == j { 1.0 } else { 0.0 };
            program.row(decrease, p.iter().zip(unit).map(|(p, e)| (p, coefficient(e))), -identity);
            program.row(positive, p.iter().zip(unit).map(|(p, e)| (p, -weight * e[i][j])), 0.0);
        }
        for (p, weight) in p.iter().zip([1.0, 0.0, 1.0]) {
            program.linear(p, weight);
        }
        Solver::new(&program, &SolverSettings::default()).expect("well-formed").solve()
    };
    assert!(solve([[0.9, 5.0], [0.0, 0.8]]).is_ok());
    let error = solve([[1.1, 0.0], [0.3, 0.5]]).expect_err("unstable");
    assert!(matches!(error, SolveError::PrimalInfeasible { .. }), "{error}");
}
