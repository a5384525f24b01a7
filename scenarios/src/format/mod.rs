//! The file as written: what each table may state (the files here), the tree that a text is read into (`read`), the schema of the tree
//! (`json_schema`), and which kinds of drivers, controllers and metrics a file may name (`registry`).

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
