//! The field's baseline: the intelligent driver model along the road (Treiber, Hennecke and Helbing, 2000), MOBIL across it
//! ([`super::mobil`]).
//!
//! ```text
//! a = a_max (1 − (v/v₀)^δ − (s*/s)²),   s* = s₀ + max(0, v T + v Δv / (2 √(a_max b)))
//! ```
//!
//! `s` is the gap between bumpers to the vehicle ahead and `Δv` the speed at which it closes. Who is partly in a lane is in
//! it; a lane that ends is a standing vehicle at its end. The model knows one road: whoever crosses it is ignored.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::mobil::{self, Mobil, leader};
use super::steering::{admissible, roll_out, steer};
use crate::predict::Prediction;
use crate::{Input, Plan, PlanError, Scene};

/// The intelligent driver model with MOBIL; the defaults suit 1/10 scale cars.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Time gap to the vehicle ahead, `T` \[s\].
    #[schemars(range(min = 0.0))]
    pub headway_s: f64,
    /// Gap at standstill, `s₀` \[m\].
    #[schemars(range(min = 0.001))]
    pub gap_m: f64,
    /// Acceleration on a free road, `a_max` \[m/s²\].
    #[schemars(range(min = 0.001))]
    pub acceleration_mps2: f64,
    /// Comfortable braking, `b`, positive \[m/s²\].
    #[schemars(range(min = 0.001))]
    pub braking_mps2: f64,
    /// How sharply acceleration ends at the wanted speed, `δ`.
    #[schemars(range(min = 0.1))]
    pub exponent: f64,
    /// When to change lanes.
    pub mobil: Mobil,
    /// What the others are expected to do.
    pub prediction: Prediction,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            headway_s: 0.8,
            gap_m: 0.2,
            acceleration_mps2: 0.5,
            braking_mps2: 0.6,
            exponent: 4.0,
            mobil: Mobil::default(),
            prediction: Prediction::ConstantVelocity,
        }
    }
}

/// A vehicle ahead, or what is as good as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Leader {
    /// Gap between bumpers \[m\].
    pub gap_m: f64,
    /// Its speed \[m/s\].
    pub speed_mps: f64,
}

/// A gap that is closed counts as this \[m\].
const NO_GAP_M: f64 = 1e-3;

impl Settings {
    /// The model's acceleration \[m/s²\].
    pub(super) fn acceleration(&self, speed_mps: f64, wanted_mps: f64, leader: Option<Leader>) -> f64 {
        let free = libm::pow(speed_mps.max(0.0) / wanted_mps.max(NO_GAP_M), self.exponent);
        let close = leader.map_or(0.0, |leader| {
            let closing = speed_mps * (speed_mps - leader.speed_mps);
            let dynamic =
                speed_mps * self.headway_s + closing / (2.0 * (self.acceleration_mps2 * self.braking_mps2).sqrt());
            let wanted_gap = self.gap_m + dynamic.max(0.0);
            let share = wanted_gap / leader.gap_m.max(NO_GAP_M);
            share * share
        });
        self.acceleration_mps2 * (1.0 - free - close)
    }
}

/// A driver after the model.
#[derive(Clone, Debug)]
pub struct Idm {
    settings: Settings,
    /// The lane it drives in or changes to.
    lane: Option<usize>,
}

impl Idm {
    /// A driver who has not chosen a lane yet.
    pub fn new(settings: Settings) -> Self {
        Idm { settings, lane: None }
    }

    /// Chooses a lane and plans the next moves.
    ///
    /// # Errors
    /// Never; the signature is that of all planners.
    pub fn plan(&mut self, scene: &Scene) -> Result<Plan, PlanError> {
        let scene = &scene.expecting(self.settings.prediction);
        let lanes = self.settings.mobil.lanes(scene);
        let now = self.lane.unwrap_or_else(|| lanes.at(scene.ego.corridor.across(scene.ego.state.position())));
        let choice = mobil::choose(scene, &self.settings, now);
        self.lane = Some(choice.lane);
        let (own, wanted) = (&scene.ego, scene.goal.target.speed_mps);
        let lateral = lanes.centre_m(choice.lane);
        let trajectory = roll_out(scene, |t, state| {
            // In the lane that it leaves it minds the vehicle ahead until it is out of it.
            let ahead = nearest([now, choice.lane].map(|lane| leader(scene, &lanes, lane, state, t)));
            let acceleration = self.settings.acceleration(state.speed_mps, wanted, ahead);
            Input {
                acceleration_mps2: admissible(own, state, acceleration, scene.step_s),
                steering_rad: steer(own, state, lateral),
            }
        });
        let ahead = leader(scene, &lanes, choice.lane, &own.state, 0);
        let mut diagnostics = vec![("lane", choice.lane as f64), ("incentive", choice.incentive_mps2)];
        diagnostics.extend(ahead.map(|leader| ("gap", leader.gap_m)));
        let events = (choice.lane != now).then(|| format!("changes to lane {}", choice.lane)).into_iter().collect();
        Ok(Plan { trajectory, diagnostics, events, ..Plan::default() })
    }
}

fn nearest(leaders: [Option<Leader>; 2]) -> Option<Leader> {
    leaders.into_iter().flatten().min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, scene};

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

    fn in_lanes(mut ego: crate::Agent, others: Vec<crate::Agent>, lane_m: f64, wanted_mps: f64) -> Scene {
        (ego.corridor.right_m, ego.corridor.left_m) = (0.0, 0.74);
        let mut scene = scene(ego, others);
        (scene.goal.target.y_m, scene.goal.target.speed_mps) = (lane_m, wanted_mps);
        scene
    }

    #[test]
    fn a_slow_leader_is_followed_and_a_standing_one_is_not_hit() {
        let leader = agent(1.2, 0.185, 0.0, 0.0);
        let mut scene = in_lanes(agent(0.0, 0.185, 0.0, 0.8), vec![leader], 0.185, 1.0);
        scene.horizon = 100;
        let plan = Idm::new(Settings::default()).plan(&scene).expect("a plan");
        let end = plan.trajectory.states.last().expect("states");
        assert!(end.x_m + 0.4 < 1.2 && end.speed_mps < 0.05, "{end:?}");
    }

    #[test]
    fn the_goal_s_lane_is_taken_when_its_follower_is_far_and_not_when_it_is_near() {
        for (behind_m, lane) in [(-3.0, 1.0), (-0.7, 0.0)] {
            let follower = agent(behind_m, 0.555, 0.0, 1.2);
            let scene = in_lanes(agent(0.0, 0.185, 0.0, 1.0), vec![follower], 0.555, 1.0);
            let plan = Idm::new(Settings::default()).plan(&scene).expect("a plan");
            assert_eq!(plan.diagnostics[0], ("lane", lane), "follower at {behind_m}");
        }
    }

    #[test]
    fn a_slow_leader_is_overtaken_by_one_who_does_not_insist_on_its_lane() {
        let leader = agent(0.9, 0.185, 0.0, 0.3);
        let scene = in_lanes(agent(0.0, 0.185, 0.0, 1.0), vec![leader], 0.185, 1.2);
        let lane = |bias_mps2: f64| {
            let mobil = Mobil { bias_mps2, ..Mobil::default() };
            Idm::new(Settings { mobil, ..Settings::default() }).plan(&scene).expect("a plan").diagnostics[0].1
        };
        assert_eq!((lane(0.0), lane(100.0)), (1.0, 0.0));
    }

    #[test]
    fn a_lane_that_ends_is_left_or_stopped_in() {
        let mut ego = agent(0.0, 0.185, 0.0, 1.0);
        ego.corridor.end = Some(crate::LaneEnd { end_m: 3.5, height_m: 0.37, taper_m: 0.3 });
        // Somebody stays beside it, so that it cannot leave.
        let mut scene = in_lanes(ego, vec![agent(0.0, 0.555, 0.0, 1.0)], 0.555, 1.0);
        scene.horizon = 100;
        let plan = Idm::new(Settings::default()).plan(&scene).expect("a plan");
        let end = plan.trajectory.states.last().expect("states");
        assert!(end.x_m + 0.21 < 2.6 && end.speed_mps < 0.05, "{end:?}");
    }
}
