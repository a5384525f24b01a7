//! The score of a start: `S = 100 · G · P · C · K`.
//!
//! - `G` is 0 for a contact at fault, a red light, a stop sign or a right of way that is broken, more than 0.3 m beyond the road's edge for
//!   more than 0.5 s, or no goal within the time limit `T_alone + 15 s`; otherwise 1.
//! - `P = max(0, 1 − (T − T_alone)/15 s)` with the time `T` at which the ego reaches its goal; `T_alone` is that of the reference driver
//!   without any other road user.
//! - `C = max(0, 1 − L/10 s − B/(4 m/s))` with the largest delay `L` of one other and the largest `B = ∫ (braking − 2 m/s²)⁺ dt` of one
//!   other, each less that of the same start without the ego.
//! - `K = 1 − 0.2 · share` of the time with `|jerk| > 5 m/s³` or a lateral acceleration above 3 m/s².
//!
//! A planner that waits loses by `P`, one that pushes by `C`.

use serde::{Deserialize, Serialize};

use crate::formula::{DISCOMFORT_WEIGHT, LEAST_SPEED_MPS, MOST_BRAKING_MPS, MOST_DELAY_S, MOST_LOST_S};
use crate::trace::{EgoTrace, OtherTrace, Trace};

/// The score of one start with its parts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StartScore {
    /// Whether nothing was broken and the goal was reached.
    pub g: f64,
    /// Progress.
    pub p: f64,
    /// Courtesy.
    pub c: f64,
    /// Comfort.
    pub k: f64,
    /// `100 G P C K`.
    pub score: f64,
}

impl StartScore {
    /// The score from its parts.
    pub fn of_parts([g, p, c, k]: [f64; 4]) -> StartScore {
        StartScore { g, p, c, k, score: 100.0 * g * p * c * k }
    }

    /// The score of a run, compared with the same start without the ego.
    pub(crate) fn of_run(ego: &EgoTrace, with: &Trace, without: &Trace, alone_s: f64) -> StartScore {
        let completed_s = ego.completed_s.filter(|_| ego.failure.is_none());
        let lost_s = completed_s.map_or(MOST_LOST_S, |completed_s| completed_s - alone_s);
        let p = (1.0 - lost_s / MOST_LOST_S).clamp(0.0, 1.0);
        let [delay_s, braking_mps] = caused(with, without);
        let c = (1.0 - delay_s / MOST_DELAY_S - braking_mps / MOST_BRAKING_MPS).max(0.0);
        let k = 1.0 - DISCOMFORT_WEIGHT * ego.uncomfortable_share();
        StartScore::of_parts([if completed_s.is_some() { 1.0 } else { 0.0 }, p, c, k])
    }
}

/// The largest delay \[s\] and the largest braking \[m/s\] of one other that the ego causes.
pub(crate) fn caused(with: &Trace, without: &Trace) -> [f64; 2] {
    let pairs = with.others.iter().zip(&without.others);
    pairs.fold([0.0, 0.0], |[delay_s, braking_mps], (with_ego, alone)| {
        [
            f64::max(delay_s, delay(with_ego, alone, with.step_s)),
            f64::max(braking_mps, braking(with_ego) - braking_at(alone, with_ego.along_m.len())),
        ]
    })
}

/// How much later a vehicle is where it is at the end of the run than without the ego; 0 if it is earlier \[s\].
fn delay(with_ego: &OtherTrace, alone: &OtherTrace, step_s: f64) -> f64 {
    let (Some(end_m), ticks) = (with_ego.along_m.last(), with_ego.along_m.len()) else { return 0.0 };
    let Some(reached) = alone.along_m.iter().position(|along_m| along_m >= end_m) else { return 0.0 };
    let before_m = alone.along_m[reached.saturating_sub(1)];
    let way_m = alone.along_m[reached] - before_m;
    let share = if way_m > 0.0 { (end_m - before_m) / way_m } else { 1.0 };
    let reached_s = (reached as f64 - 1.0 + share.clamp(0.0, 1.0)).max(0.0) * step_s;
    let late_s = ((ticks as f64 - 1.0) * step_s - reached_s).max(0.0);
    if with_ego.has_left {
        return late_s;
    }
    let behind_m = alone.along_m[(ticks - 1).min(alone.along_m.len() - 1)] - end_m;
    late_s.min(behind_m.max(0.0) / LEAST_SPEED_MPS)
}

fn braking(trace: &OtherTrace) -> f64 {
    trace.braking_mps.last().copied().unwrap_or_default()
}

/// The braking up to a tick \[m/s\].
fn braking_at(trace: &OtherTrace, ticks: usize) -> f64 {
    trace.braking_mps.get(ticks.saturating_sub(1)).copied().unwrap_or_else(|| braking(trace))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moving(speed_mps: f64, ticks: usize, stands: std::ops::Range<usize>) -> OtherTrace {
        let mut along_m = vec![0.0];
        for tick in 1..ticks {
            along_m.push(along_m[tick - 1] + if stands.contains(&tick) { 0.0 } else { 0.1 * speed_mps });
        }
        OtherTrace { braking_mps: vec![0.0; ticks], along_m, has_left: false }
    }

    #[test]
    fn the_delay_is_the_time_for_which_another_was_held_up() {
        let free = moving(10.0, 300, 0..0);
        assert!((delay(&moving(10.0, 200, 50..80), &free, 0.1) - 3.0).abs() < 1e-9);
        assert_eq!(delay(&moving(11.0, 200, 0..0), &free, 0.1), 0.0, "it is earlier");
        // Both stand at the end, one of them 10 cm behind the other: that does not cost seconds.
        let (mut one, other) = (moving(10.0, 200, 50..200), moving(10.0, 200, 50..200));
        *one.along_m.last_mut().expect("ticks") -= 0.1;
        assert!(delay(&one, &other, 0.1) < 0.11);
    }

    fn trace(others: Vec<OtherTrace>) -> Trace {
        Trace { step_s: 0.1, others, ego: None, digest: String::new() }
    }

    #[test]
    fn waiting_costs_progress_pushing_costs_courtesy_and_a_failure_costs_everything() {
        let without = trace(vec![moving(10.0, 400, 0..0)]);
        let held = trace(vec![moving(10.0, 200, 50..100)]);
        let free = trace(vec![moving(10.0, 200, 0..0)]);
        let ego = EgoTrace { completed_s: Some(13.0), ticks: 200, ..EgoTrace::default() };
        assert!((StartScore::of_run(&ego, &free, &without, 10.0).score - 80.0).abs() < 1e-9);
        assert!((StartScore::of_run(&ego, &held, &without, 10.0).score - 40.0).abs() < 1e-6);
        let failed = EgoTrace { failure: Some("contact".to_owned()), ..ego.clone() };
        assert_eq!(StartScore::of_run(&failed, &free, &without, 10.0).score, 0.0);
        let rough = EgoTrace { uncomfortable_ticks: 100, ..ego };
        assert!((StartScore::of_run(&rough, &free, &without, 13.0).score - 90.0).abs() < 1e-9);
    }

    #[test]
    fn braking_counts_above_that_without_the_ego() {
        let mut with = moving(10.0, 100, 0..0);
        let mut without = moving(10.0, 200, 0..0);
        with.braking_mps = (0..100).map(|tick| 0.03 * f64::from(tick)).collect();
        without.braking_mps = (0..200).map(|tick| 0.01 * f64::from(tick)).collect();
        let [_, braking_mps] = caused(&trace(vec![with]), &trace(vec![without]));
        assert!((braking_mps - 0.02 * 99.0).abs() < 1e-9);
    }
}
