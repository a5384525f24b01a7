//! The field's baseline of a human driver: the intelligent driver model along the road (`car_following`), and MOBIL for lane
//! changes (`mobil`).
//!
//! On a network it keeps to the right of way (module `right_of_way`): a line at which it must wait counts as a standing
//! vehicle. On straight roads that cross it ignores whoever crosses.

mod car_following;
pub mod diagnostics;
mod lanes;
mod mobil;
mod settings;

pub use settings::{Mobil, Settings};

use std::borrow::Cow;

use crate::belief::Outlook;
use crate::drive::{Drive, DriverKind, settings_of};
use crate::obstacle::{ObstacleMemory, swing_m};
use crate::relation::Relation;
use crate::right_of_way::ArrivalMemory;
use crate::steering::{admissible, roll_out, steer, steer_over_step};
use crate::{Input, Plan, PlanError, PlanEvent, Scene};
use car_following::Leader;
use diagnostics::{GAP, INCENTIVE, LANE};
use lanes::{Lanes, leader};

/// A driver that follows the intelligent driver model (IDM) and changes lanes by MOBIL.
#[derive(Clone, Debug)]
pub struct Idm {
    settings: Settings,
    /// Lateral position on its route of the centre of the lane it drives in or changes to \[m\]. On a network, lanes beside the
    /// route come and go, and with them the number of a lane.
    lane_centre_m: Option<f64>,
    arrivals: ArrivalMemory,
    obstacles: ObstacleMemory,
}

impl Idm {
    /// A driver who has not chosen a lane yet.
    pub fn new(settings: Settings) -> Self {
        Idm { settings, lane_centre_m: None, arrivals: ArrivalMemory::default(), obstacles: ObstacleMemory::default() }
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "idm"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Idm::new(*self))
    }

    fn explanation(&self) -> &'static crate::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::predict::Prediction> {
        Some(self.prediction)
    }

    fn goes_first(&self) -> bool {
        true
    }

    fn can_be_asked(&self) -> bool {
        false
    }
}

impl Drive for Idm {
    /// Chooses a lane and makes a plan along it.
    ///
    /// # Errors
    /// Never.
    fn plan(&mut self, scene: &Scene, _: &Outlook) -> Result<Plan, PlanError> {
        let mut seen = Cow::Borrowed(scene);
        let passed = if scene.ego.rules.are_kept {
            let manoeuvre = self.obstacles.judge(scene);
            manoeuvre.and_then(|manoeuvre| manoeuvre.passed_or_waited_for(&mut seen))
        } else {
            if let Some(line_m) = self.arrivals.stop_line_m(scene) {
                seen.to_mut().ego.rules.stop_before(line_m);
            }
            None
        };
        let line_m = seen.ego.rules.stop_line_m;
        let scene = &mut along_the_road(self.settings.prediction.applied_to(scene).into_owned());
        scene.others.retain(|other| passed.as_ref().is_none_or(|obstacle| obstacle.name != other.name));
        let (scene, swing_m) = (&*scene, swing_m(scene));
        let lanes = Lanes::of_road(scene, &self.settings.mobil);
        let nearest_lane = lanes.at(scene.ego.route.across(scene.ego.state.position()));
        let is_near = |lane: &usize| !scene.ego.route.is_in_network() || lane.abs_diff(nearest_lane) <= 1;
        let now = self.lane_centre_m.map(|centre_m| lanes.at(centre_m)).filter(is_near).unwrap_or(nearest_lane);
        let choice = mobil::choose(scene, &self.settings, now);
        let (own, wanted) = (&scene.ego, scene.goal.target.speed_mps);
        let lateral = lanes.centre_m(choice.lane);
        self.lane_centre_m = Some(lateral);
        let mut before = own.previous_input;
        let trajectory = roll_out(scene, |t, state| {
            // In the lane that it leaves it minds the vehicle ahead until it is out of it.
            let [left, taken] = [now, choice.lane].map(|lane| leader(scene, &lanes, lane, state, t));
            // Straight roads have neither lines nor speed limits.
            let along_m = own.route.straight().is_none().then(|| own.route.along(state.position()));
            let front_m = along_m.map(|along_m| along_m + own.body.front_m);
            let lateral_m = passed
                .as_ref()
                .zip(front_m)
                .map_or(lateral, |(obstacle, front_m)| obstacle.lateral_m(front_m, lateral, swing_m));
            let line = line_m
                .zip(along_m)
                .map(|(line_m, along_m)| Leader { gap_m: line_m - along_m - own.body.front_m, speed_mps: 0.0 });
            let permitted_mps = along_m.and_then(|along_m| own.permitted_speed_mps(along_m));
            let wanted_mps = permitted_mps.map_or(wanted, |permitted_mps| permitted_mps.min(wanted));
            let acceleration = self.settings.acceleration(state.speed_mps, wanted_mps, nearest([left, taken, line]));
            // On a free road the model brakes too weakly for a limit ahead.
            let highest_mps2 =
                along_m.and_then(|along_m| own.permitted_acceleration_mps2(along_m, state.speed_mps, scene.step_s));
            let acceleration = highest_mps2.map_or(acceleration, |highest_mps2| acceleration.min(highest_mps2));
            let steering_rad = match along_m {
                None => steer(own, state, lateral_m),
                Some(_) => steer_over_step(own, state, lateral_m, scene.step_s),
            };
            let wanted = Input { acceleration_mps2: acceleration, steering_rad };
            let Input { acceleration_mps2, steering_rad } = own.comfortably(&before, wanted, scene.step_s);
            before = Input { acceleration_mps2: admissible(own, state, acceleration_mps2, scene.step_s), steering_rad };
            before
        });
        let ahead = leader(scene, &lanes, choice.lane, &own.state, 0);
        let mut diagnostics = vec![LANE.is(choice.lane as f64), INCENTIVE.is(choice.incentive_mps2)];
        diagnostics.extend(ahead.map(|leader| GAP.is(leader.gap_m)));
        let events = (choice.lane != now)
            .then(|| PlanEvent::note(format!("changes to lane {}", choice.lane)))
            .into_iter()
            .collect();
        Ok(Plan { trajectory, diagnostics, events, ..Plan::default() })
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = *settings_of::<Settings>(settings)?;
        Some(Box::new(Idm { settings, ..self.clone() }))
    }
}

/// The scene with those others only that are on the same road.
fn along_the_road(mut scene: Scene) -> Scene {
    let Scene { ego, others, .. } = &mut scene;
    others.retain(|other| ego.relation(other) == Relation::Alongside);
    scene
}

fn nearest(leaders: [Option<Leader>; 3]) -> Option<Leader> {
    leaders.into_iter().flatten().min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Corridor;
    use crate::fixture::{agent, scene};

    fn in_lanes(mut ego: crate::Agent, others: Vec<crate::Agent>, lane_m: f64, wanted_mps: f64) -> Scene {
        ego.route = Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end: None }.into();
        let mut scene = scene(ego, others);
        (scene.goal.target.y_m, scene.goal.target.speed_mps) = (lane_m, wanted_mps);
        scene
    }

    #[test]
    fn a_slow_leader_is_followed_and_a_standing_one_is_not_hit() {
        let leader = agent(1.2, 0.185, 0.0, 0.0);
        let mut scene = in_lanes(agent(0.0, 0.185, 0.0, 0.8), vec![leader], 0.185, 1.0);
        scene.horizon = 100;
        let plan = Idm::new(Settings::default()).plan(&scene, &Outlook::default()).expect("a plan");
        let end = plan.trajectory.states.last().expect("states");
        assert!(end.x_m + 0.4 < 1.2 && end.speed_mps < 0.05, "{end:?}");
    }

    #[test]
    fn the_goal_s_lane_is_taken_when_its_follower_is_far_and_not_when_it_is_near() {
        for (behind_m, lane) in [(-3.0, 1.0), (-0.7, 0.0)] {
            let follower = agent(behind_m, 0.555, 0.0, 1.2);
            let scene = in_lanes(agent(0.0, 0.185, 0.0, 1.0), vec![follower], 0.555, 1.0);
            let plan = Idm::new(Settings::default()).plan(&scene, &Outlook::default()).expect("a plan");
            assert_eq!(plan.value_of(&LANE), Some(lane), "follower at {behind_m}");
        }
    }

    #[test]
    fn a_slow_leader_is_overtaken_by_one_who_does_not_insist_on_its_lane() {
        let leader = agent(0.9, 0.185, 0.0, 0.3);
        let scene = in_lanes(agent(0.0, 0.185, 0.0, 1.0), vec![leader], 0.185, 1.2);
        let lane = |bias_mps2: f64| {
            let mobil = Mobil { bias_mps2, ..Mobil::default() };
            Idm::new(Settings { mobil, ..Settings::default() })
                .plan(&scene, &Outlook::default())
                .expect("a plan")
                .value_of(&LANE)
        };
        assert_eq!((lane(0.0), lane(100.0)), (Some(1.0), Some(0.0)));
    }

    #[test]
    fn a_lane_that_ends_is_left_or_stopped_in() {
        // Somebody stays beside it, so that it cannot leave.
        let beside = agent(0.0, 0.555, 0.0, 1.0);
        let mut scene = in_lanes(agent(0.0, 0.185, 0.0, 1.0), vec![beside], 0.555, 1.0);
        let end = Some(crate::LaneEnd { end_m: 3.5, height_m: 0.37, taper_m: 0.3 });
        scene.ego.route = Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end }.into();
        scene.horizon = 100;
        let plan = Idm::new(Settings::default()).plan(&scene, &Outlook::default()).expect("a plan");
        let end = plan.trajectory.states.last().expect("states");
        assert!(end.x_m + 0.21 < 2.6 && end.speed_mps < 0.05, "{end:?}");
    }
}
