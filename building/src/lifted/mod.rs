//! A horizon of N steps as one linear map (section 2.5).
//!
//! Stack the zones' temperatures T(1) … T(N) and inputs u(0) … u(N−1), time-major: entry t·n + i is zone i of the t-th.
//! Then
//!
//! ```text
//! T = T_free + G U            G block lower-triangular Toeplitz with blocks h₁, h₂, …          (eqs. 2.19, 2.20)
//! h_k = E Aᵏ⁻¹ B              E picks the zones among the nodes
//! ```
//!
//! The dissertation writes T = G(U + D) + T_in. Here T_free = T_in + G D is the temperature without equipment: heat that enters through a
//! wall with a heat capacity does not equal any heat input at that time, so D is not needed. Conversely, G⁻¹(T − T_free) is the equipment
//! heat that explains measured temperatures, and its difference from the known heat is the disturbance, expressed as zone heat.
//!
//! [`Lifted::dense`] writes G down, for networks of a few zones. Everything else works by simulation, forwards for G and
//! backwards for Gᵀ (A = I − B L with symmetric B and L, so Aᵀ = I − L B), and costs as much as a simulation of the
//! horizon, at every size.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::discretise::{Gain, Model};

/// The lifted form of a model: the temperatures of a whole horizon as a linear map of its inputs, T = T_free + G U.
#[derive(Clone, Debug)]
pub struct Lifted {
    model: Model,
    steps: usize,
    zone_gain: ZoneGain,
}

impl Lifted {
    /// Lifts the model over a horizon of `steps` steps.
    pub fn new(model: &Model, steps: usize) -> Self {
        Self { model: model.clone(), steps, zone_gain: ZoneGain::compute(model) }
    }

    /// The model of one step.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Number of steps, N.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Number of zones, n.
    pub fn zones(&self) -> usize {
        self.model.network().zone_count()
    }

    /// Length of stacked inputs and of stacked temperatures, n·N.
    pub fn size(&self) -> usize {
        self.steps * self.zones()
    }

    /// The free response T_free: temperatures without equipment \[°C\], stacked.
    ///
    /// `initial_c` has one number per node, `ambient_c` one per step, and `gains_kw` is stacked, one number for each step and each
    /// node that gets any.
    ///
    /// # Panics
    /// When a slice has another length.
    pub fn free_response(&self, initial_c: &[f64], ambient_c: &[f64], gains_kw: &[f64]) -> Vec<f64> {
        self.response(initial_c, &vec![0.0; self.size()], ambient_c, gains_kw)
    }

    /// The temperatures T = T_free + G U by simulation \[°C\], stacked. Shapes are those of [`Lifted::free_response`];
    /// `heat_kw` is stacked.
    ///
    /// # Panics
    /// When a slice has another length.
    pub fn response(&self, initial_c: &[f64], heat_kw: &[f64], ambient_c: &[f64], gains_kw: &[f64]) -> Vec<f64> {
        assert_eq!(ambient_c.len(), self.steps, "one outdoor temperature per step");
        self.check(heat_kw);
        let (n, gained) = (self.zones(), self.model.network().gain_count());
        assert_eq!(gains_kw.len(), self.steps * gained, "stacked: one gain per step and node that gets any");
        let mut temperatures_c = initial_c.to_vec();
        let mut stacked = Vec::with_capacity(self.size());
        for (t, &ambient_c) in ambient_c.iter().enumerate() {
            let zones = t * n..(t + 1) * n;
            let gains_kw = &gains_kw[t * gained..(t + 1) * gained];
            self.model.step(&mut temperatures_c, &heat_kw[zones], ambient_c, gains_kw);
            stacked.extend_from_slice(&temperatures_c[..n]);
        }
        stacked
    }

    /// The product G u, for a stacked u.
    ///
    /// # Panics
    /// When `u` has not n·N numbers.
    pub fn product(&self, u: &[f64]) -> Vec<f64> {
        self.check(u);
        let n = self.zones();
        let mut state = vec![0.0; self.model.network().node_count()];
        let mut stacked = Vec::with_capacity(self.size());
        for input in u.chunks_exact(n) {
            state = self.advance(&state, input);
            stacked.extend_from_slice(&state[..n]);
        }
        stacked
    }

    /// The product Gᵀ y, for a stacked y.
    ///
    /// # Panics
    /// When `y` has not n·N numbers.
    pub fn transpose_product(&self, y: &[f64]) -> Vec<f64> {
        self.check(y);
        let n = self.zones();
        let mut costate = vec![0.0; self.model.network().node_count()];
        let mut stacked = vec![0.0; self.size()];
        for t in (0..self.steps).rev() {
            if t + 1 < self.steps {
                costate = self.model.state_transpose_product(&costate);
            }
            for (costate, y) in costate.iter_mut().zip(&y[t * n..(t + 1) * n]) {
                *costate += y;
            }
            stacked[t * n..(t + 1) * n].copy_from_slice(&self.model.gain_product(&costate)[..n]);
        }
        stacked
    }

    /// The solution G⁻¹ y, for a stacked y: the inputs that lead from rest to these temperatures. G is always
    /// invertible, because a zone responds to its own input within a step.
    ///
    /// # Panics
    /// When `y` has not n·N numbers.
    pub fn solve(&self, y: &[f64]) -> Vec<f64> {
        self.check(y);
        let n = self.zones();
        let mut state = vec![0.0; self.model.network().node_count()];
        let mut stacked = Vec::with_capacity(self.size());
        for wanted in y.chunks_exact(n) {
            let drifted = self.model.state_product(&state);
            let missing: Vec<f64> = wanted.iter().zip(&drifted).map(|(wanted, drifted)| wanted - drifted).collect();
            let input = self.zone_gain.solve(&self.model, &missing);
            state = self.advance(&state, &input);
            stacked.extend(input);
        }
        stacked
    }

    /// The Markov parameters h₁ … h_N: the response of the zones to an impulse after each step, zones by zones
    /// \[K/kW\].
    pub fn markov(&self) -> Vec<DMatrix<f64>> {
        let n = self.zones();
        let mut blocks = vec![DMatrix::zeros(n, n); self.steps];
        for zone in 0..n {
            let mut impulse = vec![0.0; self.size()];
            if let Some(first) = impulse.get_mut(zone) {
                *first = 1.0;
            }
            for (block, response) in blocks.iter_mut().zip(self.product(&impulse).chunks_exact(n)) {
                block.column_mut(zone).copy_from_slice(response);
            }
        }
        blocks
    }

    /// The matrix G, n·N by n·N \[K/kW\].
    pub fn dense(&self) -> DMatrix<f64> {
        let n = self.zones();
        let mut matrix = DMatrix::zeros(self.size(), self.size());
        let blocks = self.markov();
        for column in 0..self.steps {
            for (delay, block) in blocks[..self.steps - column].iter().enumerate() {
                matrix.view_mut(((column + delay) * n, column * n), (n, n)).copy_from(block);
            }
        }
        matrix
    }

    /// A x + B u.
    fn advance(&self, state: &[f64], input: &[f64]) -> Vec<f64> {
        let mut net = self.model.network().conduct(state);
        for net in &mut net {
            *net = -*net;
        }
        for (net, input) in net.iter_mut().zip(input) {
            *net += input;
        }
        let mut next = self.model.gain_product(&net);
        for (next, state) in next.iter_mut().zip(state) {
            *next += state;
        }
        next
    }

    fn check(&self, stacked: &[f64]) {
        assert_eq!(stacked.len(), self.size(), "stacked: one number per step and zone");
    }
}

/// Solves with the symmetric positive definite h₁.
#[derive(Clone, Debug)]
enum ZoneGain {
    Diagonal(Vec<f64>),
    Factor(Cholesky<f64, Dyn>),
    /// By conjugate gradients: h₁ is known by its products only.
    Products,
}

impl ZoneGain {
    fn compute(model: &Model) -> Self {
        let zones = model.network().zone_count();
        match model.gain() {
            Gain::Diagonal(diagonal) => Self::Diagonal(diagonal[..zones].to_vec()),
            Gain::Dense(matrix) => {
                let block = matrix.view((0, 0), (zones, zones)).into_owned();
                Cholesky::new(block).map_or(Self::Products, Self::Factor)
            }
            Gain::Series(_) => Self::Products,
        }
    }

    fn solve(&self, model: &Model, y: &[f64]) -> Vec<f64> {
        match self {
            Self::Diagonal(diagonal) => y.iter().zip(diagonal).map(|(y, d)| y / d).collect(),
            Self::Factor(factor) => factor.solve(&DVector::from_column_slice(y)).data.into(),
            Self::Products => conjugate_gradients(model, y),
        }
    }
}

/// Solves h₁ x = y to rounding error. h₁ is h/c for a zone left alone, and that times φ₁(h·rate) otherwise, so it is well
/// conditioned for any step that a controller would use.
fn conjugate_gradients(model: &Model, y: &[f64]) -> Vec<f64> {
    const RELATIVE_RESIDUAL: f64 = 1e-14;
    let nodes = model.network().node_count();
    let product = |x: &[f64]| {
        let mut padded = vec![0.0; nodes];
        padded[..x.len()].copy_from_slice(x);
        model.gain_product(&padded)
    };
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mut x = vec![0.0; y.len()];
    let mut residual = y.to_vec();
    let mut direction = residual.clone();
    let mut squared = dot(&residual, &residual);
    let enough = RELATIVE_RESIDUAL * RELATIVE_RESIDUAL * squared;
    for _ in 0..2 * y.len() + 10 {
        if squared <= enough {
            break;
        }
        let image = product(&direction);
        let length = squared / dot(&direction, &image);
        for i in 0..x.len() {
            x[i] += length * direction[i];
            residual[i] -= length * image[i];
        }
        let before = std::mem::replace(&mut squared, dot(&residual, &residual));
        for (direction, residual) in direction.iter_mut().zip(&residual) {
            *direction = residual + squared / before * *direction;
        }
    }
    x
}
