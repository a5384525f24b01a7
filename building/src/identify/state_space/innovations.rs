//! Whether the innovations of a zone are white.

use std::ops::Range;

use super::likelihood::{Filtered, Observations};
use super::selection::Fit;
use super::structure::ParameterKind;
use crate::identify::diagnostics::{self, Whiteness};

/// Innovations of a zone whose heat switches inside of rows are tested as means over this time \[s\].
const MEAN_S: f64 = 7200.0;
/// With a smaller share of the full swing, the heat of a zone counts as held.
const HELD_SWING: f64 = 0.1;

/// Whether the innovations of the training rows are white; of a zone whose heat switches inside of rows, whether their means over
/// two hours are.
///
/// A thermostat that cycles makes innovations of rows correlated, because the time of its heat depends on the temperature. Such heat
/// is not missing, and intervals allow for the correlation.
pub(super) fn whiteness(train: &Observations, fit: &Fit, filtered: &Filtered, zone: usize) -> Whiteness {
    let p = train.widths.0;
    let values: Vec<f64> = filtered.standardised.iter().skip(zone).step_by(p).copied().collect();
    let mut pieces: Vec<Range<usize>> = Vec::new();
    for segment in &train.segments {
        for row in segment.clone().filter(|&row| values[row].is_finite()) {
            match pieces.last_mut() {
                Some(piece) if piece.end == row && segment.contains(&(row - 1)) => piece.end += 1,
                _ => pieces.push(row..row + 1),
            }
        }
    }
    let swing = fit.structure.index(ParameterKind::HeatSwing(zone)).map(|index| libm::exp(fit.maximum.theta[index]));
    let rows = match swing {
        Some(swing) if swing > HELD_SWING => (libm::round(MEAN_S / train.step_s) as usize).max(1),
        _ => 1,
    };
    let (values, pieces) = means(&values, &pieces, rows);
    // A model with n states is an ARMA(n, n).
    diagnostics::whiteness(&values, &pieces, 2 * fit.structure.order())
}

/// Means of `rows` values each, and the pieces of them.
fn means(values: &[f64], pieces: &[Range<usize>], rows: usize) -> (Vec<f64>, Vec<Range<usize>>) {
    let (mut means, mut of_means) = (Vec::new(), Vec::new());
    for piece in pieces {
        let first = means.len();
        let blocks = values[piece.clone()].chunks_exact(rows);
        means.extend(blocks.map(|block| block.iter().sum::<f64>() / rows as f64));
        of_means.push(first..means.len());
    }
    (means, of_means)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_keep_to_their_piece() {
        let values: Vec<f64> = (0..10).map(f64::from).collect();
        let (found, pieces) = means(&values, &[0..5, 6..10], 2);
        assert_eq!((found, pieces), (vec![0.5, 2.5, 6.5, 8.5], vec![0..2, 2..4]));
    }
}
