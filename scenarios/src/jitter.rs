//! The random change of the starts.
//!
//! SplitMix64 (Steele, Lea and Flood, 2014) turns the seed into a sequence of 64-bit numbers; the upper 53 bits of each
//! make a uniform number in `[0, 1)`. Two numbers per vehicle, in the order of the file: position, then speed.

use interplay_planners::State;

use crate::Scenario;

struct SplitMix64(u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in `[−1, 1)`.
    fn around_zero(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// The start of each vehicle, as written plus the random change.
pub(crate) fn starts(scenario: &Scenario) -> Vec<State> {
    let jitter = scenario.start_jitter;
    let mut random = SplitMix64(scenario.seed);
    let jittered = scenario.vehicles.iter().map(|vehicle| {
        let (shift_m, faster_mps) = (jitter.position_m * random.around_zero(), jitter.speed_mps * random.around_zero());
        let (start, limits) = (vehicle.start, vehicle.limits);
        let (sin, cos) = libm::sincos(start.heading_rad);
        let speed_mps = if jitter.speed_mps > 0.0 {
            (start.speed_mps + faster_mps).max(limits.speed_min_mps).min(limits.speed_max_mps)
        } else {
            start.speed_mps
        };
        State { x_m: start.x_m + cos * shift_m, y_m: start.y_m + sin * shift_m, speed_mps, ..start }
    });
    jittered.collect()
}
