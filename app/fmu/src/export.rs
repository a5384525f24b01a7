//! Exports the building of a scenario as the bytes of an FMU.

use std::env::consts::{ARCH, OS};

use interplay_building::discretise::Model;
use interplay_scenarios::{BuildingPlant, Scenario};
use interplay_simulation::climate::surroundings_of;
use xxhash_rust::xxh3::xxh3_128;

use super::description::FmiVersion;
use crate::description::{self, Description};
use crate::error::FmuError;
use crate::resources::{OutsideSeries, archive, plant_text};

/// The shared library for the system that this crate was compiled for; empty if there is none.
const LIBRARY: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/library.bin"));
/// The name of the library, and of the model within the FMU.
const IDENTIFIER: &str = "interplay_building";
/// Most nodes; the size of the matrices is their square.
const MAX_NODES: usize = 500;
/// Most numbers of heat gains.
const MAX_WEATHER_NUMBERS: usize = 5_000_000;

/// The building of a loaded scenario as an FMU for co-simulation on the present system.
///
/// The same scenario gives the same bytes, and both versions of FMI compute the same values.
///
/// # Errors
/// [`FmuError`] if the scenario has no building, if it is too large, or if this build has no library.
pub fn export(scenario: &Scenario, version: FmiVersion) -> Result<Vec<u8>, FmuError> {
    let described = scenario.building.as_ref().ok_or(FmuError::NoBuilding)?;
    if !matches!(described.plant, BuildingPlant::Network(_)) {
        return Err(FmuError::Foreign);
    }
    let (folder, extension) = version
        .binary(OS, ARCH)
        .filter(|_| !LIBRARY.is_empty())
        .ok_or_else(|| FmuError::NoLibrary { platform: format!("{OS} on {ARCH}") })?;
    let network = described.network()?;
    let (nodes, zones) = (network.node_count(), network.zone_count());
    if nodes > MAX_NODES {
        return Err(FmuError::TooManyNodes { nodes, limit: MAX_NODES });
    }
    let (steps, days) = (described.steps_per_day(), scenario.days());
    let numbers = steps * days * zones;
    if numbers > MAX_WEATHER_NUMBERS {
        return Err(FmuError::TooMuchWeather { numbers, limit: MAX_WEATHER_NUMBERS });
    }
    let model = Model::new(&network, described.method, described.step_s)?;
    let outside = OutsideSeries::collect(&surroundings_of(scenario, &network), &model, steps, days);
    let numbers = plant_text(&model, described.initial_c, &outside);
    let guid = guid(&scenario.title, &numbers);
    let resources = format!("interplay-plant 1\nguid {guid}\n{numbers}");
    let described = Description {
        title: &scenario.title,
        identifier: IDENTIFIER,
        guid: &guid,
        zones: &network.names()[..zones],
        limits: network.limits(),
        step_s: described.step_s,
        stop_s: described.step_s * (steps * days) as f64,
    };
    Ok(archive(&[
        ("modelDescription.xml".to_owned(), description::xml(&described, version).as_bytes()),
        (format!("binaries/{folder}/{IDENTIFIER}.{extension}"), LIBRARY),
        ("resources/plant.txt".to_owned(), resources.as_bytes()),
    ]))
}

/// A GUID that depends on the content only.
fn guid(title: &str, numbers: &str) -> String {
    let digest = format!("{:032x}", xxh3_128(format!("{title}\n{numbers}").as_bytes()));
    let parts = [&digest[..8], &digest[8..12], &digest[12..16], &digest[16..20], &digest[20..]];
    format!("{{{}}}", parts.join("-"))
}
