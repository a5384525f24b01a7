//! The splits of the set, and the families of the vehicles that the ego meets.

use std::str::FromStr;

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
        ["dev", "test", "sealed"][self as usize]
    }

    /// Number of starts of each encounter.
    pub fn starts(self) -> u32 {
        [40, 100, 50][self as usize]
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
        ["people", "measured", "idm", "keeper", "erratic", "negotiating"][self as usize]
    }
}
