//! The state of a car and its surroundings at a time, from records up to that time only.

use interplay_planners::motion_prediction::{NearbyVehicle, TrafficMoment};
use interplay_scenarios::RecordedMoment;

use crate::geometry::{Box2, LaneLine};
use crate::traffic::{Timeline, Track};

/// Vehicles farther away are ignored \[m\].
const SIGHT_M: f64 = 160.0;
/// Vehicles with a larger lateral offset are on other roads \[m\].
const ACROSS_M: f64 = 15.0;
/// Vehicles that drive against or across the lane are ignored: minimum cosine of the angle to it.
const MIN_COS: f64 = 0.5;

/// What is known of a track at a step, with the line of its lane and the car's arc length on it \[m\].
pub(crate) fn known_at(timeline: &Timeline, track: usize, step: i64) -> Option<(LaneLine, f64, TrafficMoment)> {
    let car = &timeline.tracks[track];
    let at = car.at(step)?;
    let (way, speed_limit_mps) = timeline.map.way(at.position, at.heading_rad);
    let place = way.project(at.position);
    let past = past(car, step, timeline.step_s);
    let slope = |value: &dyn Fn(&RecordedMoment) -> f64| {
        slope(past.iter().map(|at| (timeline.step_s * (at.step - step) as f64, value(at))))
    };
    let (acceleration_mps2, speed_noise_mps) = slope(&|at| at.speed_mps);
    let (lateral_speed_mps, _) = slope(&|at| way.project(at.position).across_m);
    let others = timeline.tracks.iter().enumerate().filter(|(index, _)| *index != track);
    let others = others.filter_map(|(_, other)| neighbour(timeline, other, step, at.position, &way, place.along_m));
    let known = TrafficMoment {
        speed_mps: at.speed_mps,
        acceleration_mps2,
        speed_noise_mps,
        across_m: place.across_m,
        lateral_speed_mps,
        length_m: car.length_m,
        width_m: car.width_m,
        lane_width_m: place.width_m,
        road_m: timeline.map.road_m(&way, place.along_m, place.width_m),
        speed_limit_mps,
        others: others.collect(),
    };
    Some((way, place.along_m, known))
}

/// The records of the past [`PAST_S`], the present one last.
fn past(car: &Track, step: i64, step_s: f64) -> &[RecordedMoment] {
    let earliest = step - (PAST_S / step_s).round() as i64;
    let from = car.moments.partition_point(|at| at.step < earliest);
    let to = car.moments.partition_point(|at| at.step <= step);
    &car.moments[from..to]
}

/// The slope of the least-squares line through points, and its root mean square residual; 0 for fewer
/// than two points.
fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> (f64, f64) {
    let count = points.clone().count() as f64;
    let [mean_x, mean_y] = points.clone().fold([0.0; 2], |sum, (x, y)| [sum[0] + x / count, sum[1] + y / count]);
    let [above, below] = points
        .clone()
        .fold([0.0; 2], |sum, (x, y)| [sum[0] + (x - mean_x) * (y - mean_y), sum[1] + (x - mean_x) * (x - mean_x)]);
    if below <= 0.0 {
        return (0.0, 0.0);
    }
    let slope = above / below;
    let squares: f64 = points.map(|(x, y)| (y - mean_y - slope * (x - mean_x)).powi(2)).sum();
    (slope, (squares / count).sqrt())
}

/// Another vehicle in the frame of a lane; none if it is far away or drives in another direction.
fn neighbour(
    timeline: &Timeline,
    other: &Track,
    step: i64,
    from: [f64; 2],
    way: &LaneLine,
    along_m: f64,
) -> Option<NearbyVehicle> {
    let at = other.at(step)?;
    if libm::hypot(at.position[0] - from[0], at.position[1] - from[1]) > SIGHT_M {
        return None;
    }
    let place = way.project(at.position);
    let cos = libm::cos(at.heading_rad - place.heading_rad);
    if cos < MIN_COS || place.across_m.abs() > ACROSS_M {
        return None;
    }
    let past = past(other, step, timeline.step_s);
    let speeds = past.iter().map(|at| (timeline.step_s * (at.step - step) as f64, at.speed_mps));
    let (acceleration_mps2, speed_noise_mps) = slope(speeds);
    Some(NearbyVehicle {
        ahead_m: place.along_m - along_m,
        across_m: place.across_m,
        speed_mps: at.speed_mps * cos,
        acceleration_mps2,
        speed_noise_mps,
        length_m: other.length_m,
        width_m: other.width_m,
    })
}

/// Position of a car at a horizon.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Truth {
    /// Distance along its lane \[m\].
    pub along_m: f64,
    /// Lateral offset \[m\].
    pub across_m: f64,
}

#[derive(Clone, Copy)]
pub(crate) struct Later<'a> {
    pub timeline: &'a Timeline,
    pub track: usize,
    pub step: i64,
}

impl<'a> Later<'a> {
    pub(crate) fn car(&self) -> &'a Track {
        &self.timeline.tracks[self.track]
    }

    fn step_after(&self, time_s: f64) -> i64 {
        self.step + (time_s / self.timeline.step_s).round() as i64
    }

    /// The car's position at each horizon; none if the record ends before the last one.
    pub(crate) fn truth(&self, way: &LaneLine, along_m: f64) -> Option<[Truth; HORIZONS_S.len()]> {
        let mut truth = [Truth::default(); HORIZONS_S.len()];
        for (truth, horizon_s) in truth.iter_mut().zip(HORIZONS_S) {
            let place = way.project(self.car().at(self.step_after(horizon_s))?.position);
            *truth = Truth { along_m: place.along_m - along_m, across_m: place.across_m };
        }
        Some(truth)
    }

    /// The body of the car a given time after the start.
    pub(crate) fn own_box(&self, time_s: f64) -> Option<Box2> {
        self.car().at(self.step_after(time_s)).map(|at| body(self.car(), at))
    }

    /// The vehicles whose bodies do not overlap the car's at the start; in some records bodies do.
    pub(crate) fn others(&self) -> Vec<&'a Track> {
        let own = self.own_box(0.0);
        let others = self.timeline.tracks.iter().enumerate().filter(|(index, _)| *index != self.track);
        let apart = |other: &&Track| {
            let at = other.at(self.step).map(|at| body(other, at));
            own.zip(at).is_none_or(|(own, other)| !own.overlaps(&other))
        };
        others.map(|(_, other)| other).filter(apart).collect()
    }

    /// Whether a body overlaps any recorded body of `others` a given time after the start.
    pub(crate) fn touches(&self, own: &Box2, others: &[&Track], time_s: f64) -> bool {
        let step = self.step_after(time_s);
        others.iter().any(|other| other.at(step).is_some_and(|at| body(other, at).overlaps(own)))
    }
}

/// The body of a vehicle at a recorded time.
pub(crate) fn body(track: &Track, at: &RecordedMoment) -> Box2 {
    Box2 { middle: at.position, heading_rad: at.heading_rad, half_m: [0.5 * track.length_m, 0.5 * track.width_m] }
}

/// Time before a start over which slopes are computed \[s\].
pub(crate) const PAST_S: f64 = 1.2;

/// The horizons at which predictions are evaluated \[s\].
pub(crate) const HORIZONS_S: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_estimated_slope_of_a_straight_line_is_exact() {
        let line = (0..7).map(|t| (0.2 * f64::from(t), 3.0 - 0.5 * 0.2 * f64::from(t)));
        let (found, noise) = slope(line);
        assert!((found + 0.5).abs() < 1e-12 && noise < 1e-12);
        assert_eq!(slope([(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)].into_iter()).0, 0.0);
        assert_eq!(slope([(0.0, 3.0)].into_iter()), (0.0, 0.0));
        assert_eq!(slope(std::iter::empty()), (0.0, 0.0));
    }
}
