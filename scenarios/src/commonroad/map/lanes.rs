//! Converts lanelets to lanes of a network. Parts that the network refuses are left out, with a note.

use std::collections::{BTreeMap, BTreeSet};

use interplay_planners::road::network::{
    Lane, LaneFault, LaneUser, LightPhase, RightOfWay, RoadNetwork, RoadNetworkError,
};

use super::super::model::{Adjacent, CommonRoad, Lanelet, Light};
use super::line::{self, Line};
use super::notes::{NOT_YET, Names, Notes};
use super::rights::Signs;
use super::vehicles::rounded;
use crate::model::traffic::light::LightConfig;
use crate::roads::{LaneConfig, LaneNetwork, LaneWidth, NeighbourConfig, NeighbourTable};
use crate::text::error::{Fault, Place};

/// The largest gap between a lane and its successor that is closed by moving the start of the successor \[m\].
const MAX_CLOSED_GAP_M: f64 = 1.0;
/// The most loops that are opened.
const MAX_LOOPS: usize = 200;

const LANELET: [&str; 2] = ["lanelet", "lanelets"];

pub(super) struct Lanes {
    /// The lanes as a file states them.
    pub configs: Vec<LaneConfig>,
    pub places: Vec<Place>,
    pub network: RoadNetwork,
    /// The name of the lane of each lanelet, by its id.
    pub names: BTreeMap<String, String>,
    /// The lanes that others follow on the map, also where no vehicle can drive on to them.
    pub followed: BTreeSet<String>,
}

impl Lanes {
    /// Makes lanes of all lanelets.
    ///
    /// # Errors
    /// For two lanelets with one id, and if the remaining lanes are not a network.
    pub(super) fn of(scenario: &CommonRoad<'_>, root: &Place, notes: &mut Notes) -> Result<Lanes, Fault> {
        let mut draft = Draft::of(scenario, notes)?;
        draft.connect(notes);
        let followed = draft.configs.iter().filter(|config| !config.successors.is_empty());
        let followed = followed.map(|config| config.name.clone()).collect();
        draft.close_gaps(notes);
        let mut lanes = draft.checked_alone(notes)?;
        draft.put_beside(notes);
        draft.check_pairs(&mut lanes, notes);
        let refused = |error: RoadNetworkError| {
            let place = draft.lanelets.get(error.index).map_or(root.clone(), |lanelet| lanelet.element.place());
            Fault::at(&place, "no lane", format!("the lanelets are no network of lanes: {error}"))
        };
        if lanes.is_empty() {
            return Err(Fault::at(root, "without lanes", "the scenario has no lanelet on which a vehicle can drive"));
        }
        let mut network = RoadNetwork::new(lanes.clone()).map_err(refused)?;
        for _ in 0..MAX_LOOPS {
            let Some(last) = network.lanes_without_end().last().map(|lane| lane.name.clone()) else { break };
            for (lane, config) in lanes.iter_mut().zip(&mut draft.configs).filter(|(lane, _)| lane.name == last) {
                lane.successors.clear();
                config.successors.clear();
                notes.one(["loop without an exit", "loops without an exit"], "opened where it closes");
            }
            network = RoadNetwork::new(lanes.clone()).map_err(refused)?;
        }
        let places = draft.lanelets.iter().map(|lanelet| lanelet.element.place()).collect();
        Ok(Lanes { configs: draft.configs, places, network, names: draft.names, followed })
    }
}

/// Lanes under construction, each beside its lanelet.
struct Draft<'a> {
    configs: Vec<LaneConfig>,
    lanelets: Vec<&'a Lanelet<'a>>,
    names: BTreeMap<String, String>,
    /// The ids of all lanelets of the file.
    known: BTreeSet<&'a str>,
}

impl<'a> Draft<'a> {
    /// A lane for each lanelet for vehicles, without neighbours yet.
    fn of(scenario: &'a CommonRoad<'a>, notes: &mut Notes) -> Result<Draft<'a>, Fault> {
        let signs = Signs::of(scenario, notes);
        let (known, mut names) = (BTreeSet::new(), Names::default());
        let mut draft = Draft { configs: Vec::new(), lanelets: Vec::new(), names: BTreeMap::new(), known };
        for lanelet in &scenario.lanelets {
            if !draft.known.insert(&lanelet.id) {
                let message = format!("two lanelets have the id `{}`", lanelet.id);
                return Err(lanelet.element.fault("the second", message));
            }
            let Some(line) = line::between(&lanelet.left, &lanelet.right) else {
                notes.one(["lanelet through which no line leads", "lanelets through which no line leads"], "left out");
                continue;
            };
            let name = names.name("l", &lanelet.id);
            draft.names.insert(lanelet.id.clone(), name.clone());
            let right_of_way = signs.right_of_way(lanelet);
            draft.configs.push(LaneConfig {
                speed_limit_mps: signs.speed_limit_mps(lanelet),
                right_of_way,
                users: users(lanelet),
                zebra: lanelet.is_crosswalk(),
                ..lane_along(&name, &line)
            });
            draft.lanelets.push(lanelet);
            note_lanelet(lanelet, &line, right_of_way, notes);
        }
        Ok(draft)
    }

    /// The index of the lane of a lanelet.
    fn number(&self, id: &str) -> Option<usize> {
        self.lanelets.iter().position(|lanelet| lanelet.id == id)
    }

    /// Connects lanes with their successors: those that a lanelet names as successors, and those that name it as their predecessor.
    fn connect(&mut self, notes: &mut Notes) {
        let mut pairs: Vec<(usize, usize)> = Vec::new();
        for (index, lanelet) in self.lanelets.iter().enumerate() {
            let after = lanelet.successors.iter().map(|id| (id, true));
            let before = lanelet.predecessors.iter().map(|id| (id, false));
            for (id, is_after) in after.chain(before) {
                match self.number(id) {
                    Some(other) if other == index => {
                        notes.one(
                            ["lanelet that follows itself", "lanelets that follow themselves"],
                            "not after themselves",
                        );
                    }
                    Some(other) => pairs.push(if is_after { (index, other) } else { (other, index) }),
                    None if self.known.contains(id.as_str()) => {}
                    None => notes.one(["reference to a missing lanelet", "references to missing lanelets"], "left out"),
                }
            }
        }
        for (index, other) in pairs {
            let name = self.configs[other].name.clone();
            let successors = &mut self.configs[index].successors;
            if !successors.contains(&name) {
                successors.push(name);
            }
        }
    }

    /// Moves the starts of lanes to the ends of their predecessors, where the two nearly touch.
    fn close_gaps(&mut self, notes: &mut Notes) {
        for index in 0..self.configs.len() {
            let Some(end) = self.configs[index].points.last().copied() else { continue };
            for name in self.configs[index].successors.clone() {
                let begin = self.configs.iter_mut().find(|config| config.name == name);
                let Some(begin) = begin.and_then(|config| config.points.first_mut()) else { continue };
                let gap_m = libm::hypot(begin[0] - end[0], begin[1] - end[1]);
                if gap_m > GAP_M && gap_m <= MAX_CLOSED_GAP_M {
                    *begin = end;
                    notes.one(["gap between lanelets", "gaps between lanelets"], "closed");
                }
            }
        }
    }

    /// Puts lanes beside one another, as the lanelets say.
    fn put_beside(&mut self, notes: &mut Notes) {
        for (index, lanelet) in self.lanelets.iter().enumerate() {
            for (side, adjacent) in lanelet.beside.iter().enumerate() {
                let Some(Adjacent { id, is_oncoming }) = adjacent else { continue };
                let Some(other) = self.number(id).filter(|other| *other != index) else {
                    if !self.known.contains(id.as_str()) || *id == lanelet.id {
                        notes.one(["reference to a missing lanelet", "references to missing lanelets"], "left out");
                    }
                    continue;
                };
                let may_change = !is_oncoming
                    && !lanelet.is_solid[side]
                    && lanelet.is_reserved() == self.lanelets[other].is_reserved();
                let lane = self.configs[other].name.clone();
                let neighbour = if may_change {
                    NeighbourConfig::Name(lane)
                } else {
                    NeighbourConfig::Table(NeighbourTable { lane, oncoming: *is_oncoming, may_change })
                };
                let config = &mut self.configs[index];
                *(if side == 0 { &mut config.left } else { &mut config.right }) = Some(neighbour);
            }
        }
    }

    /// The lanes, each by itself. Those that no network would accept are left out.
    fn checked_alone(&mut self, notes: &mut Notes) -> Result<Vec<Lane>, Fault> {
        let (mut lanes, mut refused) = (Vec::new(), BTreeSet::new());
        for config in &self.configs {
            let alone = LaneConfig { successors: Vec::new(), ..config.clone() };
            let lane = LaneNetwork { lanes: vec![alone] }.lanes().ok().and_then(|mut lanes| lanes.pop());
            let lane = lane.filter(|lane| RoadNetwork::new(vec![lane.clone()]).is_ok());
            match lane {
                Some(lane) => lanes.push(Lane { successors: config.successors.clone(), ..lane }),
                None => {
                    notes.one(LANELET, "left out, since they cross themselves or are no line");
                    refused.insert(config.name.clone());
                }
            }
        }
        let is_kept = |config: &LaneConfig| !refused.contains(&config.name);
        let mut kept = self.configs.iter().map(is_kept).collect::<Vec<_>>().into_iter();
        self.lanelets.retain(|_| kept.next().unwrap_or(true));
        self.configs.retain(is_kept);
        self.names.retain(|_, name| !refused.contains(name));
        for (config, lane) in self.configs.iter_mut().zip(&mut lanes) {
            config.successors.retain(|name| !refused.contains(name));
            lane.successors.clone_from(&config.successors);
        }
        Ok(lanes)
    }

    /// Leaves out successors and neighbours that a network would not accept.
    fn check_pairs(&mut self, lanes: &mut [Lane], notes: &mut Notes) {
        let numbers: BTreeMap<String, usize> =
            lanes.iter().enumerate().map(|(number, lane)| (lane.name.clone(), number)).collect();
        for index in 0..lanes.len() {
            let alone = |lane: &Lane| Lane { successors: Vec::new(), left: None, right: None, ..lane.clone() };
            let with = |other: &str, own: Lane| {
                let other = numbers.get(other).map(|number| alone(&lanes[*number]));
                RoadNetwork::new([Some(own), other].into_iter().flatten().collect()).err().map(|error| error.fault)
            };
            let mut successors = self.configs[index].successors.clone();
            successors.retain(|name| {
                let fault = with(name, Lane { successors: vec![name.clone()], ..alone(&lanes[index]) });
                let is_kept = fault.is_none();
                fault.into_iter().for_each(|fault| note_successor(&fault, notes));
                is_kept
            });
            let config = &mut self.configs[index];
            for (neighbour, is_left) in [(&mut config.left, true), (&mut config.right, false)] {
                let Some(stated) = neighbour.as_ref().map(NeighbourConfig::neighbour) else { continue };
                let (name, own) = (stated.lane.clone(), alone(&lanes[index]));
                let own =
                    if is_left { Lane { left: Some(stated), ..own } } else { Lane { right: Some(stated), ..own } };
                if with(&name, own).is_some() {
                    *neighbour = None;
                    notes.one(
                        ["neighbour that is not side by side", "neighbours that are not side by side"],
                        "left out",
                    );
                }
            }
            config.successors.clone_from(&successors);
            let neighbours = [&config.left, &config.right].map(|it| it.as_ref().map(NeighbourConfig::neighbour));
            let [left, right] = neighbours;
            lanes[index] = Lane { successors, left, right, ..lanes[index].clone() };
        }
    }
}

/// The road users of a lanelet, by its type and its users; empty if cars may use it.
fn users(lanelet: &Lanelet<'_>) -> Vec<LaneUser> {
    if lanelet.is_for_walkers() {
        return vec![LaneUser::Pedestrian];
    }
    let is_of = |word: &str| lanelet.types.iter().any(|known| known == word);
    match (is_of("busLane"), is_of("bicycleLane")) {
        (true, true) => vec![LaneUser::Bus, LaneUser::Bicycle],
        (true, false) => vec![LaneUser::Bus],
        (false, true) => vec![LaneUser::Bicycle],
        (false, false) => Vec::new(),
    }
}

/// Lanes nearer than this are treated as touching \[m\].
const GAP_M: f64 = 0.02;

fn lane_along(name: &str, line: &Line) -> LaneConfig {
    let first_m = line.widths[0][1];
    let is_constant = line.widths.iter().all(|[_, width_m]| *width_m == first_m);
    LaneConfig {
        tolerance_m: line.tolerance_m,
        width_m: if is_constant { LaneWidth::Constant(first_m) } else { LaneWidth::Knots(line.widths.clone()) },
        ..LaneConfig::through(name, &line.points, first_m)
    }
}

/// Notes the parts of a lanelet that a lane cannot state.
fn note_lanelet(lanelet: &Lanelet<'_>, line: &Line, right_of_way: RightOfWay, notes: &mut Notes) {
    if line.is_turned {
        notes
            .one(["lanelet with bounds in the wrong order", "lanelets with bounds in the wrong order"], "put in order");
    }
    if line.is_narrowed {
        notes.one(LANELET, "made narrower in bends, where the inner edge would cross itself");
    }
    if line.tolerance_m > 0.1 {
        notes.one(LANELET, "smoothed by more than 0.1 m, so that a car can follow them");
    }
    if lanelet.is_two_way {
        let what = ["lanelet driven in both directions", "lanelets driven in both directions"];
        notes.one(what, "carried over in their own direction only");
    }
    if lanelet.has_stop_line && right_of_way == RightOfWay::Priority {
        notes.one(["stop line without a sign", "stop lines without a sign"], NOT_YET);
    }
}

/// Notes a successor that is left out.
fn note_successor(fault: &LaneFault, notes: &mut Notes) {
    let fate = match fault {
        LaneFault::Gap { .. } => "left out, since they begin elsewhere",
        LaneFault::Kink { .. } => "left out, since they begin in another direction",
        _ => "left out",
    };
    notes.one(["successor", "successors"], fate);
}

/// The shortest and the longest phase \[s\], and the latest begin.
const PHASES_S: [f64; 2] = [0.001, 10_000.0];

const MAX_OFFSET_S: f64 = 100_000.0;

/// The most lights of a scenario, and the most phases and lanes of each.
const MAX_LIGHTS: usize = 100;

/// The lights of a scenario, from its start on, in time steps.
pub(super) fn lights(scenario: &CommonRoad<'_>, lanes: &Lanes, begin: f64, notes: &mut Notes) -> Vec<LightConfig> {
    let mut taken: Vec<String> = Vec::new();
    let mut found = Vec::new();
    for light in &scenario.lights {
        let named = scenario.lanelets.iter().filter(|lanelet| lanelet.lights.contains(&light.id));
        let named = named.filter_map(|lanelet| lanes.names.get(&lanelet.id));
        let mut of_light: Vec<String> = named.filter(|lane| !taken.contains(lane)).cloned().collect();
        of_light.truncate(MAX_LIGHTS);
        let what = ["traffic light", "traffic lights"];
        if of_light.is_empty() {
            notes.one(what, "left out, since they stand at the end of no lane that is carried over");
            continue;
        }
        match config(light, of_light, scenario.step_s, begin) {
            Some(config) if found.len() < MAX_LIGHTS => {
                taken.extend(config.lanes.iter().cloned());
                found.push(config);
            }
            _ => notes.one(what, "left out, since they have no cycle"),
        }
    }
    found
}

fn config(light: &Light, lanes: Vec<String>, step_s: f64, begin: f64) -> Option<LightConfig> {
    let phase = |(colour, steps): &(_, f64)| {
        let duration_s = rounded(steps * step_s, 6);
        (PHASES_S[0]..=PHASES_S[1]).contains(&duration_s).then_some(LightPhase { colour: *colour, duration_s })
    };
    let phases: Vec<LightPhase> = light.phases.iter().filter_map(phase).take(MAX_LIGHTS).collect();
    let offset_s = rounded((light.offset - begin) * step_s, 6);
    let is_sound = light.is_active && !phases.is_empty() && offset_s.abs() <= MAX_OFFSET_S;
    let name: String =
        format!("light-{}", light.id).chars().filter(|c| c.is_ascii_alphanumeric() || *c == '-').collect();
    is_sound.then_some(LightConfig { name, lanes, phases, offset_s })
}
