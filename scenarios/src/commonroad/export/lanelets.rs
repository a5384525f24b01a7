//! Lanes of a network as lanelets.

use std::collections::BTreeMap;
use std::fmt::Write;

use interplay_planners::road::network::{Lane, LaneNeighbour, NeighbourRelation, RoadNetwork};

use super::DrivenVehicle;
use super::base::{Base, VERSION};
use super::xml_text::{bound, number_in};
use crate::model::scenario::{Scenario, Vehicle};
use crate::roads::{Branch, Road};

/// The largest distance between two points of a bound \[m\].
const POINTS_M: f64 = 1.0;
/// The most points of a bound.
const MAX_POINTS: f64 = 1000.0;

/// A lanelet with its references to others.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneletText {
    pub id: u64,
    /// Points of the left and the right bound \[m\].
    pub bounds: [Vec<[f64; 2]>; 2],
    pub predecessors: Vec<u64>,
    pub successors: Vec<u64>,
    /// The lanelets on the left and on the right, and whether they are driven in the same direction.
    pub beside: [Option<(u64, bool)>; 2],
}

impl LaneletText {
    pub(super) fn written(&self) -> String {
        let [left, right] = &self.bounds;
        let mut text =
            format!("  <lanelet id=\"{}\">\n{}{}", self.id, bound("leftBound", left), bound("rightBound", right));
        // Writing to a text cannot fail.
        for (name, ids) in [("predecessor", &self.predecessors), ("successor", &self.successors)] {
            for id in ids {
                let _ = writeln!(text, "    <{name} ref=\"{id}\"/>");
            }
        }
        for (name, beside) in ["adjacentLeft", "adjacentRight"].iter().zip(self.beside) {
            if let Some((id, is_same)) = beside {
                let direction = if is_same { "same" } else { "opposite" };
                let _ = writeln!(text, "    <{name} ref=\"{id}\" drivingDir=\"{direction}\"/>");
            }
        }
        text.push_str("    <laneletType>urban</laneletType>\n    <userOneWay>vehicle</userOneWay>\n  </lanelet>\n");
        text
    }
}

impl Base {
    /// Adds the lanes of a network, and the lanelet in which the way of the ego ends.
    pub(super) fn add_network(&mut self, network: &RoadNetwork, ego: Option<&Vehicle>) {
        let lanes = network.lanes();
        let ids: BTreeMap<&str, u64> =
            lanes.iter().map(|lane| (lane.name.as_str(), self.ids.give(number_in(&lane.name)))).collect();
        let mut lanelets: Vec<LaneletText> = lanes.iter().map(|lane| lanelet(lane, &ids)).collect();
        let pairs: Vec<(u64, u64)> =
            lanelets.iter().flat_map(|lanelet| lanelet.successors.iter().map(|next| (lanelet.id, *next))).collect();
        for lanelet in &mut lanelets {
            lanelet.predecessors = pairs.iter().filter(|(_, next)| *next == lanelet.id).map(|(id, _)| *id).collect();
        }
        lanelets.iter().for_each(|lanelet| self.roads.push_str(&lanelet.written()));
        let last = ego.and_then(|ego| ego.route.legs.last()).and_then(|leg| ids.get(leg.lane.as_str()));
        self.last_lanelets = last.copied().into_iter().collect();
    }
}

fn lanelet(lane: &Lane, ids: &BTreeMap<&str, u64>) -> LaneletText {
    let id = |name: &str| ids.get(name).copied();
    let beside = |neighbour: &Option<LaneNeighbour>| {
        let neighbour = neighbour.as_ref()?;
        Some((id(&neighbour.lane)?, neighbour.relation == NeighbourRelation::SameDirection))
    };
    let length_m = lane.centre.length_m();
    let count = (length_m / POINTS_M).ceil().clamp(1.0, MAX_POINTS) as usize;
    let places = (0..=count).map(|index| length_m * index as f64 / count as f64);
    let bounds = [1.0, -1.0].map(|side| {
        places.clone().map(|along_m| lane.centre.position(along_m, side * lane.half_width_m(along_m))).collect()
    });
    LaneletText {
        id: id(&lane.name).unwrap_or_default(),
        bounds,
        predecessors: Vec::new(),
        successors: lane.successors.iter().filter_map(|name| id(name)).collect(),
        beside: [beside(&lane.left), beside(&lane.right)],
    }
}

/// The roads of a scenario that was not imported.
pub(super) fn base(scenario: &Scenario, name: &str) -> Base {
    let benchmark = benchmark(name);
    let mut base = Base { attributes: attributes(scenario, &benchmark), benchmark, ..Base::default() };
    base.roads = "  <location><geoNameId>-999</geoNameId><gpsLatitude>999</gpsLatitude><gpsLongitude>999</gpsLongitude></location>\n  \
                  <scenarioTags><simulated/></scenarioTags>\n"
        .to_owned();
    match &scenario.network {
        Some(network) => base.add_network(network, scenario.ego()),
        None => base.parallel = Some(Box::new(scenario.clone())),
    }
    base.problem_id = base.ids.give(None);
    base
}

/// The same with roads as long as their driven part.
pub(super) fn around(base: &Base, vehicles: &[DrivenVehicle]) -> Base {
    let mut base = base.clone();
    if let Some(scenario) = base.parallel.take() {
        base.add_parallel(&scenario, vehicles);
    }
    base
}

/// A benchmark name in the form that CommonRoad requires.
fn benchmark(name: &str) -> String {
    let letters: String = name.trim_end_matches(".toml").chars().filter(char::is_ascii_alphanumeric).take(60).collect();
    format!("ZAM_{}-1_1_T-1", if letters.is_empty() { "Scenario".to_owned() } else { letters })
}

fn attributes(scenario: &Scenario, benchmark: &str) -> Vec<(String, String)> {
    let step_s = scenario.step_s.to_string();
    let all = [
        ("timeStepSize", step_s.as_str()),
        ("commonRoadVersion", VERSION),
        ("benchmarkID", benchmark),
        ("author", "Interplay"),
        ("affiliation", "Interplay"),
        (
            "source",
            if matches!(scenario.road, Road::Network(_)) { "a network of lanes" } else { "a scenario of Interplay" },
        ),
        ("date", "2000-01-01"),
    ];
    all.map(|(name, value)| (name.to_owned(), value.to_owned())).to_vec()
}

/// How far lanelets extend beyond the positions of all vehicles \[m\].
const BEYOND_M: f64 = 50.0;
/// The largest distance between two points of a bound \[m\].
const PARALLEL_POINTS_M: f64 = 2.0;
/// The most points of a bound.
const MAX_PARALLEL_POINTS: f64 = 2000.0;

impl Base {
    /// Adds the lanes of a road without names, each from the rearmost to the foremost position of any vehicle.
    pub(super) fn add_parallel(&mut self, scenario: &Scenario, vehicles: &[DrivenVehicle]) {
        let Some(lanes) = scenario.road.parallel_lanes() else { return };
        for branch in [Branch::Main, Branch::Cross] {
            let exists = branch == Branch::Main || scenario.road.conflict_zone_m(branch).is_some();
            let Some(route) = scenario.road.route(branch).filter(|_| exists) else { continue };
            let states = vehicles.iter().flat_map(|vehicle| &vehicle.states);
            let along = states.map(|state| route.along(state.position()));
            let [from_m, to_m] = along.fold([0.0_f64, 0.0_f64], |[low, high], at_m| [low.min(at_m), high.max(at_m)]);
            let [from_m, to_m] = [from_m - BEYOND_M, to_m + BEYOND_M];
            let count = ((to_m - from_m) / PARALLEL_POINTS_M).ceil().clamp(1.0, MAX_PARALLEL_POINTS) as usize;
            let ids: Vec<u64> = (0..lanes.count).map(|_| self.ids.give(None)).collect();
            for (lane, id) in ids.iter().enumerate() {
                let Some(centre_m) = scenario.road.lane_centre_m(branch, lane) else { continue };
                let bounds = [0.5, -0.5].map(|side| {
                    let across_m = centre_m + side * lanes.width_m;
                    let place =
                        |index: usize| route.position(from_m + (to_m - from_m) * index as f64 / count as f64, across_m);
                    (0..=count).map(place).collect()
                });
                let beside = [ids.get(lane + 1), lane.checked_sub(1).and_then(|right| ids.get(right))];
                let beside = beside.map(|id| id.map(|id| (*id, true)));
                self.roads.push_str(&LaneletText { id: *id, bounds, beside, ..LaneletText::default() }.written());
            }
        }
    }
}
