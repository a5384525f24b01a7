//! Projects the optimal causal feedback on a stabilising gain K (step 2, eqs. 3.31-3.33).
//!
//! K approximates C* on the errors that occur. These have the covariance G Y Σ Yᵀ Gᵀ = PPᵀ, not the single
//! direction Ê of the printed (3.32), along which the fit is nearly singular (gains of 10⁴). With e = −Pw and u = Vw for
//! white w,
//!
//! ```text
//! min_K Σ_t E‖K e(t) − u(t)‖²        K = −Σ_t V_t P_tᵀ (Σ_t P_t P_tᵀ)⁻¹               least squares
//! min_{F,M} ‖(M̄ Z − C* F̄) P‖²        K = M F⁻¹, and F, M, S as in [`crate::control::stability`]     (eq. 3.32, corrected)
//! ```
//!
//! over the steps that are occupied, or next to one that is. Z delays by a step: bold M is block *sub*-diagonal, since u(t) knows e(t)
//! and not e(t + 1). Walls that store heat are states without a sensor; F then has no entries from walls to zones, so that
//! M F⁻¹ acts on zones alone.

use interplay_convex::{Program, Solver, SolverSettings, Variable, Variables};
use nalgebra::{Cholesky, DMatrix};

use super::feedback::Response;
use crate::control::ControlError;
use crate::control::stability::Certificate;
use crate::lifted::Lifted;

/// A linear combination of variables.
type Terms = Vec<(Variable, f64)>;

/// The margin by which a solution satisfies the matrix inequality: chosen far above the tolerance of the solver, 10⁻⁸, so that
/// the inequality holds despite it.
const LMI_MARGIN: f64 = 1e-4;
/// S is at least this times the identity.
const LEAST_S: f64 = 1e-3;

/// The projection of the optimal causal feedback on static gains: a regression of inputs on errors.
pub struct Projection<'a> {
    lifted: &'a Lifted,
    response: &'a Response,
    /// Steps that count.
    busy: Vec<usize>,
}

/// The quadratic form of (3.32) in the entries (a, c) of M and of F that are free.
struct Fit {
    gain: Vec<(usize, usize)>,
    scale: Vec<(usize, usize)>,
    /// Symmetric; entries of M first.
    gram: DMatrix<f64>,
}

impl<'a> Projection<'a> {
    /// Prepares the projection. `response` is that of the optimal causal feedback under a lower triangular factor L;
    /// `busy` says which steps count.
    pub fn new(lifted: &'a Lifted, response: &'a Response, busy: &[bool]) -> Self {
        let busy = (1..lifted.steps()).filter(|&t| busy[t]).collect();
        Self { lifted, response, busy }
    }

    /// The gain K by least squares.
    ///
    /// # Errors
    /// [`ControlError::Covariance`] if the errors of the zones are linearly dependent.
    pub fn least_squares(&self) -> Result<DMatrix<f64>, ControlError> {
        let n = self.lifted.zones();
        let (p, v) = (&self.response.temperatures_k, &self.response.inputs_kw);
        let (mut own, mut cross) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        for &t in &self.busy {
            for i in 0..n {
                for j in 0..n {
                    let before = p.row((t - 1) * n + j);
                    own[(i, j)] += p.row((t - 1) * n + i).dot(&before);
                    cross[(i, j)] -= v.row(t * n + i).dot(&before);
                }
            }
        }
        let factor = Cholesky::new(own).ok_or(ControlError::Covariance { order: n })?;
        Ok(factor.solve(&cross.transpose()).transpose())
    }

    /// The gain K by the corrected matrix inequality, with a decay rate.
    ///
    /// # Errors
    /// [`ControlError::Solve`] if no gain has this decay rate, or the solver fails.
    pub fn lmi(&self, decay: f64) -> Result<DMatrix<f64>, ControlError> {
        let model = self.lifted.model();
        let (n, nodes) = (self.lifted.zones(), model.network().node_count());
        let all: Vec<(usize, usize)> = (0..n).flat_map(|a| (0..n).map(move |c| (a, c))).collect();
        let fit = self.fit(all.clone(), all)?;
        let (a, b) = (model.state_matrix(), model.gain_matrix());
        let mut program = Program::new();
        let certificate = Certificate::new(&mut program, nodes, |i, j| i >= n || j < n);
        let m = program.variables("M", n * n);
        let gain = |i: usize, j: usize| m.at(i * n + j);
        let moved = |i: usize, j: usize| -> Vec<(Variable, f64)> {
            let drift = (0..nodes).filter_map(|k| Some((certificate.f(k, j)?, a[(i, k)])));
            let driven = (0..n).filter(|_| j < n).map(|k| (gain(k, j), -b[(i, k)]));
            drift.chain(driven).collect()
        };
        certificate.inequality(&mut program, decay, moved, LMI_MARGIN);
        certificate.positive(&mut program, LEAST_S);
        certificate.unit_trace(&mut program);
        let scale: Vec<Variable> = fit.scale.iter().filter_map(|&(i, j)| certificate.f(i, j)).collect();
        fit.pose(&mut program, &m.iter().chain(scale.iter().copied()).collect::<Vec<_>>());
        let solution = Solver::new(&program, &SolverSettings::default())?.solve()?;
        let m = DMatrix::from_fn(n, n, |i, j| solution.at(gain(i, j)));
        let f = DMatrix::from_fn(n, n, |i, j| certificate.f(i, j).map_or(0.0, |f| solution.at(f)));
        // K F = M, so Fᵀ Kᵀ = Mᵀ; F + Fᵀ ≻ S ≻ 0 makes F invertible.
        let solved = f.transpose().lu().solve(&m.transpose()).ok_or(ControlError::Covariance { order: n })?;
        Ok(solved.transpose())
    }

    /// K by the linear certificate of positive systems with a decay rate: each zone uses its own error and those of its
    /// neighbours.
    ///
    /// # Errors
    /// As [`Projection::lmi`].
    pub fn linear(&self, decay: f64) -> Result<DMatrix<f64>, ControlError> {
        let (n, nodes) = (self.lifted.zones(), self.lifted.model().network().node_count());
        let mut local: Vec<(usize, usize)> = (0..n).map(|i| (i, i)).collect();
        for &(i, j) in self.lifted.model().network().adjacent_zones() {
            local.extend([(i, j), (j, i)]);
        }
        let fit = self.fit(local, (0..n).map(|i| (i, i)).collect())?;
        let mut program = Program::new();
        let m = program.variables("M", fit.gain.len());
        let f = program.variables("f", nodes);
        fit.pose(&mut program, &m.iter().chain((0..n).map(|i| f.at(i))).collect::<Vec<_>>());
        self.positive_rows(&mut program, decay, m, &fit.gain, f);
        let size = program.equal("size of f");
        program.row(size, f.iter().map(|f| (f, 1.0)), nodes as f64);
        let solution = Solver::new(&program, &SolverSettings::default())?.solve()?;
        let mut gain = DMatrix::zeros(n, n);
        for (m, &(i, j)) in m.iter().zip(&fit.gain) {
            gain[(i, j)] = solution.at(m) / solution.at(f.at(j));
        }
        Ok(gain)
    }

    /// Σⱼ |(AF − BM)ᵢⱼ| ≤ r fᵢ and f ≥ least.
    fn positive_rows(&self, program: &mut Program, decay: f64, m: Variables, gain: &[(usize, usize)], f: Variables) {
        let model = self.lifted.model();
        let (a, b) = (model.state_matrix(), model.gain_matrix());
        let nodes = a.nrows();
        let mut entries: Vec<(usize, Terms)> = Vec::new();
        for j in 0..nodes {
            for i in 0..nodes {
                let own = (a[(i, j)] != 0.0).then(|| (f.at(j), a[(i, j)]));
                let driven = (m.iter().zip(gain)).filter(|(_, (k, c))| *c == j && b[(i, *k)] != 0.0);
                let entry: Terms = own.into_iter().chain(driven.map(|(m, (k, _))| (m, -b[(i, *k)]))).collect();
                if !entry.is_empty() {
                    entries.push((i, entry));
                }
            }
        }
        let size = program.variables("|AF − BM|", entries.len());
        let (above, below) = (program.at_most("upper side"), program.at_most("lower side"));
        let mut sums: Vec<Terms> = f.iter().map(|f| vec![(f, -decay)]).collect();
        for (size, (i, entry)) in size.iter().zip(entries) {
            let negative: Terms = entry.iter().map(|&(variable, value)| (variable, -value)).collect();
            program.row(above, entry.into_iter().chain([(size, -1.0)]), 0.0);
            program.row(below, negative.into_iter().chain([(size, -1.0)]), 0.0);
            sums[i].push((size, 1.0));
        }
        let (decaying, positive) = (program.at_most("decay"), program.at_most("f is positive"));
        for (sum, f) in sums.into_iter().zip(f.iter()) {
            program.row(decaying, sum, 0.0);
            program.row(positive, [(f, -1.0)], -LEAST_S);
        }
    }

    /// ‖(M̄ Z − C* F̄) P‖² for the given entries of M and F.
    fn fit(&self, gain: Vec<(usize, usize)>, scale: Vec<(usize, usize)>) -> Result<Fit, ControlError> {
        let n = self.lifted.zones();
        // Stored by columns, so that a row of P is contiguous.
        let p = self.main_errors();
        let q = p.nrows();
        let wanted = self.optimal_feedback()?;
        // The contribution of each free entry to the rows (t, a) that count, with q numbers per row.
        let rows = self.busy.len() * n * q;
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(gain.len() + scale.len());
        for &(a, c) in &gain {
            let mut column = vec![0.0; rows];
            for (place, &t) in self.busy.iter().enumerate() {
                let start = (place * n + a) * q;
                for (entry, value) in column[start..start + q].iter_mut().zip(&p.column((t - 1) * n + c)) {
                    *entry = *value;
                }
            }
            columns.push(column);
        }
        for &(a, c) in &scale {
            let mut column = vec![0.0; rows];
            for (place, &t) in self.busy.iter().enumerate() {
                for i in 0..n {
                    let target = &mut column[(place * n + i) * q..(place * n + i + 1) * q];
                    // C* is strictly causal: u(t) knows the errors of rows up to t − 1.
                    for s in 0..t {
                        let weight = wanted[(t * n + i, s * n + a)];
                        for (entry, value) in target.iter_mut().zip(&p.column(s * n + c)) {
                            *entry -= weight * value;
                        }
                    }
                }
            }
            columns.push(column);
        }
        let count = columns.len();
        let mut gram = DMatrix::zeros(count, count);
        for j in 0..count {
            for i in 0..=j {
                let product: f64 = columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum();
                gram[(i, j)] = product;
                gram[(j, i)] = product;
            }
        }
        Ok(Fit { gain, scale, gram })
    }

    /// Pᵀ in its main directions: those that carry less than a thousandth of the largest variance are left out, because C*
    /// amplifies them most and they hardly occur.
    fn main_errors(&self) -> DMatrix<f64> {
        /// Smallest variance of a direction that is kept, as a share of the largest.
        const MIN_VARIANCE_RATIO: f64 = 1e-3;
        let p = &self.response.temperatures_k;
        let eigen = p.tr_mul(p).symmetric_eigen();
        let least = MIN_VARIANCE_RATIO * eigen.eigenvalues.max();
        let main: Vec<usize> = (0..p.ncols()).filter(|&k| eigen.eigenvalues[k] > least).collect();
        let transposed = p.transpose();
        let mut errors = DMatrix::zeros(main.len(), p.nrows());
        for (row, &k) in main.iter().enumerate() {
            let direction = eigen.eigenvectors.column(k);
            for i in 0..p.nrows() {
                errors[(row, i)] = transposed.column(i).dot(&direction);
            }
        }
        errors
    }

    /// C* = (Y⁻¹ − I) G⁻¹, which turns errors −P w into inputs V w: C* P = −V (eq. 3.31).
    fn optimal_feedback(&self) -> Result<DMatrix<f64>, ControlError> {
        let size = self.lifted.size();
        let p = self.response.temperatures_k.transpose();
        let v = self.response.inputs_kw.transpose();
        // Pᵀ C*ᵀ = −Vᵀ; P is square because the factor of Σ is.
        let solved = p.lu().solve(&v).ok_or(ControlError::Covariance { order: size })?;
        Ok(-solved.transpose())
    }
}

impl Fit {
    /// Adds the form to the cost; `unknowns` in the order of the Gram matrix.
    fn pose(&self, program: &mut Program, unknowns: &[Variable]) {
        // Scaling does not change the minimiser, and improves the conditioning.
        let scale = 1.0 / self.gram.diagonal().max();
        for (j, &second) in unknowns.iter().enumerate() {
            for (i, &first) in unknowns[..=j].iter().enumerate() {
                program.quadratic(first, second, 2.0 * scale * self.gram[(i, j)]);
            }
        }
    }
}
