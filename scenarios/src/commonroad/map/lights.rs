//! Traffic lights, at the ends of the lanes whose lanelets name them.

use interplay_planners::road::network::LightPhase;

use super::super::model::{CommonRoad, Light};
use super::lanes::Lanes;
use super::notes::Notes;
use super::vehicles::rounded;
use crate::model::traffic::light::LightConfig;

/// The shortest and the longest phase \[s\], and the latest begin.
const PHASES_S: [f64; 2] = [0.001, 10_000.0];
const MAX_OFFSET_S: f64 = 100_000.0;
/// The most lights of a scenario, and the most phases and lanes of each.
const MAX_LIGHTS: usize = 100;

/// The lights of a scenario, from its start on, in time steps.
pub(super) fn lights(scenario: &CommonRoad<'_>, lanes: &Lanes, begin: f64, notes: &mut Notes) -> Vec<LightConfig> {
    let mut taken: Vec<String> = Vec::new();
    let mut found = Vec::new();
    for light in &scenario.lights {
        let named = scenario.lanelets.iter().filter(|lanelet| lanelet.lights.contains(&light.id));
        let named = named.filter_map(|lanelet| lanes.names.get(&lanelet.id));
        let mut of_light: Vec<String> = named.filter(|lane| !taken.contains(lane)).cloned().collect();
        of_light.truncate(MAX_LIGHTS);
        let what = ["traffic light", "traffic lights"];
        if of_light.is_empty() {
            notes.one(what, "left out, since they stand at the end of no lane that is carried over");
            continue;
        }
        match config(light, of_light, scenario.step_s, begin) {
            Some(config) if found.len() < MAX_LIGHTS => {
                taken.extend(config.lanes.iter().cloned());
                found.push(config);
            }
            _ => notes.one(what, "left out, since they have no cycle"),
        }
    }
    found
}

fn config(light: &Light, lanes: Vec<String>, step_s: f64, begin: f64) -> Option<LightConfig> {
    let phase = |(colour, steps): &(_, f64)| {
        let duration_s = rounded(steps * step_s, 6);
        (PHASES_S[0]..=PHASES_S[1]).contains(&duration_s).then_some(LightPhase { colour: *colour, duration_s })
    };
    let phases: Vec<LightPhase> = light.phases.iter().filter_map(phase).take(MAX_LIGHTS).collect();
    let offset_s = rounded((light.offset - begin) * step_s, 6);
    let is_sound = light.is_active && !phases.is_empty() && offset_s.abs() <= MAX_OFFSET_S;
    let name: String =
        format!("light-{}", light.id).chars().filter(|c| c.is_ascii_alphanumeric() || *c == '-').collect();
    is_sound.then_some(LightConfig { name, lanes, phases, offset_s })
}
