//! Planning problems: the initial state of the vehicle to be driven, and its goals.

use super::super::xml::{Element, Unread};
use super::geometry::Region;
use super::state::StateAt;
use crate::text::error::Fault;

/// A planning problem.
pub(crate) struct PlanningProblem<'a> {
    pub element: Element<'a>,
    pub initial: StateAt,
    /// Its initial acceleration \[m/s²\].
    pub acceleration_mps2: Option<f64>,
    /// The goals, one of which has to be reached.
    pub goals: Vec<Goal>,
}

/// A goal; a quantity that is not stated is free.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Goal {
    /// The time steps between which it has to be reached.
    pub time: Option<[f64; 2]>,
    /// The regions, one of which has to be reached.
    pub position: Vec<Region>,
    /// The direction \[rad\].
    pub orientation_rad: Option<[f64; 2]>,
    /// The speed \[m/s\].
    pub velocity_mps: Option<[f64; 2]>,
}

impl<'a> PlanningProblem<'a> {
    pub(super) fn read(element: Element<'a>, unread: &mut Unread) -> Result<PlanningProblem<'a>, Fault> {
        let stated = element.required("initialState")?;
        // Both are 0 in all published scenarios.
        let noted = [&StateAt::READ[..], &["yawRate", "slipAngle", "acceleration"]].concat();
        unread.count_beyond(stated, &noted);
        unread.count_beyond(element, &["initialState", "goalState"]);
        Ok(PlanningProblem {
            element,
            initial: StateAt::read(stated)?,
            acceleration_mps2: stated.child("acceleration").map(|value| value.interval()).transpose()?.map(middle),
            goals: element.children("goalState").map(|goal| goal_of(goal, unread)).collect::<Result<_, _>>()?,
        })
    }
}

fn middle([from, to]: [f64; 2]) -> f64 {
    0.5 * (from + to)
}

fn goal_of(element: Element<'_>, unread: &mut Unread) -> Result<Goal, Fault> {
    let value = |key: &'static str| element.child(key).map(|value| value.interval()).transpose();
    unread.count_beyond(element, &StateAt::READ);
    Ok(Goal {
        time: value("time")?,
        position: element.child("position").map_or(Ok(Vec::new()), Region::read_all)?,
        orientation_rad: value("orientation")?,
        velocity_mps: value("velocity")?,
    })
}
