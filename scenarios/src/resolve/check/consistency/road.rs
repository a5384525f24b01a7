//! The check of the road, and of vehicles against its form.

use interplay_planners::road::network::RouteError;
use interplay_planners::{Body, Limits};

use super::checker::Checker;
use crate::format::read::tree::TomlNode;
use crate::model::scenario::Vehicle;
use crate::roads::{Branch, CurveFault, PieceFault, Road, RoadCurve};
use crate::text::error::{Fault, quoted};

/// The angles at which roads may cross, to either side \[deg\].
const CROSSING_ANGLE_DEG: std::ops::RangeInclusive<f64> = 20.0..=160.0;

/// Cosine of the largest angle between a start and the direction of its road.
const MIN_COS_OF_START: f64 = 0.5;

/// The faults of a curved road.
pub(crate) fn curve_faults(road: &Road, tree: &TomlNode) -> Vec<Fault> {
    let Road::Curve(curve) = road else { return Vec::new() };
    curve.check().err().map(|fault| described(curve, fault, tree)).into_iter().collect()
}

fn described(curve: &RoadCurve, fault: CurveFault, tree: &TomlNode) -> Fault {
    let at = |path: &str, label: &str, message: String| Fault::at(tree.place_of(path), label, message);
    match fault {
        CurveFault::Piece { piece, fault } => described_piece(piece, fault, tree),
        CurveFault::TooLong { length_m, most_m } => {
            let message = format!("the road is {} m long", rounded(length_m));
            at("road.pieces", "too long", message).help(format!(
                "a curve of this width may be at most {} m long; beyond its pieces the road goes on straight",
                rounded(most_m)
            ))
        }
        CurveFault::NoRoom { piece, length_m, transition_m, most_m } => {
            let message = format!(
                "`road.transition_m` ({}) is too long for `road.pieces.{piece}`, which is {} m long",
                rounded(transition_m),
                rounded(length_m)
            );
            let help = format!(
                "at most {} m works: half of each transition lies on each piece beside it",
                rounded_down(most_m)
            );
            let fault = at("road.transition_m", "too long", message);
            fault.also(tree.place_of(&format!("road.pieces.{piece}")), "for this piece").help(help)
        }
        CurveFault::MeetsItself { first_m, again_m } => {
            let message = format!(
                "the road meets itself: after {} m it is where it was after {} m",
                rounded(again_m),
                rounded(first_m)
            );
            at("road.pieces", "meets itself", message)
                .help("let it turn less, or lengthen the pieces between the turns")
        }
        CurveFault::NoLaneBeside => {
            let message = "lane 0 ends, but there is no lane beside it".to_owned();
            at("road.lane_end", "the only lane", message).help("`lane_count` must be at least 2")
        }
        CurveFault::EndsBeyond { end_m, length_m } => {
            let message = format!("`road.lane_end.end_m` ({end_m}) is beyond the end of the road");
            let help = format!(
                "the {} {} {} m long together",
                plural(curve.pieces.len(), "piece"),
                if curve.pieces.len() == 1 { "is" } else { "are" },
                rounded_down(length_m)
            );
            at("road.lane_end.end_m", "beyond the road", message).help(help)
        }
    }
}

fn described_piece(piece: usize, fault: PieceFault, tree: &TomlNode) -> Fault {
    let at = |path: &str, label: &str, message: String| Fault::at(tree.place_of(path), label, message);
    match fault {
        PieceFault::NoPiece => {
            let message = format!("`road.pieces.{piece}` is neither straight nor a turn");
            at(&format!("road.pieces.{piece}"), "no piece", message)
                .help("state `straight_m`, or `turn_deg` and `radius_m`")
        }
        PieceFault::HalfTurn { key } => {
            let message = format!("`road.pieces.{piece}.{key}` is missing");
            at(&format!("road.pieces.{piece}"), &format!("has no `{key}`"), message)
                .help("a turn has `turn_deg` and `radius_m`, for example `{ turn_deg = 90.0, radius_m = 25.0 }`")
        }
        PieceFault::NoTurn => {
            let message = format!("`road.pieces.{piece}.turn_deg` is 0");
            at(&format!("road.pieces.{piece}.turn_deg"), "no turn", message)
                .help("positive values turn to the left; a straight piece is `{ straight_m = 30.0 }`")
        }
        PieceFault::TooTight { radius_m, least_m } => {
            let message = format!(
                "`road.pieces.{piece}.radius_m` ({radius_m}) is not above half of the road's width: the inner edge would \
                 cross itself"
            );
            let help = format!("more than {} m works; so do fewer or narrower lanes", rounded(least_m));
            at(&format!("road.pieces.{piece}.radius_m"), "too tight", message).help(help)
        }
    }
}

/// A length to the millimetre.
fn rounded(length_m: f64) -> f64 {
    (1e3 * length_m).round() / 1e3
}

/// A length rounded down to the millimetre.
fn rounded_down(length_m: f64) -> f64 {
    (1e3 * length_m).floor() / 1e3
}

/// Why a road lacks a lane, and what would work; `None` if it has the lane.
pub(crate) fn no_such_lane(path: &str, lane: usize, road: &Road) -> Option<(String, String)> {
    let lanes = road.parallel_lanes()?.count;
    let message = format!("`{path}` is {lane}, but the road has only {lanes} {}", plural(lanes, "lane"));
    let help = format!("lanes are counted from the right: 0 to {}", lanes.saturating_sub(1));
    (lane >= lanes).then_some((message, help))
}

/// Radius on which the mass centre of a vehicle drives at its largest steering angle, by the bicycle model \[m\].
fn smallest_radius_m(body: &Body, limits: &Limits) -> f64 {
    libm::hypot(body.rear_axle_m, body.wheelbase_m() / libm::tan(limits.steering_max_rad))
}

impl Checker<'_> {
    /// Roads that cross at a small angle run nearly side by side, and their conflict zone is as long as they are.
    pub(super) fn road(&mut self) {
        if let Road::Intersection(crossing) = &self.scenario.road
            && !CROSSING_ANGLE_DEG.contains(&crossing.angle_deg.abs())
        {
            let message = format!("`road.angle_deg` is {}, at which roads hardly cross", crossing.angle_deg);
            let help = format!(
                "from {} to {} the crossing road comes from the right of the main one, with a minus from its left",
                CROSSING_ANGLE_DEG.start(),
                CROSSING_ANGLE_DEG.end()
            );
            self.refuse("road.angle_deg", "too small an angle", message, &help);
        }
    }

    /// Whether the vehicle's road exists and its start is along it.
    pub(super) fn branch(&mut self, index: usize, vehicle: &Vehicle) {
        let (name, road, path) = (&vehicle.name, &self.scenario.road, format!("vehicle.{index}"));
        if vehicle.road == Branch::Cross && !matches!(road, Road::Intersection(_)) {
            let message = format!("`vehicle.{name}.road` is \"cross\", but there is no crossing road");
            let help = "`[road]` with `kind = \"intersection\"` has one";
            self.refuse(&format!("{path}.road"), "no such road", message, help);
            return;
        }
        // On a network the lane of the start was found by its direction.
        if self.scenario.network.is_some() {
            return;
        }
        let heading = vehicle.route.heading_at(vehicle.start.position());
        if libm::cos(vehicle.start.heading_rad - heading) >= MIN_COS_OF_START {
            return;
        }
        let start = vehicle.start.heading_rad;
        let (message, help) = if matches!(road, Road::Intersection(_)) {
            (
                format!("`vehicle.{name}.start.heading_rad` ({start}) is not along the vehicle's road"),
                format!("its road runs at heading_rad = {heading}, and `road` chooses between both"),
            )
        } else {
            (
                format!("the start of vehicle {} is not along its road", quoted(name)),
                format!(
                    "the road runs at `heading_deg = {}` there; `lane` and `along_m` place a vehicle along it",
                    (10.0 * heading.to_degrees()).round() / 10.0
                ),
            )
        };
        self.refuse(&format!("{path}.start"), "heads elsewhere", message, &help);
    }

    /// Whether the vehicle can follow its lane through each turn.
    pub(super) fn turns(&mut self, index: usize, vehicle: &Vehicle) {
        let road = &self.scenario.road;
        let (turns, smallest_m) = (road.turns(), smallest_radius_m(&vehicle.body, &vehicle.limits));
        if self.scenario.network.is_some()
            && let Err(error) = vehicle.route.check_turns(smallest_m)
        {
            self.too_tight(index, vehicle, error);
        }
        if turns.is_empty() {
            return;
        }
        let start_m = vehicle.route.across(vehicle.start.position());
        let goal_m = vehicle.goal_lane_centre_m(road).unwrap_or(start_m);
        let radius_m = |turn: &crate::roads::Turn| turn.radius_at_m(start_m).min(turn.radius_at_m(goal_m));
        let Some(turn) = turns.iter().min_by(|a, b| radius_m(a).total_cmp(&radius_m(b))) else { return };
        if radius_m(turn) < smallest_m {
            let message = format!(
                "the lane of vehicle {} turns with a radius of {} m, but the vehicle needs {} m",
                quoted(&vehicle.name),
                rounded(radius_m(turn)),
                rounded(smallest_m)
            );
            let help = "widen `radius_m`, or let the vehicle steer more: `steering_max_rad` in its `limits`";
            let fault =
                Fault::at(self.place(&format!("vehicle.{index}.start")), "on a lane that is too tight", message);
            let turn = self.place(&format!("road.pieces.{}.radius_m", turn.piece));
            self.faults.push(fault.also(turn, "this turn").help(help));
        }
    }
}

impl Checker<'_> {
    /// A lane on the route of a vehicle has a smaller turning radius than the vehicle.
    fn too_tight(&mut self, index: usize, vehicle: &Vehicle, error: RouteError) {
        let RouteError::TooTight { lane, radius_m, smallest_m, .. } = error else { return };
        let message = format!(
            "lane {} on the route of vehicle {} turns with a radius of {} m, but the vehicle needs {} m",
            quoted(&lane),
            quoted(&vehicle.name),
            rounded(radius_m),
            rounded(smallest_m)
        );
        let help = "a larger radius works, or a vehicle that steers more: `steering_max_rad` in its `limits`";
        let fault = Fault::at(self.place(&format!("vehicle.{index}.start")), "its route is too tight", message);
        let written = self.scenario.network.as_ref().and_then(|network| {
            let number = network.lanes().iter().position(|other| other.name == lane)?;
            self.tree.at(&format!("road.lane.{number}"))
        });
        let fault = written.into_iter().fold(fault, |fault, lane| fault.also(&lane.place, "this lane"));
        self.faults.push(fault.help(help));
    }
}

fn plural(count: usize, noun: &str) -> String {
    if count == 1 { noun.to_owned() } else { format!("{noun}s") }
}
