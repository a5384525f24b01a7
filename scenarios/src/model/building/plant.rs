//! The system that the heat of a building's equipment acts on: our own network, or another program.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::boptest_plant::BoptestPlantConfig;

/// The system that a building's heat acts on; `kind` chooses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum BuildingPlant {
    /// The network of zones and walls that the file states, exactly.
    Network(NetworkPlantConfig),
    /// Another program, such as EnergyPlus, that answers each step over TCP. The network is then the controller's model only.
    Socket(SocketPlantConfig),
    /// A BOPTEST test case, behind its interface over HTTP or as an FMU. The network is then the controller's model only.
    Boptest(Box<BoptestPlantConfig>),
}

impl Default for BuildingPlant {
    fn default() -> Self {
        BuildingPlant::Network(NetworkPlantConfig {})
    }
}

/// The network has no settings besides its zones and walls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NetworkPlantConfig {}

/// The address of the other program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SocketPlantConfig {
    /// The host and the port, as `host:port`.
    #[schemars(example = &"127.0.0.1:7878")]
    pub address: String,
    /// The time limit for the other program to accept the connection, and for each answer \[s\].
    #[serde(default = "default_timeout_s")]
    #[schemars(range(min = 0.001, max = 86400.0), example = 10.0)]
    pub timeout_s: f64,
}

fn default_timeout_s() -> f64 {
    10.0
}

impl SocketPlantConfig {
    /// The fault of the address; `None` if it is a host and a port.
    pub(crate) fn address_fault(&self) -> Option<&'static str> {
        let Some((host, port)) = self.address.rsplit_once(':') else { return Some("it has no port") };
        let is_bracketed = host.starts_with('[') && host.ends_with(']') && host.len() > 2;
        let plain = |character: char| character.is_ascii_alphanumeric() || "-._".contains(character);
        match port.parse::<u16>() {
            _ if host.is_empty() => Some("it has no host"),
            _ if !is_bracketed && !host.chars().all(plain) => Some("the host is neither a name nor an IP address"),
            Err(_) | Ok(0) => Some("the port is not a whole number from 1 to 65535"),
            Ok(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(address: &str) -> Option<&'static str> {
        SocketPlantConfig { address: address.to_owned(), timeout_s: 1.0 }.address_fault()
    }

    #[test]
    fn a_socket_plant_address_is_a_host_and_a_port() {
        for sound in ["127.0.0.1:7878", "localhost:1", "plant.example:65535", "[::1]:7878"] {
            assert_eq!(fault(sound), None, "{sound}");
        }
        for bad in ["", "localhost", ":7878", "localhost:", "localhost:0", "localhost:65536", "a b:1", "::1:80", "x:-1"]
        {
            assert!(fault(bad).is_some(), "{bad}");
        }
    }
}
