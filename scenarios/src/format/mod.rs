//! The format of a scenario file: the keys of each table (the files here), the tree into which a text is read (`read`), the schema
//! of the tree (`json_schema`), and the kinds of drivers, controllers and metrics that a file may name (`registry`).

pub(crate) mod flow;
pub(crate) mod json_schema;
pub(crate) mod obstacle;
pub(crate) mod read;
pub(crate) mod registry;
pub(crate) mod scenario_file;
pub(crate) mod start;
pub(crate) mod stated;
pub(crate) mod vehicle_config;
pub(crate) mod weather;
