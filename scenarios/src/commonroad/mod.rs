//! Scenarios of CommonRoad, in XML of the versions 2018b and 2020a.
//!
//! ```text
//! text -> elements with places (`xml`) -> CommonRoad as plain values (`model`) -> ScenarioFile (`map`)
//! ```
//!
//! Parts that a scenario cannot state are left out and noted, one line for each kind. Every error has its place in the imported
//! text, including errors found later, when the scenario is resolved.

mod export;
mod map;
mod model;
pub(crate) mod recorded_traffic;
mod traffic;
mod xml;

use std::fmt::Write;
use std::io::Read;
use std::path::Path;

use serde_json::{Value as Json, json};

use crate::format::read::regular_file::open_regular;
use crate::format::read::source::imported_text;
use crate::format::read::tree::{self, TomlNode};
use crate::format::scenario_file::ScenarioFile;
use crate::resolve::records;
use crate::text::error::{Fault, LoadError, Place};
pub use export::{CommonRoadExport, DrivenVehicle, Exported};
use map::{Mapped, Notes};
use model::CommonRoad;
pub use traffic::recorded_traffic_in_commonroad;
use xml::{Unread, Xml};

/// The number of leading bytes that decide whether a file is a scenario \[bytes\].
const HEAD_BYTES: u64 = 4096;

/// Options of an import.
#[derive(Clone, Debug, Default)]
pub struct ImportOptions {
    /// The kind of driver of the ego; a nice human without one.
    pub ego: Option<String>,
    /// Drivers that take the place of records.
    pub replace: Vec<Replacement>,
}

/// A driver that replaces a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replacement {
    /// The id or the name of the vehicle; all vehicles without one.
    pub vehicle: Option<String>,
    /// The kind of the driver.
    pub kind: String,
    /// Its style, of a human.
    pub style: Option<String>,
}

/// A scenario that was imported.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The scenario, with the records of its vehicles in it.
    pub file: ScenarioFile,
    /// The parts that could not be carried over, or only with changes: one line for each kind.
    pub notes: Vec<String>,
    /// Paths of keys, each with its place in the imported text.
    places: Vec<(String, Place)>,
    root: Place,
    /// How errors call the imported text.
    pub(crate) name: String,
}

/// Imports the scenario of CommonRoad in a file.
///
/// # Errors
/// As [`import_commonroad`], and for a file that cannot be read.
pub fn import_commonroad_file(path: &Path, options: &ImportOptions) -> Result<Imported, LoadError> {
    let name = path.display().to_string();
    import_file(path, options).map_err(|fault| LoadError::new(name, vec![fault]))
}

/// The same, with the unconverted faults.
pub(crate) fn import_file(path: &Path, options: &ImportOptions) -> Result<Imported, Fault> {
    imported(&path.display().to_string(), &imported_text(path)?, options)
}

/// Imports a scenario of CommonRoad from its text; `name` is what errors call it.
///
/// # Errors
/// If the text is not such a scenario, or its lanelets and vehicles cannot become a scenario; each error is located.
pub fn import_commonroad(name: &str, text: &str, options: &ImportOptions) -> Result<Imported, LoadError> {
    imported(name, text, options).map_err(|fault| LoadError::new(name, vec![fault]))
}

fn imported(name: &str, text: &str, options: &ImportOptions) -> Result<Imported, Fault> {
    let xml = Xml::parse(name, text)?;
    let (mut unread, mut notes) = (Unread::default(), Notes::default());
    let mut scenario = CommonRoad::read(xml.root(), &mut unread)?;
    options.check_names(&scenario)?;
    let moved = scenario.move_near_origin();
    let root = xml.root().place();
    let Mapped { file, places } = map::mapped(&scenario, &root, unread, options, &mut notes)?;
    let moved = moved.map(|[x_m, y_m]| format!("coordinates: moved by ({:.0}, {:.0}) m, near the origin", -x_m, -y_m));
    let notes = notes.lines().into_iter().chain(moved).collect();
    Ok(Imported { file, notes, places, root, name: name.to_owned() })
}

impl Imported {
    /// The scenario with the records of its vehicles in a separate table called `table`, and that table, if there are records.
    pub fn with_records_in(&self, table: &str) -> (ScenarioFile, Option<String>) {
        let mut file = self.file.clone();
        let mut rows = format!("{},{}\n", records::ID_COLUMN, records::COLUMNS.join(","));
        let head = rows.len();
        for vehicle in &mut file.vehicles {
            let Some(driver) = &mut vehicle.driver else { continue };
            let Some(Json::Array(points)) = driver.take("points") else { continue };
            for point in points.iter().filter_map(Json::as_array) {
                let cells = point.iter().filter_map(Json::as_f64).map(|cell| cell.to_string());
                // Writing to a text cannot fail.
                let _ = writeln!(rows, "{},{}", vehicle.name, cells.collect::<Vec<_>>().join(","));
            }
            *driver = std::mem::take(driver).with("file", table).with("id", json!(vehicle.name));
        }
        let has_records = rows.len() > head;
        (file, has_records.then_some(rows))
    }

    /// The tree of the scenario, with the places of its values in the imported text.
    pub(crate) fn into_tree(self) -> TomlNode {
        let mut tree = tree::of_value(&Json::Object(self.file.stated()));
        tree.set_place(&self.root);
        for (path, place) in &self.places {
            if let Some(node) = tree.at_mut(path) {
                node.set_place(place);
            }
        }
        tree
    }
}

/// Whether a file is a scenario of CommonRoad: XML with its root element. An unreadable file is not.
pub fn is_commonroad(path: &Path) -> bool {
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("xml")) {
        return false;
    }
    let mut head = Vec::new();
    let read = open_regular(path).and_then(|file| file.take(HEAD_BYTES).read_to_end(&mut head));
    read.is_ok() && String::from_utf8_lossy(&head).contains(&format!("<{}", model::ROOT))
}
