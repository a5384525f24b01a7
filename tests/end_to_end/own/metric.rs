//! A metric: the shortest time headway of the ego, as a watcher of a run.

// shown from here
use std::sync::{Arc, Mutex, PoisonError};

use interplay_simulation::frame::Frame;
use interplay_simulation::watch::{WatchError, Watcher};

/// The shortest time headway to the vehicle ahead in the same lane [s]: the gap between the bumpers, divided by the speed.
struct Headway {
    /// Distance from the centre of one vehicle to that of the next when their bumpers touch [m].
    bumpers_m: f64,
    shortest_s: Arc<Mutex<Option<f64>>>,
}

impl Watcher for Headway {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        let Some(ego) = frame.vehicles.iter().find(|vehicle| vehicle.name == "ego") else { return Ok(()) };
        let same_lane = frame.vehicles.iter().filter(|other| (other.state.y_m - ego.state.y_m).abs() < 0.19);
        let ahead = same_lane.map(|other| other.state.x_m - ego.state.x_m).filter(|lead_m| *lead_m > 0.0);
        let now_s = ahead.map(|lead_m| (lead_m - self.bumpers_m) / ego.state.speed_mps).min_by(f64::total_cmp);
        let mut shortest_s = self.shortest_s.lock().unwrap_or_else(PoisonError::into_inner);
        *shortest_s = [*shortest_s, now_s].into_iter().flatten().min_by(f64::total_cmp);
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}

/// Runs a scenario and says the shortest headway of the ego in it [s]; none if nobody was ahead.
fn shortest_headway_s(scenario: &str) -> Result<Option<f64>, Box<dyn std::error::Error>> {
    let shortest_s = Arc::new(Mutex::new(None));
    let scenario = interplay_scenarios::load(scenario, &[])?;
    let headway = Headway { bumpers_m: 0.4, shortest_s: Arc::clone(&shortest_s) };
    interplay_simulation::run::run("headway", &scenario, vec![Box::new(headway)])?;
    let shortest_s = *shortest_s.lock().unwrap_or_else(PoisonError::into_inner);
    Ok(shortest_s)
}
// shown until here

#[test]
fn a_metric_of_one_s_own_watches_a_run() {
    let headway_s = |scenario| shortest_headway_s(scenario).expect("the run is finished");
    let behind = headway_s("lane-change/both-tough").expect("the ego ends behind two others");
    assert!(behind > 0.0 && behind < 2.0, "{behind} s");
    assert_eq!(headway_s("lane-change/front-nice"), None, "nobody is ahead of the ego in its lane");
}
