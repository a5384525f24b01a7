//! The data and the model of one vehicle: state and input, body, limits, the bicycle model.

mod bicycle;
mod body;
mod limits;
mod safety_ellipse;
mod state;

pub(crate) use bicycle::slip_on_curve_rad;
pub use bicycle::{Bicycle, DynamicsCurvature, Jacobian};
pub use body::Body;
pub(crate) use body::SteeringGeometry;
pub use limits::{ComfortLimits, Limits};
pub use safety_ellipse::{EllipticalDistance, OrientedEllipse, PoseExpansion, SafetyEllipse};
pub use state::{Input, State, Trajectory};
