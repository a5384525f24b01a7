//! All stabilising feedbacks of a stable building, by a stable Q (eqs. 4.16-4.21, 4.29).
//!
//! ```text
//! C = (I − QG)⁻¹ Q,    (I + GC)⁻¹ = I − GQ,    (I + CG)⁻¹ = I − QG
//! Q = Σ_l Q_l Z^(l+1)                          taps Q_0 … Q_m−1; Z delays by a step
//! ```
//!
//! Row t of U is u(t), and row t of E is e(t + 1): a diagonal block of Q would let u(t) know e(t + 1), so that Q is
//! strictly block lower triangular, and v(t) = Σ_l Q_l y(t − l).

use nalgebra::DMatrix;

use crate::control::iterative::feedback::Response;
use crate::discretise::Model;
use crate::lifted::Lifted;

/// The Youla filter Q, given by its taps; each is a matrix, zones by zones \[kW/K\].
#[derive(Clone, Debug, PartialEq)]
pub struct YoulaFilter(pub Vec<DMatrix<f64>>);

impl YoulaFilter {
    /// The product Q y, for a stacked y.
    pub fn product(&self, y: &[f64]) -> Vec<f64> {
        let n = self.zones();
        let mut out = vec![0.0; y.len()];
        for (l, tap) in self.0.iter().enumerate() {
            let delay = (l + 1) * n;
            for start in (delay..y.len()).step_by(n) {
                for (j, y) in y[start - delay..start - delay + n].iter().enumerate() {
                    for (out, tap) in out[start..start + n].iter_mut().zip(&tap.column(j)) {
                        *out += tap * y;
                    }
                }
            }
        }
        out
    }

    fn zones(&self) -> usize {
        self.0.first().map_or(1, DMatrix::nrows)
    }

    /// The largest sum of magnitudes in a row of \[Q_0 … Q_m−1\]: the induced norm of Q from bounded y to bounded v.
    pub fn row_norm(&self) -> f64 {
        let row = |i: usize| self.0.iter().map(|tap| tap.row(i).iter().map(|q| q.abs()).sum::<f64>()).sum::<f64>();
        (0..self.zones()).map(row).fold(0.0, f64::max)
    }

    /// The response to disturbances, the columns of `factor`, under this feedback: T = G (I − QG) d and U = −QG d.
    pub fn response(&self, lifted: &Lifted, factor: &DMatrix<f64>) -> Response {
        let shape = factor.shape();
        let (mut temperatures_k, mut inputs_kw) = (DMatrix::zeros(shape.0, shape.1), DMatrix::zeros(shape.0, shape.1));
        for column in 0..factor.ncols() {
            let disturbance = factor.column(column).clone_owned();
            let mut risen = lifted.product(disturbance.as_slice());
            let inputs: Vec<f64> = self.product(&risen).iter().map(|u| -u).collect();
            for (risen, answer) in risen.iter_mut().zip(lifted.product(&inputs)) {
                *risen += answer;
            }
            temperatures_k.column_mut(column).copy_from_slice(&risen);
            inputs_kw.column_mut(column).copy_from_slice(&inputs);
        }
        Response { temperatures_k, inputs_kw }
    }

    /// ‖G (I − QG) α‖ in the Frobenius norm, α = \[I; 0\]: the response to an impulse of heat in each zone \[K/kW\]
    /// (eq. 4.12, corrected). With the printed α, one vector for all zones, Q₀ = 50 (I − 11ᵀ/4) would be invisible.
    pub fn impulse_norm(&self, lifted: &Lifted) -> f64 {
        self.response(lifted, &impulses(lifted)).temperatures_k.norm()
    }
}

/// α = \[I; 0\], n·N by n.
pub(super) fn impulses(lifted: &Lifted) -> DMatrix<f64> {
    DMatrix::identity(lifted.size(), lifted.zones())
}

/// The causal controller of (4.18) and (4.19): a copy of the building that sees the feedback only, and Q as a filter.
///
/// ```text
/// x̂(t+1) = A x̂(t) + B u_fb(t),    y(t) = x̂(t) + e(t),    u_fb(t) = Σ_l Q_l y(t − l)
/// ```
///
/// With the feedback that was applied (after saturation) in the copy, it does not wind up.
#[derive(Clone, Debug)]
pub struct StateSpace {
    filter: YoulaFilter,
    model: Model,
    /// x̂, over the nodes.
    state: Vec<f64>,
    /// y(t), y(t − 1), …
    past: Vec<Vec<f64>>,
}

impl StateSpace {
    /// A controller at rest: all its states are zero.
    pub fn new(filter: YoulaFilter, model: &Model) -> Self {
        let (nodes, count, n) = (model.network().node_count(), filter.0.len(), filter.zones());
        Self { filter, model: model.clone(), state: vec![0.0; nodes], past: vec![vec![0.0; n]; count] }
    }

    /// The feedback u_fb(t) for the error e(t) \[K\]; pass zeros at t = 0, when no error is known.
    pub fn answer(&mut self, error_k: &[f64]) -> Vec<f64> {
        let y = error_k.iter().zip(&self.state).map(|(e, x)| x + e).collect();
        self.past.rotate_right(1);
        self.past[0] = y;
        let mut heat_kw = vec![0.0; error_k.len()];
        for (tap, y) in self.filter.0.iter().zip(&self.past) {
            for (j, y) in y.iter().enumerate() {
                for (heat_kw, q) in heat_kw.iter_mut().zip(&tap.column(j)) {
                    *heat_kw += q * y;
                }
            }
        }
        heat_kw
    }

    /// Advances the state by a step, with the feedback that was applied \[kW\].
    pub fn advance(&mut self, applied_kw: &[f64]) {
        self.model.step_by_heat(&mut self.state, applied_kw);
    }
}
