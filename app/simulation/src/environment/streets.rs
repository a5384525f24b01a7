//! The random draw of a street, or of a scenario of a list, for each episode.

use interplay_common::random::Random;
use interplay_common::spelling::suggestion;
use interplay_scenarios::{LoadError, Override, Scenario, ScenarioFile, Street};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::EnvironmentError;

/// Random stream of the streets.
const STREETS: u64 = 0x5374_7265;
/// Maximum number of draws until a street can be loaded.
const MOST_DRAWS: usize = 20;

/// The streets of an environment: each episode draws one of the generator's, or a scenario of a list, from its seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StreetDraw {
    /// The kinds of streets, such as `ring`; if empty, all kinds.
    pub kinds: Vec<String>,
    /// Names or paths of scenarios, of which each episode draws one, and a seed for its flows; if empty, streets of the generator are drawn.
    pub scenarios: Vec<String>,
    /// Changes of each drawn scenario, as `--set` takes them.
    pub set: Vec<String>,
    /// Probability with which each vehicle other than the ego is present, from 0 to 1.
    pub density: f64,
}

impl Default for StreetDraw {
    fn default() -> Self {
        StreetDraw { kinds: Vec::new(), scenarios: Vec::new(), set: Vec::new(), density: 1.0 }
    }
}

impl StreetDraw {
    /// The fault of the settings, if there is one.
    pub(super) fn fault(&self) -> Option<String> {
        let known: Vec<&str> = Street::kinds().collect();
        if let Some(unknown) = self.kinds.iter().find(|kind| !known.contains(&kind.as_str())) {
            return Some(format!("`{unknown}` is not a kind; {}", suggestion(unknown, "the kinds are", &known)));
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
            let mut changes: Vec<Override> = self.set.iter().cloned().map(Override::Set).collect();
            let place = |random: &mut Random, count: usize| random.uniform(0.0, count as f64) as usize;
            let listed =
                (!self.scenarios.is_empty()).then(|| &self.scenarios[place(&mut random, self.scenarios.len())]);
            let kind = place(&mut random, kinds.len());
            let number = random.uniform(0.0, f64::from(u32::MAX)) as u32;
            changes.extend(listed.map(|_| Override::Seed(number.into())));
            let name = listed.cloned().unwrap_or_else(|| format!("streets/{}/{number}", kinds[kind]));
            match self.thinned(&name, &changes, &mut random) {
                Ok(scenario) => return Ok((name, scenario)),
                Err(error) => refused = format!("`{name}` is refused: {error}"),
            }
        }
        Err(EnvironmentError::Setting { setting: "streets", reason: refused })
    }

    /// A scenario with the share of its vehicles; all of them if the rest is not a valid scenario, such as one without a leader that a
    /// route needs.
    fn thinned(&self, name: &str, changes: &[Override], random: &mut Random) -> Result<Scenario, LoadError> {
        if self.density >= 1.0 {
            return interplay_scenarios::load(name, changes);
        }
        let mut file = ScenarioFile::load(name, changes)?;
        file.vehicles.retain(|vehicle| vehicle.name == "ego" || random.chance(self.density));
        file.resolve().or_else(|_| interplay_scenarios::load(name, changes))
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
    fn scenarios_of_a_list_are_drawn_with_their_changes() {
        let scenarios = vec!["lane-change/front-nice".to_owned(), "lane-change/front-tough".to_owned()];
        let draw = StreetDraw { scenarios, set: vec!["duration_s=3.0".to_owned()], ..StreetDraw::default() };
        let drawn: Vec<(String, Scenario)> = (0..20).map(|seed| draw.drawn(seed).expect("a scenario")).collect();
        assert_eq!(drawn.iter().map(|(name, _)| name).collect::<BTreeSet<_>>().len(), 2);
        assert!(drawn.iter().all(|(_, scenario)| scenario.duration_s == 3.0));
    }

    #[test]
    fn kinds_and_density_limit_the_draw() {
        let rings = |density| StreetDraw { kinds: vec!["ring".to_owned()], density, ..StreetDraw::default() };
        let vehicles = |density: f64| -> usize {
            let drawn = |seed| rings(density).drawn(seed).expect("a street");
            assert!((0..10).all(|seed| drawn(seed).0.starts_with("streets/ring/")));
            (0..10).map(|seed| drawn(seed).1.vehicles.len()).sum()
        };
        assert!(vehicles(0.0) < vehicles(0.5) && vehicles(0.5) < vehicles(1.0));
        assert_eq!(rings(2.0).fault().as_deref(), Some("`density` is from 0 to 1, and not 2"));
        let unknown = StreetDraw { kinds: vec!["rign".to_owned()], ..StreetDraw::default() };
        assert!(unknown.fault().is_some_and(|fault| fault.contains("`ring`")));
    }
}
