//! The faults that all consistency checks collect, each at its place in the file.

use crate::format::read::tree::TomlNode;
use crate::model::scenario::Scenario;
use crate::text::error::{Fault, Place};

/// A scenario under check, with the faults found so far.
pub(super) struct Checker<'a> {
    /// The values of the files and flags.
    pub scenario: &'a Scenario,
    /// The places of these values.
    pub tree: &'a TomlNode,
    /// The faults.
    pub faults: Vec<Fault>,
}

impl<'a> Checker<'a> {
    /// A check without faults so far.
    pub fn new(scenario: &'a Scenario, tree: &'a TomlNode) -> Self {
        Checker { scenario, tree, faults: Vec::new() }
    }

    /// The path of a vehicle or an obstacle, by its number among all.
    pub fn path(&self, index: usize) -> String {
        let vehicles = self.scenario.vehicles.iter().filter(|vehicle| vehicle.obstacle.is_none()).count();
        index.checked_sub(vehicles).map_or_else(|| format!("vehicle.{index}"), |index| format!("obstacle.{index}"))
    }

    /// The place of the value at a path.
    pub fn place(&self, path: &str) -> &Place {
        self.tree.place_of(path)
    }

    /// Records a fault with the value at a path; `help` may be empty.
    pub fn refuse(&mut self, path: &str, label: &str, message: String, help: &str) {
        let fault = Fault::at(self.place(path), label, message);
        self.faults.push(if help.is_empty() { fault } else { fault.help(help) });
    }
}
