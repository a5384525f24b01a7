//! Stability of an autoregression: all roots of 1 − α_1 z⁻¹ − … − α_r z⁻ʳ inside the unit circle.

/// Largest magnitude of a reflection coefficient that is accepted as stable. At 1 the autoregression is unstable; with one
/// coefficient of this value a disturbance decays by a factor e within 10,000 steps.
const MAX_REFLECTION: f64 = 0.9999;

/// Whether the autoregression is stable, by the step-down recursion: its reflection coefficients are below one.
pub(in crate::identify) fn is_stable(autoregressive: &[f64]) -> bool {
    let mut coefficients = autoregressive.to_vec();
    while let Some(reflection) = coefficients.pop() {
        if reflection.is_nan() || reflection.abs() > MAX_REFLECTION {
            return false;
        }
        let scale = 1.0 / (1.0 - reflection * reflection);
        let reversed: Vec<f64> = coefficients.iter().rev().copied().collect();
        for (coefficient, mirror) in coefficients.iter_mut().zip(reversed) {
            *coefficient = (*coefficient + reflection * mirror) * scale;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::is_stable;

    proptest! {
        /// A second-order autoregression is stable within a triangle.
        #[test]
        fn a_second_order_autoregression_is_stable_within_the_known_triangle(a1 in -2.5..2.5, a2 in -1.5..1.5) {
            let margin: f64 = [1.0 - a2 - a1, 1.0 - a2 + a1, 1.0 + a2].into_iter().fold(f64::MAX, f64::min);
            prop_assume!(margin.abs() > 1e-3);
            prop_assert_eq!(is_stable(&[a1, a2]), margin > 0.0);
        }

        /// Third order, made from its roots.
        #[test]
        fn a_third_order_autoregression_is_stable_if_its_roots_are_inside_the_unit_circle(p in -1.3..1.3, q in -1.3..1.3, s in -1.3..1.3) {
            prop_assume!([p, q, s].iter().all(|root: &f64| (root.abs() - 1.0).abs() > 1e-2));
            let alpha: [f64; 3] = [p + q + s, -(p * q + q * s + p * s), p * q * s];
            prop_assert_eq!(is_stable(&alpha), [p, q, s].iter().all(|root: &f64| root.abs() < 1.0));
        }
    }
}
