//! What the other's best response is worth to the ego (eq. 7.18, 7.19).
//!
//! To the other, its response `x_s` costs `A‖x_s − x_sᴾ‖² − w_4‖x_s − x_e‖²` with `A = (1 + Σ_ω γ + ω) w_1`: it would like to
//! keep its plan `x_sᴾ` and to keep away from the ego at `x_e`. Norms are those of `ω`, i.e. weighted with `I′ᵀI′`, so that
//! `‖x_sᴾ − x_e‖ = ω`. (With any other weight the division below is not possible.) The best response is
//!
//! ```text
//! x_s* = (A x_sᴾ − w_4 x_e)/(A − w_4),     A > w_4                                            (7.18)
//! ```
//!
//! At it the first term, divided by `s = A − w_4 = w_1 ω + m`, is
//!
//! ```text
//! A w_4² ω²/s² = k_1 ω + k_2 + k_3/s + k_4/s²                                                (7.19)
//! k_1 = w_4²/w_1,  k_2 = (w_4/w_1)² (w_4 − m),  k_3 = (w_4/w_1)² m (m − 2 w_4),  k_4 = w_4³ m²/w_1²
//! ```
//!
//! and the source keeps `k_1 ω` of it. Two corrections: `k_3` is negative only if `w_4 < (1 + Σ_ω γ) w_1 < 3 w_4` ("always" in
//! print); and 7.19 drops the second term without a word. With it the value is `−A w_4/(A − w_4) ω²`, which is concave and
//! pushes the ego *away*. So `k_1 ω` is a modelling choice, not a consequence: a driver with little loyalty to its plan
//! (small `w_1`) invites the ego to come closer.
//!
//! 7.16 lacks a square: the exponent is `½ Σ_ω q²`, `q = ‖x_s − x_sᴾ‖²_{W_1}`; 7.18 follows from it with `γ`, the `q` of the
//! step before, for one of its factors.

use super::settings::{ReplyValue, Settings};
use crate::trajectory::terms::DistancePrice;

/// The weight `k_1` (eq. 7.19) with which the ego's cost counts its distance `ω` from the other's plan: `w_1` is the
/// weight that
/// the other puts on its own plan, `w_4` that of its wish to keep away.
pub fn attraction(w_1: f64, w_4: f64) -> f64 {
    w_4 * w_4 / w_1
}

/// The price of the distance `ω` for a believed `w_1` and a deviation `γ` of the other from what was predicted.
pub(super) fn price(settings: &Settings, w_1: f64, deviation: f64) -> DistancePrice {
    match settings.value {
        ReplyValue::Linear => DistancePrice::Linear { weight: attraction(w_1, settings.w_4) },
        ReplyValue::Exact => DistancePrice::Exact {
            base: 1.0 + settings.impression_variance * deviation,
            loyalty: w_1.max(settings.w_4),
            aversion: settings.w_4,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// `w_1`, `w_4`, `Σ_ω γ` and `ω` with `A > w_4`.
    fn numbers() -> impl Strategy<Value = (f64, f64, f64, f64)> {
        (0.1..5.0, 0.01..1.0, 0.0..0.5, 0.5..5.0)
            .prop_map(|(w_1, share, spread, omega)| (w_1, share * w_1, spread, omega))
    }

    proptest! {
        #[test]
        fn the_division_of_the_plan_deviation_is_right((w_1, w_4, spread, omega) in numbers()) {
            let (a, m) = ((1.0 + spread + omega) * w_1, (1.0 + spread) * w_1 - w_4);
            let (s, ratio) = (a - w_4, (w_4 / w_1) * (w_4 / w_1));
            let [k_2, k_3, k_4] = [ratio * (w_4 - m), ratio * m * (m - 2.0 * w_4), ratio * w_4 * m * m];
            let divided = attraction(w_1, w_4) * omega + k_2 + k_3 / s + k_4 / (s * s);
            let whole = a * w_4 * w_4 * omega * omega / (s * s);
            prop_assert!((divided - whole).abs() < 1e-12 * (1.0 + whole.abs() + k_4 / (s * s)));
            prop_assert_eq!(k_3 < 0.0, (1.0 + spread) * w_1 < 3.0 * w_4);
        }

        /// On the line through plan and ego, `r` being how far the response is from the plan, away from the ego.
        #[test]
        fn nothing_serves_the_other_better_than_its_best_response((w_1, w_4, spread, omega) in numbers(), r in -5.0..5.0) {
            let a = (1.0 + spread + omega) * w_1;
            let cost = |r: f64| a * r * r - w_4 * (omega + r) * (omega + r);
            let best = cost(w_4 * omega / (a - w_4));
            prop_assert!((best + a * w_4 / (a - w_4) * omega * omega).abs() < 1e-9 * (1.0 + best.abs()));
            prop_assert!(cost(r) >= best - 1e-9 * (1.0 + best.abs()));
        }
    }
}
