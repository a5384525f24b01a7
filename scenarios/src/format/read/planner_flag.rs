//! What `--planner` and paths of vehicles cannot change, and what does instead.

use crate::format::read::tree::{Table, TomlNode, TomlValue};
use crate::text::error::{Fault, Place};

/// Which key changes the drivers of a scenario whose vehicles come from flows; none without flows.
pub(super) fn flow_help(root: &Table) -> Option<String> {
    let TomlValue::Array(flows) = &root.get("flow")?.node.value else { return None };
    let name = flows.iter().find_map(TomlNode::label)?;
    Some(format!("its vehicles come from flows: `flow.{name}.vehicle.driver.kind` and `.style` choose their drivers"))
}

/// Refuses kinds of drivers that need more than their name, unless the ego has such a driver already.
pub(super) fn refuse_unfit_planner(root: &Table, ego: &str, kind: &str, place: &Place) -> Result<(), Fault> {
    let (reason, help) = match kind {
        "walker" => {
            ("a walker moves a pedestrian, not a vehicle", "state `class = \"pedestrian\"` and the driver in the file")
        }
        "recorded" => {
            ("a recorded driver needs a record", "state `driver = { kind = \"recorded\", file = FILE }` in the file")
        }
        "inputs" => {
            ("a driver of inputs needs inputs that were recorded", "`interplay play` records them in a file of its own")
        }
        "external" => (
            "an external driver waits for inputs from a program of your own",
            "Python and `Simulation::apply` hand them in",
        ),
        _ => return Ok(()),
    };
    let vehicles = root.get("vehicle").and_then(|entry| match &entry.node.value {
        TomlValue::Array(vehicles) => Some(vehicles),
        _ => None,
    });
    let driver = vehicles.into_iter().flatten().find(|vehicle| vehicle.label() == Some(ego));
    let stated = driver.and_then(|vehicle| vehicle.at("driver.kind")).and_then(TomlNode::text);
    if stated == Some(kind) {
        return Ok(());
    }
    let message = format!("`--planner {kind}` cannot drive `{ego}`: {reason}");
    Err(Fault::at(place, "not a planner of a vehicle", message).help(help))
}
