//! Every metric, one file for each or for a few with similar computations. To add a metric, write its file and name it here.

use super::metric::Metric;
pub use off_road::beyond_edge_m;
pub(crate) use time_gap::time_gap_s;

/// Declares the files, and lists their metrics in the order of the columns in rows of sweeps.
macro_rules! metrics {
    ($(mod $file:ident;)*) => {
        $(mod $file;)*

        /// All metrics of Interplay, by file.
        pub(super) const ALL: &[&[&dyn Metric]] = &[$($file::METRICS),*];
    };
}

metrics! {
    mod contact;
    mod gap;
    mod time_to_collision;
    mod comfort;
    mod speed;
    mod off_road;
    mod speeding;
    mod steering_rate;
    mod time_gap;
    mod lane_gaps;
    mod lane_use;
    mod post_encroachment;
    mod emergency_braking;
    mod rules;
    mod standing;
    mod rest;
}

#[cfg(test)]
mod tests {
    //! Measures constructed frames for tests.

    use crate::measure::metric::SharedStates;
    use interplay_planners::{Input, State};
    use interplay_scenarios::{Vehicle, load};

    use super::*;
    use crate::measure::metric::{ObservedMoment, ObservedTick};
    use crate::measure::values::Measured;
    use crate::state::frame::{Frame, VehicleFrame};

    pub(super) fn peak(value: f64, time_s: Option<f64>) -> Measured {
        Measured { time_s, is_peak: true, ..Measured::number(Some(value)) }
    }

    /// Measures a vehicle with these states and arc lengths at these times.
    pub(super) fn at_moments(metric: &dyn Metric, vehicle: &Vehicle, seen: &[(f64, State, f64)]) -> Measured {
        let scenario = load("lane-change/front-nice", &[]).expect("authored");
        let vehicles = std::slice::from_ref(vehicle);
        let frame = Frame { vehicles: vec![VehicleFrame::default()], ..Frame::default() };
        let mut measurement = None;
        for (time_s, state, along_m) in seen {
            let end = ObservedMoment { time_s: *time_s, vehicles, states: &[*state], along_m: &[*along_m] };
            let tick = ObservedTick {
                frame: &frame,
                step_s: 0.1,
                shared: &SharedStates::default(),
                previous_inputs: &[Input::default()],
                end,
            };
            measurement.get_or_insert_with(|| metric.begin(&scenario, &end, 0)).observe(&tick);
        }
        measurement.expect("it is seen").measured()
    }

    /// Measures a vehicle over ticks of 0.1 s, one a second, each with its input and its states before and after.
    pub(super) fn over_ticks(metric: &dyn Metric, ticks: &[(Input, [State; 2])]) -> Measured {
        let scenario = load("lane-change/front-nice", &[]).expect("authored");
        let vehicles = &scenario.vehicles[..1];
        let start = ObservedMoment { time_s: 0.0, vehicles, states: &[State::default()], along_m: &[0.0] };
        let mut measurement = metric.begin(&scenario, &start, 0);
        let mut previous = Input::default();
        for (second, (input, [before, after])) in ticks.iter().enumerate() {
            let time_s = second as f64;
            let vehicle = VehicleFrame { input: *input, state: *before, ..VehicleFrame::default() };
            let frame = Frame { time_s, vehicles: vec![vehicle], ..Frame::default() };
            let states = std::slice::from_ref(after);
            let end = ObservedMoment { time_s: time_s + 0.1, vehicles, states, along_m: &[0.0] };
            measurement.observe(&ObservedTick {
                frame: &frame,
                step_s: 0.1,
                shared: &SharedStates::default(),
                previous_inputs: &[previous],
                end,
            });
            previous = *input;
        }
        measurement.measured()
    }

    /// Measures a run from its frames alone.
    pub(super) fn of_frames(metric: &dyn Metric, frames: &[Frame]) -> Measured {
        let scenario = load("lane-change/front-nice", &[]).expect("authored");
        let end = ObservedMoment { time_s: 0.0, vehicles: &[], states: &[], along_m: &[] };
        let mut measurement = metric.begin(&scenario, &end, 0);
        for frame in frames {
            measurement.observe(&ObservedTick {
                frame,
                step_s: 0.1,
                shared: &SharedStates::default(),
                previous_inputs: &[],
                end,
            });
        }
        measurement.measured()
    }

    #[test]
    fn names_and_keys_of_metrics_are_unique() {
        let declarations: Vec<_> = ALL.iter().copied().flatten().map(|metric| metric.declaration()).collect();
        let names: Vec<&str> = declarations.iter().map(|one| one.name).collect();
        let report_keys = declarations.iter().map(|one| one.report_key.unwrap_or(one.name)).collect();
        for mut keys in [names, report_keys] {
            keys.sort_unstable();
            let count = keys.len();
            keys.dedup();
            assert_eq!(keys.len(), count, "{keys:?}");
        }
    }
}
