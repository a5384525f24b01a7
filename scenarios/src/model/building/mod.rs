//! The building of a scenario: its network, its plant, the weather around it and the heat in it.

pub(crate) mod boptest_plant;
pub(crate) mod config;
pub(crate) mod gains;
pub(crate) mod plant;
pub(crate) mod weather;
