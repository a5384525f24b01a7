//! Encounters 1 (EN1): starts of a benchmark in which the ego reaches a conflict together with others that react.
//!
//! `EN1/test/merge-dense/017:people` names the start number 17 of the encounter `merge-dense` in the split `test`, whose other vehicles
//! are of the family `people`. A name can be used wherever a scenario can be named, and always means the same file of the same minor
//! version. The times at which the ego and the others reach the conflict zone are drawn to meet; streams of others end, so that waiting is
//! always possible and costs time.

mod cast;
mod families;
mod junctions;
mod merging;
mod streets;

use std::fmt;

use sha2::{Digest, Sha256};

use crate::streets::draft::Draft;
use cast::Cast;
pub use families::{EncounterSplit, PartnerFamily};

/// The set with its minor version: scores compare within one minor version only.
pub const ENCOUNTER_VERSION: &str = "EN1.0";

/// The set in names.
const SET: &str = "EN1";

/// What the seeds of `sealed` depend on: the set, the formula, the sources of the planners and the pins of rivals, and the round.
pub const ENCOUNTER_MANIFEST: &str = include_str!("../../encounters/manifest.toml");

/// An encounter: its word, its description, and the function that draws a start.
type Kind = (&'static str, &'static str, fn(&mut Cast));

/// Seeds follow from the words, so the order is only that of tables.
const KINDS: [Kind; 12] = [
    ("merge-dense", "The ego joins dense traffic from a ramp", merging::merge_dense),
    ("lane-end", "The ego's lane ends beside a stream", merging::lane_end),
    ("zipper", "Two slow queues become one", merging::zipper),
    ("exit-across", "The ego's exit lies across a stream", merging::exit_across),
    ("left-turn", "The ego turns left across oncoming traffic", junctions::left_turn),
    ("crossing-priority", "The ego crosses a main road with traffic in both directions", junctions::crossing_priority),
    ("crossing-equal", "Roads meet without signs: right before left", junctions::crossing_equal),
    ("narrow-queue", "A queue comes through a passage for one vehicle", streets::narrow_queue),
    ("roundabout", "The ego enters a busy roundabout", junctions::roundabout),
    ("double-parked", "Vans stand in the ego's lane, and traffic comes the other way", streets::double_parked),
    ("t-fast", "The ego turns onto a fast road", junctions::t_fast),
    ("zebra-stream", "A stream of pedestrians uses a zebra crossing", streets::zebra_stream),
];

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
        KINDS.iter().map(|(word, ..)| *word)
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
        let kind = KINDS.iter().position(|kind| kind.0 == word)?;
        let number = parts.next()?.split_once(':')?.0.parse().ok()?;
        Some(Encounter { split, kind, number }).filter(|start| number < split.starts() && start.to_string() == name)
    }

    /// Its split.
    pub fn split(&self) -> EncounterSplit {
        self.split
    }

    /// The word of its encounter.
    pub fn kind(&self) -> &'static str {
        KINDS[self.kind].0
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
        let ((_, shows, draw), seed) = (KINDS[self.kind], self.seed());
        let mut cast = Cast::new(Draft::new(seed, 0), self.family());
        draw(&mut cast);
        // Vehicles leave where their routes end, so that no queue forms there.
        let text =
            cast.finished(&self.to_string(), shows).replacen("[defaults]\n", "[defaults]\nleaves_at_end = true\n", 1);
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
