//! Flows: each `[[flow]]` is replaced by its vehicles, before the file is used otherwise.
//!
//! - `arrival`: when, where and how fast each vehicle comes, drawn from the seed.
//!
//! A vehicle of a flow is thus a vehicle like any other: it has defaults, checks, a budget, a recording. Reports count the
//! vehicles of a flow together.

mod arrival;

use serde_json::{Map, Value as Json, json};

use self::arrival::Arrival;
use crate::format::flow::{FlowConfig, Headways};
use crate::format::json_schema::SchemaNode;
use crate::format::read::merge::merge_tables;
use crate::format::read::tree::{self, Table, TomlEntry, TomlNode, TomlValue};
use crate::model::traffic::flows::ScenarioFlows;
use crate::resolve::check::shape;
use crate::text::error::{Fault, quoted};
use crate::text::name;
use crate::text::readable::readable;

/// Most vehicles of all flows of a file.
const MOST_VEHICLES: f64 = 10_000.0;

/// The tree with the vehicles of its flows among its vehicles; the flows stay.
///
/// # Errors
/// The faults of the flows, once instead of once for every vehicle.
pub(crate) fn with_flows(mut tree: TomlNode, schema: SchemaNode) -> Result<TomlNode, Vec<Fault>> {
    let TomlValue::Table(root) = &mut tree.value else { return Ok(tree) };
    let Some(stated) = root.get("flow").map(|entry| entry.node.clone()).filter(|flows| !flows.is_empty_list()) else {
        return Ok(tree);
    };
    let faults = shape::check_table(&stated, "flow", schema);
    if !faults.is_empty() {
        return Err(faults);
    }
    let seed = match root.get("seed").map(|entry| &entry.node.value) {
        Some(TomlValue::Integer(seed)) => *seed as u64,
        _ => 1,
    };
    let duration_s = root.get("duration_s").map(|entry| entry.node.to_json().as_f64().unwrap_or(f64::NAN));
    // A value that is not a duration is refused with the other keys.
    if duration_s.is_some_and(|duration_s| !duration_s.is_finite()) {
        return Ok(tree);
    }
    let TomlValue::Array(nodes) = &stated.value else { return Ok(tree) };
    let read = |node: &TomlNode| serde_json::from_value::<FlowConfig>(node.to_json());
    let flows: Result<Vec<FlowConfig>, _> = nodes.iter().map(read).collect();
    let flows = flows.map_err(|error| vec![Fault::at(&stated.place, "in this list", error.to_string())])?;
    let Some(duration_s) = duration_s else {
        let fault = Fault::at(
            &stated.place,
            "comes until the run ends",
            "a flow needs `duration_s`, and the file states none".to_owned(),
        );
        return Err(vec![fault.help("state how long the run is".to_owned())]);
    };
    let faults = faults_of(&flows, nodes, duration_s);
    if !faults.is_empty() {
        return Err(faults);
    }
    let vehicle_schema = schema.property("vehicle").and_then(SchemaNode::entries);
    let is_alone = root.get("vehicle").is_none_or(|entry| entry.node.is_empty_list());
    let Some(arrivals) = drawn(&flows, seed, duration_s, is_alone) else {
        let message = "no vehicle comes before the run ends, and there is no other vehicle";
        let fault = Fault::at(&stated.place, "no arrivals", message.to_owned());
        return Err(vec![fault.help("raise the rates or `duration_s`, or state a `[[vehicle]]`".to_owned())]);
    };
    let arrivals: Vec<TomlNode> = arrivals
        .iter()
        .map(|(index, arrival)| vehicle(vehicle_schema, &flows[*index], &nodes[*index], arrival))
        .collect();
    let place = stated.place.clone();
    let empty = || TomlEntry {
        key: place.clone(),
        node: TomlNode { place: place.clone(), value: TomlValue::Array(Vec::new()) },
    };
    if let TomlValue::Array(vehicles) = &mut root.entry("vehicle".to_owned()).or_insert_with(empty).node.value {
        vehicles.extend(arrivals);
    }
    Ok(tree)
}

/// The vehicles of all flows, each with the index of its flow. Without other vehicles, the first that comes is the ego, on the road when
/// the run begins; `None` if no vehicle comes then.
fn drawn(flows: &[FlowConfig], seed: u64, duration_s: f64, are_alone: bool) -> Option<Vec<(usize, Arrival<'_>)>> {
    let mut arrivals: Vec<(usize, Arrival<'_>)> = Vec::new();
    for (index, flow) in flows.iter().enumerate() {
        arrivals.extend(arrival::draw(flow, seed, duration_s).into_iter().map(|arrival| (index, arrival)));
    }
    if are_alone {
        let enters_s = |index: &usize| arrivals[*index].1.enters_s;
        let first = (0..arrivals.len()).min_by(|one, other| enters_s(one).total_cmp(&enters_s(other)))?;
        arrivals[..=first].rotate_right(1);
        arrivals[0].1.enters_s = 0.0;
    }
    Some(arrivals)
}

/// Combinations of keys that are invalid although each key by itself is valid.
fn faults_of(flows: &[FlowConfig], nodes: &[TomlNode], duration_s: f64) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut expected = 0.0;
    for (index, (flow, node)) in flows.iter().zip(nodes).enumerate() {
        let mut wrong = |key: &str, message: String, help: &str| {
            faults.push(Fault::at(node.place_of(key), "in this flow", message).help(help.to_owned()));
        };
        let name = quoted(&flow.name);
        if flows[..index].iter().any(|other| other.name == flow.name) {
            wrong(
                "name",
                format!("there are two flows {name}"),
                "name each flow otherwise: its vehicles are called after it",
            );
        }
        if !name::is_name(&format!("{}-{MOST_VEHICLES}", flow.name)) {
            let help = "shorten it: its vehicles are called after it, with a number";
            wrong("name", format!("{name} is too long for a flow"), help);
        }
        if flow.vehicles_per_h.is_none() && flow.rates.is_empty() {
            wrong(
                "name",
                format!("nothing says how many vehicles of {name} come"),
                "state `vehicles_per_h`, or `rates` by time",
            );
        }
        if flow.rates.iter().flatten().any(|number| !(0.0..=1e5).contains(number))
            || !flow.rates.is_sorted_by(|one, other| one[0] < other[0])
        {
            wrong(
                "rates",
                "pairs are a time and a number of vehicles an hour, both from 0 to 100000, in order of time".to_owned(),
                "for example `[[0.0, 600.0], [300.0, 1500.0]]`",
            );
        }
        if flow.ends_s.is_some_and(|ends_s| ends_s <= flow.begins_s) {
            wrong("ends_s", "the flow does not end after it begins".to_owned(), "lower `begins_s` or raise `ends_s`");
        }
        let shares = |shares: Vec<f64>| shares.is_empty() || shares.iter().any(|share| *share > 0.0);
        if !shares(flow.mix.iter().map(|sort| sort.share).collect()) {
            wrong("mix", "no sort has a share".to_owned(), "state a `share` above 0");
        }
        if !shares(flow.to.iter().map(|goal| goal.share).collect()) {
            wrong("to", "no lane has a share".to_owned(), "state a `share` above 0");
        }
        expected += arrival::expected(flow, duration_s);
        if expected > MOST_VEHICLES {
            wrong(
                "name",
                format!("the flows stand for about {} vehicles, more than {MOST_VEHICLES}", readable(expected)),
                "lower the rates or `duration_s`",
            );
            break;
        }
    }
    faults
}

/// A vehicle of a flow: the common keys, then those of its sort, then the drawn values.
fn vehicle(schema: Option<SchemaNode>, flow: &FlowConfig, node: &TomlNode, arrival: &Arrival) -> TomlNode {
    let at = |path: &str| node.at(path).and_then(TomlNode::table).cloned();
    let drawn = |json: Json| -> Table {
        let mut made = tree::of_value(&json);
        made.set_place(&node.place);
        if let TomlValue::Table(table) = made.value { table } else { Table::new() }
    };
    // A wanted speed of its own may differ from the speed with which it comes, as on a ramp.
    let sorts_own = arrival.sort.map(|sort| format!("mix.{sort}.vehicle.goal.speed_mps"));
    let is_stated = |path: &str| node.at(path).is_some();
    let states_speed = is_stated("vehicle.goal.speed_mps") || sorts_own.as_deref().is_some_and(is_stated);
    let mut goal = Map::new();
    goal.extend((!states_speed).then(|| ("speed_mps".to_owned(), json!(arrival.speed_mps))));
    goal.extend(arrival.to.map(|lane| ("lane".to_owned(), json!(lane))));
    let own = json!({
        "name": format!("{}-{}", flow.name, arrival.number),
        "start": { "lane": flow.from[arrival.lane], "along_m": flow.along_m, "speed_mps": arrival.speed_mps },
        "goal": goal,
        "enters_s": arrival.enters_s,
    });
    let mut own = drawn(own);
    for (key, place) in [("start", "from"), ("goal", "to")] {
        if let Some(entry) = own.get_mut(key) {
            entry.node.set_place(node.at(place).map_or(&node.place, |stated| &stated.place));
        }
    }
    let sort = arrival.sort.and_then(|sort| at(&format!("mix.{sort}.vehicle")));
    let layers = [at("vehicle"), sort, Some(own)];
    let common = drawn(json!({ "leaves_at_end": true }));
    let table = layers.into_iter().flatten().fold(common, |under, over| merge_tables(schema, under, over));
    TomlNode { place: node.place.clone(), value: TomlValue::Table(table) }
}

/// What a scenario keeps of its flows.
pub(super) fn stated(flows: &[FlowConfig]) -> ScenarioFlows {
    let depends_on_seed = |flow: &FlowConfig| {
        let is_irregular = flow.headways == Headways::Exponential || flow.speed_sd_mps > 0.0;
        is_irregular || flow.from.len() > 1 || flow.to.len() > 1 || flow.mix.len() > 1
    };
    ScenarioFlows {
        names: flows.iter().map(|flow| flow.name.clone()).collect(),
        depend_on_seed: flows.iter().any(depends_on_seed),
    }
}

#[cfg(test)]
mod tests {
    use crate::from_text;

    fn refused(flow: &str) -> String {
        let text = format!(
            "title = 'a'\nshows = 'a'\nscale = 'full'\nduration_s = 10.0\n\
             road = {{ kind = 'lanes', lane_count = 2, lane_width_m = 3.5 }}\n[[flow]]\nname = 'a'\nfrom = [0]\nspeed_mps = 20.0\n{flow}"
        );
        from_text("a.toml", &text, &[]).map(|_| ()).expect_err("refused").faults()[0].message().to_owned()
    }

    /// Runs with different seeds have different traffic, so they are different samples.
    #[test]
    fn traffic_of_a_flow_depends_on_the_seed() {
        let text = |keys: &str| {
            format!(
                "title = 'a'\nshows = 'a'\nscale = 'full'\nduration_s = 10.0\n\
                 road = {{ kind = 'lanes', lane_count = 2, lane_width_m = 3.5 }}\n[[flow]]\nname = 'a'\nfrom = [0]\nspeed_mps = 20.0\n\
                 vehicles_per_h = 1800.0\n{keys}"
            )
        };
        let depends = |keys: &str| from_text("a.toml", &text(keys), &[]).expect("sound").depends_on_seed();
        assert!(depends(""));
        assert!(!depends("headways = 'even'"), "equal headways, one lane and one speed");
    }

    #[test]
    fn vehicles_of_a_flow_may_want_another_speed_than_they_come_with() {
        for (goals, wanted_mps) in [
            ("", 20.0),
            ("vehicle = { goal = { speed_mps = 25.0 } }", 25.0),
            ("mix = [{ share = 1.0, vehicle = { goal = { speed_mps = 23.0 } } }]", 23.0),
        ] {
            let text = format!(
                "title = 'a'\nshows = 'a'\nscale = 'full'\nduration_s = 60.0\nroad = {{ kind = 'lanes', lane_width_m = 3.5 }}\n\
                 [[flow]]\nname = 'a'\nfrom = [0]\nspeed_mps = 20.0\nvehicles_per_h = 600.0\n{goals}"
            );
            let scenario = from_text("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
            let speeds = scenario.vehicles.iter().map(|one| (one.start.speed_mps, one.goal.speed_mps));
            let speeds: Vec<_> = speeds.collect();
            assert!(speeds.iter().all(|speeds| *speeds == (20.0, Some(wanted_mps))), "{goals}: {speeds:?}");
        }
    }

    #[test]
    fn invalid_flows_are_refused_once() {
        for (flow, part) in [
            ("", "nothing says how many vehicles"),
            ("vehicles_per_h = 0.0", "no vehicle comes before the run ends"),
            ("rates = [[5.0, 10.0], [1.0, 20.0]]", "in order of time"),
            ("vehicles_per_h = 600.0\nbegins_s = 5.0\nends_s = 5.0", "does not end after it begins"),
            ("vehicles_per_h = 600.0\nto = [{ lane = 1, share = 0.0 }]", "no lane has a share"),
            ("vehicles_per_h = 600.0\nmix = [{ share = 0.0 }]", "no sort has a share"),
            (
                "vehicles_per_h = 600.0\n[[flow]]\nname = 'a'\nfrom = [0]\nspeed_mps = 20.0\nvehicles_per_h = 1.0",
                "two flows",
            ),
        ] {
            let message = refused(flow);
            assert!(message.contains(part), "{flow}: {message}");
        }
    }
}
