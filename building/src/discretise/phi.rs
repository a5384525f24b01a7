//! Scalar functions of the exact discretisation.
//!
//! A mode with rate λ that starts at 0 and is driven by a constant 1 has reached h·φ₁(λh) after a time h, and its mean over
//! that time is h·φ₂(λh):
//!
//! ```text
//! φ₁(z) = (1 − e⁻ᶻ)/z        φ₂(z) = (z − 1 + e⁻ᶻ)/z²,        φ₁(0) = 1, φ₂(0) = ½
//! ```

/// φ₁ for z ≥ 0.
pub(super) fn reached(z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { -libm::expm1(-z) / z }
}

/// φ₂ for z ≥ 0.
pub(super) fn mean(z: f64) -> f64 {
    /// Below this the closed form cancels; the power series then needs no more terms than are summed.
    const SMALL: f64 = 0.5;
    const TERMS: u32 = 16;
    if z > SMALL {
        return (z + libm::expm1(-z)) / (z * z);
    }
    let mut term = 0.5;
    let mut sum = term;
    for k in 1..TERMS {
        term *= -z / f64::from(k + 2);
        sum += term;
    }
    sum
}
