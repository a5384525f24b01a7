//! The effects of signs on lanes: speed limits, and right of way at their ends.

use std::collections::BTreeMap;

use interplay_planners::road::network::{LightPhase, RightOfWay};

use super::super::model::{CommonRoad, Lanelet, Light, SignMeaning};
use super::lanes::Lanes;
use super::notes::{NOT_YET, Notes};
use super::vehicles::rounded;
use crate::model::traffic::light::LightConfig;

/// The signs of a scenario, by id, and the approaches of all-way stops.
pub(super) struct Signs<'a> {
    meanings: BTreeMap<&'a str, &'a [SignMeaning]>,
    /// Lanelets that lead into an intersection with a stop sign on every approach.
    all_stop: Vec<&'a str>,
}

impl<'a> Signs<'a> {
    /// Sorts the signs of a scenario, and notes those without effect on a lane.
    pub(super) fn of(scenario: &'a CommonRoad<'_>, notes: &mut Notes) -> Signs<'a> {
        let meanings: BTreeMap<&str, &[SignMeaning]> =
            scenario.signs.iter().map(|sign| (sign.id.as_str(), sign.meanings.as_slice())).collect();
        for meaning in scenario.signs.iter().flat_map(|sign| &sign.meanings) {
            if let SignMeaning::Other(number) = meaning {
                let shown: String = number.chars().filter(|c| c.is_ascii_graphic()).take(20).collect();
                notes.one([&format!("sign `{shown}`"), &format!("signs `{shown}`")], NOT_YET);
            }
        }
        let mut signs = Signs { meanings, all_stop: Vec::new() };
        let lanelet = |id: &String| scenario.lanelets.iter().find(|lanelet| lanelet.id == *id);
        for intersection in &scenario.intersections {
            let stops = |approach: &Vec<String>| {
                approach.iter().filter_map(lanelet).any(|lanelet| signs.says(lanelet, &SignMeaning::Stop))
            };
            if intersection.incoming.len() > 2 && intersection.incoming.iter().all(stops) {
                signs.all_stop.extend(intersection.incoming.iter().flatten().map(String::as_str));
            }
        }
        signs
    }

    fn on<'b>(&'b self, lanelet: &'b Lanelet<'_>) -> impl Iterator<Item = &'a SignMeaning> + 'b {
        lanelet.signs.iter().filter_map(|id| self.meanings.get(id.as_str())).flat_map(|meanings| meanings.iter())
    }

    fn says(&self, lanelet: &Lanelet<'_>, meaning: &SignMeaning) -> bool {
        self.on(lanelet).any(|said| said == meaning)
    }

    /// The lowest speed limit on a lanelet \[m/s\].
    pub(super) fn speed_limit_mps(&self, lanelet: &Lanelet<'_>) -> Option<f64> {
        let limits = self.on(lanelet).filter_map(|meaning| match meaning {
            SignMeaning::SpeedLimit(limit_mps) => Some(*limit_mps),
            _ => None,
        });
        let positive = lanelet.speed_limit_mps.filter(|limit_mps| *limit_mps >= 0.001);
        limits.chain(positive).min_by(f64::total_cmp).map(|limit_mps| (100.0 * limit_mps).round() / 100.0)
    }

    /// The right of way at the end of a lanelet.
    pub(super) fn right_of_way(&self, lanelet: &Lanelet<'_>) -> RightOfWay {
        if self.all_stop.contains(&lanelet.id.as_str()) {
            RightOfWay::AllWayStop
        } else if self.says(lanelet, &SignMeaning::Stop) {
            RightOfWay::Stop
        } else if self.says(lanelet, &SignMeaning::Yield) {
            RightOfWay::Yield
        } else {
            RightOfWay::Priority
        }
    }
}

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
