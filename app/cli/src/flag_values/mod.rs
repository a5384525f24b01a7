//! Parsing of arguments: scenarios, values, plans.

pub(crate) mod files;
pub(crate) mod plan_flags;
pub(crate) mod values;
