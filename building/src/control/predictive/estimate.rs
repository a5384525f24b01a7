//! The controller's estimate of the building's state, and of heat that its model does not explain.
//!
//! ```text
//! T⁻(t+1) = A T(t) + B (k T₀ + u + w + d)        the step that the model expects
//! d ← d + λ h₁⁻¹ (T_measured − E T⁻)             heat of the step that it does not
//! T(t+1) = T⁻(t+1), with the zones as measured
//! ```
//!
//! The temperatures of walls are not measured after midnight and follow the model. In the steady state no innovation is left,
//! whatever constant heat the forecast misses: control without offset (Pannocchia and Rawlings, "Disturbance models for
//! offset-free model-predictive control", 2003).

use crate::discretise::Model;
use crate::lifted::Lifted;

/// The state of the building as the controller believes it.
#[derive(Clone, Debug)]
pub(super) struct Estimate {
    /// A single step, to tell heat from temperatures.
    one_step: Lifted,
    rate: f64,
    /// Temperatures of the nodes \[°C\], zones first; none before the first midnight.
    pub nodes_c: Vec<f64>,
    /// d: heat that the forecast misses, one number per zone \[kW\].
    pub missed_kw: Vec<f64>,
    /// Whether `nodes_c` is a prediction that a measurement can correct.
    is_predicted: bool,
}

impl Estimate {
    /// Begins without an estimate. `rate` is λ.
    pub fn new(model: &Model, rate: f64) -> Self {
        let missed_kw = vec![0.0; model.network().zone_count()];
        Self { one_step: Lifted::new(model, 1), rate, nodes_c: Vec::new(), missed_kw, is_predicted: false }
    }

    /// Begins a day with the temperatures of all nodes. They also correct the prediction that was made for them.
    pub fn begin_day(&mut self, nodes_c: &[f64]) {
        self.measure(&nodes_c[..self.missed_kw.len()]);
        self.nodes_c = nodes_c.to_vec();
    }

    /// Corrects the prediction by measured temperatures of the zones \[°C\].
    pub fn measure(&mut self, zones_c: &[f64]) {
        if !zones_c.iter().all(|temperature_c| temperature_c.is_finite()) {
            return;
        }
        if self.is_predicted {
            let unexplained_k: Vec<f64> = zones_c.iter().zip(&self.nodes_c).map(|(t, expected)| t - expected).collect();
            for (missed_kw, more_kw) in self.missed_kw.iter_mut().zip(self.one_step.solve(&unexplained_k)) {
                *missed_kw += self.rate * more_kw;
            }
            self.is_predicted = false;
        }
        for (node_c, measured_c) in self.nodes_c.iter_mut().zip(zones_c) {
            *node_c = *measured_c;
        }
    }

    /// Forecast gains of the nodes, plus the heat of the zones that the forecast misses \[kW\].
    pub fn with_missed_kw(&self, gains_kw: &[f64]) -> Vec<f64> {
        let mut gains_kw = gains_kw.to_vec();
        gains_kw.iter_mut().zip(&self.missed_kw).for_each(|(gain, missed)| *gain += missed);
        gains_kw
    }

    /// Predicts the temperatures at the end of a step with this heat, outdoor temperature and forecast gains. If a
    /// number is not finite, it predicts nothing: the temperatures stay until they are measured.
    pub fn predict(&mut self, heat_kw: &[f64], ambient_c: f64, gains_kw: &[f64]) {
        let gains_kw = self.with_missed_kw(gains_kw);
        if !ambient_c.is_finite() || !gains_kw.iter().all(|gain| gain.is_finite()) {
            return;
        }
        self.one_step.model().step(&mut self.nodes_c, heat_kw, ambient_c, &gains_kw);
        self.is_predicted = true;
    }
}
