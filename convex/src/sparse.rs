//! Matrices in compressed sparse column format, whose values can be replaced in place.
//!
//! The pattern is computed once from a list of (row, column) entries. The values of entries at the same position are added.
//! Replacing the values is a single pass over them, without sorting or allocation.

/// A sparse matrix by columns. The entries of column j have the indices `start[j]..start[j + 1]`, sorted by row.
#[derive(Debug, Clone)]
pub(crate) struct SparseColumns {
    pub(crate) rows: usize,
    pub(crate) start: Vec<usize>,
    pub(crate) row: Vec<usize>,
    pub(crate) value: Vec<f64>,
    /// For the k-th entry of the list, the index of the stored value to which it is added.
    slot: Vec<usize>,
}

impl SparseColumns {
    /// The zero matrix whose pattern holds every listed (row, column), all within `rows` × `columns`.
    pub(crate) fn with_pattern(rows: usize, columns: usize, entries: impl Iterator<Item = (usize, usize)>) -> Self {
        let mut order: Vec<(usize, usize, usize)> = entries.enumerate().map(|(k, (i, j))| (j, i, k)).collect();
        order.sort_unstable();
        let mut start = vec![0; columns + 1];
        let mut row = Vec::with_capacity(order.len());
        let mut slot = vec![0; order.len()];
        let mut previous = None;
        for (j, i, k) in order {
            if previous != Some((j, i)) {
                previous = Some((j, i));
                row.push(i);
                start[j + 1] = row.len();
            }
            slot[k] = row.len() - 1;
        }
        for j in 0..columns {
            start[j + 1] = start[j + 1].max(start[j]);
        }
        let value = vec![0.0; row.len()];
        Self { rows, start, row, value, slot }
    }

    /// Replaces every value: the k-th of `values` belongs to the k-th entry of the pattern's list.
    pub(crate) fn fill(&mut self, values: impl Iterator<Item = f64>) {
        self.value.fill(0.0);
        for (&slot, value) in self.slot.iter().zip(values) {
            self.value[slot] += value;
        }
    }

    pub(crate) fn columns(&self) -> usize {
        self.start.len() - 1
    }

    /// Every stored (row, column, value), by columns.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        self.start
            .windows(2)
            .enumerate()
            .flat_map(move |(j, ends)| (ends[0]..ends[1]).map(move |k| (self.row[k], j, self.value[k])))
    }

    /// M x.
    pub(crate) fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.rows];
        for (i, j, value) in self.entries() {
            product[i] += value * x[j];
        }
        product
    }

    /// Mᵀ y.
    pub(crate) fn transposed_times(&self, y: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.columns()];
        for (i, j, value) in self.entries() {
            product[j] += value * y[i];
        }
        product
    }

    /// S x for the symmetric matrix S of which this is the upper triangle.
    pub(crate) fn symmetric_times(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.rows];
        for (i, j, value) in self.entries() {
            product[i] += value * x[j];
            if i != j {
                product[j] += value * x[i];
            }
        }
        product
    }
}

/// aᵀb.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// ‖v‖₂.
pub(crate) fn euclidean(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// ‖v‖∞.
pub(crate) fn magnitude(vector: &[f64]) -> f64 {
    largest(vector.iter().map(|v| v.abs()))
}

/// The largest of `values` and zero; NaN if one of them is NaN (`f64::max` would ignore it).
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |largest, v| if v > largest || v.is_nan() { v } else { largest })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [1 2 0; 0 3 0], its middle entry in two parts, plus an explicit zero at the lower right.
    fn sample() -> SparseColumns {
        let entries = [(1, 2), (1, 1), (0, 0), (0, 1), (1, 1)];
        let mut matrix = SparseColumns::with_pattern(2, 3, entries.into_iter());
        matrix.fill([0.0, 1.0, 1.0, 2.0, 2.0].into_iter());
        matrix
    }

    #[test]
    fn repeated_matrix_entries_add_up_and_zeros_are_kept() {
        let matrix = sample();
        assert_eq!(matrix.start, [0, 1, 3, 4]);
        assert_eq!(matrix.row, [0, 0, 1, 1]);
        assert_eq!(matrix.value, [1.0, 2.0, 3.0, 0.0]);
    }

    #[test]
    fn sparse_products_match_hand_computed_ones() {
        let matrix = sample();
        assert_eq!(matrix.times(&[1.0, 10.0, 100.0]), [21.0, 30.0]);
        assert_eq!(matrix.transposed_times(&[1.0, 10.0]), [1.0, 32.0, 0.0]);
        let mut upper = SparseColumns::with_pattern(2, 2, [(0, 0), (0, 1)].into_iter());
        upper.fill([4.0, 5.0].into_iter());
        assert_eq!(upper.symmetric_times(&[1.0, 2.0]), [14.0, 5.0]);
    }

    #[test]
    fn matrices_may_have_empty_columns() {
        let matrix = SparseColumns::with_pattern(2, 4, [(1, 2)].into_iter());
        assert_eq!(matrix.start, [0, 0, 0, 1, 1]);
    }

    #[test]
    fn norms_of_vectors_with_nan_are_nan() {
        assert!(largest([1.0, f64::NAN, 2.0]).is_nan());
        assert!(magnitude(&[f64::NAN, 3.0]).is_nan());
        assert!(euclidean(&[3.0, f64::NAN]).is_nan());
        assert_eq!(magnitude(&[-3.0, 2.0]), 3.0);
    }
}
