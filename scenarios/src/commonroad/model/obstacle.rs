//! Obstacles: all objects on the road except the vehicle of the planning problem.

use super::super::xml::{Element, Unread};
use super::geometry::Region;
use crate::text::error::Fault;

pub(crate) struct Obstacle<'a> {
    pub id: String,
    pub element: Element<'a>,
    pub role: Role,
    /// Its type, such as `car` or `parkedVehicle`.
    pub kind: String,
    pub shape: Vec<Region>,
    /// Its states in the order of the file, the initial one first; empty if it has none.
    pub states: Vec<StateAt>,
    /// Whether its motion is stated as sets of positions and not as a trajectory.
    pub has_occupancies: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Static,
    Dynamic,
    /// It belongs to the surroundings, such as a building, or its existence is unknown.
    Surroundings,
}

impl<'a> Obstacle<'a> {
    /// Whether an element of this name is an obstacle: `obstacle` with a `role` in version 2018b, a name for each role in 2020a.
    pub(super) fn is_read_from(name: &str) -> bool {
        ["obstacle", "staticObstacle", "dynamicObstacle", "environmentObstacle", "phantomObstacle"].contains(&name)
    }

    pub(super) fn read(element: Element<'a>, unread: &mut Unread) -> Result<Obstacle<'a>, Fault> {
        let role = match (element.name(), element.child("role").map(|role| role.text())) {
            ("staticObstacle", _) | ("obstacle", Some("static")) => Role::Static,
            ("dynamicObstacle", _) | ("obstacle", Some("dynamic")) => Role::Dynamic,
            ("obstacle", _) => {
                return Err(element.fault("which role?", format!("{} is neither static nor dynamic", element.shown())));
            }
            _ => Role::Surroundings,
        };
        let kind = element.child("type").map_or("unknown", |kind| kind.text()).to_owned();
        let mut obstacle = Obstacle {
            id: element.required_attribute("id")?.to_owned(),
            element,
            role,
            kind,
            shape: Vec::new(),
            states: Vec::new(),
            has_occupancies: element.child("occupancySet").is_some(),
        };
        if role == Role::Surroundings {
            return Ok(obstacle);
        }
        obstacle.shape = Region::read_all(element.required("shape")?)?;
        let initial = element.required("initialState")?;
        let later = element.child("trajectory").into_iter().flat_map(|trajectory| trajectory.children("state"));
        obstacle.states = [initial].into_iter().chain(later).map(StateAt::read).collect::<Result<_, _>>()?;
        unread.count_beyond(element, &["role", "type", "shape", "initialState", "trajectory", "occupancySet"]);
        Ok(obstacle)
    }
}

/// A state at a time. A value that is an interval or a region is taken at its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StateAt {
    /// Number of the step of time.
    pub time: f64,
    /// Position \[m\].
    pub position: [f64; 2],
    /// Direction \[rad\].
    pub orientation_rad: f64,
    /// Speed along that direction; 0 if not stated \[m/s\].
    pub velocity_mps: f64,
    /// Whether all its values are stated as exact numbers.
    pub is_exact: bool,
}

impl StateAt {
    /// The keys of a state that are read.
    pub(super) const READ: [&'static str; 5] = ["position", "orientation", "time", "velocity", "velocityY"];

    /// Reads a state.
    ///
    /// # Errors
    /// For a state without position or time.
    pub(super) fn read(element: Element<'_>) -> Result<StateAt, Fault> {
        let stated = element.required("position")?;
        let regions = Region::read_all(stated)?;
        let position = regions.first().and_then(Region::middle);
        let position = position.ok_or_else(|| {
            stated.fault("no place", format!("`position` of {} is neither a point nor a region", element.shown()))
        })?;
        let value = |key: &'static str| element.child(key).map(|value| value.interval()).transpose();
        let [time, orientation, along, across] = [
            Some(element.required("time")?.interval()?),
            value("orientation")?,
            value("velocity")?,
            value("velocityY")?,
        ];
        let middle = |interval: Option<[f64; 2]>| interval.map_or(0.0, |[from, to]| 0.5 * (from + to));
        let is_exact = [time, orientation, along, across].iter().flatten().all(|[from, to]| from == to);
        // A point mass states both components of its velocity, and no direction.
        let (orientation_rad, velocity_mps) = match across {
            Some(_) if orientation.is_none() => {
                let [x, y] = [along, across].map(middle);
                (libm::atan2(y, x), libm::hypot(x, y))
            }
            _ => (middle(orientation), middle(along)),
        };
        Ok(StateAt {
            time: middle(time),
            position,
            orientation_rad,
            velocity_mps,
            is_exact: is_exact && matches!(regions.as_slice(), [Region::Point(_)]),
        })
    }
}

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
