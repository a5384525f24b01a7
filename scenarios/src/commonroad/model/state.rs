//! States at times.

use super::super::xml::Element;
use super::geometry::Region;
use crate::text::error::Fault;

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
