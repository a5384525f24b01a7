//! A cost on how far a vehicle is from another's predicted path: `Σ_{t=1…N} φ(ω_t)`.
//!
//! `ω = √(dᵀ M d + ε²)` with `d` the vehicle's position minus the other's, and a symmetric positive definite `M`. With
//! `n = M d/ω`,
//!
//! ```text
//! ∇φ = φ′ n,     ∇²φ = φ″ n nᵀ + φ′ (M − n nᵀ)/ω
//! ```
//!
//! `M − n nᵀ` is positive semi-definite (Cauchy and Schwarz). So the Hessian splits into a convex part, where `φ′` or `φ″`
//! is positive, and a concave one: the first is in every QP subproblem, the second in exact ones only.

use super::shape::StateCostTerm;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::stage::StateCost;

/// Smooths the tip of the cone at `d = 0`, `ε`.
const CONE_SMOOTHING: f64 = 1e-4;

/// The cost of a trajectory's distances from a moving centre.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceCost {
    /// Index of the vehicle whose distance it prices.
    pub vehicle: usize,
    /// Centres at `t = 1…N` \[m\].
    pub centres: Vec<[f64; 2]>,
    /// Entries xx, xy, yy of `M` at `t = 1…N`; `N` long.
    pub metrics: Vec<[f64; 3]>,
    /// The price `φ` of a distance.
    pub price: DistancePrice,
}

/// What a distance `ω` costs, `φ(ω)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DistancePrice {
    /// `weight · ω`: attracts.
    Linear {
        /// Weight `k_1` of eq. 7.19.
        weight: f64,
    },
    /// `−A w_4/(A − w_4) · ω²` with `A = (base + ω) w_1`: repels. `base · w_1 > w_4` keeps it smooth.
    Exact {
        /// The number `1 + Σ_ω γ` of eq. 7.18.
        base: f64,
        /// Weight `w_1` that the other puts on its own plan.
        loyalty: f64,
        /// Weight `w_4` with which the other keeps away from the ego.
        aversion: f64,
    },
}

/// A value of one variable with its first two derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Jet {
    value: f64,
    slope: f64,
    bend: f64,
}

impl DistancePrice {
    /// `φ` with its derivatives.
    ///
    /// For the exact price, with `s = A − w_4`, division gives
    /// `φ = −w_4 (ω² + w_4 ω²/s) ` and `ω²/s = (ω − m/w_1)/w_1 + (m/w_1)²/s`, `m = base·w_1 − w_4`.
    fn at(&self, omega: f64) -> Jet {
        match *self {
            DistancePrice::Linear { weight } => Jet { value: weight * omega, slope: weight, bend: 0.0 },
            DistancePrice::Exact { base, loyalty, aversion } => {
                let rest = base * loyalty - aversion;
                let (s, share) = (loyalty * omega + rest, rest / loyalty);
                let ratio = Jet {
                    value: (omega - share) / loyalty + share * share / s,
                    slope: 1.0 / loyalty - share * share * loyalty / (s * s),
                    bend: 2.0 * share * share * loyalty * loyalty / (s * s * s),
                };
                Jet {
                    value: -aversion * (omega * omega + aversion * ratio.value),
                    slope: -aversion * (2.0 * omega + aversion * ratio.slope),
                    bend: -aversion * (2.0 + aversion * ratio.bend),
                }
            }
        }
    }
}

impl DistanceCost {
    /// `ω` where the vehicle is at `position` and the centre that of stage `k`, with `n = M d/ω`.
    fn distance(&self, k: usize, position: [f64; 2]) -> (f64, [f64; 2]) {
        let [xx, xy, yy] = self.metrics[k];
        let (dx, dy) = (position[0] - self.centres[k][0], position[1] - self.centres[k][1]);
        let (mx, my) = (xx * dx + xy * dy, xy * dx + yy * dy);
        let omega = (dx * mx + dy * my + CONE_SMOOTHING * CONE_SMOOTHING).sqrt();
        (omega, [mx / omega, my / omega])
    }

    /// The distance `ω` of a position from the centre at stage `k` (`t = k + 1`).
    pub fn omega(&self, k: usize, position: [f64; 2]) -> f64 {
        self.distance(k, position).0
    }
}

impl StateCostTerm for DistanceCost {
    fn vehicle(&self) -> usize {
        self.vehicle
    }

    fn add_value(&self, stage: usize, iterate: &Iterate, total: &mut f64) {
        let state = &iterate.states[self.vehicle][stage + 1];
        *total += self.price.at(self.distance(stage, state.position()).0).value;
    }

    fn add_expansion(&self, stage: usize, iterate: &Iterate, cost: &mut StateCost, concave: &mut [f64; 3]) {
        let state = &iterate.states[self.vehicle][stage + 1];
        let (omega, n) = self.distance(stage, state.position());
        let Jet { slope, bend, .. } = self.price.at(omega);
        cost.gradient[0] += slope * n[0];
        cost.gradient[1] += slope * n[1];
        let along = [n[0] * n[0], n[0] * n[1], n[1] * n[1]];
        let round: [f64; 3] = std::array::from_fn(|i| (self.metrics[stage][i] - along[i]) / omega);
        let part = |slope: f64, bend: f64| -> [f64; 3] { std::array::from_fn(|i| bend * along[i] + slope * round[i]) };
        let [xx, xy, yy] = part(slope.max(0.0), bend.max(0.0));
        cost.hessian[0] += xx;
        cost.cross += xy;
        cost.hessian[1] += yy;
        for (sum, entry) in concave.iter_mut().zip(part(slope.min(0.0), bend.min(0.0))) {
            *sum += entry;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::State;

    const EXACT: DistancePrice = DistancePrice::Exact { base: 1.05, loyalty: 0.7, aversion: 0.3 };

    #[test]
    fn the_divided_form_of_the_exact_price_is_the_price() {
        for omega in [0.0, 0.3, 1.0, 2.5, 10.0] {
            let a = (1.05 + omega) * 0.7;
            let price = -a * 0.3 / (a - 0.3) * omega * omega;
            assert!((EXACT.at(omega).value - price).abs() < 1e-13 * (1.0 + price.abs()));
        }
    }

    #[test]
    fn the_exact_price_repels_and_the_linear_one_attracts() {
        for omega in [0.5, 1.0, 3.0] {
            assert!(EXACT.at(omega).slope < 0.0 && DistancePrice::Linear { weight: 0.2 }.at(omega).slope > 0.0);
        }
    }

    #[test]
    fn along_a_straight_line_the_linear_price_is_straight() {
        let centres = vec![[1.0, 2.0]];
        let price = DistancePrice::Linear { weight: 2.0 };
        let cost = DistanceCost { vehicle: 0, centres, metrics: vec![[1.5, 0.2, 4.0]], price };
        let value = |share: f64| {
            let state = State { x_m: 1.0 + 0.5 * share, y_m: 2.0 - 0.3 * share, ..State::default() };
            let (mut total, iterate) = (0.0, Iterate { states: vec![vec![state; 2]], ..Iterate::default() });
            cost.add_value(0, &iterate, &mut total);
            total
        };
        assert!((value(1.0) + value(3.0) - 2.0 * value(2.0)).abs() < 1e-7);
    }
}
