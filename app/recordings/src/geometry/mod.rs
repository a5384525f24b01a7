//! Lines of lanes and boxes of vehicles.

mod boxes;
mod lane_line;

pub(crate) use boxes::Box2;
pub(crate) use lane_line::LaneLine;
