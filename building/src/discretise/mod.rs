//! The network in discrete time (eq. 2.16).
//!
//! Heat and outdoor temperature are held constant for a step h, so the temperatures move by a linear function of the net
//! heat into each node at the start of the step,
//!
//! ```text
//! T(t+1) = T(t) + B (k T₀ + u + w − L T(t))          so   A = I − B L                    (eq. 2.16)
//! ```
//!
//! and the two discretisations differ in B \[K/kW\] alone, which is symmetric in both:
//!
//! ```text
//! exact   B = h φ₁(h C⁻¹L) C⁻¹        φ₁(z) = (1 − e⁻ᶻ)/z,   A = exp(−h C⁻¹L)
//! Euler   B = h C⁻¹                                          A = I − h C⁻¹L
//! ```
//!
//! Euler is the dissertation's. It is stable only below h = 2/λ_max, with λ_max the fastest rate of the network, and is refused
//! beyond. The exact one is stable and keeps temperatures in order for every step.
//!
//! # Small and large networks
//!
//! Up to [`DENSE_NODES`] nodes the exact B is a matrix, from the modes of the network (its Laplacian is symmetric, so no
//! matrix exponential is needed). Beyond, a matrix would be slow to apply, and B is a Chebyshev series in the sparse
//! Laplacian, summed to the last digit. Both are exact; tests compare them.

mod spectrum;

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::network::Network;
use spectrum::{Spectrum, inverse_root, rate_bound_per_s};

/// The largest number of nodes for which the exact discretisation is kept as matrices; beyond, it is a series.
pub const DENSE_NODES: usize = 256;

/// How time is cut into steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Discretisation {
    /// Without error for inputs that are constant over a step (zero-order hold).
    #[default]
    Exact,
    /// Forward Euler, as printed in the source.
    Euler,
}

/// The representation of the matrices of the exact discretisation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// As matrices.
    Dense,
    /// As Chebyshev series in the sparse Laplacian.
    Series,
}

/// Why a network cannot be discretised with a time step.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// The step is not a positive duration.
    #[error("the step is {step_s} s; it must be a positive number of seconds, at most a year")]
    BadStep {
        /// Duration of the step \[s\].
        step_s: f64,
    },
    /// Forward Euler would grow without end.
    #[error(
        "forward Euler is unstable at a step of {step_s} s: the largest stable step is {largest_step_s:.1} s. Use the \
         exact discretisation, or check the units (resistances in K/kW, where 1 K·min/kJ is 60 K/kW, and capacities in \
         kJ/K)"
    )]
    Unstable {
        /// Duration of the step \[s\].
        step_s: f64,
        /// Twice the inverse of the network's fastest rate.
        largest_step_s: f64,
    },
}

/// A thermal network in steps of time: all that is needed to simulate it.
#[derive(Clone, Debug)]
pub struct Model {
    network: Network,
    step_s: f64,
    method: Discretisation,
    /// B.
    gain: Gain,
}

impl Model {
    /// Discretises by the given method.
    ///
    /// # Errors
    /// [`ModelError`] as of [`Model::exact`] and [`Model::euler`].
    pub fn new(network: &Network, method: Discretisation, step_s: f64) -> Result<Self, ModelError> {
        match method {
            Discretisation::Exact => Self::exact(network, step_s),
            Discretisation::Euler => Self::euler(network, step_s),
        }
    }

    /// Discretises exactly for inputs that are constant over a step.
    ///
    /// # Errors
    /// [`ModelError::BadStep`].
    pub fn exact(network: &Network, step_s: f64) -> Result<Self, ModelError> {
        let form = if network.node_count() <= DENSE_NODES { Form::Dense } else { Form::Series };
        Self::exact_in(form, network, step_s)
    }

    /// Discretises exactly, in a form of the caller's choice.
    ///
    /// # Errors
    /// [`ModelError::BadStep`].
    pub fn exact_in(form: Form, network: &Network, step_s: f64) -> Result<Self, ModelError> {
        check(step_s)?;
        let of_rate = |rate_per_s: f64| step_s * phi_1(rate_per_s * step_s);
        let gain = match form {
            Form::Dense => Gain::dense(&Spectrum::compute(network), of_rate),
            Form::Series => Gain::series(network, of_rate),
        };
        Ok(Self { network: network.clone(), step_s, method: Discretisation::Exact, gain })
    }

    /// Discretises by forward Euler.
    ///
    /// # Errors
    /// [`ModelError::Unstable`] with the largest stable step if temperatures would grow without end;
    /// [`ModelError::BadStep`].
    pub fn euler(network: &Network, step_s: f64) -> Result<Self, ModelError> {
        check(step_s)?;
        // Gershgorin's bound settles most cases without the eigenvalues.
        if step_s * rate_bound_per_s(network) > 2.0 {
            let fastest_per_s = spectrum::rates_per_s(network).last().copied().unwrap_or(0.0);
            if step_s * fastest_per_s > 2.0 {
                return Err(ModelError::Unstable { step_s, largest_step_s: 2.0 / fastest_per_s });
            }
        }
        let gain = Gain::Diagonal(network.capacities_kj_per_k().iter().map(|capacity| step_s / capacity).collect());
        Ok(Self { network: network.clone(), step_s, method: Discretisation::Euler, gain })
    }

    /// The network.
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// Duration of a step \[s\].
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// The method of discretisation in time.
    pub fn method(&self) -> Discretisation {
        self.method
    }

    /// Advances the temperatures by one step.
    ///
    /// `temperatures_c` has one number per node (zones first), `heat_kw` from equipment (negative when cooling) one per zone, and
    /// `gains_kw` from people, sun and machines one for each of the first [`Network::gain_count`] nodes. Inputs are held for the
    /// step.
    ///
    /// # Panics
    /// When a slice has another length.
    pub fn step(&self, temperatures_c: &mut [f64], heat_kw: &[f64], ambient_c: f64, gains_kw: &[f64]) {
        let net_kw = self.network.net_heat_kw(temperatures_c, heat_kw, ambient_c, gains_kw);
        for (temperature_c, risen_k) in temperatures_c.iter_mut().zip(self.gain.product(&self.network, &net_kw)) {
            *temperature_c += risen_k;
        }
    }

    /// Like [`Model::step`] at 0 °C outdoors and without gains: what heat from equipment alone does.
    ///
    /// # Panics
    /// When a slice has another length.
    pub(crate) fn step_by_heat(&self, temperatures_c: &mut [f64], heat_kw: &[f64]) {
        self.step(temperatures_c, heat_kw, 0.0, &vec![0.0; self.network.gain_count()]);
    }

    /// The product B x, for any x over the nodes.
    ///
    /// # Panics
    /// When `x` has not one number per node.
    pub fn gain_product(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(x.len(), self.network.node_count(), "one number per node");
        self.gain.product(&self.network, x)
    }

    /// The product A x = x − B L x, for any x over the nodes.
    ///
    /// # Panics
    /// When `x` has not one number per node.
    pub fn state_product(&self, x: &[f64]) -> Vec<f64> {
        let fallen = self.gain_product(&self.network.conduct(x));
        x.iter().zip(fallen).map(|(x, fallen)| x - fallen).collect()
    }

    /// The product Aᵀ x = x − L B x, for any x over the nodes.
    ///
    /// # Panics
    /// When `x` has not one number per node.
    pub fn state_transpose_product(&self, x: &[f64]) -> Vec<f64> {
        let fallen = self.network.conduct(&self.gain_product(x));
        x.iter().zip(fallen).map(|(x, fallen)| x - fallen).collect()
    }

    /// The matrix A, nodes by nodes (eq. 2.16).
    pub fn state_matrix(&self) -> DMatrix<f64> {
        self.columns(self.network.node_count(), |unit| self.state_product(unit))
    }

    /// The matrix B, nodes by zones \[K/kW\] (eq. 2.16). The columns of wall nodes are left out: no equipment heats a
    /// wall.
    pub fn gain_matrix(&self) -> DMatrix<f64> {
        self.columns(self.network.zone_count(), |unit| self.gain_product(unit))
    }

    /// B with a column for each node that gets heat of people, machines or sun \[K/kW\] ([`Network::gain_count`]). The first
    /// columns are those of the zones.
    pub fn disturbance_matrix(&self) -> DMatrix<f64> {
        self.columns(self.network.gain_count(), |unit| self.gain_product(unit))
    }

    /// B with a column for each node \[K/kW\]; symmetric.
    pub(crate) fn full_gain(&self) -> DMatrix<f64> {
        self.columns(self.network.node_count(), |unit| self.gain_product(unit))
    }

    fn columns(&self, count: usize, product: impl Fn(&[f64]) -> Vec<f64>) -> DMatrix<f64> {
        let n = self.network.node_count();
        let mut matrix = DMatrix::zeros(n, count);
        let mut unit = vec![0.0; n];
        for column in 0..count {
            unit[column] = 1.0;
            matrix.column_mut(column).copy_from_slice(&product(&unit));
            unit[column] = 0.0;
        }
        matrix
    }

    /// Eigenvalues of A, ascending. Takes time proportional to the cube of the number of nodes.
    pub fn eigenvalues(&self) -> Vec<f64> {
        let rates_per_s = spectrum::rates_per_s(&self.network);
        let eigenvalue = |rate_per_s: f64| match self.method {
            Discretisation::Exact => libm::exp(-rate_per_s * self.step_s),
            Discretisation::Euler => 1.0 - rate_per_s * self.step_s,
        };
        rates_per_s.into_iter().rev().map(eigenvalue).collect()
    }

    pub(crate) fn gain(&self) -> &Gain {
        &self.gain
    }
}

impl Network {
    /// Time constants of all modes, descending \[s\]; infinite for heat that cannot leave. Takes time proportional to
    /// the cube of the number of nodes.
    pub fn time_constants_s(&self) -> Vec<f64> {
        spectrum::rates_per_s(self).into_iter().map(|rate_per_s| 1.0 / rate_per_s).collect()
    }
}

/// φ₁(z) = (1 − e⁻ᶻ)/z for z ≥ 0, with φ₁(0) = 1.
fn phi_1(z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { -libm::expm1(-z) / z }
}

fn check(step_s: f64) -> Result<(), ModelError> {
    const YEAR_S: f64 = 366.0 * 86_400.0;
    if step_s > 0.0 && step_s <= YEAR_S { Ok(()) } else { Err(ModelError::BadStep { step_s }) }
}

/// A symmetric positive definite matrix f(C⁻¹L)·C⁻¹.
#[derive(Clone, Debug)]
pub(crate) enum Gain {
    /// Its diagonal, for f constant.
    Diagonal(Vec<f64>),
    Dense(DMatrix<f64>),
    /// A polynomial in the Laplacian.
    Series(ChebyshevSeries),
}

/// f(C⁻¹L)·C⁻¹ as a Chebyshev series in S = C^-½ L C^-½, whose spectrum lies in [0, ρ]:
///
/// ```text
/// C^-½ Σₖ aₖ Tₖ(2S/ρ − I) C^-½
/// ```
#[derive(Clone, Debug)]
pub(crate) struct ChebyshevSeries {
    coefficients: Vec<f64>,
    inverse_root: Vec<f64>,
    bound_per_s: f64,
}

impl Gain {
    /// f(C⁻¹L)·C⁻¹ from the modes.
    fn dense(spectrum: &Spectrum, f: impl Fn(f64) -> f64) -> Self {
        Self::Dense(spectrum.function(f))
    }

    /// f(C⁻¹L)·C⁻¹ as a series, without a matrix; `f` must be analytic around \[0, ∞).
    fn series(network: &Network, f: impl Fn(f64) -> f64) -> Self {
        // A network without any conductance has the spectrum {0}; then any interval is valid.
        let bound_per_s = rate_bound_per_s(network).max(f64::MIN_POSITIVE.sqrt());
        let coefficients = chebyshev(|x| f(0.5 * bound_per_s * (x + 1.0)));
        Self::Series(ChebyshevSeries { coefficients, inverse_root: inverse_root(network), bound_per_s })
    }

    /// The product with one number per node.
    fn product(&self, network: &Network, x: &[f64]) -> Vec<f64> {
        match self {
            Self::Diagonal(diagonal) => diagonal.iter().zip(x).map(|(d, x)| d * x).collect(),
            Self::Dense(matrix) => {
                let mut out = DVector::zeros(x.len());
                for (column, x) in matrix.column_iter().zip(x) {
                    out.axpy(*x, &column, 1.0);
                }
                out.data.into()
            }
            Self::Series(series) => series.product(network, x),
        }
    }
}

impl ChebyshevSeries {
    /// Clenshaw would run backwards over the coefficients with the same cost; forwards reads like the definition.
    fn product(&self, network: &Network, x: &[f64]) -> Vec<f64> {
        let mut before: Vec<f64> = x.iter().zip(&self.inverse_root).map(|(x, r)| r * x).collect();
        let mut term = self.shifted(network, &before);
        let mut sum: Vec<f64> = before.iter().map(|before| self.coefficients[0] * before).collect();
        for (degree, coefficient) in self.coefficients.iter().enumerate().skip(1) {
            for (sum, term) in sum.iter_mut().zip(&term) {
                *sum += coefficient * term;
            }
            if degree + 1 < self.coefficients.len() {
                let mut next = self.shifted(network, &term);
                for (next, before) in next.iter_mut().zip(&before) {
                    *next = 2.0 * *next - before;
                }
                before = std::mem::replace(&mut term, next);
            }
        }
        for (sum, r) in sum.iter_mut().zip(&self.inverse_root) {
            *sum *= r;
        }
        sum
    }

    /// (2S/ρ − I) v.
    fn shifted(&self, network: &Network, v: &[f64]) -> Vec<f64> {
        let scaled: Vec<f64> = v.iter().zip(&self.inverse_root).map(|(v, r)| r * v).collect();
        let mut out = network.conduct(&scaled);
        let scale = 2.0 / self.bound_per_s;
        for ((out, r), v) in out.iter_mut().zip(&self.inverse_root).zip(v) {
            *out = scale * r * *out - v;
        }
        out
    }
}

/// Chebyshev coefficients of an analytic function on [−1, 1], to the last digit: the function is interpolated in twice as
/// many points until the last coefficients are rounding errors, and those are left out.
fn chebyshev(f: impl Fn(f64) -> f64) -> Vec<f64> {
    /// Number of points of the first interpolation, and of the last, which is taken as it is. The sums cost the square of it.
    const MIN_POINTS: usize = 16;
    const MAX_POINTS: usize = 1 << 14;
    let mut points = MIN_POINTS;
    loop {
        let coefficients = interpolated(&f, points);
        let largest = coefficients.iter().fold(0.0_f64, |largest, a| largest.max(a.abs()));
        let negligible = 4.0 * f64::EPSILON * largest;
        let needed = coefficients.iter().rposition(|a| a.abs() > negligible).map_or(1, |last| last + 1);
        if needed + points / 8 <= points || points >= MAX_POINTS {
            return coefficients[..needed].to_vec();
        }
        points *= 2;
    }
}

/// Coefficients of the interpolating polynomial in the zeros of T_m.
fn interpolated(f: impl Fn(f64) -> f64, points: usize) -> Vec<f64> {
    let m = points as f64;
    // The cosines cos(kπ/2m) for all k that the sums need.
    let cosines: Vec<f64> = (0..4 * points).map(|k| libm::cos(PI * k as f64 / (2.0 * m))).collect();
    let values: Vec<f64> = (0..points).map(|j| f(cosines[2 * j + 1])).collect();
    let coefficient = |k: usize| {
        let sum: f64 = values.iter().enumerate().map(|(j, v)| v * cosines[k * (2 * j + 1) % (4 * points)]).sum();
        if k == 0 { sum / m } else { 2.0 * sum / m }
    };
    (0..points).map(coefficient).collect()
}
