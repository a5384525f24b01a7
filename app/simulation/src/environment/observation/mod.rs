//! Observations of an agent, as numbers: one view in each file.

mod grid;
mod kinematics;
mod lane;
mod plan;
mod view;

pub use grid::OccupancyGrid;
pub use kinematics::Kinematics;
pub use lane::LaneView;
pub use plan::{BeliefView, PlanView};
pub(super) use view::Seen;
pub use view::{ForeignView, ObservationKind, ObservationSpace};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use view::MOST_SEEN;

/// A view of a scene, by the names that HighwayEnv uses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind")]
pub enum AgentView {
    /// Positions and velocities of the nearest vehicles.
    Kinematics(Kinematics),
    /// The own lane, the adjacent lanes, and the leader and follower in each.
    Lane(LaneView),
    /// A grid around the agent.
    OccupancyGrid(OccupancyGrid),
    /// The announced plans of the nearest vehicles.
    Plan(PlanView),
    /// The beliefs about the nearest drivers, which our inference updates from their motion.
    Belief(BeliefView),
    /// A view of another crate.
    #[serde(skip)]
    Foreign(ForeignView),
}

impl AgentView {
    /// The space of the view for a vehicle with a horizon.
    pub fn space(&self, horizon: usize) -> ObservationSpace {
        match self {
            AgentView::Kinematics(view) => view.space(),
            AgentView::Lane(view) => view.space(),
            AgentView::OccupancyGrid(view) => view.space(),
            AgentView::Plan(view) => view.space(horizon),
            AgentView::Belief(view) => view.space(),
            AgentView::Foreign(foreign) => foreign.view().space(horizon),
        }
    }

    /// The fault of the settings, if there is one.
    pub fn fault(&self) -> Option<String> {
        match self {
            AgentView::OccupancyGrid(view) => view.fault(),
            AgentView::Kinematics(Kinematics { count, .. })
            | AgentView::Plan(PlanView { count, .. })
            | AgentView::Belief(BeliefView { count }) => {
                (*count == 0 || *count > MOST_SEEN).then(|| format!("`count` is from 1 to {MOST_SEEN}"))
            }
            AgentView::Lane(_) => None,
            AgentView::Foreign(foreign) => foreign.view().fault(),
        }
    }

    /// Whether the view shows beliefs about the other drivers.
    pub(super) fn shows_beliefs(&self) -> bool {
        match self {
            AgentView::Belief(_) => true,
            AgentView::Foreign(foreign) => foreign.view().shows_beliefs(),
            _ => false,
        }
    }

    pub(super) fn write(&self, seen: &Seen<'_>, out: &mut [f32]) {
        match self {
            AgentView::Kinematics(view) => view.write(seen, out),
            AgentView::Lane(view) => view.write(seen, out),
            AgentView::OccupancyGrid(view) => view.write(seen, out),
            AgentView::Plan(view) => view.write(seen, out),
            AgentView::Belief(view) => view.write(seen, out),
            AgentView::Foreign(foreign) => foreign.view().write(seen.scene, seen.beliefs, out),
        }
    }
}
