//! The intelligent driver model: how a vehicle follows the one ahead (Treiber, Hennecke and Helbing, 2000).
//!
//! ```text
//! a = a_max (1 − (v/v₀)^δ − (s*/s)²),   s* = s₀ + max(0, v T + v Δv / (2 √(a_max b)))
//! ```
//!
//! `s` is the gap between bumpers to the vehicle ahead and `Δv` the speed at which it closes.

use super::Settings;
use crate::drivers::lanes::Leader;

/// A gap that is closed counts as this \[m\].
const MIN_GAP_M: f64 = 1e-3;

impl Settings {
    /// The acceleration `a` of a vehicle behind `leader`, if there is one, \[m/s²\].
    pub(super) fn acceleration(&self, speed_mps: f64, wanted_mps: f64, leader: Option<Leader>) -> f64 {
        self.acceleration_with(self.free(speed_mps, wanted_mps), speed_mps, leader)
    }

    /// What a speed takes of the acceleration on a free road, `(v/v₀)^δ`.
    pub(super) fn free(&self, speed_mps: f64, wanted_mps: f64) -> f64 {
        libm::pow(speed_mps.max(0.0) / wanted_mps.max(MIN_GAP_M), self.exponent)
    }

    /// The same acceleration, with [`Settings::free`] of its speeds.
    pub(super) fn acceleration_with(&self, free: f64, speed_mps: f64, leader: Option<Leader>) -> f64 {
        let close = leader.map_or(0.0, |leader| {
            let closing = speed_mps * (speed_mps - leader.speed_mps);
            let dynamic =
                speed_mps * self.headway_s + closing / (2.0 * (self.acceleration_mps2 * self.braking_mps2).sqrt());
            let wanted_gap = self.gap_m + dynamic.max(0.0);
            let share = wanted_gap / leader.gap_m.max(MIN_GAP_M);
            share * share
        });
        self.acceleration_mps2 * (1.0 - free - close)
    }

    /// The acceleration of a vehicle behind another one, as its gap between bumpers \[m\] and its speed \[m/s\], \[m/s²\].
    pub fn acceleration_behind(&self, speed_mps: f64, wanted_mps: f64, ahead: Option<(f64, f64)>) -> f64 {
        self.acceleration(speed_mps, wanted_mps, ahead.map(|(gap_m, speed_mps)| Leader { gap_m, speed_mps }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In equilibrium at the leader's speed the gap is `s*/√(1 − (v/v₀)^δ)`.
    #[test]
    fn followers_settle_at_the_equilibrium_gap() {
        let settings = Settings::default();
        let (mut gap, mut speed, leader_mps, wanted) = (2.0, 1.0, 0.8, 1.2);
        for _ in 0..20_000 {
            let acceleration = settings.acceleration(speed, wanted, Some(Leader { gap_m: gap, speed_mps: leader_mps }));
            gap += 0.01 * (leader_mps - speed);
            speed += 0.01 * acceleration;
        }
        let share = libm::pow(leader_mps / wanted, settings.exponent);
        let equilibrium = (settings.gap_m + leader_mps * settings.headway_s) / (1.0 - share).sqrt();
        assert!((speed - leader_mps).abs() < 1e-6 && (gap - equilibrium).abs() < 1e-4, "{speed} {gap} {equilibrium}");
    }

    #[test]
    fn on_a_free_road_the_wanted_speed_is_kept() {
        let settings = Settings::default();
        assert_eq!(settings.acceleration(1.2, 1.2, None), 0.0);
        assert!((settings.acceleration(0.0, 1.2, None) - settings.acceleration_mps2).abs() < 1e-12);
    }
}
