//! A function of a vehicle's pose, expanded to second order.

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
