//! A kind of obstacle of one's own.

// shown from here
use interplay_scenarios::DeclaredObstacle;

/// A bollard at the edge of a road.
pub const BOLLARD: DeclaredObstacle =
    DeclaredObstacle { kind: "bollard", about: "A bollard, a circle of 0.2 m.", size_m: [0.2, 0.2], is_round: true };
// shown until here
