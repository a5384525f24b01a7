//! Finds the combination of a few directions of all zones that has the least cost.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::zone::ZoneModels;
use crate::comfort::Targets;
use crate::control::BandPenalty;
use crate::lifted::Lifted;

/// Largest number of Newton steps to the best combination. The cost is piecewise quadratic, so they end after a few.
const MAX_NEWTON_STEPS: usize = 12;
/// Curvature that is added to each direction, as a share of its own, so that dependent directions have one combination.
const REGULARISATION_RATIO: f64 = 1e-10;

/// A change of all inputs, and of the temperatures that it causes. Both stacked.
#[derive(Clone, Debug)]
pub(super) struct Direction {
    pub heat_kw: Vec<f64>,
    pub risen_k: Vec<f64>,
}

/// J over u + Σ x_j d_j, temperatures moving in proportion.
pub(super) struct StepSpace<'a> {
    pub day: &'a JointDay<'a>,
    pub heat_kw: &'a [f64],
    pub known_c: &'a [f64],
    pub directions: Vec<Direction>,
    /// Sums over all zones so far: each collects a number, a gradient or a Hessian.
    pub sums: &'a mut usize,
}

impl StepSpace<'_> {
    /// The change of input k at the combination x of the directions.
    pub fn step_kw(&self, x: &[f64], k: usize) -> f64 {
        self.directions.iter().zip(x).map(|(direction, x)| x * direction.heat_kw[k]).sum()
    }

    fn temperature_c(&self, x: &[f64], k: usize) -> f64 {
        self.known_c[k] + self.directions.iter().zip(x).map(|(direction, x)| x * direction.risen_k[k]).sum::<f64>()
    }

    /// The cost J at the combination x.
    pub fn cost(&mut self, x: &[f64]) -> f64 {
        *self.sums += 1;
        let inputs_kw: Vec<f64> = (0..self.heat_kw.len()).map(|k| self.heat_kw[k] + self.step_kw(x, k)).collect();
        let temperatures_c: Vec<f64> = (0..self.heat_kw.len()).map(|k| self.temperature_c(x, k)).collect();
        self.day.cost_of(&temperatures_c, &inputs_kw)
    }

    /// The combination with the least cost, by Newton's method with a step that is halved until the cost falls.
    pub fn minimum(&mut self) -> Vec<f64> {
        let mut x = vec![0.0; self.directions.len()];
        let mut cost = self.cost(&x);
        for _ in 0..MAX_NEWTON_STEPS {
            let (gradient, hessian) = self.expansion(&x);
            let Some(factor) = Cholesky::new(hessian) else { return x };
            let step = -factor.solve(&gradient);
            let mut length = 1.0;
            let moved = |length: f64| -> Vec<f64> { x.iter().zip(&step).map(|(x, step)| x + length * step).collect() };
            let mut next = (moved(length), f64::INFINITY);
            while length > 1e-3 {
                next = (moved(length), self.cost(&moved(length)));
                if next.1 < cost {
                    break;
                }
                length *= 0.5;
            }
            if next.1.partial_cmp(&cost) != Some(std::cmp::Ordering::Less) {
                break;
            }
            let gained = cost - next.1;
            (x, cost) = next;
            if gained <= 1e-12 * cost.abs() {
                break;
            }
        }
        x
    }

    /// Gradient and Hessian at x.
    fn expansion(&mut self, x: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        *self.sums += 1;
        let count = self.directions.len();
        let (mut gradient, mut hessian) = (DVector::zeros(count), DMatrix::zeros(count, count));
        for k in 0..self.heat_kw.len() {
            let weight = 2.0 * self.day.targets.input_weight[k];
            let u = self.heat_kw[k] + self.step_kw(x, k);
            let (slope, bend) = self.day.slope(k, self.temperature_c(x, k));
            for (i, first) in self.directions.iter().enumerate() {
                gradient[i] += slope * first.risen_k[k] + weight * u * first.heat_kw[k];
                for (j, second) in self.directions[..=i].iter().enumerate() {
                    hessian[(i, j)] +=
                        bend * first.risen_k[k] * second.risen_k[k] + weight * first.heat_kw[k] * second.heat_kw[k];
                }
            }
        }
        for i in 0..count {
            hessian[(i, i)] *= 1.0 + REGULARISATION_RATIO;
        }
        (gradient, hessian)
    }
}

/// A day to be planned together.
pub(super) struct JointDay<'a> {
    pub lifted: &'a Lifted,
    pub targets: &'a Targets,
    pub penalty: BandPenalty,
    pub zone_models: &'a ZoneModels,
    /// Nodes' temperatures at midnight.
    pub initial_c: &'a [f64],
    /// All heat but that of the equipment, nodes of a step together \[kW\].
    pub driving_kw: &'a [f64],
    /// Temperatures of the zones without equipment, stacked.
    pub free_c: &'a [f64],
    pub silent: Option<usize>,
}

impl JointDay<'_> {
    /// J of the inputs, with penalties, by simulation.
    pub fn cost(&self, heat_kw: &[f64]) -> f64 {
        let temperatures_c: Vec<f64> =
            self.free_c.iter().zip(self.lifted.product(heat_kw)).map(|(free, risen)| free + risen).collect();
        self.cost_of(&temperatures_c, heat_kw)
    }

    pub(super) fn cost_of(&self, temperatures_c: &[f64], heat_kw: &[f64]) -> f64 {
        self.targets.cost(temperatures_c, heat_kw) + self.penalty.evaluate(self.targets, temperatures_c)
    }

    /// ∂J/∂T and, without the parts of bounds that are kept now, ∂²J/∂T² of an entry.
    pub(super) fn slope(&self, i: usize, temperature_c: f64) -> (f64, f64) {
        let targets = self.targets;
        let error_k = targets.reference_c[i] - temperature_c;
        let weight = targets.error_weight[i];
        let beyond_k = targets.beyond_k(i, temperature_c);
        let c = self.penalty.quadratic;
        let bent = if beyond_k > 0.0 { 2.0 * c } else { 0.0 };
        (-2.0 * weight * error_k - 2.0 * c * beyond_k * error_k.signum(), 2.0 * weight + bent)
    }
}
