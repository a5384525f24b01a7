//! Consecutive windows of one recording, such as `C-DEU_MONAEast-2_80_T-159`, which contains the steps 80 to 159 of
//! `C-DEU_MONAEast-2`. They are joined to one recording, so that a car in two windows is one car.

use std::collections::BTreeMap;

use interplay_scenarios::{RecordedTraffic, RecordedVehicle};

use super::timeline::Timeline;

/// Joins windows with the same map and time step. All other recordings stay as they are, in the order of their first files.
pub(super) fn joined(traffic: Vec<RecordedTraffic>) -> Vec<RecordedTraffic> {
    let mut found: Vec<RecordedTraffic> = Vec::new();
    let mut heads: Vec<Option<String>> = Vec::new();
    for mut window in traffic {
        let Some((head, from)) = window_of(&window.name) else {
            found.push(window);
            heads.push(None);
            continue;
        };
        shift(&mut window, from);
        let is_same = |(index, known): (usize, &RecordedTraffic)| {
            heads[index].as_ref() == Some(&head) && known.step_s == window.step_s && known.lanes == window.lanes
        };
        match found.iter().enumerate().position(is_same) {
            Some(index) => window.vehicles.into_iter().for_each(|vehicle| add(&mut found[index].vehicles, vehicle)),
            None => {
                window.name.clone_from(&head);
                found.push(window);
                heads.push(Some(head));
            }
        }
    }
    found
}

/// The recording of which a name is a window, and the step at which it begins: `head_FROM_T-TO` with `FROM` below `TO`.
fn window_of(name: &str) -> Option<(String, i64)> {
    let (before, to) = name.rsplit_once("_T-")?;
    let (head, from) = before.rsplit_once('_')?;
    let (from, to): (i64, i64) = (from.parse().ok()?, to.parse().ok()?);
    (from < to).then(|| (head.to_owned(), from))
}

/// Shifts a window whose steps are counted from its own begin to the axis of its recording, which begins with 1 at step 0.
fn shift(window: &mut RecordedTraffic, from: i64) {
    let steps = || window.vehicles.iter().filter_map(|vehicle| vehicle.moments.first()).map(|at| at.step);
    let is_counted_anew = steps().min().is_some_and(|first| first < from);
    if from > 1 && is_counted_anew {
        window.vehicles.iter_mut().flat_map(|vehicle| &mut vehicle.moments).for_each(|at| at.step += from);
    }
}

/// Adds the records of a vehicle in a window. Records of an earlier window stay.
fn add(vehicles: &mut Vec<RecordedVehicle>, vehicle: RecordedVehicle) {
    let Some(known) = vehicles.iter_mut().find(|known| known.id == vehicle.id) else {
        vehicles.push(vehicle);
        return;
    };
    for moment in vehicle.moments {
        if let Err(place) = known.moments.binary_search_by_key(&moment.step, |at| at.step) {
            known.moments.insert(place, moment);
        }
    }
}

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

    fn window(name: &str, id: &str, steps: std::ops::Range<i64>) -> RecordedTraffic {
        let moments = steps.map(|step| RecordedMoment { step, ..RecordedMoment::default() }).collect();
        let vehicle = RecordedVehicle { id: id.to_owned(), moments, ..RecordedVehicle::default() };
        RecordedTraffic { name: name.to_owned(), step_s: 0.2, vehicles: vec![vehicle], lanes: Vec::new() }
    }

    #[test]
    fn consecutive_windows_become_one_recording() {
        let windows =
            vec![window("A-2_1_T-79", "7", 60..80), window("A-2_80_T-159", "7", 0..5), window("B-1_2_T-1", "7", 0..3)];
        let joined = joined(windows);
        assert_eq!(joined.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["A-2", "B-1_2_T-1"]);
        let steps: Vec<i64> = joined[0].vehicles[0].moments.iter().map(|at| at.step).collect();
        assert_eq!(steps, (60..85).collect::<Vec<_>>());
    }

    #[test]
    fn recordings_on_different_maps_are_not_joined() {
        let mut other = window("A-2_80_T-159", "7", 0..5);
        other.step_s = 0.1;
        assert_eq!(joined(vec![window("A-2_1_T-79", "7", 0..5), other]).len(), 2);
    }

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
