//! The effects of signs on lanes: speed limits, and right of way at their ends.

use std::collections::BTreeMap;

use interplay_planners::road::network::RightOfWay;

use super::super::model::{CommonRoad, Lanelet, SignMeaning};
use super::notes::{NOT_YET, Notes};

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
        if self.all_stop.contains(&lanelet.id.as_str()) || self.says(lanelet, &SignMeaning::AllWayStop) {
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
