//! The random draw of a street for each episode.

use interplay_common::random::Random;
use interplay_common::spelling::suggestion;
use interplay_scenarios::{LoadError, Scenario, ScenarioFile, Street};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::EnvironmentError;

/// Random stream of the streets.
const STREETS: u64 = 0x5374_7265;
/// Maximum number of draws until a street can be loaded.
const MOST_DRAWS: usize = 20;

/// The streets of an environment: each episode draws one of the generator's from its seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StreetDraw {
    /// The kinds of streets, such as `ring`; if empty, all kinds.
    pub kinds: Vec<String>,
    /// Probability with which each vehicle other than the ego is present, from 0 to 1.
    pub density: f64,
}

impl Default for StreetDraw {
    fn default() -> Self {
        StreetDraw { kinds: Vec::new(), density: 1.0 }
    }
}

impl StreetDraw {
    /// The fault of the settings, if there is one.
    pub(super) fn fault(&self) -> Option<String> {
        let known: Vec<&str> = Street::kinds().collect();
        if let Some(unknown) = self.kinds.iter().find(|kind| !known.contains(&kind.as_str())) {
            return Some(format!("there is no kind `{unknown}`; {}", suggestion(unknown, "the kinds are", &known)));
        }
        (!(0.0..=1.0).contains(&self.density)).then(|| format!("`density` is from 0 to 1, and not {}", self.density))
    }

    /// The name of the street of a seed, and its scenario.
    pub(super) fn drawn(&self, seed: u64) -> Result<(String, Scenario), EnvironmentError> {
        let mut random = Random::new(seed, STREETS);
        let mut refused = String::new();
        let own: Vec<&str> = self.kinds.iter().map(String::as_str).collect();
        let kinds = if own.is_empty() { Street::kinds().collect() } else { own };
        for _ in 0..MOST_DRAWS {
            let kind = kinds[random.uniform(0.0, kinds.len() as f64) as usize];
            let name = format!("streets/{kind}/{}", random.uniform(0.0, f64::from(u32::MAX)) as u32);
            match self.thinned(&name, &mut random) {
                Ok(scenario) => return Ok((name, scenario)),
                Err(error) => refused = format!("`{name}` is refused: {error}"),
            }
        }
        Err(EnvironmentError::Setting { setting: "streets", reason: refused })
    }

    /// A street with the share of its vehicles; all of them if the rest is not a valid scenario, such as one without a leader that a
    /// route needs.
    fn thinned(&self, name: &str, random: &mut Random) -> Result<Scenario, LoadError> {
        if self.density >= 1.0 {
            return interplay_scenarios::load(name, &[]);
        }
        let mut file = ScenarioFile::load(name, &[])?;
        file.vehicles.retain(|vehicle| vehicle.name == "ego" || random.chance(self.density));
        file.resolve().or_else(|_| interplay_scenarios::load(name, &[]))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn different_seeds_draw_different_streets() {
        let draw = StreetDraw::default();
        let names: BTreeSet<String> = (0..40).map(|seed| draw.drawn(seed).expect("a street").0).collect();
        assert_eq!(names.len(), 40);
        assert_eq!(draw.drawn(3).expect("a street"), draw.drawn(3).expect("a street"));
    }

    #[test]
    fn kinds_and_density_limit_the_draw() {
        let rings = |density| StreetDraw { kinds: vec!["ring".to_owned()], density };
        let vehicles = |density: f64| -> usize {
            let drawn = |seed| rings(density).drawn(seed).expect("a street");
            assert!((0..10).all(|seed| drawn(seed).0.starts_with("streets/ring/")));
            (0..10).map(|seed| drawn(seed).1.vehicles.len()).sum()
        };
        assert!(vehicles(0.0) < vehicles(0.5) && vehicles(0.5) < vehicles(1.0));
        assert_eq!(rings(2.0).fault().as_deref(), Some("`density` is from 0 to 1, and not 2"));
        let unknown = StreetDraw { kinds: vec!["rign".to_owned()], density: 1.0 };
        assert!(unknown.fault().is_some_and(|fault| fault.contains("`ring`")));
    }
}
