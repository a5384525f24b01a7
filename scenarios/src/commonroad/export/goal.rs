//! Checks whether a state lies in one of the goals of a planning problem.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use super::super::model::{Goal, Lanelet, Region};
use crate::commonroad::recorded_traffic::is_inside;

/// The goals of a planning problem, with the outlines of the lanelets that they name.
#[derive(Clone, Debug, Default)]
pub(super) struct GoalPlaces {
    goals: Vec<Goal>,
    outlines: BTreeMap<String, Vec<[f64; 2]>>,
}

/// The quantities of a state that goals bound, as CommonRoad's referee computes them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    pub time: f64,
    pub position: [f64; 2],
    pub orientation_rad: f64,
    pub velocity_mps: f64,
}

impl GoalPlaces {
    /// The goals, and the lanelets on which they lie.
    pub(super) fn of(goals: &[Goal], lanelets: &[Lanelet<'_>]) -> GoalPlaces {
        let outline = |it: &Lanelet<'_>| it.left.iter().chain(it.right.iter().rev()).copied().collect();
        let outlines = lanelets.iter().map(|lanelet| (lanelet.id.clone(), outline(lanelet))).collect();
        GoalPlaces { goals: goals.to_vec(), outlines }
    }

    /// Whether one of the goals is reached; a problem without goals is never solved.
    pub(super) fn are_reached(&self, at: &Arrival) -> bool {
        self.goals.iter().any(|goal| self.is_reached(goal, at))
    }

    fn is_reached(&self, goal: &Goal, at: &Arrival) -> bool {
        let is_within =
            |interval: Option<[f64; 2]>, value: f64| interval.is_none_or(|[from, to]| from <= value && value <= to);
        let is_there =
            goal.position.is_empty() || goal.position.iter().any(|region| self.contains(region, at.position));
        let is_along = goal.orientation_rad.is_none_or(|interval| contains_angle(interval, at.orientation_rad));
        is_there && is_along && is_within(goal.time, at.time) && is_within(goal.velocity_mps, at.velocity_mps)
    }

    fn contains(&self, region: &Region, [x_m, y_m]: [f64; 2]) -> bool {
        match region {
            Region::Rectangle(rectangle) => {
                let (sin, cos) = libm::sincos(rectangle.orientation_rad);
                let [x_m, y_m] = [x_m - rectangle.centre[0], y_m - rectangle.centre[1]];
                let (along_m, across_m) = (cos * x_m + sin * y_m, cos * y_m - sin * x_m);
                along_m.abs() <= 0.5 * rectangle.length_m && across_m.abs() <= 0.5 * rectangle.width_m
            }
            Region::Circle { radius_m, centre } => libm::hypot(x_m - centre[0], y_m - centre[1]) <= *radius_m,
            Region::Polygon(corners) => is_inside(corners.iter().copied(), [x_m, y_m]),
            Region::Point(_) => false,
            Region::Lanelets(ids) => ids
                .iter()
                .filter_map(|id| self.outlines.get(id))
                .any(|outline| is_inside(outline.iter().copied(), [x_m, y_m])),
        }
    }
}

/// Whether an angle lies in an interval of angles, modulo full turns.
fn contains_angle([from_rad, to_rad]: [f64; 2], angle_rad: f64) -> bool {
    let middle_rad = 0.5 * (from_rad + to_rad);
    let away_rad = (angle_rad - middle_rad + PI).rem_euclid(TAU) - PI;
    away_rad.abs() <= 0.5 * (to_rad - from_rad)
}

#[cfg(test)]
mod tests {
    use super::super::super::model::Rectangle;
    use super::*;

    #[test]
    fn a_commonroad_goal_is_reached_where_all_its_conditions_hold() {
        let square = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let goal = Goal {
            time: Some([5.0, 7.0]),
            position: vec![Region::Polygon(square)],
            orientation_rad: Some([3.0, 3.5]),
            velocity_mps: None,
        };
        let goals = GoalPlaces { goals: vec![goal], ..GoalPlaces::default() };
        let there = Arrival { time: 6.0, position: [1.0, 1.5], orientation_rad: -3.1, velocity_mps: 9.0 };
        assert!(goals.are_reached(&there));
        let others = [
            Arrival { time: 8.0, ..there },
            Arrival { position: [2.5, 1.0], ..there },
            Arrival { orientation_rad: 0.0, ..there },
        ];
        assert!(others.iter().all(|at| !goals.are_reached(at)));
        assert!(!GoalPlaces::default().are_reached(&there));
    }

    #[test]
    fn a_rotated_rectangle_of_a_goal_is_converted() {
        let rectangle = Rectangle { length_m: 4.0, width_m: 1.0, orientation_rad: 0.5 * PI, centre: [1.0, 1.0] };
        let goals = GoalPlaces::default();
        let region = Region::Rectangle(rectangle);
        assert!(goals.contains(&region, [1.0, 2.9]) && !goals.contains(&region, [2.9, 1.0]));
    }
}
