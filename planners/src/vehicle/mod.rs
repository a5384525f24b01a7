//! The data and the model of one vehicle: state and input, body, limits, the bicycle model.

mod bicycle;
mod body;
mod comfort_limits;
mod limits;
mod pose_expansion;
mod safety_ellipse;
mod state;
mod steering_geometry;

pub(crate) use bicycle::slip_on_curve_rad;
pub use bicycle::{Bicycle, DynamicsCurvature, Jacobian};
pub use body::Body;
pub use comfort_limits::ComfortLimits;
pub use limits::Limits;
pub use pose_expansion::PoseExpansion;
pub use safety_ellipse::{EllipticalDistance, OrientedEllipse, SafetyEllipse};
pub use state::{Input, State, Trajectory};
pub(crate) use steering_geometry::SteeringGeometry;
