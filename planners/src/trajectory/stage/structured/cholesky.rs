//! Cholesky factors of the small matrices over the inputs of a stage.

/// Lower Cholesky factor with reciprocal diagonal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cholesky<const W: usize> {
    pub(super) lower: [[f64; W]; W],
}

impl<const W: usize> Cholesky<W> {
    /// Factors the lower triangle of `matrix`; `None` if it is not positive definite.
    #[inline(always)]
    pub(super) fn new(matrix: &[[f64; W]; W]) -> Option<Self> {
        let mut lower = *matrix;
        for j in 0..W {
            let mut pivot = lower[j][j];
            for k in 0..j {
                pivot -= lower[j][k] * lower[j][k];
            }
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            let inverse = 1.0 / pivot.sqrt();
            lower[j][j] = inverse;
            for i in j + 1..W {
                let mut value = lower[i][j];
                for k in 0..j {
                    value -= lower[i][k] * lower[j][k];
                }
                lower[i][j] = value * inverse;
            }
        }
        Some(Cholesky { lower })
    }

    /// `L⁻¹ v`.
    #[inline(always)]
    pub(super) fn forward(&self, v: &mut [f64; W]) {
        for i in 0..W {
            for k in 0..i {
                v[i] -= self.lower[i][k] * v[k];
            }
            v[i] *= self.lower[i][i];
        }
    }

    /// `L⁻ᵀ v`.
    #[inline(always)]
    pub(super) fn backward(&self, v: &mut [f64; W]) {
        for i in (0..W).rev() {
            for k in i + 1..W {
                v[i] -= self.lower[k][i] * v[k];
            }
            v[i] *= self.lower[i][i];
        }
    }

    /// `L⁻¹ M` for a matrix of `W` rows, all columns at once.
    #[inline(always)]
    pub(super) fn forward_all<const Z: usize>(&self, matrix: &mut [[f64; Z]; W]) {
        for i in 0..W {
            let (above, below) = matrix.split_at_mut(i);
            let row = &mut below[0];
            for (k, earlier) in above.iter().enumerate() {
                for c in 0..Z {
                    row[c] -= self.lower[i][k] * earlier[c];
                }
            }
            for value in row {
                *value *= self.lower[i][i];
            }
        }
    }
}
