//! The human driver model as a prediction: one of its plans, made on the straightened lane.
//!
//! The plan is made by [`human`](crate::drivers::human) itself, with all its terms, for a real car among real cars. The lane and its
//! neighbours are straight in the frame of the prediction. Of the vehicles ahead and beside it expects what their motion shows
//! (`SeenMotion`), or that they keep their speed. A driver in traffic is assumed to want about its present speed, because the speed that it
//! would choose on a free road cannot be observed.

use std::sync::Arc;

use super::car_following::CarFollowing;
use super::{LateralMotion, NearbyVehicle, PredictedMotion, STEP_S, STEPS, TrafficMoment, trusted_mps2};
use crate::drivers::SeenMotion;
use crate::drivers::human::{self, Human};
use crate::prediction::constant_velocity;
use crate::rules::RoadRules;
use crate::scene::Knowledge;
use crate::scene::inferred_futures::InferredFutures;
use crate::{Agent, Body, ComfortLimits, Corridor, Drive, Goal, Input, Limits, Route, SafetyEllipse, Scene, State};

/// Stages of the plan: 8 s, as people have on real roads.
const HORIZON: usize = 40;
/// A body is at least this far from the edge of the road \[m\].
const EDGE_M: f64 = 0.2;
/// Others farther away than this along the lane are not looked at, ahead and behind \[m\].
const SIGHT_M: [f64; 2] = [150.0, 40.0];
/// Largest number of vehicles in the lane ahead that are considered.
const MAX_LEADERS: usize = 4;
/// Those beside the lane are looked at up to this far across \[m\].
const BESIDE_M: f64 = 5.5;
/// Where the axles are, as a share of the length from the middle.
const AXLE_SHARE: f64 = 0.3;
/// Half axes of the safety ellipse of a car: along the road and across it \[m\].
const SAFETY_M: [f64; 2] = [12.0, 3.3];
/// Weights of a real car on the place along and across the lane, its heading and its speed.
const TRACKING: [f64; 4] = [0.0, 0.01, 0.5, 0.1];
/// The gap at standstill \[m\], and the shortest time gap beyond it that a driver is taken to keep \[s\]: of recorded people 5 % keep a
/// shorter one.
const STANDSTILL_M: f64 = 3.5;
const LEAST_GAP_S: f64 = 0.6;
/// Weight of changes of the steering angle.
const STEERING_CHANGE: f64 = 0.1;

/// The human driver model of Interplay, as a prediction of a vehicle in traffic.
#[derive(Clone, Debug, PartialEq)]
pub struct PredictedDriver {
    /// The driver.
    pub settings: human::Settings,
    /// Weight of changes of the acceleration \[s⁴/m²\].
    pub acceleration_change: f64,
    /// Time gap that the driver keeps, before its style makes it longer or shorter \[s\].
    pub time_gap_s: f64,
    /// Which share of the acceleration at the start is taken for the driver's last input.
    pub own_acceleration: f64,
    /// Noise of the record with which half of that acceleration is trusted \[m/s\].
    pub half_noise_mps: f64,
    /// Who accelerates wants to be faster: the wanted speed is what it will have after this time \[s\].
    pub wants_ahead_s: f64,
    /// The speed that the driver wants, where it is known; without it about the present one \[m/s\].
    pub wanted_mps: Option<f64>,
    /// Whether those beside the lane are looked at, too.
    pub looks_beside: bool,
    /// Whether the driver expects of the others what their motion shows, as people do; otherwise that they keep their speed.
    pub sees_motion: bool,
    /// By which share a shorter gap that the driver keeps now takes the place of `time_gap_s`; never below 0.6 s.
    pub keeps_gap: f64,
    /// A driver who changes lanes drives by the vehicles that are ahead where it will be after this time \[s\].
    pub drifts_s: f64,
    /// How the lateral place goes on; as planned, towards the middle of the lane, without one.
    pub lateral: Option<LateralMotion>,
}

impl PredictedDriver {
    /// The driver of a real car with the usual settings of scenarios.
    pub fn usual() -> PredictedDriver {
        PredictedDriver {
            settings: human::Settings { style: Some(human::Style::Normal), ..human::Settings::default() },
            acceleration_change: 0.1,
            time_gap_s: ComfortLimits::default().time_gap_s,
            own_acceleration: 1.0,
            half_noise_mps: 1.0,
            wants_ahead_s: 0.0,
            wanted_mps: None,
            looks_beside: true,
            sees_motion: true,
            keeps_gap: 0.0,
            drifts_s: 0.0,
            lateral: None,
        }
    }

    /// Where the driver plans to be. If it finds no plan, its speed is kept.
    pub(super) fn predict(&self, moment: &TrafficMoment) -> PredictedMotion {
        let is_changing = self.drifts_s > 0.0 && moment.moves_sideways();
        let drift_m = if is_changing { self.drifts_s * moment.lateral_speed_mps } else { 0.0 };
        let mut scene = if is_changing {
            self.scene(&TrafficMoment { across_m: moment.across_m + drift_m, ..moment.clone() })
        } else {
            self.scene(moment)
        };
        scene.ego.urgency = scene.urgency();
        let Ok(plan) = Human::new(self.settings).plan(&scene, &InferredFutures::default()) else {
            let lateral = self.lateral.unwrap_or_default();
            return predict(moment, None, lateral);
        };
        let states = &plan.trajectory.states[..=STEPS];
        let across_m = match self.lateral {
            Some(lateral) => lateral.places_m(moment),
            None => states.iter().map(|state| state.y_m).collect(),
        };
        PredictedMotion { along_m: travelled_m(states), across_m }
    }

    /// Where any driver expects the vehicle who sees it behind the vehicle ahead.
    pub(super) fn predict_seen(&self, moment: &TrafficMoment) -> PredictedMotion {
        let driver = PredictedDriver { lateral: None, looks_beside: false, ..self.clone() };
        let Scene { ego, others, .. } = driver.scene(moment);
        let motion = SeenMotion { vehicle: &ego, leader: ego.leader_among(&others) }.expected(STEPS, STEP_S);
        let across_m = motion.states.iter().map(|state| state.y_m).collect();
        PredictedMotion { along_m: travelled_m(&motion.states), across_m }
    }

    /// The moment as the driver sees it.
    fn scene(&self, moment: &TrafficMoment) -> Scene {
        // If the vehicle starts beside the road, the road is widened to include it.
        let reach_m = [-1.0, 1.0].map(|side| side * moment.across_m + 0.5 * moment.width_m + EDGE_M);
        let [right_m, left_m] = [0, 1].map(|side| moment.road_m[side].max(reach_m[side]));
        let corridor = Corridor { heading_rad: 0.0, right_m: -right_m, left_m, end: None };
        let route: Arc<Route> = Arc::new(Route::from(corridor));
        // A driver who keeps its line has no heading to correct.
        let lateral_mps = if self.lateral.is_some() { 0.0 } else { moment.lateral_speed_mps };
        let heading_rad = if moment.speed_mps > 1.0 { libm::atan(lateral_mps / moment.speed_mps) } else { 0.0 };
        let state = State { x_m: 0.0, y_m: moment.across_m, heading_rad, speed_mps: moment.speed_mps };
        let own_mps2 = moment.trusted_acceleration_mps2(self.half_noise_mps);
        let acceleration_mps2 = self.own_acceleration * own_mps2;
        let about_mps = (moment.speed_mps + self.wants_ahead_s * own_mps2).max(0.0);
        let wanted_mps = self.wanted_mps.unwrap_or(about_mps);
        let mut ego = self.agent("ego", state, [moment.length_m, moment.width_m], acceleration_mps2, &route);
        if let Some(comfort) = &mut ego.limits.comfort {
            comfort.time_gap_s = self.own_gap_s(moment);
        }
        let seen = self.seen(moment);
        let others = seen.iter().enumerate().map(|(index, it)| {
            let state = State { x_m: it.ahead_m, y_m: it.across_m, heading_rad: 0.0, speed_mps: it.speed_mps };
            let shown_mps2 = trusted_mps2(it.acceleration_mps2, it.speed_noise_mps, self.half_noise_mps);
            let acceleration_mps2 = if self.sees_motion { shown_mps2 } else { 0.0 };
            self.agent(&index.to_string(), state, [it.length_m, it.width_m], acceleration_mps2, &route)
        });
        let mut others: Vec<Agent> = others.collect();
        let knowledge = if self.sees_motion { Knowledge::Motion { late_steps: 0 } } else { Knowledge::Plans };
        if self.sees_motion {
            // The farthest first: each is expected to stay behind the one ahead of it.
            for index in (0..others.len()).rev() {
                let expected = {
                    let vehicle = &others[index];
                    SeenMotion { vehicle, leader: vehicle.leader_among(&others[index + 1..]) }.expected(HORIZON, STEP_S)
                };
                others[index].prediction = expected.into();
            }
        }
        let wanted_m = if self.lateral.is_some() { moment.across_m } else { 0.0 };
        let goal = Goal {
            target: State { x_m: 0.0, y_m: wanted_m, heading_rad: 0.0, speed_mps: wanted_mps },
            tracking: TRACKING,
            comfort: [self.acceleration_change, STEERING_CHANGE],
            safety: SafetyEllipse { along_m: SAFETY_M[0], across_m: SAFETY_M[1] },
        };
        Scene { tick: 0, step_s: STEP_S, horizon: HORIZON, knowledge, ego, goal, others }
    }

    /// The time gap that the driver keeps \[s\].
    fn own_gap_s(&self, moment: &TrafficMoment) -> f64 {
        let leader = moment.leaders().first().copied().filter(|_| self.keeps_gap > 0.0);
        leader.map_or(self.time_gap_s, |leader| {
            let now_s = (moment.gap_m(&leader) - STANDSTILL_M) / moment.speed_mps.max(1.0);
            let kept_s = now_s.clamp(LEAST_GAP_S.min(self.time_gap_s), self.time_gap_s);
            self.time_gap_s + self.keeps_gap * (kept_s - self.time_gap_s)
        })
    }

    /// Whom the driver looks at: the nearest ahead in its lane, and those beside it.
    fn seen(&self, moment: &TrafficMoment) -> Vec<NearbyVehicle> {
        let mut seen = moment.leaders();
        seen.truncate(MAX_LEADERS);
        let is_beside = |it: &&NearbyVehicle| {
            let across_m = (it.across_m - moment.across_m).abs();
            across_m < BESIDE_M && !moment.is_in_way(it) && (-SIGHT_M[1]..SIGHT_M[0] / 2.0).contains(&it.ahead_m)
        };
        if self.looks_beside {
            seen.extend(moment.others.iter().filter(is_beside));
        }
        seen.retain(|it| it.ahead_m <= SIGHT_M[0]);
        seen
    }

    fn agent(
        &self,
        name: &str,
        state: State,
        [length_m, width_m]: [f64; 2],
        acceleration_mps2: f64,
        route: &Arc<Route>,
    ) -> Agent {
        let [half_m, axle_m] = [0.5 * length_m, AXLE_SHARE * length_m];
        let body = Body {
            front_m: half_m,
            rear_m: half_m,
            width_m,
            front_axle_m: axle_m,
            rear_axle_m: axle_m,
            scale: Body::REAL_SCALE,
        };
        let limits = Limits {
            acceleration_min_mps2: -6.4,
            acceleration_max_mps2: 3.0,
            steering_max_rad: 0.55,
            speed_min_mps: 0.0,
            speed_max_mps: 50.0,
            lateral_acceleration_max_mps2: Some(7.0),
            steering_rate_max_radps: None,
            comfort: Some(ComfortLimits { time_gap_s: self.time_gap_s, ..ComfortLimits::default() }),
        };
        let acceleration_mps2 = acceleration_mps2.clamp(limits.acceleration_min_mps2, limits.acceleration_max_mps2);
        Agent {
            name: name.to_owned(),
            prediction: constant_velocity(&state, HORIZON, STEP_S).into(),
            state,
            previous_input: Input { acceleration_mps2, steering_rad: 0.0 },
            body,
            limits,
            route: Arc::clone(route),
            shared_goal: None,
            can_be_asked: true,
            is_obstacle: false,
            indicator: None,
            rules: RoadRules::default(),
            urgency: 1.0,
            own_place: Default::default(),
        }
    }
}

/// How far a planned motion leads \[m\]. The plan's model moves a vehicle by its speed at the begin of each step; with steps of 0.2 s that
/// is 0.3 m too far after 3 s of braking at 1 m/s², so speeds are summed up here.
fn travelled_m(states: &[State]) -> Vec<f64> {
    let mut at_m = 0.0;
    let further = states.windows(2).map(|pair| {
        at_m += 0.5 * STEP_S * (pair[0].speed_mps + pair[1].speed_mps);
        at_m
    });
    [0.0].into_iter().chain(further).collect()
}

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

/// A model that predicts the motion of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionModel {
    /// Speed and lateral place are kept.
    ConstantVelocity,
    /// The acceleration decays within about `time_s`.
    DecayingAcceleration {
        /// The time within which the acceleration falls to 37 % \[s\].
        time_s: f64,
        /// Noise of the record with which half of the acceleration is trusted \[m/s\].
        half_noise_mps: f64,
        /// How the lateral place goes on.
        lateral: LateralMotion,
    },
    /// The intelligent driver model.
    CarFollowing(CarFollowing),
    /// Our human driver.
    Driver(PredictedDriver),
    /// What is expected of a population of drivers: the mean of their motions.
    Population(Vec<PredictedDriver>),
    /// The motion that drivers expect who know no plans ([`SeenMotion`](crate::drivers::SeenMotion)).
    Seen {
        /// Noise of the record with which half of an acceleration is trusted \[m/s\].
        half_noise_mps: f64,
    },
}

/// The mean of the motions of some drivers.
fn mean(drivers: &[PredictedDriver], moment: &TrafficMoment) -> PredictedMotion {
    let motions: Vec<PredictedMotion> = drivers.iter().map(|driver| driver.predict(moment)).collect();
    let mean = |part: fn(&PredictedMotion) -> &Vec<f64>| {
        let at = |step: usize| motions.iter().map(|it| part(it)[step]).sum::<f64>() / motions.len().max(1) as f64;
        (0..=STEPS).map(at).collect()
    };
    PredictedMotion { along_m: mean(|it| &it.along_m), across_m: mean(|it| &it.across_m) }
}

impl MotionModel {
    /// Predicts the motion of the vehicle.
    pub fn predict(&self, moment: &TrafficMoment) -> PredictedMotion {
        match self {
            MotionModel::ConstantVelocity => predict(moment, None, LateralMotion::Kept),
            MotionModel::DecayingAcceleration { time_s, half_noise_mps, lateral } => {
                predict(moment, Some([*time_s, *half_noise_mps]), *lateral)
            }
            MotionModel::CarFollowing(model) => model.predict(moment),
            MotionModel::Driver(model) => model.predict(moment),
            MotionModel::Population(drivers) => mean(drivers, moment),
            MotionModel::Seen { half_noise_mps } => {
                PredictedDriver { half_noise_mps: *half_noise_mps, ..PredictedDriver::usual() }.predict_seen(moment)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::behind;
    use super::*;

    #[test]
    fn a_predicted_driver_keeps_its_speed_on_a_free_road() {
        let moment = TrafficMoment { others: Vec::new(), ..behind(1.0, 1.0) };
        let motion = PredictedDriver::usual().predict(&moment);
        assert!((motion.along_m[STEPS] - 100.0).abs() < 0.01, "{}", motion.along_m[STEPS]);
    }

    #[test]
    fn a_predicted_vehicle_stays_behind_a_slow_leader() {
        let motion = PredictedDriver::usual().predict(&behind(30.0, 10.0));
        assert!(motion.along_m[STEPS] < 30.0 + 50.0, "{}", motion.along_m[STEPS]);
    }

    #[test]
    fn a_driver_with_a_short_gap_keeps_it_but_none_below_the_least() {
        let driver = PredictedDriver { keeps_gap: 1.0, ..PredictedDriver::usual() };
        let gap_s = |driver: &PredictedDriver, gap_m: f64| driver.own_gap_s(&behind(gap_m, 20.0));
        assert!((gap_s(&driver, 3.5 + 16.0) - 0.8).abs() < 1e-9 && gap_s(&driver, 5.0) == 0.6);
        assert_eq!((gap_s(&driver, 80.0), gap_s(&PredictedDriver::usual(), 5.0)), (1.15, 1.15));
    }

    #[test]
    fn a_leader_that_is_seen_to_brake_slows_the_driver_behind() {
        let mut moment = behind(25.0, 20.0);
        moment.others[0].acceleration_mps2 = -2.0;
        let along_m =
            |sees_motion| PredictedDriver { sees_motion, ..PredictedDriver::usual() }.predict(&moment).along_m[15];
        assert!(along_m(true) < along_m(false) - 0.2, "{} {}", along_m(true), along_m(false));
    }

    #[test]
    fn who_changes_lanes_follows_whom_it_will_be_behind() {
        let mut moment = TrafficMoment { lateral_speed_mps: 1.0, ..behind(25.0, 12.0) };
        moment.others[0].across_m = 2.5;
        let along_m = |drifts_s| {
            let lateral = Some(LateralMotion::Kept);
            PredictedDriver { drifts_s, lateral, looks_beside: false, ..PredictedDriver::usual() }
                .predict(&moment)
                .along_m[15]
        };
        assert!(along_m(2.0) < along_m(0.0) - 0.5, "{} {}", along_m(2.0), along_m(0.0));
    }

    #[test]
    fn a_population_is_predicted_by_the_mean_of_its_drivers() {
        let drivers = [0.6, 1.6].map(|time_gap_s| PredictedDriver { time_gap_s, ..PredictedDriver::usual() });
        let moment = behind(20.0, 15.0);
        let alone = drivers.each_ref().map(|driver| driver.predict(&moment).along_m[STEPS]);
        let mean_m = MotionModel::Population(drivers.to_vec()).predict(&moment).along_m[STEPS];
        assert!((mean_m - 0.5 * (alone[0] + alone[1])).abs() < 1e-9 && alone[0] > alone[1], "{alone:?}");
    }

    #[test]
    fn a_vehicle_off_the_lane_centre_is_predicted_to_keep_its_lateral_position() {
        let moment = TrafficMoment { across_m: 0.8, ..behind(200.0, 20.0) };
        let across_m =
            |lateral| PredictedDriver { lateral, ..PredictedDriver::usual() }.predict(&moment).across_m[STEPS];
        assert_eq!(across_m(Some(LateralMotion::Kept)), 0.8);
        assert!(across_m(None).abs() < 0.8);
    }
}
