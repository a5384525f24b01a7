//! How a plan passes another vehicle, in types and in words.

use std::fmt;

/// How a plan passes another vehicle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlannedPassing {
    /// The other vehicle, by its name.
    pub of: String,
    /// On which side of it the plan leads.
    pub side: PassingSide,
}

/// A side of another vehicle, as that vehicle faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassingSide {
    /// Ahead of it; where roads cross, over its path before it comes.
    Ahead,
    /// On its left.
    Left,
    /// Behind it; where roads cross, over its path after it has passed.
    Behind,
    /// On its right.
    Right,
}

impl fmt::Display for PlannedPassing {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = match self.side {
            PassingSide::Ahead => "ahead of",
            PassingSide::Left => "left of",
            PassingSide::Behind => "behind",
            PassingSide::Right => "right of",
        };
        write!(formatter, "{side} {}", self.of)
    }
}

impl PlannedPassing {
    /// The passing as a sentence about the planning vehicle, without the subject.
    pub fn sentence(&self) -> String {
        let verb = match self.side {
            PassingSide::Ahead => "goes",
            PassingSide::Behind => "stays",
            PassingSide::Left | PassingSide::Right => "drives",
        };
        format!("{verb} {self}")
    }
}
