//! Streets for which no planner was tuned: ordinary scenes, each drawn from a seed.
//!
//! `streets/ring/17` names the scenario number 17 of the kind `ring`, wherever a scenario can be named: in `run`,
//! `why`, plans of sweeps and `extends`. The same name always means the same file. If a kind is changed such that its
//! random draws change, it needs a new word, because rows of sweeps are compared by name.
//!
//! The ego of each street is a human of a random style; `--planner` gives it another driver. Most scenes contain a
//! conflict: a road user stands in the ego's lane, crosses, merges, comes towards the ego, or drives slowly ahead.

pub(crate) mod draft;
pub(crate) mod junctions;
mod lanes;
mod narrow_places;
mod obstacles;
mod passing;
pub(crate) mod queues;
mod surprises;

use draft::Draft;

use crate::text::name::fits;

/// One kind of street: its word, its description, and the function that draws a scene.
struct StreetKind {
    word: &'static str,
    shows: &'static str,
    draw: fn(&mut Draft),
}

/// Streets are drawn by the place of their kind in this list, so new kinds are added at its end.
const KINDS: [StreetKind; 30] = [
    StreetKind { word: "van", shows: "A van stands in the ego's lane", draw: obstacles::standing_van },
    StreetKind {
        word: "parked",
        shows: "Vans are parked along a street with oncoming traffic",
        draw: obstacles::parked_vans,
    },
    StreetKind { word: "bus", shows: "A bus stops, and goes on", draw: obstacles::bus },
    StreetKind {
        word: "crosser",
        shows: "A slow road user crosses the street and has priority",
        draw: obstacles::crosser,
    },
    StreetKind {
        word: "truck",
        shows: "A slow truck drives ahead on a road with two directions",
        draw: lanes::slow_truck,
    },
    StreetKind { word: "dense", shows: "The ego changes lanes in dense traffic", draw: lanes::dense },
    StreetKind { word: "drop", shows: "The ego's lane ends", draw: lanes::lane_drop },
    StreetKind { word: "ramp", shows: "The ego joins a motorway", draw: lanes::on_ramp },
    StreetKind { word: "narrow", shows: "Two directions share one lane", draw: junctions::narrow_passage },
    StreetKind { word: "ring", shows: "A roundabout with one lane", draw: junctions::ring },
    StreetKind { word: "ring2", shows: "A roundabout with two lanes", draw: junctions::wide_ring },
    StreetKind { word: "tee", shows: "A minor road joins a main one", draw: junctions::tee },
    StreetKind { word: "crossing", shows: "A minor road crosses a main one", draw: junctions::crossing },
    StreetKind { word: "equal", shows: "Four roads meet without signs: right before left", draw: junctions::equal },
    StreetKind { word: "stop", shows: "An all-way stop", draw: junctions::all_way_stop },
    StreetKind { word: "queue-light", shows: "Vehicles wait at a red light", draw: queues::light },
    StreetKind { word: "queue-zebra", shows: "Vehicles wait at a zebra crossing", draw: queues::zebra },
    StreetKind { word: "queue-turn", shows: "Vehicles wait behind one that turns left", draw: queues::turn },
    StreetKind {
        word: "keep-clear",
        shows: "The light is green, but the queue behind the junction stands",
        draw: queues::keep_clear,
    },
    StreetKind { word: "beside", shows: "A cyclist rides straight on beside the turning ego", draw: queues::beside },
    StreetKind { word: "gate", shows: "Two vans leave a gap that a car fits", draw: narrow_places::gate },
    StreetKind {
        word: "rows",
        shows: "Cars are parked on both sides, with traffic in both directions",
        draw: narrow_places::rows,
    },
    StreetKind { word: "head-on", shows: "An oncoming vehicle drives in the ego's lane", draw: surprises::head_on },
    StreetKind { word: "sudden-stop", shows: "The leader stops for no visible reason", draw: surprises::sudden_stop },
    StreetKind { word: "cut-in", shows: "A slower vehicle changes into the ego's lane", draw: surprises::cut_in },
    StreetKind { word: "child", shows: "A child runs out between parked cars", draw: surprises::child },
    StreetKind {
        word: "backing",
        shows: "A car backs out and stands across the ego's lane",
        draw: surprises::backing_out,
    },
    StreetKind { word: "overtake", shows: "A slow vehicle on a country road", draw: passing::overtake },
    StreetKind { word: "parallel", shows: "Dense traffic on parallel lanes", draw: passing::parallel },
    StreetKind { word: "two-lanes", shows: "The ego wants to be two lanes further", draw: passing::two_lanes },
];

/// The most numbers of each kind that a pattern stands for.
const MAX_NUMBERS: usize = 100_000;

/// The folder of names.
const FOLDER: &str = "streets/";

/// A street: a kind, and the number from which the rest is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Street {
    kind: usize,
    number: u32,
}

impl Street {
    /// The words of all kinds of streets.
    pub fn kinds() -> impl Iterator<Item = &'static str> {
        KINDS.iter().map(|kind| kind.word)
    }

    /// The street with a name such as `streets/ring/17`; `None` if the name is not that of a street.
    pub fn named(name: &str) -> Option<Street> {
        let (word, number) = name.strip_prefix(FOLDER)?.split_once('/')?;
        let kind = KINDS.iter().position(|kind| kind.word == word)?;
        let is_plain = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
        let number: u32 = is_plain.then(|| number.parse().ok())??;
        Some(Street { kind, number }).filter(|street| street.name() == name)
    }

    /// The streets of a pattern such as `streets/ring/0-19`, `streets/*/7` or `streets/t*/3`: of the kinds that fit, each number from the
    /// first to the last. Empty if it is not such a pattern.
    pub(crate) fn matching(pattern: &str) -> Vec<Street> {
        let Some((kinds, numbers)) = pattern.strip_prefix(FOLDER).and_then(|rest| rest.split_once('/')) else {
            return Vec::new();
        };
        let (first, last) = numbers.split_once('-').unwrap_or((numbers, numbers));
        let (Ok(first), Ok(last)) = (first.parse::<u32>(), last.parse::<u32>()) else { return Vec::new() };
        let fitting = (0..KINDS.len()).filter(|kind| fits(kinds, KINDS[*kind].word));
        fitting.flat_map(|kind| (first..=last).take(MAX_NUMBERS).map(move |number| Street { kind, number })).collect()
    }

    /// The name of the street.
    pub fn name(&self) -> String {
        format!("{FOLDER}{}/{}", KINDS[self.kind].word, self.number)
    }

    /// The text of the scenario file.
    pub fn text(&self) -> String {
        let kind = &KINDS[self.kind];
        let mut draft = Draft::new(u64::from(self.number), self.kind as u64);
        (kind.draw)(&mut draft);
        draft.finished(&format!("{} {}", kind.word, self.number), kind.shows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load;

    #[test]
    fn street_names_convert_to_streets_and_back() {
        for kind in Street::kinds() {
            let name = format!("streets/{kind}/12");
            assert_eq!(Street::named(&name).map(|street| street.name()), Some(name));
        }
        for wrong in ["streets/ring", "streets/ring/", "streets/ring/-1", "streets/ring/01", "streets/moon/1", "ring/1"]
        {
            assert_eq!(Street::named(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_street_pattern_covers_kinds_and_numbers() {
        let names = |pattern: &str| Street::matching(pattern).iter().map(Street::name).collect::<Vec<_>>();
        assert_eq!(names("streets/ring/3-5"), ["streets/ring/3", "streets/ring/4", "streets/ring/5"]);
        assert_eq!(names("streets/ring*/7"), ["streets/ring/7", "streets/ring2/7"]);
        assert_eq!(names("streets/*/0-1").len(), 2 * KINDS.len());
        for wrong in ["streets/ring/5-3", "streets/moon/1", "streets/ring", "streets/ring/x", "ring/1"] {
            assert!(names(wrong).is_empty(), "{wrong}");
        }
    }

    /// Every street loads without a fault, with an ego that moves.
    #[test]
    fn every_street_is_a_valid_scenario() {
        for kind in Street::kinds() {
            for number in 0..40 {
                let name = format!("streets/{kind}/{number}");
                let scenario = load(&name, &[]).unwrap_or_else(|error| panic!("{name}: {:?}", error.faults()));
                assert_eq!(scenario.ego().map(|ego| ego.name.as_str()), Some("ego"), "{name}");
                assert!(scenario.vehicles.len() >= 2, "{name}");
            }
        }
    }

    /// Draws differ from number to number, and are repeatable.
    #[test]
    fn different_numbers_give_different_streets() {
        let text = |name: &str| Street::named(name).expect("a street").text();
        assert_eq!(text("streets/tee/3"), text("streets/tee/3"));
        assert_ne!(text("streets/tee/3"), text("streets/tee/4"));
    }
}
