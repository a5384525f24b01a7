//! The menu of scenarios that can be played.

use interplay_scenarios::{Registry, embedded};

use crate::protocol::{MenuFamily, MenuScenario};
use crate::session::seats_of;

/// The scenarios with vehicles that a person can drive, by family.
#[derive(Clone, Debug)]
pub(crate) struct Menu {
    pub families: Vec<MenuFamily>,
}

impl Menu {
    /// The menu of the scenarios in the binary.
    pub fn of(registry: &Registry) -> Menu {
        let mut families: Vec<MenuFamily> = Vec::new();
        for file in embedded() {
            let Ok(scenario) = registry.load(file.name, &[]) else { continue };
            let seats = seats_of(&scenario);
            if seats.is_empty() {
                continue;
            }
            let family = file.name.split('/').next().unwrap_or(file.name);
            let entry =
                MenuScenario { name: file.name.to_owned(), title: scenario.title, shows: scenario.shows, seats };
            match families.last_mut().filter(|last| last.family == family) {
                Some(last) => last.scenarios.push(entry),
                None => families.push(MenuFamily {
                    family: family.to_owned(),
                    title: entry.title.clone(),
                    scenarios: vec![entry],
                }),
            }
        }
        Menu { families }
    }

    /// The scenario after the named one, and its first seat. The first scenario follows the last.
    pub fn after(&self, name: &str) -> Option<(String, String)> {
        let all: Vec<&MenuScenario> = self.families.iter().flat_map(|family| &family.scenarios).collect();
        let next = all.iter().position(|entry| entry.name == name).map_or(0, |place| (place + 1) % all.len());
        all.get(next).map(|entry| (entry.name.clone(), entry.seats[0].clone()))
    }
}
