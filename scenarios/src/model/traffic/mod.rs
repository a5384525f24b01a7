//! The traffic of a scenario: vehicles, obstacles, lights and detectors, and their level of detail.

pub(crate) mod conduct;
pub(crate) mod flows;
pub(crate) mod goal;
pub(crate) mod lane_reference;
pub(crate) mod light;
pub(crate) mod obstacle;
pub(crate) mod plant;
pub(crate) mod real_time;
pub(crate) mod weights;
