//! Obstacles: all objects on the road except the vehicle of the planning problem.

use super::super::xml::{Element, Unread};
use super::geometry::Region;
use super::state::StateAt;
use crate::text::error::Fault;

/// An obstacle.
pub(crate) struct Obstacle<'a> {
    pub id: String,
    pub element: Element<'a>,
    pub role: Role,
    /// Its type, such as `car` or `parkedVehicle`.
    pub kind: String,
    /// The parts of its shape.
    pub shape: Vec<Region>,
    /// Its states in the order of the file, the initial one first; empty if it has none.
    pub states: Vec<StateAt>,
    /// Whether its motion is stated as sets of positions and not as a trajectory.
    pub has_occupancies: bool,
}

/// The role of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// It stands.
    Static,
    /// It moves.
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
