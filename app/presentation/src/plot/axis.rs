//! Axes: the map from values to pixels, and round values for ticks.

use std::ops::Range;

/// The map from values to pixels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    values: Range<f64>,
    pixels: [f64; 2],
    logarithmic: bool,
    every: Option<f64>,
}

impl Axis {
    /// A linear axis that maps the ends of `values` to `pixels`.
    pub fn new(values: Range<f64>, pixels: [f64; 2]) -> Axis {
        Axis { values, pixels, logarithmic: false, every: None }
    }

    /// The same axis with a logarithmic scale, if all values are above 0.
    pub fn logarithmic(self) -> Axis {
        Axis { logarithmic: self.values.start > 0.0, ..self }
    }

    /// The same axis with ticks at multiples of a value, if one is given.
    pub fn every(self, every: Option<f64>) -> Axis {
        Axis { every, ..self }
    }

    /// The pixel of a value, clamped to the ends of the axis.
    pub fn pixel(&self, value: f64) -> f64 {
        let Range { start, end } = self.values;
        let share = if self.logarithmic {
            libm::log(value.max(start) / start) / libm::log(end / start)
        } else {
            (value - start) / (end - start)
        };
        self.pixels[0] + share.clamp(0.0, 1.0) * (self.pixels[1] - self.pixels[0])
    }

    /// Ticks: round values within the ends, about one every `spacing` pixels, with their labels.
    pub fn ticks(&self, spacing: f64) -> Vec<(f64, String)> {
        let Range { start, end } = self.values;
        if self.logarithmic {
            return decades(start, end);
        }
        let count = ((self.pixels[1] - self.pixels[0]).abs() / spacing).max(1.0);
        let step = self.every.unwrap_or_else(|| round_step((end - start) / count));
        let decimals = (-libm::floor(libm::log10(step) + 1e-9)).max(0.0) as usize;
        let decimals = if is_whole(step * libm::pow(10.0, decimals as f64)) { decimals } else { decimals + 1 };
        let words = |value: f64| match step < SHORTEST_WRITTEN_STEP {
            true => format!("{value:.1e}"),
            false => format!("{value:.decimals$}"),
        };
        let (first, last) = (libm::ceil(start / step - 1e-9) as i64, libm::floor(end / step + 1e-9) as i64);
        (first..=last)
            .map(|index| {
                let value = index as f64 * step;
                (value, words(value).replace('-', "\u{2212}"))
            })
            .collect()
    }
}

/// Numbers with smaller steps are written with a power of ten, since they would not fit beside an axis.
const SHORTEST_WRITTEN_STEP: f64 = 1e-6;

/// The smallest of 1, 2, 2.5 and 5 times a power of ten that is at least `least`.
fn round_step(least: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    let factor = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().find(|factor| factor * power >= least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

fn is_whole(value: f64) -> bool {
    (value - value.round()).abs() < 1e-6
}

/// 1, 2 and 5 times powers of ten.
fn decades(start: f64, end: f64) -> Vec<(f64, String)> {
    let (first, last) = (libm::floor(libm::log10(start)) as i32, libm::ceil(libm::log10(end)) as i32);
    let values = (first..=last).flat_map(|power| [1.0, 2.0, 5.0].map(|factor| factor * libm::pow(10.0, power.into())));
    values.filter(|value| (start..=end).contains(value)).map(|value| (value, format!("{value}"))).collect()
}

/// Smallest and largest of the finite values, with a margin.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> Range<f64> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return 0.0..1.0;
    }
    let margin = (0.05 * (high - low)).max(1e-6);
    low - margin..high + margin
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(values: Range<f64>, pixels: f64, spacing: f64) -> Vec<String> {
        Axis::new(values, [0.0, pixels]).ticks(spacing).into_iter().map(|(_, words)| words).collect()
    }

    #[test]
    fn axis_ticks_are_round_numbers_written_in_full() {
        assert_eq!(words(0.0..12.0, 600.0, 100.0), ["0", "2", "4", "6", "8", "10", "12"]);
        assert_eq!(words(-0.3..0.31, 400.0, 100.0), ["−0.2", "0.0", "0.2"]);
        assert_eq!(words(22.4..24.1, 400.0, 100.0), ["22.5", "23.0", "23.5", "24.0"]);
        assert_eq!(words(0.0..1.0, 400.0, 100.0), ["0.00", "0.25", "0.50", "0.75", "1.00"]);
    }

    #[test]
    fn linear_and_logarithmic_axes_map_values_to_pixels() {
        let axis = Axis::new(10.0..1000.0, [500.0, 100.0]);
        assert_eq!((axis.pixel(10.0), axis.pixel(505.0), axis.pixel(2000.0)), (500.0, 300.0, 100.0));
        let log = axis.logarithmic();
        assert!((log.pixel(100.0) - 300.0).abs() < 1e-9);
        let ticks: Vec<String> = log.ticks(1.0).into_iter().map(|(_, words)| words).collect();
        assert_eq!(ticks, ["10", "20", "50", "100", "200", "500", "1000"]);
    }
}
