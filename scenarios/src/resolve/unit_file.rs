//! Finds the functional mock-up unit that is a scenario's building, when the scenario is loaded.

use crate::format::read::stated_path::{base_in_words, path_beside};
use crate::format::read::tree::TomlNode;
use crate::text::error::{Fault, quoted};

/// The absolute path of the unit that is called `name` at `building.plant.fmu`. Its content is read when the run begins.
pub(crate) fn find(name: &str, tree: &TomlNode) -> Result<String, Fault> {
    let place = tree.place_of("building.plant.fmu");
    let beside = path_beside(place, name);
    if beside.is_file() {
        return Ok(std::path::absolute(&beside).unwrap_or(beside).to_string_lossy().into_owned());
    }
    let message = format!("there is no file {}", quoted(&beside.display().to_string()));
    Err(Fault::at(place, "this file", message).help(base_in_words(place)))
}
