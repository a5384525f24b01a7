//! What arguments stand for: scenarios, values, plans.

pub(crate) mod export_file;
pub(crate) mod files;
pub(crate) mod plan_flags;
pub(crate) mod run_outputs;
pub(crate) mod values;
