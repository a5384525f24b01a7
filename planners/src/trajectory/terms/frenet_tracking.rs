//! Tracking in Frenet coordinates: `Σ_{t=1…N} q_s (s − s*)² + q_n (n − n*)² + q_θ (θ − ψ(s))² + q_v (v − v*)²` (eq. 6.6 along a
//! curved road), with `ψ` the direction of the road beside the vehicle, less the slip angle that the curve takes.
//!
//! With `e_θ = θ − ψ(s) + β_t`, whose gradient is `(−ψ′ ∇s, 1)`, the Gauss-Newton part of the Hessian is
//! `2 Σ q ∇e ∇eᵀ`. The rest is `2 (q_s e_s ∇²s + q_n e_n ∇²n − q_θ e_θ (ψ′ ∇²s + ψ″ ∇s ∇sᵀ))`, over the position only.
//!
//! On a straight road this is [`Tracking`](super::Tracking).

use super::shape::StateCostTerm;
use crate::road::centre_line::FrenetExpansion;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::stage::StateCost;

/// The tracking cost of one vehicle on a curved road: that of its participant's [`RouteStart`](crate::trajectory::RouteStart).
#[derive(Clone, Debug, PartialEq)]
pub struct FrenetTracking {
    /// Index of the vehicle whose states it concerns.
    pub vehicle: usize,
    /// Diagonal of `Q` on (position along the road, across it, θ, v).
    pub weights: [f64; 4],
    /// Desired arc length \[m\], lateral coordinate \[m\] and speed \[m/s\].
    pub target: FrenetTarget,
    /// Highest permitted speeds at `t = 1…N`, which lower the desired one; `N` long, or empty without limits \[m/s\].
    pub permitted_mps: Vec<f64>,
    /// Slip angles of a vehicle that follows the road at `t = 1…N`, by which it heads outward of the road; `N` long, or empty for
    /// none \[rad\].
    pub slips_rad: Vec<f64>,
}

/// Desired place and speed of a vehicle on a curved road.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrenetTarget {
    /// Desired arc length `s` \[m\].
    pub along_m: f64,
    /// Desired lateral coordinate `n`, positive to the left \[m\].
    pub across_m: f64,
    /// Desired speed \[m/s\].
    pub speed_mps: f64,
}

impl FrenetTracking {
    /// The desired speed at a stage \[m/s\].
    fn speed_mps(&self, stage: usize) -> f64 {
        let permitted_mps = self.permitted_mps.get(stage).copied().unwrap_or(f64::INFINITY);
        self.target.speed_mps.min(permitted_mps)
    }

    /// Where the vehicle is beside its route.
    fn place<'a>(&self, stage: usize, iterate: &'a Iterate) -> &'a FrenetExpansion {
        &iterate.frenet[self.vehicle][stage]
    }

    /// The slip angle at a stage \[rad\].
    fn slip_rad(&self, stage: usize) -> f64 {
        self.slips_rad.get(stage).copied().unwrap_or_default()
    }
}

impl StateCostTerm for FrenetTracking {
    fn vehicle(&self) -> usize {
        self.vehicle
    }

    fn add_value(&self, stage: usize, iterate: &Iterate, total: &mut f64) {
        let state = &iterate.states[self.vehicle][stage + 1];
        let at = self.place(stage, iterate);
        let deviation = [
            at.along_m - self.target.along_m,
            at.across_m - self.target.across_m,
            state.heading_rad - at.heading_rad + self.slip_rad(stage),
            state.speed_mps - self.speed_mps(stage),
        ];
        for (weight, deviation) in self.weights.iter().zip(deviation) {
            *total += weight * deviation * deviation;
        }
    }

    fn add_expansion(&self, stage: usize, iterate: &Iterate, cost: &mut StateCost, concave: &mut [f64; 3]) {
        let state = &iterate.states[self.vehicle][stage + 1];
        let at = self.place(stage, iterate);
        let [along, across, turn, speed] = self.weights.map(|weight| 2.0 * weight);
        let pull_along = along * (at.along_m - self.target.along_m);
        let pull_across = across * (at.across_m - self.target.across_m);
        let pull_turn = turn * (state.heading_rad - at.heading_rad + self.slip_rad(stage));
        let (s, n) = (at.along_gradient, at.across_gradient);
        let psi = s.map(|slope| at.heading_slope_radpm * slope);
        for axis in 0..2 {
            cost.gradient[axis] += pull_along * s[axis] + pull_across * n[axis] - pull_turn * psi[axis];
            cost.heading_cross[axis] -= turn * psi[axis];
        }
        cost.gradient[2] += pull_turn;
        cost.gradient[3] += speed * (state.speed_mps - self.speed_mps(stage));
        let squares = |v: [f64; 2]| [v[0] * v[0], v[0] * v[1], v[1] * v[1]];
        let (ss, nn, pp) = (squares(s), squares(n), squares(psi));
        let [xx, xy, yy]: [f64; 3] = std::array::from_fn(|i| along * ss[i] + across * nn[i] + turn * pp[i]);
        for (sum, bend) in cost.hessian.iter_mut().zip([xx, yy, turn, speed]) {
            *sum += bend;
        }
        cost.cross += xy;
        for (i, sum) in concave.iter_mut().enumerate() {
            let turning = at.heading_slope_radpm * at.along_hessian[i] + at.heading_bend_radpm2 * ss[i];
            *sum += pull_along * at.along_hessian[i] + pull_across * at.across_hessian[i] - pull_turn * turning;
        }
    }
}
