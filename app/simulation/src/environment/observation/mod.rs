//! What an agent sees, as numbers: one view a file.

mod belief;
mod foreign;
mod grid;
mod kinematics;
mod lane;
mod plan;
mod view;

pub use belief::BeliefView;
pub use foreign::{ForeignView, ObservationKind};
pub use grid::OccupancyGrid;
pub use kinematics::Kinematics;
pub use lane::LaneView;
pub use plan::PlanView;
pub use view::ObservationSpace;
pub(super) use view::Seen;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use view::MOST_SEEN;

/// A view of a scene, with the names that users of HighwayEnv know.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind")]
pub enum AgentView {
    /// The nearest vehicles: where they are and how they move.
    Kinematics(Kinematics),
    /// The own lane, the lanes beside it, and who is ahead and behind in each of them.
    Lane(LaneView),
    /// A grid around the agent.
    OccupancyGrid(OccupancyGrid),
    /// What the nearest others announced that they will do.
    Plan(PlanView),
    /// How nice the nearest others are, as our inference learns it from their motion.
    Belief(BeliefView),
    /// A view of another crate.
    #[serde(skip)]
    Foreign(ForeignView),
}

impl AgentView {
    /// The numbers of the view of a vehicle with a horizon.
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

    /// What is wrong with the settings, if anything.
    pub(super) fn fault(&self) -> Option<String> {
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

    /// Whether it shows what is believed of the other drivers.
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
