//! Converts the coefficients of a sampled model to the rates of the continuous network.
//!
//! Let M be the matrix of the losses in a step by eq. 2.3, T(t+1) = (I − M) T(t) + …: T_s Σ_k b_ik on the diagonal
//! (with T_s a_i ṁ c_p of the supply air), −T_s b_ij beside it. A continuous network with rates A and inputs that are held
//! over a step has I − M = exp(−T_s A), so
//!
//! ```text
//! T_s A = −ln(I − M) = K M,    K = I + M/2 + M²/3 + …
//! ```
//!
//! and the coefficients of the inputs, b_i0, a_i and s_i, are multiplied by K_ii (their effect on other zones within one step
//! is of second order and neglected). For one zone K is −ln(1 − y)/y with y the share of a temperature difference that decays within a step.

use nalgebra::DMatrix;

use super::estimate::Estimate;
use super::free_run::RunZone;
use super::normal::product;
use super::regression::Coefficient;
use super::telemetry::Telemetry;

/// The series for K ends when all entries of the power of M are below this. K is near the identity, so what follows is below its
/// rounding errors.
const MAX_OMITTED_POWER: f64 = 1e-15;
const MOST_TERMS: i32 = 1000;

/// The estimates of all zones as rates of the continuous network.
///
/// A model that settles within a step has no continuous counterpart; its estimates are returned as they are.
pub(super) fn continuous(telemetry: &Telemetry, zones: &[RunZone], estimates: &[Estimate]) -> Vec<Estimate> {
    let loss = loss(telemetry, zones);
    let Some(factor) = factor(&loss) else { return estimates.to_vec() };
    let rates = product(&factor, &loss) / telemetry.step_s;
    let convert = |(zone, mut estimate): (usize, Estimate)| {
        let own = factor[(zone, zone)];
        for (index, kind) in zones[zone].model.coefficients(telemetry).iter().enumerate() {
            let value = estimate.coefficients[index];
            let converted = match neighbour(telemetry, kind) {
                Some(other) => -rates[(zone, other)],
                None => own * value,
            };
            estimate.unconstrained[index] = own * (estimate.unconstrained[index] - value) + converted;
            estimate.coefficients[index] = converted.max(0.0);
        }
        estimate.covariance *= own * own;
        estimate
    };
    estimates.iter().cloned().enumerate().map(convert).collect()
}

/// The share of a zone's temperature difference that decays within a step, M_ii.
pub(super) fn decay(telemetry: &Telemetry, zone: usize, run: &RunZone) -> f64 {
    let supply_kw_per_k: f64 = (telemetry.zones[zone].supply_air.iter())
        .map(|air| air.conductance_kw_per_k.iter().sum::<f64>() / air.conductance_kw_per_k.len().max(1) as f64)
        .sum();
    let rate = |(kind, value): (&Coefficient, &f64)| match kind {
        Coefficient::Wall { .. } => *value,
        Coefficient::Heat => value * supply_kw_per_k,
        Coefficient::Solar => 0.0,
    };
    telemetry.step_s * run.model.coefficients(telemetry).iter().zip(&run.coefficients).map(rate).sum::<f64>()
}

/// The zone on the other side of a wall, if there is one.
fn neighbour(telemetry: &Telemetry, kind: &Coefficient) -> Option<usize> {
    match kind {
        Coefficient::Wall { to } => telemetry.zones.iter().position(|zone| zone.name == *to),
        Coefficient::Heat | Coefficient::Solar => None,
    }
}

/// M.
fn loss(telemetry: &Telemetry, zones: &[RunZone]) -> DMatrix<f64> {
    let mut loss = DMatrix::zeros(zones.len(), zones.len());
    for (zone, run) in zones.iter().enumerate() {
        loss[(zone, zone)] = decay(telemetry, zone, run);
        for (kind, value) in run.model.coefficients(telemetry).iter().zip(&run.coefficients) {
            if let Some(other) = neighbour(telemetry, kind) {
                loss[(zone, other)] = -telemetry.step_s * value;
            }
        }
    }
    loss
}

/// K; `None` where its series does not converge.
fn factor(loss: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let mut power = DMatrix::identity(loss.nrows(), loss.ncols());
    let mut factor = power.clone();
    for term in 2..=MOST_TERMS {
        power = product(&power, loss);
        factor += &power / f64::from(term);
        match power.amax() {
            size if size < MAX_OMITTED_POWER => return Some(factor),
            size if size > 1e3 => return None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::factor;
    use crate::identify::normal::product;

    #[test]
    fn the_rate_of_one_zone_is_the_logarithm_of_its_decay() {
        for y in [0.01, 0.1, 0.5, 0.9] {
            let k = factor(&DMatrix::from_element(1, 1, y)).expect("converges")[(0, 0)];
            assert!((k - -(1.0_f64 - y).ln() / y).abs() < 1e-12);
        }
        assert!(factor(&DMatrix::from_element(1, 1, 1.5)).is_none());
    }

    /// exp(−K M) = I − M, summed as a power series.
    #[test]
    fn continuous_rates_invert_the_matrix_exponential() {
        let m = DMatrix::from_row_slice(3, 3, &[0.3, -0.1, 0.0, -0.05, 0.2, -0.1, 0.0, -0.2, 0.4]);
        let rates = product(&factor(&m).expect("converges"), &m);
        let (mut power, mut exponential) = (DMatrix::<f64>::identity(3, 3), DMatrix::<f64>::identity(3, 3));
        for term in 1..40 {
            power = product(&power, &rates) / -f64::from(term);
            exponential += &power;
        }
        assert!((exponential - (DMatrix::identity(3, 3) - m)).amax() < 1e-13);
    }
}
