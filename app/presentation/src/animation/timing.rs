//! The times of a run that pictures show, and the rate of time.

use interplay_simulation::report::Report;

/// Time from one picture to the next \[s\]; GIF counts in hundredths of a second.
pub const PICTURE_S: f64 = 0.1;
/// Duration of the last picture \[s\].
pub const LAST_PICTURE_S: f64 = 1.6;
/// Time shown after the last vehicle has reached its goal \[s\], at 1/10 scale.
const AFTER_GOALS_S: f64 = 0.8;
/// Time shown after the ego has reached its goal \[s\], at 1/10 scale: the camera then leaves the other vehicles.
const AFTER_EGO_S: f64 = 1.2;
/// Time shown after the last collision \[s\], at 1/10 scale.
const AFTER_COLLISION_S: f64 = 2.5;
/// Time shown after the interactions of the ego have ended \[s\].
const AFTER_ORDERS_S: f64 = 2.0;
/// Longest animation at the rate of the run \[s\]; longer ones are sped up.
const LONGEST_S: f64 = 8.5;
/// Rate of time around a contact.
const SLOW_RATE: f64 = 0.25;
/// Durations of slow motion before and after a contact \[s\], at 1/10 scale.
const SLOW_S: [f64; 2] = [0.35, 0.45];

/// The time that a picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureTime {
    /// Simulated time \[s\].
    pub time_s: f64,
    /// Rate of time; 1 is that of the run.
    pub rate: f64,
}

/// The times that limit the animation of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunTimes {
    /// Index of the ego.
    pub ego: usize,
    /// When the run ends \[s\].
    pub end_s: f64,
    /// Time at which the interactions of the ego end \[s\], if there are any that end.
    pub settled_s: Option<f64>,
    /// The stated end of the animation \[s\].
    pub until_s: Option<f64>,
    /// Whether the ego is only the first vehicle of a flow.
    pub is_flow: bool,
    /// Factor of times at 1/10 scale.
    pub time_ratio: f64,
}

/// The times of all pictures of a run.
pub fn moments(report: &Report, times: &RunTimes) -> Vec<PictureTime> {
    let (end_s, time_ratio) = (last_s(report, times), times.time_ratio);
    let usual_rate = usual_rate(end_s);
    let is_slow = |time_s: f64| {
        let [before_s, after_s] = SLOW_S.map(|part| part * time_ratio);
        report.collisions.iter().any(|hit| (hit.time_s - before_s..hit.time_s + after_s).contains(&time_s))
    };
    let mut moments = Vec::new();
    let mut time_s = 0.0;
    while time_s < end_s {
        let rate = if is_slow(time_s) { SLOW_RATE } else { usual_rate };
        moments.push(PictureTime { time_s, rate });
        time_s += rate * PICTURE_S;
    }
    moments.push(PictureTime { time_s: end_s, rate: usual_rate });
    moments
}

/// The least rate of 1, 1.5, 2, 3, 4, 6, 8, … with which the animation is at most [`LONGEST_S`] long.
fn usual_rate(end_s: f64) -> f64 {
    let mut rate = 1.0;
    while end_s / rate > LONGEST_S {
        if end_s / (1.5 * rate) <= LONGEST_S {
            return 1.5 * rate;
        }
        rate *= 2.0;
    }
    rate
}

/// The end of the animation: a while after the last goal, interaction or collision, or the end of the run.
fn last_s(report: &Report, times: &RunTimes) -> f64 {
    let RunTimes { ego, end_s, settled_s, until_s, time_ratio, .. } = *times;
    if let Some(until_s) = until_s {
        return until_s.min(end_s);
    }
    // Of traffic that comes and goes, no single vehicle ends the picture.
    if times.is_flow {
        return end_s;
    }
    let collided = report.collisions.iter().map(|hit| hit.time_s + AFTER_COLLISION_S * time_ratio).reduce(f64::max);
    let tasks = report.vehicles.iter().filter(|vehicle| vehicle.has_task);
    let all: Option<Vec<f64>> = tasks.map(|vehicle| vehicle.completed_s).collect();
    let all_s = all.and_then(|times| times.into_iter().reduce(f64::max)).map(|at| at + AFTER_GOALS_S * time_ratio);
    let ego_s = report.vehicles.get(ego).and_then(|ego| ego.completed_s).map(|at| at + AFTER_EGO_S * time_ratio);
    let reached = match (all_s, ego_s) {
        (Some(all_s), Some(ego_s)) => Some(all_s.min(ego_s)),
        // The goals of others do not end the animation of an ego without a task.
        (all_s, ego_s) => ego_s.or(all_s.filter(|_| report.vehicles.get(ego).is_none_or(|ego| ego.has_task))),
    };
    let settled = settled_s.map(|at| at + AFTER_ORDERS_S);
    let reached = reached.into_iter().chain(settled).reduce(f64::min);
    // If the scenario expects a vehicle to yield, the animation does not end before that is decided.
    let yields = report.expectations.iter().any(|expectation| expectation.what.starts_with("yields"));
    let crossed = report.right_of_way.iter().filter_map(|passage| passage.second_s).filter(|_| yields);
    let crossed = crossed.map(|at| at + AFTER_GOALS_S * time_ratio);
    let reached = reached.map(|reached| crossed.fold(reached, f64::max));
    let everything = match (reached, collided) {
        (Some(reached), Some(collided)) => Some(reached.max(collided)),
        (reached, collided) => reached.or(collided),
    };
    everything.map_or(end_s, |at| at.min(end_s))
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;
    use interplay_simulation::run::run;

    use super::*;

    fn report(name: &str) -> Report {
        run(name, &load(name, &[]).expect("embedded"), Vec::new()).expect("a run")
    }

    fn times(end_s: f64, settled_s: Option<f64>) -> RunTimes {
        RunTimes { ego: 0, end_s, settled_s, until_s: None, is_flow: false, time_ratio: 1.0 }
    }

    #[test]
    fn time_passes_slowly_around_a_contact() {
        let report = report("crash/side-impact");
        let moments = moments(&report, &times(8.0, None));
        let hit_s = report.collisions[0].time_s;
        let steps: Vec<[f64; 2]> = moments.windows(2).map(|pair| [pair[0].time_s, pair[1].time_s]).collect();
        assert!(steps.iter().all(|[from, to]| to > from));
        let around = steps.iter().find(|[from, to]| *from <= hit_s && hit_s < *to).expect("it is shown");
        assert!((around[1] - around[0] - SLOW_RATE * PICTURE_S).abs() < 1e-9);
        assert!((steps[0][1] - steps[0][0] - PICTURE_S).abs() < 1e-9);
        assert!(moments.last().expect("some").time_s < 5.0, "the rest shows nothing new");
    }

    #[test]
    fn the_animation_ends_after_the_goals_and_long_runs_are_faster() {
        let report = report("intersection/nice");
        let last = |moments: Vec<PictureTime>| moments.last().expect("some").time_s;
        let goals_s: Vec<f64> = report.vehicles.iter().filter_map(|vehicle| vehicle.completed_s).collect();
        let expected_s = (goals_s[0] + AFTER_EGO_S).min(goals_s[1] + AFTER_GOALS_S);
        assert!((last(moments(&report, &times(7.0, None))) - expected_s).abs() < 1e-9);
        let until = RunTimes { until_s: Some(1.0), ..times(7.0, None) };
        assert_eq!(last(moments(&report, &until)), 1.0, "the stated end");
        let unfinished = Report { vehicles: Vec::new(), ..report };
        assert_eq!(last(moments(&unfinished, &times(7.0, None))), 7.0);
        assert_eq!(last(moments(&unfinished, &times(7.0, Some(1.5)))), 1.5 + AFTER_ORDERS_S);
        assert_eq!(last(moments(&unfinished, &times(7.0, Some(6.5)))), 7.0, "not after the run");
        let long = moments(&unfinished, &times(40.0, None));
        assert_eq!([8.0, 12.0, 16.0, 25.0, 40.0].map(usual_rate), [1.0, 1.5, 2.0, 3.0, 6.0]);
        assert_eq!(long[0].rate, 6.0);
        assert!(long.len() as f64 * PICTURE_S < LONGEST_S);
    }
}
