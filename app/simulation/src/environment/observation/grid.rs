//! A grid around the agent.

use interplay_planners::{Agent, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::view::{ObservationSpace, Scales, Seen, names, share};

/// A grid around the agent, along and across its road: for each cell whether a vehicle is in it, its speed relative to the agent, and
/// whether the cell is road. The agent itself is not entered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OccupancyGrid {
    /// Number of cells along and across.
    pub cells: [usize; 2],
    /// Length and width of a cell, in lengths and widths of the agent's body.
    pub cell_bodies: [f64; 2],
}

impl Default for OccupancyGrid {
    fn default() -> Self {
        OccupancyGrid { cells: [11, 11], cell_bodies: [1.0, 1.0] }
    }
}

const FEATURES: [&str; 4] = ["presence", "vx", "vy", "on_road"];
/// Maximum number of cells along an axis.
const MOST_CELLS: usize = 128;

impl OccupancyGrid {
    pub(super) fn fault(&self) -> Option<String> {
        let is_sound = self.cells.iter().all(|cells| (1..=MOST_CELLS).contains(cells))
            && self.cell_bodies.iter().all(|size| (0.01..=100.0).contains(size));
        (!is_sound).then(|| format!("`cells` are from 1 to {MOST_CELLS}, and `cell_bodies` from 0.01 to 100"))
    }

    pub(super) fn space(&self) -> ObservationSpace {
        let shape = vec![FEATURES.len(), self.cells[0], self.cells[1]];
        ObservationSpace {
            names: names(&FEATURES),
            ..ObservationSpace::normalised("OccupancyGrid", shape, Vec::new(), true)
        }
    }

    pub(super) fn write(&self, seen: &Seen<'_>, out: &mut [f32]) {
        out.fill(0.0);
        let (scene, [along, across]) = (seen.scene, self.cells);
        let (sides, road) = out.split_at_mut(3 * along * across);
        for other in &scene.others {
            let moves = relative_velocity(scene, other);
            for cell in self.covered(scene, other) {
                sides[cell] = 1.0;
                sides[along * across + cell] = moves[0];
                sides[2 * along * across + cell] = moves[1];
            }
        }
        let (ego, at) = (&scene.ego, scene.ego.route.locate(scene.ego.state.position(), None));
        for (cell, on_road) in road.iter_mut().enumerate() {
            let [ahead_m, left_m] = self.centre_m(scene, cell);
            let along_m = at.along_m + ahead_m;
            let [right_edge_m, left_edge_m] = [ego.route.right.value(along_m), ego.route.left.value(along_m)];
            *on_road = f32::from(u8::from((right_edge_m..=left_edge_m).contains(&(at.across_m + left_m))));
        }
    }

    fn cell_m(&self, scene: &Scene) -> [f64; 2] {
        let body = &scene.ego.body;
        [self.cell_bodies[0] * (body.front_m + body.rear_m), self.cell_bodies[1] * body.width_m]
    }

    /// Position of a cell's centre, ahead of the agent and to its left \[m\].
    fn centre_m(&self, scene: &Scene, cell: usize) -> [f64; 2] {
        let at = [cell / self.cells[1], cell % self.cells[1]];
        let size_m = self.cell_m(scene);
        std::array::from_fn(|axis| (at[axis] as f64 - 0.5 * (self.cells[axis] as f64 - 1.0)) * size_m[axis])
    }

    /// The cells whose centres are in the footprint of a vehicle, and the one that contains its centre.
    fn covered(&self, scene: &Scene, other: &Agent) -> Vec<usize> {
        let route = &scene.ego.route;
        let [own, there] = [&scene.ego, other].map(|agent| route.locate(agent.state.position(), None));
        let [ahead_m, left_m] = [there.along_m - own.along_m, there.across_m - own.across_m];
        let (sin, cos) = libm::sincos(other.state.heading_rad - there.heading_rad);
        let is_covered = |cell: usize| {
            let [x, y] = self.centre_m(scene, cell);
            let [dx, dy] = [x - ahead_m, y - left_m];
            let [forward_m, aside_m] = [cos * dx + sin * dy, cos * dy - sin * dx];
            let size_m = self.cell_m(scene);
            let is_centre = 2.0 * dx.abs() <= size_m[0] && 2.0 * dy.abs() <= size_m[1];
            let is_inside = (-other.body.rear_m..=other.body.front_m).contains(&forward_m)
                && 2.0 * aside_m.abs() <= other.body.width_m;
            is_centre || is_inside
        };
        (0..self.cells[0] * self.cells[1]).filter(|cell| is_covered(*cell)).collect()
    }
}

/// Velocity of another vehicle along and across the agent's road, relative to the agent.
fn relative_velocity(scene: &Scene, other: &Agent) -> [f32; 2] {
    let scales = Scales::of_ego(scene);
    let heading_rad = scene.ego.route.heading_at(scene.ego.state.position());
    let [own, theirs] = [&scene.ego, other].map(|agent| {
        let (sin, cos) = libm::sincos(agent.state.heading_rad - heading_rad);
        [agent.state.speed_mps * cos, agent.state.speed_mps * sin]
    });
    std::array::from_fn(|axis| share(theirs[axis] - own[axis], scales.speed_mps))
}
