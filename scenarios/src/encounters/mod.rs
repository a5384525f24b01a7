//! Encounters 1 (EN1): starts of a benchmark in which the ego reaches a conflict together with others that react.
//!
//! `EN1/test/merge-dense/017:people` names the start number 17 of the encounter `merge-dense` in the split `test`, whose other vehicles
//! are of the family `people`. A name can be used wherever a scenario can be named, and always means the same file of the same minor
//! version. The times at which the ego and the others reach the conflict zone are drawn to meet; streams of others end, so that waiting is
//! always possible and costs time.

mod cast;
mod junctions;
mod merging;
mod streets;

use std::fmt;
use std::str::FromStr;

use sha2::{Digest, Sha256};

use crate::streets::draft::Draft;
use cast::Cast;

/// The set with its minor version: scores compare within one minor version only.
pub const ENCOUNTER_VERSION: &str = "EN1.0";

/// The set in names.
const SET: &str = "EN1";

/// What the seeds of `sealed` depend on: the set, the formula, the sources of the planners and the pins of rivals, and the round.
pub const ENCOUNTER_MANIFEST: &str = include_str!("../../encounters/manifest.toml");

/// One kind of encounter: its word, its description, and the function that draws a start.
struct EncounterKind {
    word: &'static str,
    shows: &'static str,
    draw: fn(&mut Cast),
}

/// Seeds follow from the words, so the order is only that of tables.
const KINDS: [EncounterKind; 12] = [
    EncounterKind { word: "merge-dense", shows: "The ego joins dense traffic from a ramp", draw: merging::merge_dense },
    EncounterKind { word: "lane-end", shows: "The ego's lane ends beside a stream", draw: merging::lane_end },
    EncounterKind { word: "zipper", shows: "Two slow queues become one", draw: merging::zipper },
    EncounterKind { word: "exit-across", shows: "The ego's exit lies across a stream", draw: merging::exit_across },
    EncounterKind {
        word: "left-turn",
        shows: "The ego turns left across oncoming traffic",
        draw: junctions::left_turn,
    },
    EncounterKind {
        word: "crossing-priority",
        shows: "The ego crosses a main road with traffic in both directions",
        draw: junctions::crossing_priority,
    },
    EncounterKind {
        word: "crossing-equal",
        shows: "Roads meet without signs: right before left",
        draw: junctions::crossing_equal,
    },
    EncounterKind {
        word: "narrow-queue",
        shows: "A queue comes through a passage for one vehicle",
        draw: streets::narrow_queue,
    },
    EncounterKind { word: "roundabout", shows: "The ego enters a busy roundabout", draw: junctions::roundabout },
    EncounterKind {
        word: "double-parked",
        shows: "Vans stand in the ego's lane, and traffic comes the other way",
        draw: streets::double_parked,
    },
    EncounterKind { word: "t-fast", shows: "The ego turns onto a fast road", draw: junctions::t_fast },
    EncounterKind {
        word: "zebra-stream",
        shows: "A stream of pedestrians uses a zebra crossing",
        draw: streets::zebra_stream,
    },
];

/// A part of the set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EncounterSplit {
    /// For development: planners may be tuned on it.
    Dev,
    /// For published scores.
    Test,
    /// The same with seeds that follow from the frozen manifest.
    Sealed,
}

impl EncounterSplit {
    /// All splits.
    pub const ALL: [EncounterSplit; 3] = [EncounterSplit::Dev, EncounterSplit::Test, EncounterSplit::Sealed];

    /// Its word in names.
    pub fn word(self) -> &'static str {
        match self {
            EncounterSplit::Dev => "dev",
            EncounterSplit::Test => "test",
            EncounterSplit::Sealed => "sealed",
        }
    }

    /// Number of starts of each encounter.
    pub fn starts(self) -> u32 {
        match self {
            EncounterSplit::Dev => 40,
            EncounterSplit::Test => 100,
            EncounterSplit::Sealed => 50,
        }
    }

    /// The families of its starts, in turn; two are not in `dev`.
    pub fn families(self) -> &'static [PartnerFamily] {
        let all = &PartnerFamily::ALL;
        if self == EncounterSplit::Dev { &all[..4] } else { all }
    }
}

impl FromStr for EncounterSplit {
    type Err = String;

    fn from_str(text: &str) -> Result<EncounterSplit, String> {
        let known = || "splits are dev, test and sealed".to_owned();
        EncounterSplit::ALL.into_iter().find(|split| split.word() == text).ok_or_else(known)
    }
}

/// What drives the vehicles that the ego meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PartnerFamily {
    /// People of the continuum from nice to tough.
    People,
    /// People as measured on real roads.
    Measured,
    /// IDM with MOBIL.
    Idm,
    /// Vehicles that keep lane and speed and do not react.
    Keeper,
    /// People that react and decide late. Not in `dev`.
    Erratic,
    /// Vehicles that negotiate themselves. Not in `dev`.
    Negotiating,
}

impl PartnerFamily {
    /// All families, those of every split first.
    pub const ALL: [PartnerFamily; 6] = [
        PartnerFamily::People,
        PartnerFamily::Measured,
        PartnerFamily::Idm,
        PartnerFamily::Keeper,
        PartnerFamily::Erratic,
        PartnerFamily::Negotiating,
    ];

    /// Its word in names.
    pub fn word(self) -> &'static str {
        match self {
            PartnerFamily::People => "people",
            PartnerFamily::Measured => "measured",
            PartnerFamily::Idm => "idm",
            PartnerFamily::Keeper => "keeper",
            PartnerFamily::Erratic => "erratic",
            PartnerFamily::Negotiating => "negotiating",
        }
    }
}

/// A start of the benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Encounter {
    split: EncounterSplit,
    kind: usize,
    number: u32,
}

impl Encounter {
    /// The words of all encounters.
    pub fn kinds() -> impl Iterator<Item = &'static str> {
        KINDS.iter().map(|kind| kind.word)
    }

    /// All starts of a split, encounter by encounter.
    pub fn all(split: EncounterSplit) -> impl Iterator<Item = Encounter> {
        (0..KINDS.len()).flat_map(move |kind| (0..split.starts()).map(move |number| Encounter { split, kind, number }))
    }

    /// The start with a name such as `EN1/dev/zipper/003:keeper`; `None` if the name is not that of a start.
    pub fn named(name: &str) -> Option<Encounter> {
        let mut parts = name.strip_prefix(SET)?.strip_prefix('/')?.split('/');
        let split: EncounterSplit = parts.next()?.parse().ok()?;
        let word = parts.next()?;
        let kind = KINDS.iter().position(|kind| kind.word == word)?;
        let number = parts.next()?.split_once(':')?.0.parse().ok()?;
        Some(Encounter { split, kind, number }).filter(|start| number < split.starts() && start.to_string() == name)
    }

    /// Its split.
    pub fn split(&self) -> EncounterSplit {
        self.split
    }

    /// The word of its encounter.
    pub fn kind(&self) -> &'static str {
        KINDS[self.kind].word
    }

    /// Its number within the encounter.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// The family of the other vehicles.
    pub fn family(&self) -> PartnerFamily {
        let families = self.split.families();
        families[self.number as usize % families.len()]
    }

    /// The seed of everything that is drawn: the first eight bytes of a SHA-256.
    fn seed(&self) -> u64 {
        let secret = match self.split {
            EncounterSplit::Sealed => format!("{}/", sealed_prefix(ENCOUNTER_MANIFEST)),
            EncounterSplit::Dev | EncounterSplit::Test => format!("{SET}/{}/", self.split.word()),
        };
        let digest = Sha256::digest(format!("{secret}{}/{}", self.kind(), self.number));
        let mut first = [0; 8];
        first.copy_from_slice(&digest[..8]);
        u64::from_le_bytes(first)
    }

    /// The text of the scenario file.
    pub fn text(&self) -> String {
        let (kind, seed) = (&KINDS[self.kind], self.seed());
        let mut cast = Cast::new(Draft::new(seed, 0), self.family());
        (kind.draw)(&mut cast);
        // Vehicles leave where their routes end, so that no queue forms there.
        let text = cast.finished(&self.to_string(), kind.shows).replacen(
            "[defaults]\n",
            "[defaults]\nleaves_at_end = true\n",
            1,
        );
        // Numbers of a file are at most those of a signed integer of 64 bits.
        format!("seed = {}\n{text}", seed >> 1)
    }
}

impl fmt::Display for Encounter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (split, word, family) = (self.split.word(), self.kind(), self.family().word());
        write!(f, "{SET}/{split}/{word}/{:03}:{family}", self.number)
    }
}

/// `EN1/sealed/`, the round, and the digest of the manifest.
fn sealed_prefix(manifest: &str) -> String {
    let round = manifest.lines().find_map(|line| line.strip_prefix("round = ")).unwrap_or("0");
    format!("{SET}/sealed/{round}/{:x}", Sha256::digest(manifest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load;

    #[test]
    fn names_convert_to_starts_and_back() {
        for split in EncounterSplit::ALL {
            assert_eq!(Encounter::all(split).count(), 12 * split.starts() as usize);
            for start in Encounter::all(split) {
                assert_eq!(Encounter::named(&start.to_string()), Some(start));
            }
        }
        for wrong in [
            "EN1/dev/zipper/003",
            "EN1/dev/zipper/003:people",
            "EN1/dev/zipper/3:keeper",
            "EN1/dev/zipper/040:people",
            "EN1/no/zipper/003:keeper",
            "EN2/dev/zipper/003:keeper",
            "EN1/dev/moon/003:keeper",
        ] {
            assert_eq!(Encounter::named(wrong), None, "{wrong}");
        }
    }

    /// Every start of every split loads, and the ego is at most 15 s from the conflict.
    #[test]
    fn every_start_is_a_valid_scenario() {
        for split in EncounterSplit::ALL {
            for start in Encounter::all(split) {
                let name = start.to_string();
                let scenario = load(&name, &[]).unwrap_or_else(|error| panic!("{name}: {:?}", error.faults()));
                assert_eq!(scenario.ego().map(|ego| ego.name.as_str()), Some("ego"), "{name}");
                assert!(scenario.vehicles.len() >= 3, "{name}");
            }
        }
    }

    /// Another round or another manifest gives other sealed starts.
    #[test]
    fn sealed_seeds_depend_on_the_round_and_the_manifest() {
        let prefix = |text: &str| sealed_prefix(text);
        assert_ne!(prefix("round = 1\n"), prefix("round = 2\n"));
        assert_ne!(prefix("round = 1\n"), prefix("round = 1\n\n"));
        assert!(prefix("round = 7\n").starts_with("EN1/sealed/7/"));
    }
}
