//! The ellipse around a vehicle that other vehicles must not enter.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Half axes of the safety ellipse around another vehicle's centre, `a_s` and `b_s` of Table 6.2. The long axis lies
/// along the other's road.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SafetyEllipse {
    /// Half axis along the road, `a_s` \[m\].
    #[schemars(range(min = 0.001))]
    pub along_m: f64,
    /// Half axis across the road, `b_s` \[m\].
    #[schemars(range(min = 0.001))]
    pub across_m: f64,
}

impl Default for SafetyEllipse {
    fn default() -> Self {
        SafetyEllipse { along_m: 0.75, across_m: 0.35 }
    }
}

/// A squared elliptical distance and its gradient with respect to the first position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticalDistance {
    /// `d² = (s/a_s)² + (n/b_s)²`; 1 on the ellipse.
    pub squared: f64,
    /// `∂d²/∂(x, y)` at the first position \[1/m\].
    pub gradient: [f64; 2],
}

/// A safety ellipse turned into a direction: `d² = (s/a_s)² + (n/b_s)²` with `s` and `n` the position along and across it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedEllipse {
    shape: SafetyEllipse,
    heading_rad: f64,
    sin: f64,
    cos: f64,
    hessian: [f64; 3],
}

impl SafetyEllipse {
    /// This ellipse with its long axis along `heading_rad`.
    pub fn oriented(self, heading_rad: f64) -> OrientedEllipse {
        let (sin, cos) = libm::sincos(heading_rad);
        let (along, across) = (1.0 / (self.along_m * self.along_m), 1.0 / (self.across_m * self.across_m));
        let hessian = [
            2.0 * (cos * cos * along + sin * sin * across),
            2.0 * cos * sin * (along - across),
            2.0 * (sin * sin * along + cos * cos * across),
        ];
        OrientedEllipse { shape: self, heading_rad, sin, cos, hessian }
    }
}

impl OrientedEllipse {
    /// The half axes of the ellipse.
    pub fn shape(&self) -> SafetyEllipse {
        self.shape
    }

    /// Direction of the long axis \[rad\].
    pub fn heading_rad(&self) -> f64 {
        self.heading_rad
    }

    /// Squared elliptical distance of `position` from `centre` with its gradient (eq. 6.8: the set `S` is the outside of
    /// this ellipse, `d² ≥ 1`).
    pub fn distance(&self, position: [f64; 2], centre: [f64; 2]) -> EllipticalDistance {
        let OrientedEllipse { shape, sin, cos, .. } = *self;
        let (dx, dy) = (position[0] - centre[0], position[1] - centre[1]);
        let (along, across) = (cos * dx + sin * dy, -sin * dx + cos * dy);
        let along_slope = along / (shape.along_m * shape.along_m);
        let across_slope = across / (shape.across_m * shape.across_m);
        EllipticalDistance {
            squared: along * along_slope + across * across_slope,
            gradient: [2.0 * (cos * along_slope - sin * across_slope), 2.0 * (sin * along_slope + cos * across_slope)],
        }
    }

    /// Second derivatives `(∂²/∂x², ∂²/∂x∂y, ∂²/∂y²)` of the squared elliptical distance; the same everywhere \[1/m²\].
    pub fn hessian(&self) -> [f64; 3] {
        self.hessian
    }
}

/// Value, gradient and Hessian of a function of position and heading `(x, y, θ)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseExpansion {
    /// Value of the function.
    pub value: f64,
    /// First derivatives over `(x, y, θ)`.
    pub gradient: [f64; 3],
    /// Second derivatives over `(xx, xy, xθ, yy, yθ, θθ)`.
    pub hessian: [f64; 6],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_points_of_its_axes_lie_on_the_safety_ellipse() {
        let heading = 0.7;
        let ellipse = SafetyEllipse::default().oriented(heading);
        let (sin, cos) = libm::sincos(heading);
        let ends = [[0.75 * cos, 0.75 * sin], [-0.35 * sin, 0.35 * cos]];
        for [x, y] in ends {
            let distance = ellipse.distance([1.0 + x, 2.0 + y], [1.0, 2.0]);
            assert!((distance.squared - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn derivatives_agree_with_finite_differences() {
        let ellipse = SafetyEllipse { along_m: 0.8, across_m: 0.3 }.oriented(1.1);
        let (at, centre, step) = ([0.4, -0.2], [0.1, 0.3], 1e-5);
        let distance = |x: f64, y: f64| ellipse.distance([x, y], centre);
        let here = distance(at[0], at[1]);
        let curvature = ellipse.hessian();
        let (east, west) = (distance(at[0] + step, at[1]), distance(at[0] - step, at[1]));
        let (north, south) = (distance(at[0], at[1] + step), distance(at[0], at[1] - step));
        assert!(((east.squared - west.squared) / (2.0 * step) - here.gradient[0]).abs() < 1e-8);
        assert!(((north.squared - south.squared) / (2.0 * step) - here.gradient[1]).abs() < 1e-8);
        assert!(((east.gradient[0] - west.gradient[0]) / (2.0 * step) - curvature[0]).abs() < 1e-8);
        assert!(((east.gradient[1] - west.gradient[1]) / (2.0 * step) - curvature[1]).abs() < 1e-8);
        assert!(((north.gradient[1] - south.gradient[1]) / (2.0 * step) - curvature[2]).abs() < 1e-8);
    }
}
