//! Predictions of one vehicle in real traffic, from its state and those of the vehicles around it at one time.
//!
//! A [`TrafficMoment`] is stated in the frame of the vehicle's lane: `s` along it from the vehicle's middle, `n` across
//! it from the lane's middle, positive to the left. It contains no plans and no later observations. A [`MotionModel`] returns positions
//! at steps of [`STEP_S`].
//!
//! | model | along the lane | across it |
//! |---|---|---|
//! | constant velocity | `s = v t` | the lateral place is kept |
//! | decaying acceleration | `s = v t + a τ (t − τ (1 − e^{−t/τ}))` | as stated |
//! | IDM | Treiber, Hennecke and Helbing (2000), with or without a lag | as stated |
//! | seen | what drivers expect who know no plans (`SeenMotion`) | as seen |
//! | human | one plan of our human driver | as planned, or as stated |
//! | population | the mean of some human drivers' plans | the same |
//!
//! "As stated" refers to [`LateralMotion`]: the lateral position is kept, or the present lateral speed decays.

mod car_following;
mod driver;

pub use car_following::CarFollowing;
pub use driver::{MotionModel, PredictedDriver};

/// Time between two positions of a prediction \[s\].
pub const STEP_S: f64 = 0.2;
/// A car that moves sideways faster than this is changing lanes \[m/s\].
const SIDEWAYS_MPS: f64 = 0.4;
/// Number of steps of a prediction, which reaches 5 s.
pub const STEPS: usize = 25;

/// The observed state of a vehicle and of the vehicles around it at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrafficMoment {
    /// Its speed along the lane \[m/s\].
    pub speed_mps: f64,
    /// Its acceleration: the slope of its speed in the past second or so \[m/s²\].
    pub acceleration_mps2: f64,
    /// How far its speeds of that time are from the line with that slope, root mean square: noise of the record, by which a slope is
    /// trusted less \[m/s\].
    pub speed_noise_mps: f64,
    /// Its place across the lane \[m\].
    pub across_m: f64,
    /// Its speed across the lane \[m/s\].
    pub lateral_speed_mps: f64,
    /// Length of its body \[m\].
    pub length_m: f64,
    /// Width of its body \[m\].
    pub width_m: f64,
    /// Width of the lane \[m\].
    pub lane_width_m: f64,
    /// How far the road reaches to the right and to the left of the lane's middle \[m\].
    pub road_m: [f64; 2],
    /// The highest speed that is permitted, where that is known \[m/s\].
    pub speed_limit_mps: Option<f64>,
    /// The others, in any order.
    pub others: Vec<NearbyVehicle>,
}

/// Another vehicle at that time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NearbyVehicle {
    /// How far its middle is ahead along the lane \[m\].
    pub ahead_m: f64,
    /// Its place across the lane \[m\].
    pub across_m: f64,
    /// Its speed along the lane \[m/s\].
    pub speed_mps: f64,
    /// Its acceleration, as that of the vehicle itself \[m/s²\].
    pub acceleration_mps2: f64,
    /// Noise of its record, as that of the vehicle itself \[m/s\].
    pub speed_noise_mps: f64,
    /// Length of its body \[m\].
    pub length_m: f64,
    /// Width of its body \[m\].
    pub width_m: f64,
}

/// An acceleration as far as it can be trusted: half of it where the noise is as stated \[m/s²\].
fn trusted_mps2(acceleration_mps2: f64, noise_mps: f64, half_noise_mps: f64) -> f64 {
    let ratio = noise_mps / half_noise_mps.max(1e-6);
    acceleration_mps2 / (1.0 + ratio * ratio)
}

impl TrafficMoment {
    /// The vehicles ahead in the same lane, the nearest first.
    pub fn leaders(&self) -> Vec<NearbyVehicle> {
        let mut ahead: Vec<NearbyVehicle> =
            self.others.iter().copied().filter(|it| it.ahead_m > 0.0 && self.is_in_way(it)).collect();
        ahead.sort_by(|a, b| a.ahead_m.total_cmp(&b.ahead_m));
        ahead
    }

    /// Whether a vehicle overlaps this one across the lane.
    fn is_in_way(&self, other: &NearbyVehicle) -> bool {
        (other.across_m - self.across_m).abs() < 0.5 * (other.width_m + self.width_m)
    }

    /// Whether it moves sideways as in a change of lane.
    pub fn moves_sideways(&self) -> bool {
        self.lateral_speed_mps.abs() > SIDEWAYS_MPS
    }

    /// The acceleration as far as it can be trusted: half of it where the noise is as stated \[m/s²\].
    fn trusted_acceleration_mps2(&self, half_noise_mps: f64) -> f64 {
        trusted_mps2(self.acceleration_mps2, self.speed_noise_mps, half_noise_mps)
    }

    /// The gap to a vehicle ahead, from bumper to bumper \[m\].
    pub fn gap_m(&self, leader: &NearbyVehicle) -> f64 {
        leader.ahead_m - 0.5 * (leader.length_m + self.length_m)
    }
}

/// The predicted motion of a vehicle: its position at each of [`STEPS`]` + 1` times, of which the first is the present.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PredictedMotion {
    /// How far along the lane it has come \[m\].
    pub along_m: Vec<f64>,
    /// Its place across the lane \[m\].
    pub across_m: Vec<f64>,
}

/// The prediction of the lateral position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LateralMotion {
    /// The place is kept.
    #[default]
    Kept,
    /// The lateral speed decays within about this time \[s\]: `n + v_n τ (1 − e^{−t/τ})`.
    Decaying(f64),
}

impl LateralMotion {
    /// The places across the lane \[m\].
    fn places_m(self, moment: &TrafficMoment) -> Vec<f64> {
        let at = |step: usize| match self {
            LateralMotion::Kept => moment.across_m,
            LateralMotion::Decaying(time_s) => {
                let time_s = time_s.max(1e-3);
                let passed = 1.0 - libm::exp(-STEP_S * step as f64 / time_s);
                moment.across_m + moment.lateral_speed_mps * time_s * passed
            }
        };
        (0..=STEPS).map(at).collect()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A car at 20 m/s behind another one.
    pub(crate) fn behind(gap_m: f64, leader_mps: f64) -> TrafficMoment {
        let leader = NearbyVehicle {
            ahead_m: gap_m + 4.5,
            speed_mps: leader_mps,
            length_m: 4.5,
            width_m: 1.8,
            ..NearbyVehicle::default()
        };
        TrafficMoment {
            speed_mps: 20.0,
            length_m: 4.5,
            width_m: 1.8,
            lane_width_m: 3.5,
            road_m: [5.25, 1.75],
            others: vec![leader],
            ..TrafficMoment::default()
        }
    }

    #[test]
    fn constant_velocity_keeps_speed_and_lateral_position() {
        let moment =
            TrafficMoment { across_m: 0.4, lateral_speed_mps: 1.0, acceleration_mps2: -2.0, ..behind(5.0, 3.0) };
        let motion = MotionModel::ConstantVelocity.predict(&moment);
        assert!((motion.along_m[STEPS] - 100.0).abs() < 1e-9 && motion.across_m.iter().all(|at| *at == 0.4));
        assert_eq!((motion.along_m.len(), motion.along_m[0]), (STEPS + 1, 0.0));
    }

    #[test]
    fn predicted_accelerations_and_lateral_speeds_decay() {
        let moment = TrafficMoment { lateral_speed_mps: 1.0, acceleration_mps2: 1.0, ..behind(500.0, 20.0) };
        let model = MotionModel::DecayingAcceleration {
            time_s: 1.0,
            half_noise_mps: 1.0,
            lateral: LateralMotion::Decaying(2.0),
        };
        let motion = model.predict(&moment);
        let expected_m = 100.0 + (5.0 - (1.0 - (-5.0_f64).exp()));
        assert!((motion.along_m[STEPS] - expected_m).abs() < 1e-9, "{}", motion.along_m[STEPS]);
        assert!((motion.across_m[STEPS] - 2.0 * (1.0 - (-2.5_f64).exp())).abs() < 1e-9);
    }

    #[test]
    fn a_predicted_vehicle_that_brakes_to_a_stop_does_not_reverse() {
        let moment = TrafficMoment { speed_mps: 1.0, acceleration_mps2: -3.0, ..behind(500.0, 20.0) };
        let model =
            MotionModel::DecayingAcceleration { time_s: 2.0, half_noise_mps: 1.0, lateral: LateralMotion::Kept };
        assert!(model.predict(&moment).along_m.windows(2).all(|pair| pair[1] >= pair[0]));
    }

    #[test]
    fn a_noisy_acceleration_is_trusted_less() {
        let moment = TrafficMoment { acceleration_mps2: 2.0, speed_noise_mps: 0.1, ..behind(500.0, 20.0) };
        assert_eq!(moment.trusted_acceleration_mps2(0.1), 1.0);
        assert!(moment.trusted_acceleration_mps2(10.0) > 1.99 && moment.trusted_acceleration_mps2(0.01) < 0.02);
    }

    #[test]
    fn the_nearest_vehicle_ahead_in_the_lane_is_the_leader() {
        let mut moment = behind(30.0, 10.0);
        moment.others.push(NearbyVehicle { ahead_m: 10.0, across_m: 3.5, width_m: 1.8, ..NearbyVehicle::default() });
        moment.others.push(NearbyVehicle { ahead_m: -10.0, width_m: 1.8, ..NearbyVehicle::default() });
        moment.others.push(NearbyVehicle { ahead_m: 50.0, width_m: 1.8, ..NearbyVehicle::default() });
        let leaders = moment.leaders();
        assert_eq!((leaders.len(), leaders[0].ahead_m), (2, 34.5));
        assert_eq!(moment.gap_m(&leaders[0]), 30.0);
    }
}
