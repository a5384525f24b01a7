//! Integrals and means of sampled signals.

/// Length of the windows of a peak \[s\].
const PEAK_WINDOW_S: f64 = 900.0;

/// The integral of `values(index)` over the times by the trapezoidal rule \[unit of the values times seconds\].
pub fn trapezoid(times_s: &[f64], values: impl Fn(usize) -> f64) -> f64 {
    (1..times_s.len()).map(|i| 0.5 * (values(i - 1) + values(i)) * (times_s[i] - times_s[i - 1])).sum()
}

/// The largest mean of the samples within a quarter of an hour. Windows begin at the first time and include their first instant, as
/// those of pandas do; samples count alike, whatever the time between them. `None` without samples.
pub fn peak(times_s: &[f64], values: impl Fn(usize) -> f64) -> Option<f64> {
    let window = |i: usize| ((times_s[i] - times_s[0]) / PEAK_WINDOW_S).floor();
    let mut peak: Option<f64> = None;
    let mut from = 0;
    while from < times_s.len() {
        let mut to = from;
        while to < times_s.len() && window(to) == window(from) {
            to += 1;
        }
        let mean = (from..to).map(&values).sum::<f64>() / (to - from) as f64;
        peak = Some(peak.map_or(mean, |largest| largest.max(mean)));
        from = to;
    }
    peak
}
