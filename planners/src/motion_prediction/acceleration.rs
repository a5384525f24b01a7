//! Motions that ignore all other vehicles: constant velocity, and an acceleration that decays.

use super::{LateralMotion, PredictedMotion, STEP_S, STEPS, TrafficMoment};

/// The motion at the present speed, with an acceleration that decays within about a time \[s\] and is half trusted at a noise \[m/s\];
/// without them, at constant velocity.
pub(super) fn predict(moment: &TrafficMoment, decay: Option<[f64; 2]>, lateral: LateralMotion) -> PredictedMotion {
    let mut along_m = Vec::with_capacity(STEPS + 1);
    let mut farthest_m: f64 = 0.0;
    for step in 0..=STEPS {
        let time_s = STEP_S * step as f64;
        let gained_m = decay.map_or(0.0, |[decay_s, half_noise_mps]| {
            let decay_s = decay_s.max(1e-3);
            let passed_s = decay_s * (1.0 - libm::exp(-time_s / decay_s));
            moment.trusted_acceleration_mps2(half_noise_mps) * decay_s * (time_s - passed_s)
        });
        // A standing vehicle does not drive backwards.
        farthest_m = farthest_m.max(moment.speed_mps * time_s + gained_m);
        along_m.push(farthest_m);
    }
    PredictedMotion { along_m, across_m: lateral.places_m(moment) }
}
