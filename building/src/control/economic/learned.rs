//! Learns the heat that the forecast misses at the same hour of every day.
//!
//! ```text
//! m ← (1 − λ) m + λ d_k          mean of the missed heat of a step and zone
//! v ← (1 − λ) (v + λ (d_k − m)²) its variance from day to day
//! bias = m · m² / (m² + v λ/(2 − λ))
//! ```
//!
//! A mean that is small compared with its own uncertainty `v λ/(2 − λ)` is not trusted: an error that does not repeat
//! is not expected again.

/// Learned means of the missed heat of each step and zone.
#[derive(Clone, Debug)]
pub(super) struct LearnedForecast {
    rate: f64,
    /// Stacked \[kW\].
    mean_kw: Vec<f64>,
    /// Stacked \[kW²\].
    variance_kw2: Vec<f64>,
    /// Missed heat of the day in progress, stacked \[kW\].
    today_kw: Vec<Option<f64>>,
    days: usize,
}

impl LearnedForecast {
    /// Begins without any learned heat; `size` is the number of steps times the number of zones, and `rate` is λ.
    pub fn new(size: usize, rate: f64) -> Self {
        let zeros = vec![0.0; size];
        Self { rate, mean_kw: zeros.clone(), variance_kw2: zeros, today_kw: vec![None; size], days: 0 }
    }

    /// Records the heat of a step that the forecast missed \[kW\], one number per zone.
    pub fn note(&mut self, step: usize, missed_kw: &[f64]) {
        let zones = missed_kw.len();
        for (today, missed_kw) in self.today_kw.iter_mut().skip(step * zones).zip(missed_kw) {
            *today = Some(*missed_kw);
        }
    }

    /// Updates the means and variances with the day that is over.
    pub fn end_day(&mut self) {
        if self.today_kw.iter().all(Option::is_none) {
            return;
        }
        self.days += 1;
        // The first days have equal weights, as in an average.
        let rate = self.rate.max(1.0 / self.days as f64).min(if self.rate > 0.0 { 1.0 } else { 0.0 });
        for (i, today_kw) in self.today_kw.iter_mut().enumerate() {
            let Some(missed_kw) = today_kw.take() else { continue };
            let error_kw = missed_kw - self.mean_kw[i];
            self.mean_kw[i] += rate * error_kw;
            self.variance_kw2[i] = (1.0 - rate) * (self.variance_kw2[i] + rate * error_kw * error_kw);
        }
    }

    /// The heat that is expected beyond the forecast in a step \[kW\], one number per zone.
    pub fn bias_kw(&self, step: usize, zones: usize) -> impl Iterator<Item = f64> + '_ {
        (step * zones..(step + 1) * zones).map(|i| {
            let square = self.mean_kw[i] * self.mean_kw[i];
            // A single day does not show how days vary.
            if self.days < 2 || square == 0.0 {
                return 0.0;
            }
            let uncertainty = self.variance_kw2[i] * self.rate / (2.0 - self.rate);
            self.mean_kw[i] * square / (square + uncertainty)
        })
    }

    /// The bias of all steps, stacked \[kW\].
    pub fn all_kw(&self, zones: usize) -> Vec<f64> {
        (0..self.mean_kw.len() / zones.max(1)).flat_map(|step| self.bias_kw(step, zones)).collect()
    }
}
