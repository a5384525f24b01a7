//! The key of a run.

use std::fmt;
use std::str::FromStr;

use interplay_scenarios::{SweepPlan, SweepPoint};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use sha2::{Digest, Sha256};

/// Digest of all that determines the result of a run: the program's version, the scenario, the changes to it, and the seed.
/// The first half of a SHA-256.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RunKey([u8; 16]);

impl RunKey {
    /// The key of a run.
    pub fn of(plan: &SweepPlan, point: &SweepPoint) -> RunKey {
        let parts = [&program_version(), plan.canonical_scenario(point), &plan.canonical_changes(point)];
        RunKey::of_parts(&parts)
    }

    /// The key of a list of texts.
    pub fn of_parts(parts: &[&str]) -> RunKey {
        let mut digest = Sha256::new();
        for part in parts {
            // The lengths make different lists of parts different inputs.
            digest.update((part.len() as u64).to_le_bytes());
            digest.update(part.as_bytes());
        }
        let mut key = [0; 16];
        key.copy_from_slice(&digest.finalize()[..16]);
        RunKey(key)
    }

    /// The key as a number, evenly distributed.
    pub(crate) fn number(self) -> u128 {
        u128::from_be_bytes(self.0)
    }
}

impl fmt::Display for RunKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for RunKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for RunKey {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<RunKey, Self::Err> {
        const REFUSED: &str = "a key has 32 hexadecimal digits";
        if text.len() != 32 || !text.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(REFUSED);
        }
        u128::from_str_radix(text, 16).map(|number| RunKey(number.to_be_bytes())).map_err(|_| REFUSED)
    }
}

impl Serialize for RunKey {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for RunKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<RunKey, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

/// The version of the package and a digest of the sources that compute a run.
pub fn program_version() -> String {
    format!("{}+{}", env!("CARGO_PKG_VERSION"), env!("INTERPLAY_SOURCES"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn run_keys_read_back_exactly_and_depend_on_part_boundaries() {
        let key = RunKey::of_parts(&["ab", "c"]);
        assert_eq!(key.to_string().parse(), Ok(key));
        assert_ne!(key, RunKey::of_parts(&["a", "bc"]));
        for wrong in ["", "12", &"g".repeat(32), &"ä".repeat(16)] {
            assert!(wrong.parse::<RunKey>().is_err(), "{wrong}");
        }
    }
}
