//! Stability of a feedback u = K e, and certificates of it (section 3.3).
//!
//! A − BK is stable exactly when its spectral radius is below one (the printed (3.7) allows one). A matrix F with M = KF
//! and S = Sᵀ ≻ 0 proves it, with decay rate r, when (de Oliveira, Bernussou, Geromel)
//!
//! ```text
//! ⎡ F + Fᵀ − S   (AF − BM)ᵀ ⎤
//! ⎣ AF − BM      r² S       ⎦ ≻ 0                                              (eq. 3.23, corrected)
//! ```
//!
//! The dissertation prints I in place of r² S. Then F = S = εI satisfies it for *every* K, since the off-diagonal vanishes faster
//! than the diagonal: the printed inequality certifies nothing.
//!
//! Heat flows from warm to cold, so A is nonnegative. For such systems a vector f > 0 is a certificate:
//!
//! ```text
//! Σⱼ |(A − BK)ᵢⱼ| fⱼ ≤ r fᵢ
//! ```
//!
//! It is linear in f and M = K diag f, and so scales to hundreds of zones ([`positive_decay`]).

use interplay_convex::{Block, Program, Variable, Variables, triangle};
use nalgebra::DMatrix;

/// Largest magnitude of the eigenvalues of a square matrix; NaN if an entry is not finite.
///
/// By Gelfand's formula lim ‖Mᵏ‖^(1/k), with k doubled by squaring: it terminates for every matrix, which iterations for the
/// eigenvalues do not guarantee.
pub fn spectral_radius(matrix: &DMatrix<f64>) -> f64 {
    const DOUBLINGS: i32 = 50;
    let mut power = matrix.clone();
    let mut logarithm = 0.0;
    let mut share = 1.0;
    for _ in 0..=DOUBLINGS {
        let norm = power.norm();
        if norm == 0.0 || !norm.is_finite() {
            return if norm == 0.0 { 0.0 } else { f64::NAN };
        }
        logarithm += share * libm::log(norm);
        share *= 0.5;
        power.unscale_mut(norm);
        power = product(&power, &power);
    }
    libm::exp(logarithm)
}

/// A B with its sums in a fixed order.
fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = DMatrix::zeros(a.nrows(), b.ncols());
    for j in 0..b.ncols() {
        for k in 0..a.ncols() {
            product.column_mut(j).axpy(b[(k, j)], &a.column(k), 1.0);
        }
    }
    product
}

/// The matrix A − BK of the closed loop, nodes by nodes; `b` is nodes by zones and `gain` zones by zones, since walls
/// are not measured.
pub fn closed_loop(a: &DMatrix<f64>, b: &DMatrix<f64>, gain: &DMatrix<f64>) -> DMatrix<f64> {
    let mut closed = a.clone();
    for j in 0..gain.ncols() {
        for k in 0..gain.nrows() {
            let column = b.column(k);
            closed.column_mut(j).axpy(-gain[(k, j)], &column, 1.0);
        }
    }
    closed
}

/// The best decay rate that a vector f proves: min over f > 0 of maxᵢ Σⱼ |Mᵢⱼ| fⱼ / fᵢ, the spectral radius of |M|, by
/// the power method. An upper bound for the spectral radius of M, and equal to it where M is nonnegative.
pub fn positive_decay(closed: &DMatrix<f64>) -> f64 {
    const MAX_POWER_STEPS: usize = 500;
    let n = closed.nrows();
    let mut f = vec![1.0; n];
    let mut bound = f64::INFINITY;
    for _ in 0..MAX_POWER_STEPS {
        let moved: Vec<f64> = (0..n).map(|i| (0..n).map(|j| closed[(i, j)].abs() * f[j]).sum()).collect();
        bound = moved.iter().zip(&f).map(|(moved, f)| moved / f).fold(0.0, f64::max).min(bound);
        let largest = moved.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 || !largest.is_finite() {
            break;
        }
        // The average with the old f keeps every entry positive and damps oscillation; any positive f gives a valid bound.
        for (f, moved) in f.iter_mut().zip(moved) {
            *f = 0.5 * *f + 0.5 * moved / largest;
        }
    }
    bound
}

/// The unknowns F (without the entries that are fixed at zero) and S of the matrix inequality.
pub(super) struct Certificate {
    order: usize,
    /// F by columns.
    f: Vec<Option<Variable>>,
    s: Variables,
}

impl Certificate {
    /// Declares the unknown matrices F and S of order `order`; `free` says which entries of F are unknowns.
    pub fn new(program: &mut Program, order: usize, free: impl Fn(usize, usize) -> bool) -> Self {
        let places = || (0..order).flat_map(|j| (0..order).map(move |i| (i, j)));
        let unknown = program.variables("F", places().filter(|&(i, j)| free(i, j)).count());
        let mut unknown = unknown.iter();
        let f = places().map(|(i, j)| if free(i, j) { unknown.next() } else { None }).collect();
        let s = program.variables("S", order * (order + 1) / 2);
        Self { order, f, s }
    }

    /// F(i, j), unless it is fixed at zero.
    pub fn f(&self, i: usize, j: usize) -> Option<Variable> {
        self.f[i + j * self.order]
    }

    fn s(&self, i: usize, j: usize) -> Variable {
        let (low, high) = (i.min(j), i.max(j));
        self.s.at(high * (high + 1) / 2 + low)
    }

    /// Adds the inequality with decay rate r = `decay` and a margin of `margin` I; `moved` gives AF − BM entry by entry.
    pub fn inequality(
        &self,
        program: &mut Program,
        decay: f64,
        moved: impl Fn(usize, usize) -> Vec<(Variable, f64)>,
        margin: f64,
    ) {
        let n = self.order;
        let block = program.semidefinite("stability", 2 * n);
        for (i, j, weight) in triangle(2 * n) {
            let mut entry = Vec::new();
            match (i < n, j < n) {
                (true, true) => {
                    entry.extend(self.f(i, j).map(|f| (f, 1.0)));
                    entry.extend(self.f(j, i).map(|f| (f, 1.0)));
                    entry.push((self.s(i, j), -1.0));
                }
                // The upper right block is (AF − BM)ᵀ.
                (true, false) => entry = moved(j - n, i),
                (false, _) => entry.push((self.s(i - n, j - n), decay * decay)),
            }
            let constant = if i == j { -margin } else { 0.0 };
            inside(program, block, entry, constant, weight);
        }
    }

    /// Adds the constraint S ⪰ `least` I.
    pub fn positive(&self, program: &mut Program, least: f64) {
        let block = program.semidefinite("S", self.order);
        for (i, j, weight) in triangle(self.order) {
            let constant = if i == j { -least } else { 0.0 };
            inside(program, block, vec![(self.s(i, j), 1.0)], constant, weight);
        }
    }

    /// Adds the constraint tr S = order, because the inequality is homogeneous and its scale is arbitrary.
    pub fn unit_trace(&self, program: &mut Program) {
        let block = program.equal("size of S");
        program.row(block, (0..self.order).map(|i| (self.s(i, i), 1.0)), self.order as f64);
    }
}

/// The row b − aᵀx = weight (entry + constant).
fn inside(program: &mut Program, block: Block, entry: Vec<(Variable, f64)>, constant: f64, weight: f64) {
    program.row(block, entry.into_iter().map(|(variable, value)| (variable, -weight * value)), weight * constant);
}
