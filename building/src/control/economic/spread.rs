//! How far temperatures are from their prediction a step before.
//!
//! ```text
//! v ← v + (e² − v)/m        m = 1 + the number of errors so far, at most that of a day's steps; v at first by the filter
//! ```

/// Weight of the filter's own variance at the start, in errors.
const FIRST_WEIGHT: f64 = 6.0;

/// Mean squares of the errors of predictions of the next step, zone by zone.
#[derive(Clone, Debug)]
pub(super) struct Spread {
    variance_k2: Vec<f64>,
    weight: f64,
    most: f64,
}

impl Spread {
    /// Begins at the variances that the filter expects; a day has `steps` steps.
    pub fn new(variance_k2: Vec<f64>, steps: usize) -> Self {
        Self { variance_k2, weight: FIRST_WEIGHT, most: (steps as f64).max(FIRST_WEIGHT) }
    }

    /// Counts the errors of a step \[K\].
    pub fn note(&mut self, errors_k: &[f64]) {
        self.weight = (self.weight + 1.0).min(self.most);
        for (variance_k2, error_k) in self.variance_k2.iter_mut().zip(errors_k) {
            *variance_k2 += (error_k * error_k - *variance_k2) / self.weight;
        }
    }

    /// Standard deviations \[K\].
    pub fn deviations_k(&self) -> Vec<f64> {
        self.variance_k2.iter().map(|variance_k2| libm::sqrt(variance_k2.max(0.0))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn predictions_without_error_leave_no_margin_and_errors_bring_it_back() {
        let mut spread = Spread::new(vec![0.01, 0.04], 48);
        assert_eq!(spread.deviations_k(), [0.1, 0.2]);
        (0..480).for_each(|_| spread.note(&[0.0, 0.3]));
        let deviations_k = spread.deviations_k();
        assert!(deviations_k[0] < 1e-3 && (deviations_k[1] - 0.3).abs() < 1e-3, "{deviations_k:?}");
    }
}
