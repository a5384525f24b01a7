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
    /// Up to this argument φ₂ is its power series: the closed form would lose more than two bits to cancellation, and the first
    /// term left out of the series is below 10⁻¹⁹.
    const MAX_SERIES_ARGUMENT: f64 = 0.5;
    const SERIES_TERMS: u32 = 16;
    if z > MAX_SERIES_ARGUMENT {
        return (z + libm::expm1(-z)) / (z * z);
    }
    let mut term = 0.5;
    let mut sum = term;
    for k in 1..SERIES_TERMS {
        term *= -z / f64::from(k + 2);
        sum += term;
    }
    sum
}
