//! What a vehicle may do at each stage of a plan: what it can, what the rules permit, and what is comfortable.
//!
//! Comfort bounds how fast inputs change from the last one on: at stage `t` of the length `h` the acceleration is within
//! `a₋₁ ± j h (t + 1)` of the last one `a₋₁`, and the steering angle likewise, no faster than its wheels turn. Only the first
//! input of a plan is applied, so that the driven motion keeps the bound, and a plan is free where it only promises. A vehicle that has
//! to brake harder than is comfortable ([`urgency`](Agent::urgency)) has wider bounds, up to those of its body.
//!
//! Where the largest steering rate of the wheels is stated, each change of the angle from one stage to the next keeps it, too, softly.
//!
//! Speeds are bounded so that there is always a motion within all bounds: from each speed that is allowed at a stage, one that is
//! allowed at the next stage can be reached.

use crate::trajectory::StageBounds;
use crate::vehicle::ComfortLimits;
use crate::{Agent, Limits};

/// Plans turn the wheels with this share of the largest steering rate that is stated, so that some is left to correct the motion.
const TURNING_SHARE: f64 = 0.8;
/// Largest lateral acceleration in danger, as a multiple of the comfortable one.
const MOST_LATERAL_URGENCY: f64 = 2.0;

impl Agent {
    /// The bounds at the stages of a plan, with highest speeds at `t = 1…N` where there are any; empty where the limits of the
    /// body alone bound everything.
    pub(crate) fn stage_bounds(&self, horizon: usize, step_s: f64, caps_mps: &[f64]) -> Vec<StageBounds> {
        let limits = &self.limits;
        let steering_rate = limits.steering_rate_radps(self.urgency);
        if limits.lateral_acceleration_max_mps2.is_none() && steering_rate.is_none() && caps_mps.is_empty() {
            return Vec::new();
        }
        let steering_max_rad = self.steering_bounds_rad(horizon);
        let turning_wheels = steering_rate.filter(|_| limits.steering_rate_max_radps.is_some());
        let turn_rad = turning_wheels.map_or(f64::INFINITY, |rate_radps| TURNING_SHARE * rate_radps * step_s);
        let mut bounds: Vec<StageBounds> = (0..horizon)
            .map(|t| {
                let steering_max_rad = steering_max_rad.get(t).copied().unwrap_or(limits.steering_max_rad);
                let turned_rad = steering_rate.map(|rate_radps| rate_radps * step_s * (t + 1) as f64);
                let bounds = StageBounds {
                    acceleration_mps2: [limits.acceleration_min_mps2, limits.acceleration_max_mps2],
                    steering_rad: self.steerable([-steering_max_rad, steering_max_rad], turned_rad),
                    speed_mps: [limits.speed_min_mps, self.highest_speed_mps(t, caps_mps)],
                    turn_rad,
                };
                limits.comfort.map_or(bounds, |comfort| self.comfortable(bounds, &comfort, t, step_s))
            })
            .collect();
        if limits.comfort.is_some() {
            self.within_reach(&mut bounds, step_s);
            return bounds;
        }
        for (t, StageBounds { speed_mps, .. }) in bounds.iter_mut().enumerate() {
            *speed_mps = limits.speeds_within_reach(*speed_mps, self.state.speed_mps, step_s * (t + 1) as f64);
        }
        bounds
    }

    /// The largest steering angles at `t = 0…N−1`, at the speeds that it is expected to have; empty where they do not depend on
    /// the speed \[rad\].
    pub(crate) fn steering_bounds_rad(&self, horizon: usize) -> Vec<f64> {
        let comfortable_mps2 = self
            .limits
            .comfort
            .map(|comfort| comfort.lateral_acceleration_mps2 * self.urgency.min(MOST_LATERAL_URGENCY));
        let bounds = self.limits.lateral_acceleration_max_mps2.into_iter().chain(comfortable_mps2);
        let Some(most_mps2) = bounds.min_by(f64::total_cmp) else { return Vec::new() };
        let expected = self.prediction.states.iter().skip(1).map(|state| state.speed_mps);
        let last_mps = self.prediction.states.last().unwrap_or(&self.state).speed_mps;
        let speeds = std::iter::once(self.state.speed_mps).chain(expected).chain(std::iter::repeat(last_mps));
        speeds.take(horizon).map(|speed_mps| self.limits.steering_at_rad(&self.body, speed_mps, most_mps2)).collect()
    }

    fn highest_speed_mps(&self, t: usize, caps_mps: &[f64]) -> f64 {
        caps_mps.get(t).map_or(self.limits.speed_max_mps, |cap_mps| cap_mps.min(self.limits.speed_max_mps))
    }

    /// Bounds of one stage, within what is comfortable.
    fn comfortable(&self, bounds: StageBounds, comfort: &ComfortLimits, t: usize, step_s: f64) -> StageBounds {
        let until_s = step_s * (t + 1) as f64;
        let Limits { acceleration_min_mps2, acceleration_max_mps2, .. } = self.limits;
        let last = &self.previous_input;
        let jerk_mps3 = comfort.jerk_mps3 * self.urgency * self.urgency;
        // What is driven releases the brakes before the vehicle stands.
        let next_mps = self.state.speed_mps + step_s * last.acceleration_mps2.min(0.0);
        let speed_mps = if t == 0 { next_mps } else { f64::INFINITY };
        let least_mps2 = acceleration_min_mps2.max(-comfort.braking_at_mps2(self.urgency, speed_mps));
        StageBounds {
            acceleration_mps2: shared(
                [least_mps2, acceleration_max_mps2],
                around(last.acceleration_mps2, jerk_mps3 * until_s),
                [acceleration_min_mps2, acceleration_max_mps2],
            ),
            ..bounds
        }
    }

    /// What can be reached of a range of steering angles, where the angle changes by no more than some other one \[rad\].
    fn steerable(&self, wanted_rad: [f64; 2], turned_rad: Option<f64>) -> [f64; 2] {
        let (last_rad, most_rad) = (self.previous_input.steering_rad, self.limits.steering_max_rad);
        turned_rad
            .map_or(wanted_rad, |turned_rad| shared(wanted_rad, around(last_rad, turned_rad), [-most_rad, most_rad]))
    }

    /// Widens bounds on the speed for a vehicle that is out of them now, as [`Limits::speeds_within_reach`] does, where the bounds on the
    /// acceleration differ from stage to stage; and from each allowed speed the next ones can be reached.
    fn within_reach(&self, bounds: &mut [StageBounds], step_s: f64) {
        let [mut lowest_mps, mut highest_mps] = [self.state.speed_mps; 2];
        for StageBounds { acceleration_mps2: [low, high], speed_mps: [slowest, fastest], .. } in bounds.iter_mut() {
            // Brakes are released at once where the vehicle would otherwise roll backwards.
            *high = high.max((*slowest - highest_mps).min(0.0) / step_s);
            *low = low.min(*high);
            highest_mps += step_s * *high;
            lowest_mps += step_s * *low;
            *slowest = slowest.min(highest_mps);
            *fastest = fastest.max(lowest_mps);
            lowest_mps = lowest_mps.max(*slowest);
            highest_mps = highest_mps.min(*fastest);
        }
        for t in (1..bounds.len()).rev() {
            let next = bounds[t];
            let [low, high] = next.acceleration_mps2;
            let [slowest, fastest] = &mut bounds[t - 1].speed_mps;
            *fastest = fastest.min(next.speed_mps[1] - step_s * low).max(*slowest);
            *slowest = slowest.max(next.speed_mps[0] - step_s * high).min(*fastest);
        }
    }
}

/// The range of a size around a value.
fn around(value: f64, size: f64) -> [f64; 2] {
    [value - size, value + size]
}

/// What two ranges have in common, within a third one; where the first two have nothing in common, the end of the second that is
/// nearest to the first.
fn shared(wanted: [f64; 2], reachable: [f64; 2], possible: [f64; 2]) -> [f64; 2] {
    let nearest = |value: f64| value.max(reachable[0]).min(reachable[1]).max(possible[0]).min(possible[1]);
    wanted.map(nearest)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::fixture;

    proptest! {
        /// From any speed and last acceleration, and under any speed caps, braking as hard as allowed and accelerating as hard as
        /// allowed keep all bounds from stage to stage.
        #[test]
        fn there_is_always_a_motion_within_the_bounds(
            speed_mps in 0.0..30.0, last_mps2 in -6.0..3.0, caps in proptest::collection::vec(0.1..30.0, 12), urgency in 1.0..3.0,
        ) {
            let mut agent = fixture::agent(0.0, 0.0, 0.0, speed_mps);
            agent.limits = Limits {
                acceleration_min_mps2: -6.4, acceleration_max_mps2: 3.0, speed_max_mps: 50.0,
                comfort: Some(ComfortLimits::default()), ..agent.limits
            };
            agent.previous_input.acceleration_mps2 = last_mps2;
            agent.urgency = urgency;
            let bounds = agent.stage_bounds(12, 0.3, &caps);
            for extreme in [0, 1] {
                let mut speed_mps = speed_mps;
                for stage in &bounds {
                    let [low, high] = stage.acceleration_mps2;
                    let [slowest, fastest] = stage.speed_mps;
                    prop_assert!(low <= high && slowest <= fastest);
                    let wanted = stage.acceleration_mps2[extreme];
                    let applied = wanted.min((fastest - speed_mps) / 0.3).max((slowest - speed_mps) / 0.3);
                    prop_assert!(applied >= low - 1e-9 && applied <= high + 1e-9, "{applied} {low} {high}");
                    speed_mps += 0.3 * applied;
                    prop_assert!(speed_mps > -1e-9, "{speed_mps}");
                }
            }
        }
    }
}
