//! The words under a picture: who asks whom, what the other answers, and what happened last.

use interplay_simulation::frame::{Frame, Level};

use super::scene::DrivingRun;

/// How long a collision stays in the caption, and any other event \[s\] at 1/10 scale.
const COLLISION_SHOWN_S: f64 = 3.0;
const EVENT_SHOWN_S: f64 = 2.5;
/// From this share of acceptance on a vehicle accepts, below the other it declines.
const ACCEPTS: f64 = 0.7;
const DECLINES: f64 = 0.3;

/// What is said at a moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Caption {
    /// Who asks whom, and the answer; or who collided.
    pub first: String,
    /// What happened last.
    pub second: String,
    /// Whether the first line is about a collision.
    pub alarms: bool,
}

/// The caption at a time.
pub fn caption(run: &DrivingRun, time_s: f64) -> Caption {
    let ratio = run.scenario.ego().map_or(1.0, |ego| ego.body.time_ratio());
    let frame = run.frame(time_s);
    let past = |shown_s: f64| {
        let shown = move |frame: &&&Frame| frame.time_s <= time_s + 1e-9 && frame.time_s > time_s - shown_s * ratio;
        run.frames.iter().filter(shown).map(|frame| **frame).collect::<Vec<&Frame>>()
    };
    let hit = past(COLLISION_SHOWN_S).into_iter().flat_map(|frame| &frame.collisions).find(|hit| hit.time_s <= time_s);
    let second = past(EVENT_SHOWN_S).into_iter().rev().find_map(|frame| news(run, frame)).unwrap_or_default();
    if let Some(hit) = hit {
        let [one, other] = &hit.between;
        return Caption { first: format!("{one} and {other} collide"), second, alarms: true };
    }
    Caption { first: asks(run, frame), second, alarms: false }
}

/// Who asks whom for the dotted motion, and how far the other follows it; of the ego if it asks.
fn asks(run: &DrivingRun, frame: &Frame) -> String {
    let ego = run.scenario.ego_index();
    let mut vehicles: Vec<usize> = (0..frame.vehicles.len()).collect();
    vehicles.sort_by_key(|index| *index != ego);
    let asking = vehicles.into_iter().find_map(|index| {
        let vehicle = &frame.vehicles[index];
        vehicle.plan.proposal.as_ref().map(|proposal| (&vehicle.name, proposal))
    });
    let Some((name, proposal)) = asking else { return String::new() };
    let to = &proposal.to;
    let answer = match proposal.acceptance {
        None => return format!("{name} expects {to} to take the dotted way"),
        Some(share) if share >= ACCEPTS => "accepts",
        Some(share) if share < DECLINES => "declines",
        Some(_) => "hesitates",
    };
    let percent = (100.0 * proposal.acceptance.unwrap_or_default()).round();
    format!("{name} asks {to} to take the dotted way – {to} {answer} ({percent:.0} %)")
}

/// What happened in a tick: alarms before warnings before notes, the ego's first.
fn news(run: &DrivingRun, frame: &Frame) -> Option<String> {
    let ego = run.scenario.ego().map(|ego| ego.name.as_str());
    let of_level = |level: Level| {
        let mut events: Vec<_> = frame.events.iter().filter(|event| event.level == level).collect();
        events.sort_by_key(|event| Some(event.vehicle.as_str()) != ego);
        events.first().map(|event| format!("{} {}", event.vehicle, event.text))
    };
    // Collisions have the first line.
    of_level(Level::Warning).or_else(|| of_level(Level::Note))
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::figures::RecordedRun;

    fn captions(name: &str) -> Vec<Caption> {
        let recorded = RecordedRun::of(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        let run = DrivingRun::of(&recorded).expect("vehicles");
        run.frames.iter().map(|frame| caption(&run, frame.time_s)).collect()
    }

    #[test]
    fn a_negotiator_asks_and_is_answered() {
        let captions = captions("intersection/nice");
        assert!(captions.iter().any(|caption| caption.first.starts_with("ego asks crossing") && caption.first.contains("accepts")));
        assert!(captions.iter().any(|caption| !caption.second.is_empty()));
        assert!(captions.iter().all(|caption| !caption.alarms));
    }

    #[test]
    fn a_collision_is_said() {
        let captions = captions("crash/side-impact");
        let alarms = captions.iter().filter(|caption| caption.alarms).count();
        assert!(alarms > 5 && alarms < captions.len());
        let said = captions.iter().find(|caption| caption.alarms).expect("a collision");
        assert!(said.first.contains("ego") && said.first.contains("crossing"), "{}", said.first);
    }
}
