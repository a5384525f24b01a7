//! The network of a road, and its faults.

use std::sync::Arc;

use interplay_common::spelling::suggestion;
use interplay_planners::road::network::{Lane, LaneFault, NeighbourRelation, RoadNetwork, RoadNetworkError};

use crate::format::read::tree::TomlNode;
use crate::model::traffic::light::LightConfig;
use crate::roads::{Road, RoadFault, to_centimetres};
use crate::text::error::{Fault, quoted};

/// The network of a road; `None` for a road of parallel lanes.
///
/// # Errors
/// For lanes that do not form a network, and for a network without an exit.
pub(super) fn network(road: &Road, lights: &[LightConfig], tree: &TomlNode) -> Result<Option<RoadNetwork>, Fault> {
    let mut lanes = match road.network_lanes() {
        None => return Ok(None),
        Some(Err(fault)) => return Err(located(fault, tree)),
        Some(Ok(lanes)) => lanes,
    };
    place_lights(&mut lanes, lights, tree)?;
    let describer = Describer { road, lanes: &lanes, tree };
    let network = RoadNetwork::new(lanes.clone()).map_err(|error| describer.described(&error))?;
    if let Some(fault) = describer.without_end(&network) {
        return Err(fault);
    }
    Ok(Some(network))
}

/// Puts traffic lights at the ends of their lanes.
fn place_lights(lanes: &mut [Lane], lights: &[LightConfig], tree: &TomlNode) -> Result<(), Fault> {
    for (index, light) in lights.iter().enumerate() {
        let cycle = Arc::new(light.cycle());
        for (place, name) in light.lanes.iter().enumerate() {
            let at = tree.place_of(&format!("light.{index}.lanes.{place}"));
            let known = lanes.iter().position(|lane| lane.name == *name);
            let Some(lane) = known.map(|known| &mut lanes[known]) else {
                let names: Vec<&str> = lanes.iter().map(|lane| lane.name.as_str()).collect();
                let message = format!(
                    "light {} stands at lane {}, which the road does not have",
                    quoted(&light.name),
                    quoted(name)
                );
                return Err(Fault::at(at, "no such lane", message).help(suggestion(name, "the lanes are", &names)));
            };
            if lane.light.is_some() {
                let message = format!("two lights stand at the end of lane {}", quoted(name));
                return Err(Fault::at(at, "the second", message).help("name each lane once"));
            }
            lane.light = Some(Arc::clone(&cycle));
        }
    }
    Ok(())
}

fn located(fault: RoadFault, tree: &TomlNode) -> Fault {
    let path = if fault.path.is_empty() { "road".to_owned() } else { format!("road.{}", fault.path) };
    Fault::at(tree.place_of(&path), &fault.label, fault.message).help(fault.help)
}

struct Describer<'a> {
    road: &'a Road,
    lanes: &'a [Lane],
    tree: &'a TomlNode,
}

impl Describer<'_> {
    /// A fault at a key of a lane; in a short form, which has no lanes to point at, at the road.
    fn at(&self, index: usize, key: &str, label: &str, message: String) -> Fault {
        let path = match self.road {
            Road::Network(_) => format!("road.lane.{index}.{key}"),
            _ => "road".to_owned(),
        };
        Fault::at(self.tree.place_of(&path), label, message)
    }

    /// Lanes that form a loop without an exit.
    fn without_end(&self, network: &RoadNetwork) -> Option<Fault> {
        let caught = network.lanes_without_end();
        let first = caught.first()?;
        let index = self.lanes.iter().position(|lane| lane.name == first.name)?;
        let message = match caught.as_slice() {
            [_] => {
                format!("lane {} leads only to itself: vehicles on it drive in a circle for ever", quoted(&first.name))
            }
            more => format!(
                "lane {} and {} more lead only into a loop: vehicles on them drive in a circle for ever",
                quoted(&first.name),
                more.len() - 1
            ),
        };
        let fault = self.at(index, "successors", "never ends", message);
        Some(fault.help("give a lane of the loop a successor that leads out of it, or no successor"))
    }

    fn described(&self, error: &RoadNetworkError) -> Fault {
        let RoadNetworkError { lane, index, fault, .. } = error;
        let of = format!("lane {}", quoted(lane));
        let (key, label) = (self.key(error), label(fault));
        let at = |message: String| self.at(*index, &key, label, message);
        match fault {
            LaneFault::SameName => {
                let first = self.lanes.iter().position(|other| other.name == *lane).unwrap_or_default();
                let first = self.tree.place_of(&format!("road.lane.{first}.name"));
                at(format!("two lanes are called {}", quoted(lane)))
                    .also(first, "the first")
                    .help("give each lane a name of its own")
            }
            LaneFault::NotPositive { value, along_m } => {
                at(format!("{of} has the width {} m, {} m along it", to_centimetres(*value), to_centimetres(*along_m)))
                    .help("widths are above 0 m everywhere; 3.5 m is a usual one")
            }
            LaneFault::EdgesCross { width_m, radius_m, along_m } => at(format!(
                "{of} is {} m wide where it turns with a radius of {} m, {} m along it: its inner edge crosses itself",
                to_centimetres(*width_m),
                to_centimetres(*radius_m),
                to_centimetres(*along_m)
            ))
            .help(format!("less than {} m works there, or a larger radius", (200.0 * radius_m).floor() / 100.0)),
            LaneFault::UnknownLane { other } => {
                let names: Vec<&str> = self.lanes.iter().map(|lane| lane.name.as_str()).collect();
                at(format!("{of} names lane {}, which the road does not have", quoted(other))).help(suggestion(
                    other,
                    "the lanes are",
                    &names,
                ))
            }
            LaneFault::NamedTwice { other } => {
                at(format!("{of} names lane {} twice among its successors", quoted(other))).help("name it once")
            }
            LaneFault::OwnNeighbour => {
                at(format!("{of} is named as its own neighbour")).help("name the lane beside it")
            }
            LaneFault::Gap { .. } | LaneFault::Kink { .. } => self.not_touching(error),
            LaneFault::MeetsItself { first_m, again_m } => at(format!(
                "{of} comes back onto itself: after {} m it is where it was after {} m",
                to_centimetres(*again_m),
                to_centimetres(*first_m)
            ))
            .help("let it turn less, or end beside itself; it may cross itself at a large angle"),
            LaneFault::NoName | LaneFault::NoEnds => at(format!("{of} is invalid: {fault}")),
            LaneFault::WrongDirection { other }
            | LaneFault::ChangesSides { other, .. }
            | LaneFault::NotSideBySide { other, .. }
            | LaneFault::WrongSide { other } => self.beside(error, other),
        }
    }

    /// A neighbour, by its name, that is not where a lane states.
    fn beside(&self, error: &RoadNetworkError, other: &str) -> Fault {
        let RoadNetworkError { lane, index, fault, .. } = error;
        let of = format!("lane {}", quoted(lane));
        let (key, label) = (self.key(error), label(fault));
        let at = |message: String| self.at(*index, &key, label, message);
        match fault {
            LaneFault::WrongDirection { .. } => {
                let is_oncoming = self.lanes.get(*index).is_some_and(|lane| says_oncoming(lane, other));
                at(format!("lane `{other}` beside {of} does not run in the direction that is said of it")).help(
                    if is_oncoming {
                        "it runs in the same direction: leave `oncoming` out".to_owned()
                    } else {
                        format!("`{{ lane = \"{other}\", oncoming = true }}` is a lane in the opposite direction")
                    },
                )
            }
            LaneFault::ChangesSides { along_m, .. } => {
                at(format!("lane `{other}` crosses {of}, {} m along it", to_centimetres(*along_m)))
                    .help("neighbours lie side by side or merge; lanes that cross are no neighbours")
            }
            LaneFault::NotSideBySide { along_m, space_m, .. } => {
                self.not_side_by_side(*index, other, *along_m, *space_m, error)
            }
            _ => at(format!("lane `{other}` is not on this side of {of}"))
                .help("`left` and `right` are as who drives on the lane sees them"),
        }
    }

    /// A neighbour that overlaps a lane, or lies apart from it.
    fn not_side_by_side(
        &self,
        index: usize,
        other: &str,
        along_m: f64,
        space_m: f64,
        error: &RoadNetworkError,
    ) -> Fault {
        let (of, along_m, wide_m) = (quoted(&error.lane), to_centimetres(along_m), to_centimetres(space_m.abs()));
        let message = if space_m < 0.0 {
            format!("lane `{other}` overlaps lane {of} by {wide_m} m where they overlap least, {along_m} m along it")
        } else {
            format!(
                "lane `{other}` is {wide_m} m away from the edge of lane {of} where they are nearest, {along_m} m along it"
            )
        };
        let help = "the middles of neighbours are half of both widths apart; lanes elsewhere are no neighbours";
        self.at(index, &self.key(error), label(&error.fault), message).help(help)
    }

    /// A successor that does not begin where the lane ends, or not in its direction.
    fn not_touching(&self, error: &RoadNetworkError) -> Fault {
        let RoadNetworkError { lane, index, fault, .. } = error;
        let end = self.lanes.get(*index).map(|lane| lane.centre.at(lane.centre.length_m()));
        let (message, help) = match fault {
            LaneFault::Gap { other, gap_m, most_m } => {
                let ([x, y], gap_m) =
                    (end.map_or([0.0; 2], |end| end.position.map(to_centimetres)), to_centimetres(*gap_m));
                let message =
                    format!("lane `{lane}` does not touch its successor `{other}`: {gap_m} m are between them");
                let most_m = to_centimetres(*most_m);
                let help =
                    format!("`{other}` must begin where `{lane}` ends, at x = {x}, y = {y}, to within {most_m} m");
                (message, help)
            }
            LaneFault::Kink { other, turn_deg, most_deg } => {
                let end_deg = end.map_or(0.0, |end| to_centimetres(end.heading_rad.to_degrees()));
                let turn_deg = to_centimetres(*turn_deg);
                let message =
                    format!("lane `{lane}` and its successor `{other}` differ by {turn_deg} degrees in direction");
                let help = format!(
                    "`{other}` must begin at `heading_deg = {end_deg}`, in which `{lane}` ends, to within {most_deg:.0} degrees"
                );
                (message, help)
            }
            other => (format!("lane `{lane}` does not go on: {other}"), String::new()),
        };
        self.at(*index, &self.key(error), label(fault), message).help(help)
    }

    /// The key that states the line of a lane.
    fn line_key(&self, index: usize) -> &'static str {
        let stated = if let Road::Network(network) = self.road { network.lanes.get(index) } else { None };
        if stated.is_some_and(|lane| lane.pieces.is_empty()) { "points" } else { "pieces" }
    }

    /// The key of the wrong lane, as in files.
    fn key(&self, error: &RoadNetworkError) -> String {
        let successor = |other: &String| {
            let stated = self.lanes.get(error.index).map(|lane| lane.successors.as_slice()).unwrap_or_default();
            let last = stated.iter().rposition(|name| name == other);
            last.map_or_else(|| "successors".to_owned(), |place| format!("successors.{place}"))
        };
        match (error.field, &error.fault) {
            (
                "successors",
                LaneFault::UnknownLane { other }
                | LaneFault::NamedTwice { other }
                | LaneFault::Gap { other, .. }
                | LaneFault::Kink { other, .. },
            ) => successor(other),
            ("width", _) => "width_m".to_owned(),
            ("centre", _) => self.line_key(error.index).to_owned(),
            (field, _) => field.to_owned(),
        }
    }
}

/// Whether a lane states that its neighbour is driven in the opposite direction.
fn says_oncoming(lane: &Lane, other: &str) -> bool {
    let mut beside = [&lane.left, &lane.right].into_iter().flatten();
    beside.any(|neighbour| neighbour.lane == other && neighbour.relation == NeighbourRelation::Oncoming)
}

/// The label of the underlined text.
fn label(fault: &LaneFault) -> &'static str {
    match fault {
        LaneFault::NoName => "no name",
        LaneFault::SameName => "the second",
        LaneFault::NoEnds => "no ends",
        LaneFault::NotPositive { .. } => "no width",
        LaneFault::EdgesCross { .. } => "too wide",
        LaneFault::UnknownLane { .. } => "no such lane",
        LaneFault::NamedTwice { .. } => "again",
        LaneFault::OwnNeighbour => "the lane itself",
        LaneFault::Gap { .. } => "does not begin there",
        LaneFault::Kink { .. } => "begins in another direction",
        LaneFault::WrongDirection { .. } => "in the other direction",
        LaneFault::WrongSide { .. } => "on the other side",
        LaneFault::MeetsItself { .. } => "meets itself",
        LaneFault::ChangesSides { .. } => "crosses it",
        LaneFault::NotSideBySide { .. } => "not beside it",
    }
}
