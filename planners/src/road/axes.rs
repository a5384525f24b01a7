//! Axes along and across a road, rotated against those of the world.

/// Orthogonal axes: the first along a direction, the second to its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    cos: f64,
    sin: f64,
}

/// Below this, a sine or cosine is the rounding error of a multiple of a right angle.
const RIGHT_ANGLE: f64 = 1e-12;

impl Axes {
    /// The axes x and y of the world.
    pub const WORLD: Axes = Axes { cos: 1.0, sin: 0.0 };

    /// The axes along and across a heading \[rad\]; exact where it is a multiple of a right angle.
    pub fn along(heading_rad: f64) -> Axes {
        let (sin, cos) = libm::sincos(heading_rad);
        if sin.abs() < RIGHT_ANGLE {
            Axes { cos: cos.signum(), sin: 0.0 }
        } else if cos.abs() < RIGHT_ANGLE {
            Axes { cos: 0.0, sin: sin.signum() }
        } else {
            Axes { cos, sin }
        }
    }

    /// The components of a world vector along and across.
    pub fn components(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.cos * x + self.sin * y, -self.sin * x + self.cos * y]
    }

    /// The world vector with these components along and across.
    pub fn vector(&self, [along, across]: [f64; 2]) -> [f64; 2] {
        [self.cos * along - self.sin * across, self.sin * along + self.cos * across]
    }

    /// Rotates a symmetric matrix, given by its entries (along, mixed, across) in these axes, into the world; returns
    /// its entries xx, xy, yy.
    pub fn matrix(&self, [along, mixed, across]: [f64; 3]) -> [f64; 3] {
        let Axes { cos, sin } = *self;
        [
            cos * cos * along - 2.0 * cos * sin * mixed + sin * sin * across,
            cos * sin * (along - across) + (cos * cos - sin * sin) * mixed,
            sin * sin * along + 2.0 * cos * sin * mixed + cos * cos * across,
        ]
    }

    /// Rotates a symmetric matrix of the world, given by its entries xx, xy, yy, into these axes; returns its entries
    /// (along, mixed, across).
    pub fn entries(&self, matrix: [f64; 3]) -> [f64; 3] {
        Axes { cos: self.cos, sin: -self.sin }.matrix(matrix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quadratic form has the same value in either coordinates, and both ways lead back.
    #[test]
    fn rotating_axes_changes_only_coordinates() {
        for heading_rad in [0.0, 0.7, -2.1, std::f64::consts::FRAC_PI_2, std::f64::consts::PI] {
            let (axes, own, vector) = (Axes::along(heading_rad), [0.3, -0.2, 4.0], [1.3, -0.4]);
            let form = |[xx, xy, yy]: [f64; 3], [x, y]: [f64; 2]| xx * x * x + 2.0 * xy * x * y + yy * y * y;
            let world = axes.matrix(own);
            assert!((form(world, vector) - form(own, axes.components(vector))).abs() < 1e-12);
            let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
            assert!(close(&axes.entries(world), &own) && close(&axes.vector(axes.components(vector)), &vector));
        }
    }

    #[test]
    fn axes_at_right_angles_are_exact() {
        let quarter = Axes::along(std::f64::consts::FRAC_PI_2);
        assert_eq!(quarter.matrix([0.1, 0.0, 4.0]), [4.0, 0.0, 0.1]);
        assert_eq!(quarter.components([2.0, 3.0]), [3.0, -2.0]);
        assert_eq!(Axes::along(0.0), Axes::WORLD);
    }
}
