//! Finds rows that repeat others: published files contain the same cars several times, each time with a different one removed as the ego.

use std::collections::BTreeMap;

use super::timeline::Timeline;

/// A slower vehicle may be at the former position of another one, so its rows do not identify it \[m/s\].
const MIN_SPEED_MPS: f64 = 0.5;
/// Rows are equal if they agree to this fraction of a metre and of a metre per second.
const PARTS: f64 = 1000.0;

/// Marks the rows that an earlier track contains, and gives tracks of one car the same name.
pub(super) fn mark(timelines: &mut [Timeline]) {
    let mut known: BTreeMap<[i64; 3], String> = BTreeMap::new();
    for track in timelines.iter_mut().flat_map(|timeline| &mut timeline.tracks) {
        let keys: Vec<Option<[i64; 3]>> = track
            .moments
            .iter()
            .map(|at| {
                let key = [at.position[0], at.position[1], at.speed_mps].map(|number| (PARTS * number).round() as i64);
                (at.speed_mps >= MIN_SPEED_MPS).then_some(key)
            })
            .collect();
        if let Some(car) = keys.iter().flatten().find_map(|key| known.get(key)) {
            track.car.clone_from(car);
        }
        for (key, repeats) in keys.iter().zip(&mut track.repeats) {
            let Some(key) = key else { continue };
            *repeats = known.insert(*key, track.car.clone()).is_some();
        }
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::{RecordedMoment, RecordedTraffic, RecordedVehicle};

    use super::*;

    #[test]
    fn a_car_that_two_files_contain_is_counted_once() {
        let file = |name: &str, from: i64| {
            let at = |step: i64| RecordedMoment {
                step: step - from,
                position: [2.0 * step as f64, 0.0],
                heading_rad: 0.0,
                speed_mps: 10.0,
            };
            let vehicle = RecordedVehicle {
                id: name.to_owned(),
                moments: (from..from + 10).map(at).collect(),
                ..RecordedVehicle::default()
            };
            let traffic =
                RecordedTraffic { name: name.to_owned(), step_s: 0.2, lanes: Vec::new(), vehicles: vec![vehicle] };
            Timeline::of(traffic, 0)
        };
        let mut timelines = vec![file("a", 0), file("b", 7), file("c", 90)];
        mark(&mut timelines);
        let cars: Vec<&str> = timelines.iter().map(|it| it.tracks[0].car.as_str()).collect();
        assert_eq!(cars, ["a/a", "a/a", "c/c"]);
        let repeated = timelines[1].tracks[0].repeats.iter().filter(|repeats| **repeats).count();
        assert_eq!(repeated, 3);
    }
}
