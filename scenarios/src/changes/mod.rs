//! Scenarios that are changed beside their own run: counterfactuals, and the standard list of `interplay why`.

pub(crate) mod changed;
pub(crate) mod standard_changes;
