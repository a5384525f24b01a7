//! Coordinates in the Frenet frame of a centre line, with and without derivatives: `s` along it, `n` across (Werling et al., "Optimal
//! trajectory generation for dynamic street scenarios in a Frenet frame", 2010).

/// A position in the Frenet frame of a centre line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrenetPoint {
    /// Arc length `s` of the nearest point; negative before the begin, above the length after the end \[m\].
    pub along_m: f64,
    /// Signed distance `n` from the line, positive to the left \[m\].
    pub across_m: f64,
    /// Heading of the line at the nearest point, without jumps of a full turn along the line \[rad\].
    pub heading_rad: f64,
    /// Curvature of the line at the nearest point \[1/m\].
    pub curvature_1pm: f64,
}

impl FrenetPoint {
    /// The arc length beside a place `[a, b]` along and across the line from here \[m\]: exact, to the fifth power of `κ a`, where
    /// the line is a circle.
    ///
    /// On a circle it is `s + atan(z)/κ` with `z = κ a/(1 − κ (n + b))`.
    pub(in crate::road) fn along_beside_m(&self, [a, b]: [f64; 2]) -> f64 {
        let stretch = (1.0 - self.curvature_1pm * (self.across_m + b)).max(FrenetExpansion::MIN_STRETCH);
        let shift_m = a / stretch;
        let turn = self.curvature_1pm * shift_m;
        self.along_m + shift_m * (1.0 - turn * turn * (1.0 / 3.0))
    }
}

/// The Frenet coordinates `(s, n)` of a position, expanded to second order over `(x, y)`.
///
/// With the curve `p(s)`, its speed `v = |p′|`, tangent `t`, normal `m` (to the left), curvature `κ` and `q = 1 − κ n`:
///
/// - `∇n = m`, `∇²n = −κ/q · t tᵀ`
/// - `∇s = t/(v q)`
/// - `∇²s = (κ/q² · (m tᵀ + t mᵀ) + (κ′ n/(v q³) − v′/(v² q²)) · t tᵀ)/v`
///
/// where `′` is the derivative over `s`. Beyond the centre of curvature, where `q ≤ 0`, the derivatives do not exist. `q` is
/// taken as at least [`FrenetExpansion::MIN_STRETCH`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrenetExpansion {
    /// Arc length `s` of the nearest point \[m\].
    pub along_m: f64,
    /// First derivatives of `s` over (x, y).
    pub along_gradient: [f64; 2],
    /// Second derivatives of `s` over (xx, xy, yy) \[1/m\].
    pub along_hessian: [f64; 3],
    /// Signed distance `n` from the line, positive to the left \[m\].
    pub across_m: f64,
    /// First derivatives of `n` over (x, y).
    pub across_gradient: [f64; 2],
    /// Second derivatives of `n` over (xx, xy, yy) \[1/m\].
    pub across_hessian: [f64; 3],
    /// Heading `ψ` of the line at the nearest point \[rad\].
    pub heading_rad: f64,
    /// First derivative of the heading over `s`, `ψ′ = κ v` \[rad/m\].
    pub heading_slope_radpm: f64,
    /// Second derivative of the heading over `s`, `ψ″ = κ′ v + κ v′` \[rad/m²\].
    pub heading_bend_radpm2: f64,
    /// Curvature `κ` of the line at the nearest point \[1/m\].
    pub curvature_1pm: f64,
}

/// The lateral coordinate `n` of a position, expanded to second order over `(x, y)`: a part of [`FrenetExpansion`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::road) struct AcrossExpansion {
    /// `n` \[m\].
    pub across_m: f64,
    /// First derivatives over (x, y).
    pub gradient: [f64; 2],
    /// Second derivatives over (xx, xy, yy) \[1/m\].
    pub hessian: [f64; 3],
}

impl FrenetExpansion {
    /// Lower limit of `1 − κ n` in derivatives.
    pub const MIN_STRETCH: f64 = 0.05;

    /// The coordinates without their derivatives.
    pub fn point(&self) -> FrenetPoint {
        let FrenetExpansion { along_m, across_m, heading_rad, curvature_1pm, .. } = *self;
        FrenetPoint { along_m, across_m, heading_rad, curvature_1pm }
    }

    /// The arc length after a move `d`, to second order: `s + ∇s·d + ½ dᵀ ∇²s d` \[m\].
    pub(crate) fn along_after_m(&self, [x, y]: [f64; 2]) -> f64 {
        let ([sx, sy], [xx, xy, yy]) = (self.along_gradient, self.along_hessian);
        self.along_m + sx * x + sy * y + 0.5 * (xx * x * x + 2.0 * xy * x * y + yy * y * y)
    }
}
