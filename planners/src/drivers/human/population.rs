//! The drivers of `style = "measured"`: a population whose time gaps are those of recorded people.
//!
//! - **Time gap.** The steady gap beyond 3.5 m is a multiple of 1.15 s, spread log-normally over drivers. The median is that of recorded
//!   cars; the deviation of the logarithm is smaller than theirs, 0.65, part of which is that a car is seen for some seconds only
//!   (`docs/evidence/how-human.md`).
//! - **Safety weight.** Recordings do not tell it: it changes predictions by less than 1 %. It is drawn log-uniformly from 0.5 to 30.
//! - **Flow.** Each driver adapts to the vehicles ahead as people do on average.

use interplay_common::random::Random;

use super::{Settings, Style};

/// Median over cars of the time gap, as a multiple of the usual one.
const GAP_MEDIAN: f64 = 1.0;
/// Standard deviation of its logarithm.
const GAP_DEVIATION: f64 = 0.45;
/// Bounds of the ratio: no driver of the population is a danger or an obstacle.
const GAP_BOUNDS: [f64; 2] = [0.45, 2.5];
/// Least and greatest safety weight.
const SAFETY_WEIGHTS: [f64; 2] = [0.5, 30.0];
/// By which shares people adapt to the vehicles ahead and to their lane.
const ADAPTS: [f64; 2] = [0.27, 0.1];
/// The stream of the population among those of its seed.
const STREAM: u64 = 0x4d45_4153;

impl Settings {
    /// The settings with which the driver drives: where the style is `measured`, those of its member of the population.
    pub(super) fn driven(&self) -> Settings {
        if self.style == Some(Style::Measured) { member(self, self.member.unwrap_or(0)) } else { *self }
    }
}

/// What a driver of the population is like who says nothing else.
fn member(settings: &Settings, number: u32) -> Settings {
    let mut random = Random::new(u64::from(number), STREAM);
    let ratio = GAP_MEDIAN * libm::exp(random.normal(0.0, GAP_DEVIATION));
    let [low, high] = SAFETY_WEIGHTS.map(libm::log);
    let weight = libm::exp(random.uniform(low, high));
    let or = |stated: f64, usual: f64| if stated > 0.0 { stated } else { usual };
    Settings {
        safety_weight: Some(weight),
        time_gap_ratio: settings.time_gap_ratio.or(Some(ratio.clamp(GAP_BOUNDS[0], GAP_BOUNDS[1]))),
        adapts_to_leaders: or(settings.adapts_to_leaders, ADAPTS[0]),
        adapts_to_lane: or(settings.adapts_to_lane, ADAPTS[1]),
        ..*settings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_are_spread_like_people_and_are_the_same_again() {
        let measured = Settings { style: Some(Style::Measured), ..Settings::default() };
        let mut ratios: Vec<f64> = (0..2000).filter_map(|number| member(&measured, number).time_gap_ratio).collect();
        ratios.sort_by(f64::total_cmp);
        assert!((ratios[1000] - GAP_MEDIAN).abs() < 0.05, "median {}", ratios[1000]);
        assert!(ratios[100] < 0.55 && ratios[1900] > 1.8, "{} to {}", ratios[100], ratios[1900]);
        assert_eq!(member(&measured, 7), member(&measured, 7));
        assert!(member(&measured, 7) != member(&measured, 8));
    }

    #[test]
    fn what_is_stated_stays() {
        let stated = Settings { time_gap_ratio: Some(1.5), adapts_to_leaders: 0.5, ..Settings::default() };
        let drawn = member(&stated, 3);
        assert_eq!((drawn.time_gap_ratio, drawn.adapts_to_leaders), (Some(1.5), 0.5));
    }
}
