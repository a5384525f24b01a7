//! Coordinate search over grids: one parameter after the other moves to a neighbouring value while the error falls.

/// A parameter of a model with its grid.
pub(super) struct Parameter {
    /// Its name, with the unit.
    pub name: &'static str,
    /// The values, in order.
    pub values: &'static [f64],
    pub start: usize,
}

/// Maximum number of rounds over all parameters.
const MAX_ROUNDS: usize = 4;
/// Minimum relative improvement of a step; smaller ones are noise.
const LEAST_GAIN: f64 = 1e-4;

/// The values with the least error that the search finds. It is deterministic.
pub(super) fn least(parameters: &[Parameter], error: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let mut at: Vec<usize> = parameters.iter().map(|parameter| parameter.start).collect();
    let values =
        |at: &[usize]| -> Vec<f64> { parameters.iter().zip(at).map(|(it, index)| it.values[*index]).collect() };
    if parameters.is_empty() {
        return Vec::new();
    }
    let mut best = error(&values(&at));
    for _ in 0..MAX_ROUNDS {
        let before = best;
        for index in 0..parameters.len() {
            for forwards in [true, false] {
                loop {
                    let mut moved = at.clone();
                    let next = if forwards { at[index] + 1 } else { at[index].wrapping_sub(1) };
                    if next >= parameters[index].values.len() {
                        break;
                    }
                    moved[index] = next;
                    let found = error(&values(&moved));
                    if found >= best * (1.0 - LEAST_GAIN) {
                        break;
                    }
                    (best, at) = (found, moved);
                }
            }
        }
        if best == before {
            break;
        }
    }
    values(&at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_search_finds_the_minimum_of_a_convex_function() {
        const VALUES: &[f64] = &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        let parameters = [0, 5].map(|start| Parameter { name: "x", values: VALUES, start });
        let bowl = |x: &[f64]| 1.0 + (x[0] - 3.0).powi(2) + (x[1] - 1.0).powi(2) + 0.5 * (x[0] - 3.0) * (x[1] - 1.0);
        assert_eq!(least(&parameters, bowl), [3.0, 1.0]);
        assert!(least(&[], |_| 0.0).is_empty());
    }
}
