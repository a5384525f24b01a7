//! What a vehicle covers on the road, and the ellipse around it that others keep out of.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::State;

/// Body and axles of a vehicle, measured from its mass centre. The default is Table 6.1 (a 1/10 scale car).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Body {
    /// Distance from the mass centre to the front bumper \[m\].
    #[schemars(range(min = 0.001))]
    pub front_m: f64,
    /// Distance from the mass centre to the rear bumper \[m\].
    #[schemars(range(min = 0.001))]
    pub rear_m: f64,
    /// Width of the body, `W` \[m\].
    #[schemars(range(min = 0.001))]
    pub width_m: f64,
    /// Distance from the mass centre to the front axle, `L_f` \[m\].
    #[schemars(range(min = 0.001))]
    pub front_axle_m: f64,
    /// Distance from the mass centre to the rear axle, `L_r` \[m\].
    #[schemars(range(min = 0.001))]
    pub rear_axle_m: f64,
}

impl Default for Body {
    fn default() -> Self {
        Body { front_m: 0.21, rear_m: 0.19, width_m: 0.19, front_axle_m: 0.21, rear_axle_m: 0.19 }
    }
}

impl Body {
    /// Distance between the axles, `L = L_f + L_r` \[m\].
    pub fn wheelbase_m(&self) -> f64 {
        self.front_axle_m + self.rear_axle_m
    }

    /// The corners in the body's own frame (x forward, y left), in the order of eq. 6.7: front right, front left,
    /// rear right, rear left \[m\].
    pub fn local_corners(&self) -> [[f64; 2]; 4] {
        let half = self.width_m / 2.0;
        [[self.front_m, -half], [self.front_m, half], [-self.rear_m, -half], [-self.rear_m, half]]
    }

    /// The corners in the world, in the order of [`Body::local_corners`] \[m\].
    pub fn corners(&self, state: &State) -> [[f64; 2]; 4] {
        let (sin, cos) = libm::sincos(state.heading_rad);
        self.local_corners()
            .map(|[ahead, left]| [state.x_m + cos * ahead - sin * left, state.y_m + sin * ahead + cos * left])
    }
}

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

impl SafetyEllipse {
    /// Squared elliptical distance of `position` from `centre`, the long axis along `heading_rad` (eq. 6.8 as we take
    /// it: `S` is the outside of this ellipse, `d² ≥ 1`).
    pub fn distance(&self, position: [f64; 2], centre: [f64; 2], heading_rad: f64) -> EllipticalDistance {
        let (sin, cos) = libm::sincos(heading_rad);
        let (dx, dy) = (position[0] - centre[0], position[1] - centre[1]);
        let (along, across) = (cos * dx + sin * dy, -sin * dx + cos * dy);
        let along_slope = along / (self.along_m * self.along_m);
        let across_slope = across / (self.across_m * self.across_m);
        EllipticalDistance {
            squared: along * along_slope + across * across_slope,
            gradient: [2.0 * (cos * along_slope - sin * across_slope), 2.0 * (sin * along_slope + cos * across_slope)],
        }
    }

    /// Second derivatives `(∂²/∂x², ∂²/∂x∂y, ∂²/∂y²)` of the squared elliptical distance; the same everywhere \[1/m²\].
    pub fn curvature(&self, heading_rad: f64) -> [f64; 3] {
        let (sin, cos) = libm::sincos(heading_rad);
        let (along, across) = (1.0 / (self.along_m * self.along_m), 1.0 / (self.across_m * self.across_m));
        [
            2.0 * (cos * cos * along + sin * sin * across),
            2.0 * cos * sin * (along - across),
            2.0 * (sin * sin * along + cos * cos * across),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_axes_lie_on_the_ellipse() {
        let ellipse = SafetyEllipse::default();
        let heading = 0.7;
        let (sin, cos) = libm::sincos(heading);
        let ends = [[0.75 * cos, 0.75 * sin], [-0.35 * sin, 0.35 * cos]];
        for [x, y] in ends {
            let distance = ellipse.distance([1.0 + x, 2.0 + y], [1.0, 2.0], heading);
            assert!((distance.squared - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn derivatives_agree_with_finite_differences() {
        let ellipse = SafetyEllipse { along_m: 0.8, across_m: 0.3 };
        let (at, centre, heading, step) = ([0.4, -0.2], [0.1, 0.3], 1.1, 1e-5);
        let distance = |x: f64, y: f64| ellipse.distance([x, y], centre, heading);
        let here = distance(at[0], at[1]);
        let curvature = ellipse.curvature(heading);
        let (east, west) = (distance(at[0] + step, at[1]), distance(at[0] - step, at[1]));
        let (north, south) = (distance(at[0], at[1] + step), distance(at[0], at[1] - step));
        assert!(((east.squared - west.squared) / (2.0 * step) - here.gradient[0]).abs() < 1e-8);
        assert!(((north.squared - south.squared) / (2.0 * step) - here.gradient[1]).abs() < 1e-8);
        assert!(((east.gradient[0] - west.gradient[0]) / (2.0 * step) - curvature[0]).abs() < 1e-8);
        assert!(((east.gradient[1] - west.gradient[1]) / (2.0 * step) - curvature[1]).abs() < 1e-8);
        assert!(((north.gradient[1] - south.gradient[1]) / (2.0 * step) - curvature[2]).abs() < 1e-8);
    }

    #[test]
    fn corners_turn_with_the_heading() {
        let body = Body::default();
        let state = State { x_m: 1.0, y_m: 2.0, heading_rad: std::f64::consts::FRAC_PI_2, speed_mps: 0.0 };
        let [front_right, ..] = body.corners(&state);
        assert!((front_right[0] - (1.0 + 0.095)).abs() < 1e-12 && (front_right[1] - 2.21).abs() < 1e-12);
    }
}
