//! Linear stochastic models in continuous time, and their exact form in steps.
//!
//! ```text
//! dx = (A x + B u) dt + dw,   E[dw dwᵀ] = diag(q) dt;        y_k = x[output_k] + v_k,   E[v_k²] = r_k
//! x(t+h) = Φ x(t) + Γ₀ u(t) + Γ₁ u'(t) + w,   E[w wᵀ] = Q
//! ```
//!
//! exact for inputs that change at a constant rate u' over a step (first-order hold; with u' = 0, zero-order hold):
//!
//! ```text
//! Φ = exp(A h),   Γ₀ = h φ₁(A h) B,   Γ₁ = h² φ₂(A h) B
//!
//!     ⎡A diag(q)⎤         ⎡Φ  Q Φ⁻ᵀ⎤
//! exp ⎢0   −Aᵀ  ⎥ h   =   ⎣0   Φ⁻ᵀ ⎦      (Van Loan, 1978)
//!     ⎣         ⎦
//! ```

use nalgebra::DMatrix;

use super::exponential::{Number, matrix_exponential, phi_functions, product, real};

/// A model in continuous time with n states, m inputs and p outputs.
#[derive(Debug, Clone)]
pub(super) struct ContinuousModel {
    /// A, n × n \[1/s\].
    pub dynamics: DMatrix<Number>,
    /// B, n × m.
    pub inputs: DMatrix<Number>,
    /// q, the variance that each state gains in a second \[K²/s\].
    pub diffusion: Vec<Number>,
    /// Which state each output measures.
    pub outputs: Vec<usize>,
    /// r, variance of the noise of each output \[K²\].
    pub sensor_variance: Vec<Number>,
    /// What each state gains in variance in a row of which the heat is unknown \[K²\].
    pub unknown_heat_variance: Vec<f64>,
    /// Of each zone, the share s in \[0, 1\] of the full swing of heat within a row ([`super::heat_timing`]); 0 for heat that is held.
    pub heat_swing: Vec<Number>,
    /// How a segment begins.
    pub initial: InitialState,
}

/// The state at the first row of a segment: mean x₀ = offset + F y(0) + G u(0), with independent errors.
#[derive(Debug, Clone)]
pub(super) struct InitialState {
    pub offset: Vec<Number>,
    /// F, n × p.
    pub from_outputs: DMatrix<Number>,
    /// G, n × m.
    pub from_inputs: DMatrix<Number>,
    pub variance: Vec<Number>,
    /// Whether x₀ already contains the outputs of the first row, which then must not count a second time.
    pub contains_first_outputs: bool,
}

#[derive(Debug, Clone)]
pub(super) struct SampledModel {
    /// Φ.
    pub transition: DMatrix<Number>,
    /// Γ₀.
    pub gain: DMatrix<Number>,
    /// Γ₁.
    pub slope_gain: DMatrix<Number>,
    /// Q.
    pub noise: DMatrix<Number>,
}

impl ContinuousModel {
    /// The model in steps of `step_s`; `None` if its dynamics are too fast for that, or not finite.
    pub fn sampled(&self, step_s: f64) -> Option<SampledModel> {
        let [transition, first, second] = phi_functions(&self.dynamics.map(|entry| entry * step_s))?;
        Some(SampledModel {
            transition,
            gain: product(&first, &self.inputs).map(|entry| entry * step_s),
            slope_gain: product(&second, &self.inputs).map(|entry| entry * (step_s * step_s)),
            noise: self.sampled_noise(step_s)?,
        })
    }

    /// Q over one step.
    ///
    /// Van Loan's exponential grows with the fastest mode, so it is formed over a part of the step, and doubled by
    /// Q(2h) = Q(h) + Φ(h) Q(h) Φ(h)ᵀ.
    fn sampled_noise(&self, step_s: f64) -> Option<DMatrix<Number>> {
        let n = self.dynamics.nrows();
        let fastest = (0..n).map(|i| self.dynamics[(i, i)].re.abs()).fold(0.0, f64::max) * step_s;
        let (mut part_s, mut doublings) = (step_s, 0);
        while fastest * part_s / step_s > 1.0 {
            part_s *= 0.5;
            doublings += 1;
        }
        let block = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => self.dynamics[(i, j)] * part_s,
            (true, false) if j - n == i => self.diffusion[i] * part_s,
            (false, false) => -self.dynamics[(j - n, i - n)] * part_s,
            _ => real(0.0),
        });
        let block = matrix_exponential(&block)?;
        let mut transition = block.view((0, 0), (n, n)).into_owned();
        let mut noise = product(&block.view((0, n), (n, n)).into_owned(), &transition.transpose());
        for _ in 0..doublings {
            noise += product(&product(&transition, &noise), &transition.transpose());
            transition = product(&transition, &transition);
        }
        Some((&noise + noise.transpose()).map(|entry| entry * 0.5))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// dx = (a x + b u) dt + dw with a full swing of heat.
    pub fn one_state(rate: f64, input: f64) -> ContinuousModel {
        ContinuousModel {
            dynamics: DMatrix::from_element(1, 1, real(rate)),
            inputs: DMatrix::from_element(1, 1, real(input)),
            diffusion: vec![real(0.3)],
            outputs: vec![0],
            sensor_variance: vec![real(1.0)],
            unknown_heat_variance: vec![0.0],
            heat_swing: vec![real(1.0)],
            initial: InitialState {
                offset: vec![real(0.0)],
                from_outputs: DMatrix::zeros(1, 1),
                from_inputs: DMatrix::zeros(1, 1),
                variance: vec![real(1.0)],
                contains_first_outputs: false,
            },
        }
    }

    /// One state: Φ = e⁻ᵃʰ, Γ₀ = (1−Φ)/a, Γ₁ = (h − Γ₀)/a, Q = q (1−Φ²)/2a.
    #[test]
    fn a_model_with_one_state_is_sampled_by_its_closed_forms() {
        for (rate, step) in [(0.01, 60.0), (0.01, 3600.0), (1e-5, 900.0)] {
            let sampled = one_state(-rate, 2.0).sampled(step).expect("sound");
            let decay = libm::exp(-rate * step);
            let integral = -libm::expm1(-rate * step) / rate;
            let close =
                |found: Number, wanted: f64| assert!((found.re / wanted - 1.0).abs() < 1e-9, "{found} {wanted}");
            close(sampled.transition[(0, 0)], decay);
            close(sampled.gain[(0, 0)], 2.0 * integral);
            close(sampled.slope_gain[(0, 0)], 2.0 * (step - integral) / rate);
            close(sampled.noise[(0, 0)], 0.3 * -libm::expm1(-2.0 * rate * step) / (2.0 * rate));
        }
    }
}
