//! Finds gaps in a series and bridges them.

use std::ops::Range;

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
