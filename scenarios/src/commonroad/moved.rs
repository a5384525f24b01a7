//! Moves scenarios in geographic coordinates to a local origin.

use super::model::{CommonRoad, Region};
use crate::resolve::local_origin;

impl CommonRoad<'_> {
    /// Moves everything near the origin, if it is far away. Returns the place that is the origin now.
    pub(super) fn move_near_origin(&mut self) -> Option<[f64; 2]> {
        let origin = local_origin::of(*self.lanelets.first()?.left.first()?)?;
        let moved = |point: &mut [f64; 2]| *point = [point[0] - origin[0], point[1] - origin[1]];
        for lanelet in &mut self.lanelets {
            lanelet.left.iter_mut().chain(&mut lanelet.right).for_each(moved);
        }
        for state in self.obstacles.iter_mut().flat_map(|obstacle| &mut obstacle.states) {
            moved(&mut state.position);
        }
        for problem in &mut self.problems {
            moved(&mut problem.initial.position);
            for region in problem.goals.iter_mut().flat_map(|goal| &mut goal.position) {
                match region {
                    Region::Rectangle(rectangle) => moved(&mut rectangle.centre),
                    Region::Circle { centre, .. } => moved(centre),
                    Region::Polygon(corners) => corners.iter_mut().for_each(moved),
                    Region::Point(point) => moved(point),
                    Region::Lanelets(_) => {}
                }
            }
        }
        Some(origin)
    }
}
