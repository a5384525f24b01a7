//! Comfort: changes of the input cost, `Σ_t ‖u_t − u_{t−1}‖²_R` (eq. 6.6), over the stages whose input is decided.
//!
//! The cost is quadratic in the inputs, and a stage problem has it in its form (`Σ r (Δū + w_k − w_{k−1})²`): the solvers take
//! the weights `R` and know the derivatives.

/// The comfort cost of one vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comfort {
    /// Index of the vehicle whose inputs it concerns.
    pub vehicle: usize,
    /// Diagonal of `R` on (Δa, Δδ).
    pub weights: [f64; 2],
}

impl Comfort {
    /// Adds the cost of one change of the input.
    pub(in crate::trajectory) fn add_value(&self, change: [f64; 2], total: &mut f64) {
        for axis in 0..2 {
            *total += self.weights[axis] * change[axis].powi(2);
        }
    }
}
