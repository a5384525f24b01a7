//! The file format: what each table of a scenario file may state.

pub(crate) mod boptest_plant;
pub(crate) mod budget_limits;
pub(crate) mod building;
pub(crate) mod building_plant;
pub(crate) mod conduct;
pub(crate) mod counterfactual;
pub(crate) mod detail;
pub(crate) mod detector;
pub(crate) mod expect;
mod expectation_names;
pub(crate) mod flow;
pub(crate) mod gains;
pub(crate) mod goal;
pub(crate) mod lane_reference;
pub(crate) mod light;
pub(crate) mod metric_bound;
pub(crate) mod obstacle;
pub(crate) mod plant;
pub(crate) mod real_time;
pub(crate) mod scenario_file;
pub(crate) mod start;
pub(crate) mod start_jitter;
pub(crate) mod stated;
pub(crate) mod vehicle_config;
pub(crate) mod vehicle_defaults;
pub(crate) mod weather;
pub(crate) mod weights;
