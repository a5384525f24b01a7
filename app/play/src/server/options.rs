//! What is served, and where.

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

use interplay_scenarios::Registry;

/// How a scenario is served.
#[derive(Clone, Debug)]
pub struct ServeOptions {
    /// The address; by default that of this machine alone.
    pub address: IpAddr,
    /// The port; 0 takes a free one.
    pub port: u16,
    /// The scenario that is played first and its seat; none for the menu.
    pub chosen: Option<(String, String)>,
    /// A second seat, for a second page.
    pub joined: Option<String>,
    /// Where what is played is kept.
    pub folder: PathBuf,
    /// The kinds of drivers and metrics.
    pub registry: Registry,
}

impl ServeOptions {
    /// A server for this machine alone, on a free port.
    pub fn new(registry: &Registry) -> ServeOptions {
        ServeOptions {
            address: Ipv4Addr::LOCALHOST.into(),
            port: 0,
            chosen: None,
            joined: None,
            folder: PathBuf::from("played"),
            registry: registry.clone(),
        }
    }
}
