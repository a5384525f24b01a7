//! Vehicles on networks of lanes: their starts and their routes.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use interplay_common::spelling::{listed, suggestion};
use interplay_planners::road::network::{EndingLane, Lane, LaneUser, RoadNetwork, RouteError, Turner};
use interplay_planners::{Body, Limits, Route, State};

use super::known_roads::KnownNetwork;
use super::written::{Start, VehicleAsWritten, next_to};
use crate::model::classes::VehicleClass;
use crate::model::traffic::lane_reference::LaneReference;
use crate::roads::to_centimetres;
use crate::text::error::{Fault, quoted};

/// Cosine of the largest angle between a start and its lane.
const MIN_COS_OF_START: f64 = 0.5;

const MAX_NAMES: usize = 12;

/// The state of a vehicle at its start, and its route from the start of the lane there.
///
/// # Errors
/// For a start that is on no lane, and if no route leads to the goal; all errors are returned.
pub(super) fn place(written: &VehicleAsWritten<'_>, known: &KnownNetwork) -> Result<Start, Vec<Fault>> {
    let user = written.stated.class.map_or(LaneUser::Car, VehicleClass::lane_user);
    let vehicle = NetworkVehicle { written, known, user, open: known.open_to(user) };
    if written.stated.start.is_in_lane() {
        return vehicle.in_lane();
    }
    vehicle.in_world().map_err(|fault| vehicle.with_goal(fault))
}

struct NetworkVehicle<'a> {
    written: &'a VehicleAsWritten<'a>,
    known: &'a KnownNetwork,
    /// The type of road user that lanes admit it as.
    user: LaneUser,
    /// The part of the network that is open to it.
    open: Arc<RoadNetwork>,
}

impl NetworkVehicle<'_> {
    /// A start in a lane. The faults of the position in the lane and of the route from there are reported together.
    fn in_lane(&self) -> Result<Start, Vec<Fault>> {
        let lane = self.start_lane().map_err(|fault| self.with_goal(fault))?;
        let stated = &self.written.stated.start;
        let place = self.along_m(lane).and_then(|along_m| {
            let offset_m = self.written.offset_within(lane.half_width_m(along_m))?;
            let [x_m, y_m] = lane.centre.position(along_m, offset_m);
            let heading_rad = lane.centre.at(along_m).heading_rad + stated.heading_error_rad();
            Ok((State { x_m, y_m, heading_rad, speed_mps: stated.speed_mps }, along_m))
        });
        match (place, self.route(lane)) {
            (Ok((state, along_m)), Ok(route)) => Ok(self.on_route(state, along_m, route)),
            (place, route) => Err(place.err().into_iter().chain(route.err()).collect()),
        }
    }

    /// A fault of the start, and with it that of a goal on no lane.
    fn with_goal(&self, start: Fault) -> Vec<Fault> {
        let goal = self.written.stated.goal.lane.as_ref().and_then(|goal| self.known("goal.lane", goal).err());
        let is_new = |goal: &Fault| goal.message() != start.message();
        let goal = goal.filter(is_new);
        [start].into_iter().chain(goal).collect()
    }

    /// The lane in which the vehicle starts, by its name.
    fn start_lane(&self) -> Result<&Lane, Fault> {
        let stated = self.written.stated.start.lane.as_ref().ok_or_else(|| self.written.missing("lane"))?;
        self.known("start.lane", stated)
    }

    /// The lane that a key names.
    fn known(&self, key: &str, stated: &LaneReference) -> Result<&Lane, Fault> {
        let shown = format!("`{}.{key}`", self.written.shown());
        let name = match stated {
            LaneReference::Name(name) => name,
            LaneReference::Number(number) => {
                let message = format!("{shown} is the number {number}, but the lanes of this road have names");
                let fault = self.written.fault(key, "not a name", message);
                return Err(fault.help(format!("the lanes are: {}", self.some_names())));
            }
        };
        if let Some(lane) = self.known.network.lane(name).filter(|lane| !lane.is_open_to(self.user)) {
            let message = format!("{shown} names lane {}, which is not for vehicles of this class", quoted(&lane.name));
            let fault = self.written.fault(key, "kept for others", message);
            return Err(fault.help("state another lane, the `class` for which it is kept, or more `users` of the lane"));
        }
        self.known.network.lane(name).ok_or_else(|| {
            let names: Vec<&str> = self.known.network.lanes().iter().map(|lane| lane.name.as_str()).collect();
            let near = suggestion(name, "", &names);
            let help = if near.starts_with("did") { near } else { format!("the lanes are: {}", self.some_names()) };
            let message = format!("{shown} names lane {}, which the road does not have", quoted(name));
            self.written.fault(key, "no such lane", message).help(help)
        })
    }

    /// The names of lanes that begin or end the network, and of others up to the limit.
    fn some_names(&self) -> String {
        let lanes = self.known.network.lanes();
        let has_before = |lane: &Lane| lanes.iter().any(|other| other.successors.contains(&lane.name));
        let is_outer = |lane: &&Lane| lane.successors.is_empty() || !has_before(lane);
        let names: Vec<&str> = lanes.iter().filter(is_outer).map(|lane| lane.name.as_str()).collect();
        some(&names)
    }

    /// The distance along the lane at which the vehicle starts \[m\].
    fn along_m(&self, lane: &Lane) -> Result<f64, Fault> {
        let (along_m, length_m) = (self.written.stated.start.along_m, lane.centre.length_m());
        let along_m = along_m.ok_or_else(|| self.written.missing("along_m"))?;
        if (0.0..=length_m).contains(&along_m) {
            return Ok(along_m);
        }
        let message =
            format!("`{}.start.along_m` ({along_m}) is not on lane {}", self.written.shown(), quoted(&lane.name));
        let help = format!("the lane is {} m long", to_centimetres(length_m));
        Err(self.written.fault("start.along_m", "not on the lane", message).help(help))
    }

    /// A start in world coordinates is on the lane whose direction is nearest to its own and from which the goal can be
    /// reached.
    fn in_world(&self) -> Result<Start, Fault> {
        let [x_m, y_m] = self.written.position()?;
        let heading_rad = self.written.stated.start.heading_rad();
        let state = State { x_m, y_m, heading_rad, speed_mps: self.written.stated.start.speed_mps };
        let places = self.open.locate([x_m, y_m], heading_rad);
        let mut refused = None;
        for place in places.iter().filter(|place| libm::cos(place.heading_error_rad) >= MIN_COS_OF_START) {
            let Some(lane) = self.known.network.lane(&place.lane) else { continue };
            match self.route(lane) {
                Ok(route) => return Ok(self.on_route(state, place.point.along_m, route)),
                Err(fault) => refused = refused.or(Some(fault)),
            }
        }
        Err(refused.unwrap_or_else(|| match places.first() {
            Some(place) => {
                let message = format!("the start of {} is not along a lane", quoted(&self.written.shown()));
                let heading_deg = (10.0 * place.point.heading_rad.to_degrees()).round() / 10.0;
                let help = format!("lane `{}` runs at `heading_deg = {heading_deg}` there", place.lane);
                self.written.at_start("heads elsewhere", message).help(help)
            }
            None => {
                let message = format!("the start of {} is on no lane", quoted(&self.written.shown()));
                let help = format!("`lane` and `along_m` place a vehicle on a lane; there are {}", self.some_names());
                self.written.at_start("beside the lanes", message).help(help)
            }
        }))
    }

    /// A state at a distance along the first lane of a route \[m\].
    fn on_route(&self, state: State, along_m: f64, route: Arc<Route>) -> Start {
        let along_rad = route.locate(state.position(), Some(along_m)).heading_rad;
        (State { heading_rad: next_to(state.heading_rad, along_rad), ..state }, route)
    }

    /// The route from the start of a lane on: along the stated lanes, or to the lane of the goal, or the only one.
    fn route(&self, lane: &Lane) -> Result<Arc<Route>, Fault> {
        let goal = self.written.stated.goal.lane.as_ref().map(|goal| format!("{goal:?}")).unwrap_or_default();
        let words =
            [&[lane.name.clone(), goal, format!("{:?}", self.user)], self.written.stated.route.as_slice()].concat();
        let plain = self.known.route(words.clone(), || self.new_route(lane))?;
        let (plain, words) = self.leaving_late(plain, words)?;
        let Some(turner) = self.turner() else { return Ok(plain) };
        // A long body swings out in tight turns.
        let words = [words, vec![format!("{turner:?}")]].concat();
        self.known.route(words, || Ok(self.known.network.route_of_body(Route::clone(&plain), &turner)))
    }

    /// The same route for a driver who knows comfort: it leaves a lane that ends near its end, after it has become fast there.
    fn leaving_late(&self, plain: Arc<Route>, words: Vec<String>) -> Result<(Arc<Route>, Vec<String>), Fault> {
        let limits: Option<Limits> = self.written.stated.limits.clone().and_then(|limits| limits.settings().ok());
        let lanes: Vec<&str> = plain.legs.iter().map(|leg| leg.lane.as_str()).collect();
        let ends = |name: &&str| self.open.lane(name).is_some_and(|lane| lane.successors.is_empty());
        let leaves_one = lanes.split_last().is_some_and(|(_, before)| before.iter().any(ends));
        if !leaves_one || limits.is_none_or(|limits| limits.comfort.is_none()) {
            return Ok((plain, words));
        }
        let words = [words, vec!["late".to_owned()]].concat();
        let late = || self.open.route_leaving(&lanes, EndingLane::End).map_err(|error| self.no_route(error));
        Ok((self.known.route(words.clone(), late)?, words))
    }

    /// What of the vehicle decides how it comes round a turn; `None` where that is invalid, which later checks refuse.
    fn turner(&self) -> Option<Turner> {
        let Limits { steering_max_rad, .. } = self.written.stated.limits.clone()?.settings().ok()?;
        let body: Body = self.written.stated.body.clone()?.settings().ok()?;
        let is_sound = [body.front_m, body.rear_m, body.width_m, body.front_axle_m, body.rear_axle_m, steering_max_rad];
        let is_sound = is_sound.iter().all(|size| size.is_finite() && *size > 0.0);
        (is_sound && steering_max_rad < FRAC_PI_2).then_some(Turner { body, steering_max_rad })
    }

    fn new_route(&self, lane: &Lane) -> Result<Route, Fault> {
        let refused = |error| self.no_route(error);
        let goal = self.written.stated.goal.lane.as_ref().map(|goal| self.known("goal.lane", goal)).transpose()?;
        let Some(first) = self.written.stated.route.first() else {
            return match goal {
                Some(goal) => self.open.shortest_route(&lane.name, &goal.name).map_err(refused),
                None => self.open.route(&self.only_way(lane)?).map_err(refused),
            };
        };
        for (index, name) in self.written.stated.route.iter().enumerate() {
            self.known(&format!("route.{index}"), &LaneReference::Name(name.clone()))?;
        }
        if *first != lane.name {
            let message = format!(
                "the route of {} begins on lane {}, but the vehicle starts on lane `{}`",
                quoted(&self.written.shown()),
                quoted(first),
                lane.name
            );
            return Err(self
                .written
                .fault("route.0", "not the lane of the start", message)
                .help("a route begins with the lane on which the vehicle starts"));
        }
        let last = self.written.stated.route.last().unwrap_or(first);
        if let Some(goal) = goal.filter(|goal| goal.name != *last) {
            let message =
                format!("the route of {} does not end on the lane of its goal", quoted(&self.written.shown()));
            let key = format!("route.{}", self.written.stated.route.len() - 1);
            return Err(self
                .written
                .fault(&key, "the last lane", message)
                .help(format!("leave the `lane` of its goal out, or add the lanes from `{last}` to `{}`", goal.name)));
        }
        self.open.route(&self.written.stated.route).map_err(refused)
    }

    /// The lanes from a lane on, as long as each has one successor.
    fn only_way(&self, lane: &Lane) -> Result<Vec<String>, Fault> {
        let mut names = vec![lane.name.clone()];
        let mut last = self.open.lane(&lane.name).unwrap_or(lane);
        while let [only] = last.successors.as_slice() {
            let Some(next) = self.open.lane(only).filter(|_| !names.contains(only)) else { break };
            names.push(only.clone());
            last = next;
        }
        if last.successors.len() < 2 {
            return Ok(names);
        }
        let message = format!("nothing says where {} goes: lane `{}` forks", quoted(&self.written.shown()), last.name);
        let help = format!("its goal may have one of these lanes: {}", some(&self.ends_from(lane)));
        Err(self.written.fault("name", "without a goal lane", message).help(help))
    }

    /// The lanes that can be reached from a lane, if every lane change had enough room.
    fn reached_from<'b>(&'b self, lane: &'b Lane) -> Vec<&'b str> {
        let mut reached: Vec<&str> = vec![&lane.name];
        let mut index = 0;
        while let Some(lane) = reached.get(index).and_then(|name| self.known.network.lane(name)) {
            let beside = [&lane.left, &lane.right].into_iter().flatten().filter(|other| other.is_open());
            for name in lane.successors.iter().chain(beside.map(|other| &other.lane)) {
                if let Some(next) = self.known.network.lane(name).filter(|next| !reached.contains(&next.name.as_str()))
                {
                    reached.push(&next.name);
                }
            }
            index += 1;
        }
        reached
    }

    /// Those of them without successors.
    fn ends_from<'b>(&'b self, lane: &'b Lane) -> Vec<&'b str> {
        let is_end = |name: &&str| self.known.network.lane(name).is_some_and(|lane| lane.successors.is_empty());
        self.reached_from(lane).into_iter().filter(is_end).collect()
    }

    /// The place of a lane of the route.
    fn key_of(&self, lane: &str) -> String {
        let place = self.written.stated.route.iter().position(|name| name == lane);
        place.map_or_else(|| "goal.lane".to_owned(), |place| format!("route.{place}"))
    }

    fn no_route(&self, error: RouteError) -> Fault {
        let of = format!("the route of {}", quoted(&self.written.shown()));
        match error {
            RouteError::NotConnected { from, to } => {
                let ahead = self.known.network.lane(&from).map(|lane| lane.successors.as_slice()).unwrap_or_default();
                let help = match ahead {
                    [] => format!("lane `{from}` ends there; lanes beside it need `may_change`"),
                    ahead => format!("lane `{from}` leads to {}", listed(ahead)),
                };
                let message = format!("{of} cannot go from lane `{from}` to lane `{to}`");
                self.written.fault(&self.key_of(&to), "not connected", message).help(help)
            }
            RouteError::NoRoomToChange { from, to, room_m, needed_m } => {
                let message = format!(
                    "{of} has no room to change from lane `{from}` to lane `{to}`: there are {} m, and {} m are needed",
                    to_centimetres(room_m.max(0.0)),
                    to_centimetres(needed_m)
                );
                let help = format!("let it start on lane `{to}`, or lengthen the lanes");
                self.written.fault(&self.key_of(&to), "no room to change", message).help(help)
            }
            RouteError::NoWay { from, to } => {
                let from_lane = self.known.network.lane(&from);
                if from_lane.is_some_and(|lane| self.reached_from(lane).contains(&to.as_str())) {
                    let message =
                        format!("{of} has no room to change lanes on the way from lane `{from}` to lane `{to}`");
                    let fault = self.written.fault("goal.lane", "no room to change", message);
                    return fault.help("let it start on a lane that leads there, or lengthen the lanes");
                }
                let ends = from_lane.map(|lane| self.ends_from(lane)).unwrap_or_default();
                let message = format!("no way leads from lane `{from}` to lane `{to}`");
                let help = format!("from there one can reach {}", some(&ends));
                self.written.fault("goal.lane", "not reachable", message).help(help)
            }
            other @ (RouteError::NoLanes
            | RouteError::UnknownLane { .. }
            | RouteError::Centre { .. }
            | RouteError::TooTight { .. }) => {
                let message = format!("{of} is invalid: {other}");
                self.written.fault(&self.key_of(""), "no route", message).help("another `lane` or `route` may work")
            }
        }
    }
}

/// The first of some names.
fn some(names: &[&str]) -> String {
    let shown = listed(&names[..names.len().min(MAX_NAMES)]);
    if names.len() > MAX_NAMES { format!("{shown} and {} more", names.len() - MAX_NAMES) } else { shown }
}
