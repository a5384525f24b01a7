//! The conflicts of a route with another one, as the route stores them.

/// A place where a route meets another one of the same network, described from the first route.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteConflict {
    /// The number of the other route.
    pub(super) with: usize,
    /// Where the route is on the lanes of the other one, from and to \[m\].
    pub own_m: [f64; 2],
    /// Where the other one is on the lanes of this one \[m\].
    pub their_m: [f64; 2],
    /// Where a vehicle on this route waits before the conflict \[m\].
    pub own_line_m: f64,
    /// Where a vehicle on the other route waits \[m\].
    pub their_line_m: f64,
    /// Where the centre lines meet, on this route \[m\].
    pub own_meeting_m: f64,
    /// Where the centre lines meet, on the other one \[m\].
    pub their_meeting_m: f64,
    /// Whether the routes cross, merge, part or run against each other there.
    pub kind: ConflictKind,
    /// Who goes first at the conflict.
    pub precedence: Precedence,
}

/// The rule for which vehicle goes first where two routes meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precedence {
    /// The vehicles on this route go first.
    Own,
    /// The vehicles on the other route go first.
    Other,
    /// The first to arrive goes first.
    ByArrival,
}

/// How two routes overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConflictKind {
    /// The routes come from different lanes and go on to different lanes.
    Crossing,
    /// The routes go on to the same lane.
    Merging,
    /// The routes come from the same lane and go on to different lanes.
    Diverging,
    /// The routes use the same strip in opposite directions.
    HeadOn,
}
