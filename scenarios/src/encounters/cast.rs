//! A start under construction: the draft, and the vehicles of its family.

use super::families::PartnerFamily;
use crate::streets::draft::{Draft, Draftee, SCRIPTED};

/// Vehicles of one lane that reach a place one after the other.
pub(super) struct Stream<'a> {
    /// Beginning of their names.
    pub prefix: &'a str,
    pub lane: &'a str,
    /// The lane to which they drive; `None` if their route is unique.
    pub to: Option<&'a str>,
    /// Arc length of the conflict along the lane \[m\].
    pub place_m: f64,
    pub speed_mps: f64,
    /// When the first of them is there \[s\].
    pub from_s: f64,
    /// Bounds of the time from one to the next \[s\].
    pub headway_s: [f64; 2],
    pub count: usize,
}

/// A start under construction.
pub(super) struct Cast {
    pub draft: Draft,
    family: PartnerFamily,
}

/// Vehicles start at least this far along their lane \[m\].
const FIRST_M: f64 = 6.0;

impl Cast {
    pub fn new(mut draft: Draft, family: PartnerFamily) -> Cast {
        draft.duration_s = 70.0;
        Cast { draft, family }
    }

    pub fn is_of_keepers(&self) -> bool {
        self.family == PartnerFamily::Keeper
    }

    /// The driver of one other vehicle.
    fn driver(&mut self) -> String {
        let weight = |draft: &mut Draft, low: f64, high: f64| {
            // Tenths of the logarithm of the safety weight.
            libm::pow(10.0, draft.between(libm::log10(low), libm::log10(high)))
        };
        match self.family {
            PartnerFamily::People => {
                format!("{{ kind = \"human\", safety_weight = {:.2} }}", weight(&mut self.draft, 0.1, 50.0))
            }
            PartnerFamily::Measured => "{ kind = \"human\", style = \"measured\" }".to_owned(),
            PartnerFamily::Idm => "{ kind = \"idm\" }".to_owned(),
            PartnerFamily::Keeper => SCRIPTED.to_owned(),
            PartnerFamily::Erratic => {
                let safety_weight = weight(&mut self.draft, 0.1, 20.0);
                let (reaction_s, hesitation_s) = (self.draft.between(1.2, 1.8), self.draft.between(0.6, 1.4));
                format!(
                    "{{ kind = \"human\", safety_weight = {safety_weight:.2}, reaction_s = {reaction_s:.1}, \
                     hesitation_s = {hesitation_s:.1} }}"
                )
            }
            PartnerFamily::Negotiating => "{ kind = \"negotiation\" }".to_owned(),
        }
    }

    /// Adds the ego, which reaches a place of its lane after a time if it keeps its speed.
    pub fn ego(&mut self, lane: &str, to: &str, place_m: f64, [speed_mps, wanted_mps]: [f64; 2], in_s: f64) {
        let along_m = (place_m - speed_mps * in_s).max(FIRST_M);
        let driver = Some("{ kind = \"human\", style = \"normal\" }".to_owned());
        let (name, class, to) = ("ego", "car", Some(to));
        self.draft.vehicle(Draftee { name, class, lane, along_m, speed_mps, to, wanted_mps, driver });
    }

    /// Adds one vehicle of the family.
    pub fn partner(&mut self, name: &str, lane: &str, to: Option<&str>, along_m: f64, speed_mps: f64) {
        let driver = Some(self.driver());
        self.draft.vehicle(Draftee { name, class: "car", lane, along_m, speed_mps, to, wanted_mps: speed_mps, driver });
    }

    /// Adds a stream, as far as its lane is long enough.
    pub fn stream(&mut self, stream: &Stream<'_>) {
        let Stream { prefix, lane, to, place_m, speed_mps, mut from_s, headway_s, count } = *stream;
        for number in 0..count {
            let along_m = place_m - speed_mps * from_s;
            if along_m < FIRST_M {
                return;
            }
            self.partner(&format!("{prefix}-{number}"), lane, to, along_m, speed_mps);
            from_s += self.draft.between(headway_s[0], headway_s[1]);
        }
    }

    /// In a third of the starts, adds a vehicle that follows the ego, which is then in its way while it waits.
    pub fn follower(&mut self, lane: &str, to: &str, ego_along_m: f64, speed_mps: f64) {
        let gap_m = 4.6 + self.draft.between(1.4, 2.4) * speed_mps;
        let is_there = self.draft.chance(1.0 / 3.0);
        if is_there && ego_along_m - gap_m > FIRST_M && !self.is_of_keepers() {
            self.partner("follower", lane, Some(to), ego_along_m - gap_m, speed_mps);
        }
    }

    pub fn finished(self, title: &str, shows: &str) -> String {
        self.draft.finished(title, shows)
    }
}
