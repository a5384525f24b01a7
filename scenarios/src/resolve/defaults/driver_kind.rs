//! The kind of a driver of which a file states the style alone.

use interplay_planners::drivers::human::Style;
use serde_json::json;

use crate::format::read::tree::{self, Table, TomlEntry, TomlNode, TomlValue};

/// The kind of the drivers that have a style of people.
const HUMAN: &str = "human";
/// The class of those on foot, whose styles are others.
const PEDESTRIAN: &str = "pedestrian";

/// The tree with the `kind` of each driver that has a style of people and no kind: `human`, unless what lies under it states one. So a
/// change such as `flow.west.vehicle.driver.style=tough` needs no other.
pub(crate) fn with_driver_kinds(mut tree: TomlNode) -> TomlNode {
    let TomlValue::Table(root) = &mut tree.value else { return tree };
    let of_all = root.get("defaults").and_then(|entry| stated_kind(entry.node.table()?));
    if let Some(defaults) = root.get_mut("defaults").and_then(|entry| table_of(&mut entry.node)) {
        complete(defaults, None);
    }
    for vehicle in tables(root, "vehicle") {
        complete(vehicle, of_all.as_deref());
    }
    for flow in tables(root, "flow") {
        let common = flow.get_mut("vehicle").and_then(|entry| table_of(&mut entry.node));
        let of_flow = common.and_then(|common| {
            complete(common, of_all.as_deref());
            stated_kind(common)
        });
        let under = of_flow.or_else(|| of_all.clone());
        for sort in tables(flow, "mix") {
            if let Some(vehicle) = sort.get_mut("vehicle").and_then(|entry| table_of(&mut entry.node)) {
                complete(vehicle, under.as_deref());
            }
        }
    }
    tree
}

/// The kind of driver that a table of a vehicle states.
fn stated_kind(vehicle: &Table) -> Option<String> {
    Some(vehicle.get("driver")?.node.table()?.get("kind")?.node.text()?.to_owned())
}

/// States the kind of a vehicle's driver if it has a style of people and no kind: `under`, if that is stated.
fn complete(vehicle: &mut Table, under: Option<&str>) {
    let class = vehicle.get("class").and_then(|entry| entry.node.text());
    if class == Some(PEDESTRIAN) {
        return;
    }
    let Some(driver) = vehicle.get_mut("driver").and_then(|entry| table_of(&mut entry.node)) else { return };
    let is_style = |word: &str| word == Style::Measured.name() || Style::ALL.iter().any(|style| style.name() == word);
    let Some(style) = driver.get("style").filter(|entry| entry.node.text().is_some_and(is_style)) else { return };
    if driver.contains_key("kind") {
        return;
    }
    let key = style.key.clone();
    let mut node = tree::of_value(&json!(under.unwrap_or(HUMAN)));
    node.set_place(&key);
    driver.insert("kind".to_owned(), TomlEntry { key, node });
}

fn table_of(node: &mut TomlNode) -> Option<&mut Table> {
    if let TomlValue::Table(table) = &mut node.value { Some(table) } else { None }
}

/// The tables of a list.
fn tables<'t>(root: &'t mut Table, key: &str) -> impl Iterator<Item = &'t mut Table> {
    let list = root.get_mut(key).and_then(|entry| match &mut entry.node.value {
        TomlValue::Array(items) => Some(items),
        _ => None,
    });
    list.into_iter().flatten().filter_map(table_of)
}

#[cfg(test)]
mod tests {
    use interplay_planners::Driver;
    use interplay_planners::drivers::human::Style;

    use crate::format::read::overrides::Override;
    use crate::from_text;

    const TEXT: &str = "title = 'a'\nshows = 'a'\nscale = 'full'\nduration_s = 20.0\n\
         road = { kind = 'lanes', lane_count = 2, lane_width_m = 3.5 }\n\
         [[vehicle]]\nname = 'ego'\nstart = { lane = 0, along_m = 300.0, speed_mps = 20.0 }\n\
         [[flow]]\nname = 'west'\nfrom = [0]\nspeed_mps = 20.0\nvehicles_per_h = 1800.0\n";

    #[test]
    fn a_style_alone_makes_a_driver_human() {
        for set in ["flow.west.vehicle.driver.style='tough'", "vehicle.ego.driver.style='tough'"] {
            let scenario = from_text("a.toml", TEXT, &[Override::Set(set.to_owned())]).expect("sound");
            let tough = |driver: &Driver| matches!(driver, Driver::Human(human) if human.style == Some(Style::Tough));
            assert!(scenario.vehicles.iter().any(|vehicle| tough(&vehicle.driver)), "{set}");
        }
    }

    #[test]
    fn a_style_that_no_human_has_makes_no_driver() {
        let set = Override::Set("vehicle.ego.driver.style='bold'".to_owned());
        let error = from_text("a.toml", TEXT, &[set]).expect_err("no kind");
        assert!(error.faults()[0].message().contains("`vehicle.ego.driver.kind` is missing"), "{error:?}");
    }
}
