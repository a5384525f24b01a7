//! The Kalman filter: temperatures of walls that are not measured, and heat that the forecast misses.
//!
//! ```text
//! x(t+1) = A x(t) + B (k T₀ + u + w + d) + ξ        nodes, zones first
//! d(t+1) = φ d(t) + η                               missed heat of the zones, φ = exp(−h/τ)
//! y(t)   = x_zones(t) + ν
//! ```
//!
//! The gain is that of the steady state. Its covariance solves the discrete algebraic Riccati equation of the filter, by the
//! structure-preserving doubling algorithm (Chu, Fan, Lin and Wang, "Structure-preserving algorithms for periodic discrete-time
//! algebraic Riccati equations", 2004), which converges quadratically: the pair is detectable, since heat of a zone shows in its temperature.

use nalgebra::DMatrix;

use super::EconomicSettings;
use super::spread::Spread;
use crate::discretise::Model;
use crate::lifted::Lifted;
use crate::staged::dense::product;

/// Maximum number of doublings; each squares the error.
const MAX_DOUBLINGS: usize = 40;
/// The doublings end when the covariance changes by at most this share.
const MAX_CHANGE: f64 = 1e-12;

/// The filter with its estimates.
#[derive(Clone, Debug)]
pub(super) struct Kalman {
    /// The model over a single step, which infers heat from temperatures.
    one_step: Lifted,
    /// Gain of nodes and missed heat, (nodes + zones) by zones.
    gain: DMatrix<f64>,
    /// φ.
    persistence: f64,
    /// Estimated temperatures of the nodes \[°C\]; empty before the first midnight.
    pub nodes_c: Vec<f64>,
    /// Estimated heat that the forecast misses \[kW\], of each zone.
    pub missed_kw: Vec<f64>,
    /// The missed heat that went into the last prediction; `None` before the first prediction.
    predicted_with_kw: Option<Vec<f64>>,
    /// What the predictions of the next step miss.
    pub spread: Spread,
}

impl Kalman {
    /// A filter before the first midnight of days of `steps` steps.
    pub fn new(model: &Model, settings: &EconomicSettings, steps: usize) -> Self {
        let persistence = libm::exp(-model.step_s() / (3600.0 * settings.persistence_h));
        let (gain, variance_k2) = steady_gain(model, settings, persistence);
        Self {
            one_step: Lifted::new(model, 1),
            gain,
            persistence,
            nodes_c: Vec::new(),
            missed_kw: vec![0.0; model.network().zone_count()],
            predicted_with_kw: None,
            spread: Spread::new(variance_k2, steps),
        }
    }

    /// The share of the missed heat that remains after `steps` steps.
    pub fn left_after(&self, steps: usize) -> f64 {
        libm::pow(self.persistence, steps as f64)
    }

    /// Starts a day: the temperatures of all nodes are used before the first day, afterwards only those of the zones.
    pub fn begin(&mut self, nodes_c: &[f64]) -> Option<Vec<f64>> {
        if self.nodes_c.is_empty() {
            self.nodes_c = nodes_c.to_vec();
            return None;
        }
        self.measure(&nodes_c[..self.missed_kw.len()])
    }

    /// Corrects the prediction by measured temperatures of the zones \[°C\]. Returns the heat of the last step that was not
    /// forecast \[kW\], as if all of it entered the zones; `None` without a prediction.
    pub fn measure(&mut self, zones_c: &[f64]) -> Option<Vec<f64>> {
        if !zones_c.iter().all(|temperature_c| temperature_c.is_finite()) {
            return None;
        }
        let Some(with_kw) = self.predicted_with_kw.take() else {
            self.nodes_c[..zones_c.len()].copy_from_slice(zones_c);
            return None;
        };
        let innovation_k: Vec<f64> = zones_c.iter().zip(&self.nodes_c).map(|(t, expected)| t - expected).collect();
        self.spread.note(&innovation_k);
        let unexplained = self.one_step.solve(&innovation_k);
        let nodes = self.nodes_c.len();
        for (j, innovation_k) in innovation_k.iter().enumerate() {
            let column = self.gain.column(j);
            self.nodes_c.iter_mut().zip(column.iter()).for_each(|(node, gain)| *node += gain * innovation_k);
            self.missed_kw.iter_mut().zip(column.iter().skip(nodes)).for_each(|(d, gain)| *d += gain * innovation_k);
        }
        Some(unexplained.iter().zip(with_kw).map(|(more, with)| more + with).collect())
    }

    /// Predicts the temperatures at the end of a step. If a number is not finite, it predicts nothing.
    pub fn predict(&mut self, heat_kw: &[f64], ambient_c: f64, gains_kw: &[f64]) {
        let mut gains_kw = gains_kw.to_vec();
        gains_kw.iter_mut().zip(&self.missed_kw).for_each(|(gain, missed)| *gain += missed);
        if !ambient_c.is_finite() || !gains_kw.iter().chain(heat_kw).all(|kw| kw.is_finite()) {
            return;
        }
        self.one_step.model().step(&mut self.nodes_c, heat_kw, ambient_c, &gains_kw);
        self.predicted_with_kw = Some(self.missed_kw.clone());
        self.missed_kw.iter_mut().for_each(|missed| *missed *= self.persistence);
    }
}

/// The steady gain K = P Cᵀ (C P Cᵀ + R)⁻¹, with P the covariance of the prediction, and the variance of each innovation \[K²\].
fn steady_gain(model: &Model, settings: &EconomicSettings, persistence: f64) -> (DMatrix<f64>, Vec<f64>) {
    let (n, zones) = (model.network().node_count(), model.network().zone_count());
    let order = n + zones;
    let mut a = DMatrix::zeros(order, order);
    a.view_mut((0, 0), (n, n)).copy_from(&model.state_matrix());
    a.view_mut((0, n), (n, zones)).copy_from(&model.gain_matrix());
    let hours = model.step_s() / 3600.0;
    let mut noise = DMatrix::zeros(order, order);
    for i in 0..n {
        noise[(i, i)] = settings.wall_noise_k * settings.wall_noise_k * hours;
    }
    for zone in 0..zones {
        a[(n + zone, n + zone)] = persistence;
        noise[(n + zone, n + zone)] = settings.heat_noise_kw * settings.heat_noise_kw * hours;
    }
    let sensor = settings.sensor_noise_k * settings.sensor_noise_k;
    let p = covariance(&a, noise, zones, sensor);
    let mut seen = p.view((0, 0), (zones, zones)).into_owned();
    for zone in 0..zones {
        seen[(zone, zone)] += sensor;
    }
    let variance_k2 = seen.diagonal().iter().copied().collect();
    let rows = p.view((0, 0), (zones, order)).into_owned();
    // The sum has an inverse, because P is a covariance and R is positive; without one, the measurement would be taken as it is.
    let gain = seen
        .lu()
        .solve(&rows)
        .map_or_else(|| DMatrix::from_fn(order, zones, |i, j| if i == j { 1.0 } else { 0.0 }), |gain| gain.transpose());
    (gain, variance_k2)
}

/// P = A P Aᵀ − A P Cᵀ (C P Cᵀ + R)⁻¹ C P Aᵀ + Q, by doubling, where C picks the first `zones` entries and R = `sensor` I.
fn covariance(a: &DMatrix<f64>, noise: DMatrix<f64>, zones: usize, sensor: f64) -> DMatrix<f64> {
    let order = a.nrows();
    let mut f = a.transpose();
    let mut g = DMatrix::from_fn(order, order, |i, j| if i == j && i < zones { 1.0 / sensor } else { 0.0 });
    let mut p = noise;
    for _ in 0..MAX_DOUBLINGS {
        let mut w = product(&g, &p);
        for i in 0..order {
            w[(i, i)] += 1.0;
        }
        let factor = w.lu();
        let (Some(by_f), Some(by_g)) = (factor.solve(&f), factor.solve(&g)) else { break };
        let more_p = product(&product(&f.transpose(), &p), &by_f);
        let more_g = product(&product(&f, &by_g), &f.transpose());
        f = product(&f, &by_f);
        g += 0.5 * (&more_g + more_g.transpose());
        let change = 0.5 * (&more_p + more_p.transpose());
        p += &change;
        if change.amax() <= MAX_CHANGE * p.amax() {
            break;
        }
    }
    p
}
