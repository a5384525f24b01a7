//! Factors of a square matrix.

/// `P A = L U` with the largest pivot of each column.
#[derive(Debug)]
pub struct Factors {
    /// L below the diagonal, U on and above it, row by row.
    matrix: Vec<f64>,
    /// The row that was exchanged with each row.
    pivots: Vec<usize>,
}

impl Factors {
    /// Factors a matrix that is given row by row; `None` if it is singular or not finite.
    pub fn new(mut matrix: Vec<f64>, size: usize) -> Option<Self> {
        let mut pivots = Vec::with_capacity(size);
        for column in 0..size {
            let largest = (column..size).max_by(|one, other| {
                matrix[one * size + column].abs().total_cmp(&matrix[other * size + column].abs())
            })?;
            let pivot = matrix[largest * size + column];
            if pivot == 0.0 || !pivot.is_finite() {
                return None;
            }
            pivots.push(largest);
            (0..size).for_each(|index| matrix.swap(column * size + index, largest * size + index));
            let (upper, lower) = matrix.split_at_mut((column + 1) * size);
            let row = &upper[column * size..];
            for other in lower.chunks_exact_mut(size) {
                let factor = other[column] / pivot;
                other[column] = factor;
                if factor != 0.0 {
                    other[column + 1..]
                        .iter_mut()
                        .zip(&row[column + 1..])
                        .for_each(|(it, above)| *it -= factor * above);
                }
            }
        }
        Some(Self { matrix, pivots })
    }

    /// Replaces a right-hand side by the solution.
    pub fn solve(&self, side: &mut [f64]) {
        let size = self.pivots.len();
        let row = |index: usize| &self.matrix[index * size..(index + 1) * size];
        self.pivots.iter().enumerate().for_each(|(index, pivot)| side.swap(index, *pivot));
        for index in 0..size {
            let sum: f64 = row(index)[..index].iter().zip(&*side).map(|(factor, value)| factor * value).sum();
            side[index] -= sum;
        }
        for index in (0..size).rev() {
            let sum: f64 = row(index)[index + 1..].iter().zip(&side[index + 1..]).map(|(factor, it)| factor * it).sum();
            side[index] = (side[index] - sum) / row(index)[index];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_fulfils_its_equations() {
        let matrix = vec![0.0, 2.0, -1.0, 3.0, 0.0, 4.0, 1.0, -5.0, 0.5];
        let mut found = vec![1.0, 2.0, 3.0];
        Factors::new(matrix.clone(), 3).expect("regular").solve(&mut found);
        for (row, wanted) in matrix.chunks(3).zip([1.0, 2.0, 3.0]) {
            let sum: f64 = row.iter().zip(&found).map(|(factor, value)| factor * value).sum();
            assert!((sum - wanted).abs() < 1e-14, "{sum}");
        }
        assert!(Factors::new(vec![1.0, 2.0, 2.0, 4.0], 2).is_none());
    }
}
