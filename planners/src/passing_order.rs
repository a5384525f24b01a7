//! How a plan passes another vehicle, in types and in words.

use std::fmt;

/// How a plan passes another vehicle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PassingOrder {
    /// The other vehicle, by its name.
    pub of: String,
    /// Where the plan leads relative to it.
    pub position: PassingPosition,
}

/// A place relative to another vehicle, as that vehicle faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassingPosition {
    /// Ahead of it; where roads cross, over its path before it comes.
    Ahead,
    /// On its left.
    Left,
    /// Behind it; where roads cross, over its path after it has passed.
    Behind,
    /// On its right.
    Right,
}

impl fmt::Display for PassingOrder {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = match self.position {
            PassingPosition::Ahead => "ahead of",
            PassingPosition::Left => "left of",
            PassingPosition::Behind => "behind",
            PassingPosition::Right => "right of",
        };
        write!(formatter, "{side} {}", self.of)
    }
}

impl PassingOrder {
    /// The order as a sentence about whoever plans it, without the subject.
    pub fn sentence(&self) -> String {
        let verb = match self.position {
            PassingPosition::Ahead => "goes",
            PassingPosition::Behind => "stays",
            PassingPosition::Left | PassingPosition::Right => "drives",
        };
        format!("{verb} {self}")
    }
}
