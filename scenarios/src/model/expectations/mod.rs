//! The expectations of a run and of its counterfactuals.

pub(crate) mod counterfactual;
pub(crate) mod expect;
pub(crate) mod metric_bound;
