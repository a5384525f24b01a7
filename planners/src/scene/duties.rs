//! The gap that a vehicle owes to the one behind it when it comes into its lane.
//!
//! Responsibility-sensitive safety (Shalev-Shwartz, Shammah and Shashua, 2017) with the values of people:
//!
//! ```text
//! in an emergency  v ρ + v²/2b − u²/2b + d₀        both brake with b = 6 m/s², the one behind after ρ = 0.6 s
//! otherwise        ρ Δv + Δv²/2a + d₀              the one behind brakes with at most a = 2 m/s²,  Δv = max(0, v − u)
//! in any case      0.5 s · v
//! ```
//!
//! `v` is the speed of the one behind, `u` that of the one ahead, and `d₀` is 2 m. The largest counts: 18.8 m at equal speeds of 28 m/s.

use crate::Body;

/// Time after which a driver brakes, of real vehicles \[s\].
const REACTION_S: f64 = 0.6;
/// How hard both brake in an emergency \[m/s²\].
const EMERGENCY_MPS2: f64 = 6.0;
/// How hard a driver may be made to brake while the one ahead keeps its plan \[m/s²\].
const ASKED_MPS2: f64 = 2.0;
/// What is left between two standing vehicles, of real ones \[m\].
const LEFT_M: f64 = 2.0;
/// The least time gap, of real vehicles \[s\].
const LEAST_S: f64 = 0.5;

/// The gap between bumpers that a vehicle at `ahead_mps` owes to one of some body behind it at `behind_mps` \[m\]; speeds in m/s.
pub fn owed_gap_m(behind: &Body, behind_mps: f64, ahead_mps: f64) -> f64 {
    let (length_ratio, time_ratio) = (behind.real_ratio(), behind.real_ratio().sqrt());
    let (reaction_s, left_m) = (REACTION_S * time_ratio, LEFT_M * length_ratio);
    let faster_mps = (behind_mps - ahead_mps).max(0.0);
    let emergency_m = behind_mps * reaction_s + (behind_mps.powi(2) - ahead_mps.powi(2)) / (2.0 * EMERGENCY_MPS2);
    let asked_m = reaction_s * faster_mps + faster_mps.powi(2) / (2.0 * ASKED_MPS2);
    (emergency_m + left_m).max(asked_m + left_m).max(LEAST_S * time_ratio * behind_mps)
}

/// The braking that a gap asks of the one behind so that it does not touch one ahead that keeps its speed \[m/s²\]: after its reaction time
/// it becomes as slow on what is left of the gap \[m\]; infinite where nothing is left. Speeds in m/s.
pub fn needed_braking_mps2(behind: &Body, gap_m: f64, behind_mps: f64, ahead_mps: f64) -> f64 {
    let faster_mps = behind_mps - ahead_mps;
    if faster_mps <= 0.0 {
        return 0.0;
    }
    let left_m = gap_m - REACTION_S * behind.real_ratio().sqrt() * faster_mps;
    if left_m > 0.0 { faster_mps.powi(2) / (2.0 * left_m) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::real_car;

    #[test]
    fn at_equal_speeds_the_reaction_and_two_metres_are_owed() {
        let body = real_car(0.0, 28.0).body;
        assert!((owed_gap_m(&body, 28.0, 28.0) - 18.8).abs() < 1e-9);
    }

    #[test]
    fn a_slower_vehicle_owes_what_braking_in_an_emergency_or_at_two_takes() {
        let body = real_car(0.0, 28.0).body;
        // 18.8 m and 10 m/s that are braked off with 6 m/s², from 28 and from 18 m/s.
        assert!((owed_gap_m(&body, 28.0, 18.0) - (18.8 + 460.0 / 12.0)).abs() < 1e-9);
        // A faster one leaves less than 0.5 s.
        assert!((owed_gap_m(&body, 20.0, 40.0) - 10.0).abs() < 1e-9);
    }

    #[test]
    fn model_cars_owe_the_same_in_their_scale() {
        let (real, model) = (real_car(0.0, 0.0).body, Body::default());
        let (length, speed) = (model.real_ratio(), model.real_ratio().sqrt());
        let owed_m = owed_gap_m(&model, 28.0 * speed, 20.0 * speed);
        assert!((owed_m / length - owed_gap_m(&real, 28.0, 20.0)).abs() < 1e-9);
    }

    #[test]
    fn the_braking_that_a_gap_asks_for_grows_as_it_shrinks() {
        let body = real_car(0.0, 28.0).body;
        let needed = [60.0, 20.0, 10.0, 5.0].map(|gap_m| needed_braking_mps2(&body, gap_m, 28.0, 18.0));
        assert!(needed.windows(2).all(|pair| pair[0] < pair[1]), "{needed:?}");
        assert!((needed[1] - 100.0 / 28.0).abs() < 1e-9 && needed[3].is_infinite());
        assert_eq!(needed_braking_mps2(&body, 1.0, 10.0, 12.0), 0.0);
    }
}
