//! Wilson's score interval.
#![allow(dead_code, reason = "each binary uses its own part")]

/// Wilson's score interval of a share, at a confidence of 95 %.
pub fn wilson_interval(count: usize, of: usize) -> [f64; 2] {
    const QUANTILE: f64 = 1.959_964;
    let (count, of, z2) = (count as f64, of as f64, QUANTILE * QUANTILE);
    let (middle, scale) = (count + 0.5 * z2, of + z2);
    let half_width = QUANTILE * (count * (of - count) / of + 0.25 * z2).sqrt();
    [(middle - half_width).max(0.0) / scale, (middle + half_width).min(scale) / scale]
}
