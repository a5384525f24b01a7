//! What a driver sees at a moment that reacts to it.

use std::fmt;

use super::lane_order::OnStraightRoad;
use crate::{Agent, Goal, Scene};

/// What a reacting driver can see at a moment.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// The own vehicle.
    pub own: &'a Agent,
    /// Its goal.
    pub goal: &'a Goal,
    /// Time until the next answer \[s\].
    pub step_s: f64,
    pub(crate) road: Option<OnStraightRoad<'a>>,
    pub(crate) scene: &'a dyn Fn() -> Scene,
}

impl fmt::Debug for Moment<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Moment").field("own", self.own).finish_non_exhaustive()
    }
}

impl<'a> Moment<'a> {
    /// The own vehicle among the others of its straight road; none on other roads.
    pub(crate) fn on_straight_road(&self) -> Option<OnStraightRoad<'a>> {
        self.road
    }

    /// The moment as a scene: with a horizon of one step, and over the whole horizon where a vehicle stands that may have to be passed.
    pub fn scene(&self) -> Scene {
        (self.scene)()
    }
}
