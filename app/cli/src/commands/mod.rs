//! The subcommands, one a file, and the first run.

pub(crate) mod bench;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod export_fmu;
pub(crate) mod fit;
pub(crate) mod fmu_host;
pub(crate) mod identify;
pub(crate) mod import;
pub(crate) mod list;
pub(crate) mod man;
pub(crate) mod new;
pub(crate) mod play;
pub(crate) mod predict;
pub(crate) mod reproduce;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod suite;
pub(crate) mod sweep;
pub(crate) mod view;
pub(crate) mod why;
