//! A series whose values each hold until the next one.

use std::ops::Range;

/// Values that hold from `first_s`, `first_s + interval_s`, … on, each for an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldSeries {
    /// Time from which the first value holds \[s\].
    pub first_s: f64,
    /// How long each value holds \[s\].
    pub interval_s: f64,
    /// Whether the values begin anew after the last.
    pub cyclic: bool,
    /// The values; at least one.
    pub values: Vec<f64>,
}

impl HeldSeries {
    /// The mean from one time to a later one. Beyond the ends of a series that is not cyclic the value at the nearer end holds.
    ///
    /// # Panics
    /// When there are no values.
    pub fn mean(&self, from_s: f64, to_s: f64) -> f64 {
        assert!(!self.values.is_empty(), "a series needs a value");
        // Because of rounding, a step that ends with a value must not reach into the next value.
        const TOLERANCE: f64 = 1e-9;
        let (from, to) = ((from_s - self.first_s) / self.interval_s, (to_s - self.first_s) / self.interval_s);
        let (first, last) = ((from + TOLERANCE).floor(), (to - TOLERANCE).ceil() - 1.0);
        if last <= first {
            return self.value(first);
        }
        let mut sum = 0.0;
        let mut place = first;
        while place <= last {
            let share = (place + 1.0).min(to) - place.max(from);
            sum += share * self.value(place);
            place += 1.0;
        }
        sum / (to - from)
    }

    /// The value of an interval, counted from that of the first value.
    fn value(&self, place: f64) -> f64 {
        let count = self.values.len();
        let place = if self.cyclic { place.rem_euclid(count as f64) } else { place.max(0.0) };
        self.values[(place as usize).min(count - 1)]
    }
}

/// Fills these gaps linearly between the values around them, or with the only neighbour; a series without any value stays as it is.
pub fn bridge(values: &mut [f64], gaps: &[Range<usize>]) {
    for gap in gaps {
        let before = gap.start.checked_sub(1).map(|index| values[index]);
        let after = values.get(gap.end).copied();
        let (Some(from), Some(to)) = (before.or(after), after.or(before)) else { return };
        let width = (gap.len() + 1) as f64;
        for index in gap.clone() {
            values[index] = from + (to - from) * (index - gap.start + 1) as f64 / width;
        }
    }
}

/// The ranges of values that are missing (NaN).
pub fn gaps(values: &[f64]) -> Vec<Range<usize>> {
    let mut gaps: Vec<Range<usize>> = Vec::new();
    for (index, _) in values.iter().enumerate().filter(|(_, value)| value.is_nan()) {
        match gaps.last_mut() {
            Some(gap) if gap.end == index => gap.end += 1,
            _ => gaps.push(index..index + 1),
        }
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(cyclic: bool) -> HeldSeries {
        HeldSeries { first_s: 0.0, interval_s: 900.0, cyclic, values: vec![1.0, 2.0, 3.0, 4.0] }
    }

    #[test]
    fn a_step_gets_the_mean_of_the_held_values_during_it() {
        let series = series(false);
        assert_eq!(series.mean(0.0, 900.0), 1.0);
        assert_eq!(series.mean(900.0, 1200.0), 2.0);
        assert_eq!(series.mean(0.0, 3600.0), 2.5);
        assert!((series.mean(600.0, 1200.0) - 1.5).abs() < 1e-12);
        assert_eq!((series.mean(-900.0, 0.0), series.mean(3600.0, 4500.0)), (1.0, 4.0));
    }

    #[test]
    fn a_cyclic_series_repeats_beyond_its_ends() {
        assert_eq!(series(true).mean(3600.0, 4500.0), 1.0);
        assert_eq!(series(true).mean(-900.0, 0.0), 4.0);
        assert_eq!(series(true).mean(2700.0, 4500.0), 2.5);
    }

    #[test]
    fn gaps_are_interpolated_and_missing_ends_take_the_nearest_value() {
        const NONE: f64 = f64::NAN;
        let filled = |values: &[f64]| {
            let mut filled = values.to_vec();
            bridge(&mut filled, &gaps(values));
            filled
        };
        let values = [NONE, 1.0, NONE, NONE, 4.0, 5.0, NONE, 9.0, NONE];
        assert_eq!(gaps(&values), [0..1, 2..4, 6..7, 8..9]);
        assert_eq!(filled(&values), [1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 9.0, 9.0]);
        assert!(filled(&[NONE, NONE]).iter().all(|value| value.is_nan()));
        assert_eq!(filled(&[2.0]), [2.0]);
    }
}
