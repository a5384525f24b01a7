//! The colour of every vehicle at every tick: vehicles near the ego have different colours.

use interplay_scenarios::Scenario;
use interplay_simulation::frame::Frame;

use crate::crowd::nearest_vehicles;
use crate::palette::{Colour, OTHERS, UNNAMED, vehicle_colours};

/// A vehicle keeps its colour while it is among this many nearest to the ego, so that colours do not flicker.
const KEPT_AMONG: usize = OTHERS.len() + 3;

/// The colour of each vehicle at each tick. With more vehicles than colours, those nearest to the ego have one, and all others are
/// [`UNNAMED`].
pub fn colours(scenario: &Scenario, frames: &[&Frame]) -> Vec<Vec<Colour>> {
    let usual: Vec<Colour> = vehicle_colours(scenario).into_iter().map(|colour| colour.rgb).collect();
    let ego = scenario.ego_index();
    let is_other = |index: usize| index != ego && scenario.vehicles[index].obstacle.is_none();
    if (0..usual.len()).filter(|index| is_other(*index)).count() <= OTHERS.len() {
        return vec![usual; frames.len()];
    }
    let mut holders: [Option<usize>; OTHERS.len()] = [None; OTHERS.len()];
    let at = |frame: &&Frame| {
        let near = nearest_vehicles(scenario, frame);
        for holder in &mut holders {
            *holder = holder.filter(|vehicle| near.iter().take(KEPT_AMONG).any(|other| other == vehicle));
        }
        for vehicle in near.iter().take(OTHERS.len()) {
            let is_coloured = holders.contains(&Some(*vehicle));
            if let Some(free) = holders.iter_mut().find(|holder| holder.is_none()).filter(|_| !is_coloured) {
                *free = Some(*vehicle);
            }
        }
        let colour = |index: usize| match holders.iter().position(|holder| *holder == Some(index)) {
            Some(number) => OTHERS[number].rgb,
            None if is_other(index) => UNNAMED,
            None => usual[index],
        };
        (0..usual.len()).map(colour).collect()
    };
    frames.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::from_text;

    use super::*;
    use crate::figures::RecordedRun;

    /// Of twelve cars, the ego and the five nearest ones have colours, all different.
    #[test]
    fn in_a_crowd_the_nearest_vehicles_have_colours() {
        let vehicle = |number: u32| {
            let name = if number == 6 { "ego".to_owned() } else { format!("car-{number}") };
            let along_m = 15.0 * f64::from(number);
            format!(
                "[[vehicle]]\nname = '{name}'\nstart = {{ lane = 0, along_m = {along_m}, speed_mps = 8.0 }}\n\
                 goal = {{ speed_mps = 8.0 }}\ndriver = {{ kind = 'idm' }}\n"
            )
        };
        let vehicles: String = (0..12).map(vehicle).collect();
        let text = format!(
            "title = 'a'\nshows = 'b'\nduration_s = 1.0\n[defaults]\nclass = 'car'\n[road]\nkind = 'lanes'\nlane_width_m = 3.5\n{vehicles}"
        );
        let scenario = from_text("row.toml", &text, &[]).expect("a scenario without fault");
        let recorded = RecordedRun::record("row", scenario, Vec::new(), "").expect("a run");
        let frames: Vec<&Frame> = recorded.frames.iter().collect();
        for colours in colours(&recorded.scenario, &frames) {
            let mut named: Vec<Colour> = colours.into_iter().filter(|colour| *colour != UNNAMED).collect();
            named.sort_unstable();
            assert_eq!(named.len(), 6);
            named.dedup();
            assert_eq!(named.len(), 6);
        }
    }
}
