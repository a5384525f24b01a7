//! A series whose values each hold until the next one.

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
}
