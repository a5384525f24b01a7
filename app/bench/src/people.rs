//! The digest that pins the people, the set and the formula.
//!
//! Sixty calibration runs, five starts of each encounter, are made for their first seconds with the ego's own driver. Their digests, the
//! texts of their starts and the constants of the formula are hashed. A change of one of them needs a new minor version of the set:
//! the test of this module refuses to renew the golden file under the old one.

use interplay_scenarios::{ENCOUNTER_VERSION, Encounter, EncounterSplit, Registry};
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::error::BenchError;
use crate::start::loaded;
use crate::trace::trace;

/// The version and the digest of the calibration runs, as they are pinned.
pub const PEOPLE: &str = include_str!("../people.txt");

/// Starts of each encounter: all families are among them.
const STARTS: u32 = 5;
/// Simulated time of each run \[s\].
const RUN_S: f64 = 3.0;

/// The digest of the calibration runs of this program.
///
/// # Errors
/// If a run fails.
pub fn people_digest(registry: &Registry) -> Result<String, BenchError> {
    let one = |start: &Encounter| -> Result<String, BenchError> {
        let id = start.to_string();
        let scenario = loaded(registry, &id, &[])?;
        let run = trace(&scenario, RUN_S, None)
            .map_err(|reason| BenchError::Run { id: id.clone(), reason: Box::new(reason) })?;
        Ok(format!("{id} {:x} {}\n", Sha256::digest(start.text()), run.digest))
    };
    let starts: Vec<Encounter> = Encounter::all(EncounterSplit::Test).filter(|start| is_calibration(*start)).collect();
    let lines: Vec<String> = starts.par_iter().with_max_len(1).map(one).collect::<Result<_, _>>()?;
    let formula = include_str!("formula.rs");
    Ok(format!("{ENCOUNTER_VERSION} {:x}", Sha256::digest(format!("{}{formula}", lines.concat()))))
}

/// Starts of `test`, whose first six have all families; the sixth family negotiates, whose plans take longest, and is left out.
fn is_calibration(start: Encounter) -> bool {
    start.number() < STARTS
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `INTERPLAY_BLESS=1` renews the file, but only under another version of the set.
    #[test]
    fn people_set_and_formula_are_those_of_the_version() {
        let found = people_digest(Registry::standard()).expect("runs");
        if found == PEOPLE.trim() {
            return;
        }
        let is_other_version = PEOPLE.split_whitespace().next() != Some(ENCOUNTER_VERSION);
        if std::env::var_os("INTERPLAY_BLESS").is_some() && is_other_version {
            let path = concat!(env!("CARGO_MANIFEST_DIR"), "/people.txt");
            std::fs::write(path, format!("{found}\n")).expect("the file can be written");
            return;
        }
        panic!(
            "people, set or formula have changed: {found} instead of {PEOPLE}\nscores do not compare with earlier ones: give \
             ENCOUNTER_VERSION the next minor version, and renew the file with INTERPLAY_BLESS=1"
        );
    }
}
