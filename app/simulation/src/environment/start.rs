//! The random draw of each episode's start.

use interplay_common::random::{Random, SplitMix64};
use interplay_planners::drivers::human::Style;
use interplay_planners::{Body, Driver};
use interplay_scenarios::{Scenario, StartJitter};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::physics::gap_m;

/// How an episode begins; the rest follows from the decisions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EpisodeStart {
    /// Drawn from this seed.
    Drawn(u64),
    /// The scenario as written, with this seed of its random numbers.
    AsWritten(u64),
}

/// Random stream of the styles.
const STYLES: u64 = 0x5374_796C;
/// Distinguishes the seeds of repeated draws, where two vehicles touch, from the first.
const STARTS: u64 = 0x5374_6172;
/// Maximum number of draws until no two vehicles touch; after these, the scenario's own starts are used.
const MOST_DRAWS: usize = 100;

/// Maximum shift of a start, in lengths of a body,
const SHIFT_LENGTHS: f64 = 0.25;
/// and maximum change of a speed, as a share of the ego's initial speed.
const SPEED_SHARE: f64 = 0.1;

/// The random draw of each episode from its seed: starts, and styles of the other drivers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StartDraw {
    /// Whether anything is drawn. Otherwise every episode is the scenario as written, except for the seed of its random numbers.
    pub is_drawn: bool,
    /// Largest shift of each vehicle along its heading \[m\]; without it a quarter of the ego's length.
    pub position_m: Option<f64>,
    /// Largest change of each speed \[m/s\]; without it a tenth of the speed with which the ego starts.
    pub speed_mps: Option<f64>,
    /// The safety weights from which each human driver's is drawn; by default those of the styles, from nice (50) to tough (0). With an
    /// empty list each driver keeps its own.
    pub safety_weights: Option<Vec<f64>>,
}

impl Default for StartDraw {
    fn default() -> Self {
        StartDraw { is_drawn: true, position_m: None, speed_mps: None, safety_weights: None }
    }
}

impl StartDraw {
    /// The scenario of the episode with a seed, whose agents are driven from outside.
    pub(super) fn drawn(&self, scenario: &Scenario, seed: u64) -> Scenario {
        let mut drawn = Scenario { seed, ..scenario.clone() };
        if !self.is_drawn {
            return drawn;
        }
        self.draw_styles(&mut drawn, &mut Random::new(seed, STYLES));
        let Some(ego) = scenario.ego() else { return drawn };
        drawn.start_jitter = StartJitter {
            position_m: self.position_m.unwrap_or(SHIFT_LENGTHS * length_m(&ego.body)),
            speed_mps: self.speed_mps.unwrap_or(SPEED_SHARE * ego.start.speed_mps),
        };
        let mut seeds = SplitMix64::new(seed ^ STARTS);
        for _ in 0..MOST_DRAWS {
            if !touch(&drawn) {
                return drawn;
            }
            drawn.seed = seeds.next_u64();
        }
        Scenario { start_jitter: scenario.start_jitter, seed, ..drawn }
    }

    fn draw_styles(&self, drawn: &mut Scenario, random: &mut Random) {
        let styles: Vec<f64> = Style::ALL.into_iter().map(Style::safety_weight).collect();
        let weights = self.safety_weights.as_ref().unwrap_or(&styles);
        for vehicle in &mut drawn.vehicles {
            let Driver::Human(human) = &mut vehicle.driver else { continue };
            let place = random.uniform(0.0, weights.len() as f64) as usize;
            if let Some(weight) = weights.get(place) {
                (human.style, human.safety_weight) = (None, Some(*weight));
            }
        }
    }
}

fn length_m(body: &Body) -> f64 {
    body.front_m + body.rear_m
}

/// Whether any two vehicles touch at their starts.
fn touch(scenario: &Scenario) -> bool {
    let starts = scenario.starts();
    let all: Vec<_> = scenario.vehicles.iter().map(|vehicle| &vehicle.body).zip(&starts).collect();
    let pairs = |from: usize| all[from + 1..].iter().any(|other| gap_m(all[from], *other) <= 0.0);
    (0..all.len()).any(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same seed draws the same start, another seed another one, and no vehicle starts inside another.
    #[test]
    fn the_random_start_is_a_function_of_the_seed() {
        let scenario = interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored");
        let draw = StartDraw { position_m: Some(1.0), ..StartDraw::default() };
        let drawn = |seed| draw.drawn(&scenario, seed);
        for seed in 0..50 {
            assert!(!touch(&drawn(seed)), "{seed}");
            assert_eq!(drawn(seed), drawn(seed));
        }
        assert_ne!(drawn(1).starts(), drawn(2).starts());
    }

    #[test]
    fn only_the_listed_safety_weights_are_drawn() {
        let scenario = interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored");
        let draw = StartDraw { safety_weights: Some(vec![1.0, 4.0]), ..StartDraw::default() };
        let mut seen = Vec::new();
        for seed in 0..50 {
            for vehicle in draw.drawn(&scenario, seed).vehicles {
                if let Driver::Human(human) = vehicle.driver {
                    seen.extend(human.safety_weight);
                }
            }
        }
        assert!(seen.iter().all(|weight| [1.0, 4.0].contains(weight)));
        assert!(seen.contains(&1.0) && seen.contains(&4.0));
    }
}
