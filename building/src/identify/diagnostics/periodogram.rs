//! The cumulated periodogram: for white noise it is a straight line, and its distance from the band around this line
//! measures the remaining structure.
//!
//! With the periodogram I_j of the tapered series at frequencies j/n, C_j = Σ_{i≤j} I_i / Σ I. White noise stays within
//! ±1.358/(√m + 0.12 + 0.11/√m) of the line with probability 95 % (Kolmogorov and Smirnov, m frequencies). The mean of the
//! excess over that band is what Leprince et al. (Energy and Buildings 253, 2021) call nCPBES; ours follows their
//! definition, cosine taper over a tenth at each end included, so that numbers can be compared.

use std::f64::consts::PI;

use rustfft::FftPlannerScalar;
use rustfft::num_complex::Complex;

/// The excess is rounded to a multiple of one over this, nine decimals. The transform takes sines from the platform's library,
/// whose last digit depends on the processor; rounding makes the reported number the same everywhere.
const EXCESS_STEPS_PER_UNIT: f64 = 1e9;

/// The normalised cumulated periodogram's boundary excess sum; zero for white noise. `None` for fewer than 16 values.
pub(super) fn boundary_excess(series: &[f64]) -> Option<f64> {
    if series.len() < 16 {
        return None;
    }
    let power = periodogram(&tapered(series));
    let total: f64 = power.iter().sum();
    let count = power.len() as f64;
    let root = (count - 1.0).sqrt();
    let band = 1.358 / (root + 0.12 + 0.11 / root);
    let mut cumulated = 0.0;
    let mut excess = 0.0;
    for (index, value) in power.iter().enumerate() {
        cumulated += value / total;
        let line = 2.0 * index as f64 / series.len() as f64;
        excess += ((cumulated - line).abs() - band).max(0.0);
    }
    Some((excess / count * EXCESS_STEPS_PER_UNIT).round() / EXCESS_STEPS_PER_UNIT)
}

/// The series about its mean, with a cosine taper over a tenth at each end.
fn tapered(series: &[f64]) -> Vec<f64> {
    let mean = series.iter().sum::<f64>() / series.len() as f64;
    let taper = series.len() / 10;
    let weight = |index: usize| {
        let from_end = index.min(series.len() - 1 - index);
        if from_end >= taper {
            return 1.0;
        }
        0.5 * (1.0 - libm::cos(PI * (2.0 * from_end as f64 + 1.0) / (2.0 * taper as f64)))
    };
    series.iter().enumerate().map(|(index, value)| (value - mean) * weight(index)).collect()
}

/// |Σ_t x_t exp(−2πi jt/n)|² for the frequencies j/n below one half, the zeroth set to zero.
fn periodogram(series: &[f64]) -> Vec<f64> {
    let mut transform: Vec<Complex<f64>> = series.iter().map(|&value| Complex::new(value, 0.0)).collect();
    // This FFT planner does not use SIMD: the others choose their instructions, and thereby the order of sums, by the processor.
    FftPlannerScalar::new().plan_fft_forward(series.len()).process(&mut transform);
    transform[0] = Complex::ZERO;
    transform[..series.len().div_ceil(2)].iter().map(Complex::norm_sqr).collect()
}

#[cfg(test)]
mod tests {
    use super::{boundary_excess, periodogram};

    #[test]
    fn a_sine_has_all_its_power_at_its_frequency() {
        let series: Vec<f64> =
            (0..200).map(|t| (2.0 * std::f64::consts::PI * 7.0 * f64::from(t) / 200.0).sin()).collect();
        for (frequency, power) in periodogram(&series).iter().enumerate() {
            let expected = if frequency == 7 { 100.0_f64.powi(2) } else { 0.0 };
            assert!((power - expected).abs() < 1e-8, "{frequency}: {power}");
        }
    }

    /// Parseval: the power over all frequencies is n Σ x² (frequencies above one half mirror those below).
    #[test]
    fn the_periodogram_obeys_parsevals_theorem() {
        let series: Vec<f64> = (0..101).map(|t| f64::from((t * 31) % 17) - 8.0).collect();
        let mean = series.iter().sum::<f64>() / 101.0;
        let energy: f64 = 101.0 * series.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
        let power: f64 = 2.0 * periodogram(&series).iter().sum::<f64>();
        assert!((power - energy).abs() < 1e-8 * energy);
    }

    /// The definition, summed term by term.
    #[test]
    fn the_periodogram_is_the_squared_discrete_fourier_transform() {
        for n in [16, 97, 240, 1009] {
            let series: Vec<f64> = (0..n).map(|t| f64::from((t * 7919) % 1013) / 1013.0 - 0.5).collect();
            let energy = f64::from(n) * series.iter().map(|x| x * x).sum::<f64>();
            for (j, power) in periodogram(&series).iter().enumerate().skip(1) {
                let angle = |t: usize| std::f64::consts::TAU * ((j * t) % series.len()) as f64 / f64::from(n);
                let part = |of: fn(f64) -> f64| series.iter().enumerate().map(|(t, x)| x * of(angle(t))).sum::<f64>();
                let (real, imaginary) = (part(f64::cos), part(f64::sin));
                assert!((power - real * real - imaginary * imaginary).abs() < 1e-12 * energy, "{j} of {n}");
            }
        }
    }

    /// Structure that begins late in a long series counts too.
    #[test]
    fn structure_late_in_a_long_series_is_detected() {
        let mut series = scramble(60_000);
        let white = boundary_excess(&series).expect("long enough");
        for (t, value) in series.iter_mut().enumerate().skip(30_000) {
            *value += (t as f64 * 0.05).sin();
        }
        let coloured = boundary_excess(&series).expect("long enough");
        assert!(white < 1e-3 && coloured > 0.1, "{white} {coloured}");
    }

    /// A multiplicative congruential sequence: as good as white.
    fn scramble(count: usize) -> Vec<f64> {
        let next = |state: &u64| Some(state * 48_271 % 2_147_483_647);
        std::iter::successors(Some(606_091_095), next).take(count).map(|state| state as f64 / 2_147_483_647.0).collect()
    }

    #[test]
    fn a_slow_wave_leaves_the_band_of_white_noise_and_noise_does_not() {
        let wave: Vec<f64> = (0..500).map(|t| (f64::from(t) * 0.05).sin()).collect();
        assert!(boundary_excess(&wave).expect("long enough") > 0.2);
        assert!(boundary_excess(&scramble(500)).expect("long enough") < 1e-3);
    }
}
