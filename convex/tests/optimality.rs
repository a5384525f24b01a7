//! Random problems with an optimum known by construction, and the laws that solutions and updates obey.
//!
//! Choose x*, and for every row a complementary pair s* ∈ K, z* ∈ K*, s*ᵀz* = 0. With b = Ax* + s* and
//! q = −Px* − Aᵀz*, the pair (x*, z*) satisfies the optimality conditions of the problem (P, q, A, b, K).

use interplay_convex::{
    Block, Cone, ConicSolution, ProblemError, ProblemPlace, Program, SolveError, Solver, SolverSettings, Variables,
    residuals,
};
use proptest::prelude::*;

const VARIABLES: usize = 6;
const EQUALITIES: usize = 2;
const INEQUALITIES: usize = 7;
const CONES: usize = 2;
const DIMENSION: usize = 4;
const ROWS: usize = EQUALITIES + INEQUALITIES + CONES * DIMENSION;

/// A dense problem and its optimum; blocks are stacked as equalities, inequalities, cones.
#[derive(Debug, Clone)]
struct Known {
    p: Vec<Vec<f64>>,
    q: Vec<f64>,
    a: Vec<Vec<f64>>,
    b: Vec<f64>,
    x: Vec<f64>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn numbers(count: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-2.0..2.0_f64, count)
}

/// About half of the entries are exactly zero: they must keep their place in the pattern.
fn sparse_matrix(rows: usize) -> impl Strategy<Value = Vec<Vec<f64>>> {
    let entry = prop_oneof![Just(0.0), -2.0..2.0_f64];
    prop::collection::vec(prop::collection::vec(entry, VARIABLES), rows)
}

/// Complementary (s, z): of an inequality one side is zero; of a cone, s is on its boundary and z on the
/// opposite one.
fn complementary(seed: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut s, mut z) = (vec![0.0; ROWS], vec![0.0; ROWS]);
    z[..EQUALITIES].copy_from_slice(&seed[..EQUALITIES]);
    let cones = EQUALITIES + INEQUALITIES;
    for i in EQUALITIES..cones {
        s[i] = seed[i].max(0.0);
        z[i] = (-seed[i]).max(0.0);
    }
    for start in (cones..ROWS).step_by(DIMENSION) {
        let vector = &seed[start + 1..start + DIMENSION];
        let norm = dot(vector, vector).sqrt();
        let weight = seed[start].abs();
        (s[start], z[start]) = (norm, weight * norm);
        for (k, v) in vector.iter().enumerate() {
            (s[start + 1 + k], z[start + 1 + k]) = (*v, -weight * v);
        }
    }
    (s, z)
}

/// P = MᵀM + curvature·I with M of fewer rows than columns.
fn known(curvature: f64) -> impl Strategy<Value = Known> {
    (sparse_matrix(3), sparse_matrix(ROWS), numbers(VARIABLES), numbers(ROWS)).prop_map(move |(m, a, x, seed)| {
        let mut p = vec![vec![0.0; VARIABLES]; VARIABLES];
        for (i, row) in p.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = m.iter().map(|r| r[i] * r[j]).sum();
            }
            row[i] += curvature;
        }
        let (s, z) = complementary(&seed);
        let b = a.iter().zip(&s).map(|(row, s)| dot(row, &x) + s).collect();
        let column = |j: usize| a.iter().map(|row| row[j]).collect::<Vec<f64>>();
        let q = (0..VARIABLES).map(|j| -dot(&p[j], &x) - dot(&column(j), &z)).collect();
        Known { p, q, a, b, x }
    })
}

struct Handles {
    x: Variables,
    blocks: [Block; 3],
}

fn declare(program: &mut Program) -> Handles {
    let x = program.variables("x", VARIABLES);
    let equal = program.equal("equal");
    let at_most = program.at_most("at most");
    let cones = program.second_order("cones", DIMENSION);
    Handles { x, blocks: [equal, at_most, cones] }
}

fn write(program: &mut Program, handles: &Handles, known: &Known) {
    let x = handles.x;
    for i in 0..VARIABLES {
        program.linear(x.at(i), known.q[i]);
        for j in i..VARIABLES {
            program.quadratic(x.at(i), x.at(j), known.p[i][j]);
        }
    }
    for (i, (row, b)) in known.a.iter().zip(&known.b).enumerate() {
        let block = usize::from(i >= EQUALITIES) + usize::from(i >= EQUALITIES + INEQUALITIES);
        program.row(handles.blocks[block], x.iter().zip(row.iter().copied()), *b);
    }
}

fn program(known: &Known) -> Program {
    let mut program = Program::new();
    let handles = declare(&mut program);
    write(&mut program, &handles, known);
    program
}

fn solve(program: &Program) -> Result<ConicSolution, SolveError> {
    Solver::new(program, &SolverSettings::default()).expect("well-formed").solve()
}

impl Known {
    fn objective(&self, x: &[f64]) -> f64 {
        let quadratic: f64 = self.p.iter().zip(x).map(|(row, xi)| xi * dot(row, x)).sum();
        0.5 * quadratic + dot(&self.q, x)
    }

    /// The four conditions from the dense data, sharing no code with the crate's own check.
    fn assert_optimal(&self, solution: &ConicSolution, tolerance: f64) {
        let (x, z) = (solution.point(), solution.duals());
        for j in 0..VARIABLES {
            let atz: f64 = self.a.iter().zip(z).map(|(row, z)| row[j] * z).sum();
            let gradient = dot(&self.p[j], x) + self.q[j] + atz;
            assert!(gradient.abs() < tolerance, "stationarity {gradient}");
        }
        let s: Vec<f64> = self.a.iter().zip(&self.b).map(|(row, b)| b - dot(row, x)).collect();
        assert!(s[..EQUALITIES].iter().all(|s| s.abs() < tolerance), "equalities {s:?}");
        let cones = EQUALITIES + INEQUALITIES;
        for i in EQUALITIES..cones {
            assert!(s[i] > -tolerance && z[i] > -tolerance, "inequality {}, {}", s[i], z[i]);
        }
        for start in (cones..ROWS).step_by(DIMENSION) {
            for v in [&s[start..start + DIMENSION], &z[start..start + DIMENSION]] {
                assert!(dot(&v[1..], &v[1..]).sqrt() < v[0] + tolerance, "cone {v:?}");
            }
        }
        let gap = dot(&s, z);
        assert!(gap.abs() < tolerance * (1.0 + solution.objective.abs()), "gap {gap}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn a_strictly_convex_problem_returns_its_known_optimum(known in known(0.1)) {
        let solution = solve(&program(&known)).expect("solvable by construction");
        let want = known.objective(&known.x);
        prop_assert!((solution.objective - want).abs() < 1e-6 * (1.0 + want.abs()));
        for (got, want) in solution.point().iter().zip(&known.x) {
            prop_assert!((got - want).abs() < 1e-3, "{} for {}", got, want);
        }
        known.assert_optimal(&solution, 1e-5);
        prop_assert!(solution.residuals.largest() < 1e-6, "{:?}", solution.residuals);
    }

    #[test]
    fn a_merely_convex_problem_reaches_its_known_cost(known in known(0.0)) {
        let program = program(&known);
        let solution = solve(&program).expect("solvable by construction");
        let want = known.objective(&known.x);
        prop_assert!((solution.objective - want).abs() < 1e-5 * (1.0 + want.abs()));
        prop_assert!(solution.residuals.largest() < 1e-6, "{:?}", solution.residuals);
        let recomputed = residuals(&program, &solution).expect("well-formed");
        prop_assert_eq!(recomputed, solution.residuals);
    }

    #[test]
    fn an_update_returns_the_bits_of_a_new_solver(first in known(0.1), second in known(0.1)) {
        let mut program = Program::new();
        let handles = declare(&mut program);
        write(&mut program, &handles, &first);
        let mut solver = Solver::new(&program, &SolverSettings::default()).expect("well-formed");
        let before = solver.solve();
        program.clear();
        write(&mut program, &handles, &second);
        solver.update(&program).expect("the same pattern");
        prop_assert_eq!(solver.solve(), solve(&program));
        program.clear();
        write(&mut program, &handles, &first);
        solver.update(&program).expect("the same pattern");
        prop_assert_eq!(solver.solve(), before);
    }

    #[test]
    fn a_perturbed_solution_has_large_residuals(known in known(0.5), which in 0..VARIABLES) {
        // The residuals belong to the pair of problem and answer: another cost must show.
        let solution = solve(&program(&known)).expect("solvable by construction");
        let mut other = known.clone();
        other.q[which] += 0.5;
        let found = residuals(&program(&other), &solution).expect("well-formed");
        prop_assert!(found.stationarity > 1e-3);
        other.q[which] -= 0.5;
        other.b[0] += 0.5;
        let found = residuals(&program(&other), &solution).expect("well-formed");
        prop_assert!(found.primal > 1e-3);
    }
}

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
