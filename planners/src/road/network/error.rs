//! Errors of lanes that do not form a valid network, and of lists of lanes that are not a route.

use thiserror::Error;

use super::super::centre_line::CentreLineError;

/// A fault of a lane of a network, with the lane and the field.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("lane `{lane}`: {fault}")]
pub struct RoadNetworkError {
    /// The name of the lane.
    pub lane: String,
    /// The place of the lane in the list, from 0.
    pub index: usize,
    /// The field of [`Lane`](super::Lane) that is wrong.
    pub field: &'static str,
    /// What is wrong with the field.
    pub fault: LaneFault,
}

/// A fault of a lane.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LaneFault {
    /// The lane has no name.
    #[error("it has no name")]
    NoName,
    /// Another lane before it has the same name.
    #[error("another lane has the same name")]
    SameName,
    /// The centre line has no ends.
    #[error("its centre line has no ends")]
    NoEnds,
    /// A width, or a speed limit, is not a positive finite number.
    #[error("{value} at {along_m:.2} m is not a positive finite number")]
    NotPositive {
        /// The value that is not positive.
        value: f64,
        /// Arc length of the lane at which the fault is \[m\].
        along_m: f64,
    },
    /// The curve is so tight for the width that an edge crosses itself: `|κ| w/2 ≥ 1`.
    #[error(
        "it is {width_m:.2} m wide where its centre line has a radius of {radius_m:.2} m, {along_m:.2} m along it: the inner \
         edge crosses itself"
    )]
    EdgesCross {
        /// Arc length of the lane at which the fault is \[m\].
        along_m: f64,
        /// Width of the lane at that arc length \[m\].
        width_m: f64,
        /// Radius of the centre line at that arc length \[m\].
        radius_m: f64,
    },
    /// The lane names a lane that does not exist.
    #[error("there is no lane `{other}`")]
    UnknownLane {
        /// The name that is wrong.
        other: String,
    },
    /// The lane names a lane twice among its successors.
    #[error("lane `{other}` is named twice")]
    NamedTwice {
        /// The name that is wrong.
        other: String,
    },
    /// The lane names itself as its neighbour.
    #[error("a lane is not its own neighbour")]
    OwnNeighbour,
    /// The lane does not end where its successor begins.
    #[error("its end is {gap_m:.2} m from the begin of its successor `{other}`, more than {most_m:.2} m")]
    Gap {
        /// Name of the successor.
        other: String,
        /// Distance between both \[m\].
        gap_m: f64,
        /// Largest distance that is accepted \[m\].
        most_m: f64,
    },
    /// The successor of the lane begins in another direction.
    #[error(
        "its end and the begin of its successor `{other}` differ by {turn_deg:.1}° in direction, more than {most_deg:.0}°"
    )]
    Kink {
        /// Name of the successor.
        other: String,
        /// How much the directions differ \[deg\].
        turn_deg: f64,
        /// Largest difference that is accepted \[deg\].
        most_deg: f64,
    },
    /// A neighbour runs in the other direction than it should.
    #[error("its neighbour `{other}` does not run in the direction that is said of it")]
    WrongDirection {
        /// Name of the neighbour.
        other: String,
    },
    /// The lane comes back onto itself.
    #[error("after {again_m:.2} m it is where it was after {first_m:.2} m")]
    MeetsItself {
        /// Arc length at which the lane is there first \[m\].
        first_m: f64,
        /// Arc length at which the lane is there again \[m\].
        again_m: f64,
    },
    /// A neighbour changes to the other side.
    #[error("its neighbour `{other}` is on the other side of it {along_m:.2} m along it")]
    ChangesSides {
        /// Name of the neighbour.
        other: String,
        /// Arc length of the lane at which the fault is \[m\].
        along_m: f64,
    },
    /// A neighbour lies nowhere side by side with the lane.
    #[error("its neighbour `{other}` is nowhere beside it: {space_m:.2} m are between both at {along_m:.2} m")]
    NotSideBySide {
        /// Name of the neighbour.
        other: String,
        /// Where along the lane they come nearest to lying side by side \[m\].
        along_m: f64,
        /// Width of the strip between both there, negative where they overlap \[m\].
        space_m: f64,
    },
    /// A neighbour is not on the side that is said of it.
    #[error("its neighbour `{other}` is not on this side of it")]
    WrongSide {
        /// Name of the neighbour.
        other: String,
    },
}

/// Why a list of lanes is not a valid route.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RouteError {
    /// No lanes are named.
    #[error("a route needs at least one lane")]
    NoLanes,
    /// No lane has this name.
    #[error("there is no lane `{lane}`")]
    UnknownLane {
        /// The name that is wrong.
        lane: String,
    },
    /// A lane of the route is neither a successor of the one before nor a neighbour into which one may change.
    #[error("lane `{to}` is neither a successor of lane `{from}` nor a neighbour into which a vehicle may change")]
    NotConnected {
        /// Name of the lane before.
        from: String,
        /// The lane that cannot be reached from it.
        to: String,
    },
    /// Two lanes do not run side by side for long enough to change from one to the other.
    #[error("lane `{from}` leaves {room_m:.2} m for a change into lane `{to}`, which needs {needed_m:.2} m")]
    NoRoomToChange {
        /// Name of the lane before.
        from: String,
        /// Name of the lane beside it.
        to: String,
        /// Length of the stretch in which the change must end \[m\].
        room_m: f64,
        /// Least length of this stretch \[m\].
        needed_m: f64,
    },
    /// No sequence of lanes leads from one lane to another.
    #[error("no route leads from lane `{from}` to lane `{to}`")]
    NoWay {
        /// Name of the lane at which the route would begin.
        from: String,
        /// Name of the lane at which the route would end.
        to: String,
    },
    /// The centre lines of lanes cannot be joined.
    #[error("the centre lines of {} cannot be joined: {source}", lanes.join(", "))]
    Centre {
        /// Names of the lanes of the route.
        lanes: Vec<String>,
        /// Why the lines cannot be joined.
        source: CentreLineError,
    },
    /// A curve is tighter than a vehicle can turn.
    #[error(
        "lane `{lane}` has a radius of {radius_m:.2} m, {along_m:.2} m along the route; the vehicle needs {smallest_m:.2} m"
    )]
    TooTight {
        /// Name of the lane.
        lane: String,
        /// Arc length of the route \[m\].
        along_m: f64,
        /// Radius of the centre line at that arc length \[m\].
        radius_m: f64,
        /// The vehicle's smallest turning radius \[m\].
        smallest_m: f64,
    },
}
