//! The checks of a file: its shape against the schema, and its meaning. Remarks report values that are allowed but probably not intended.

pub(crate) mod consistency;
pub(crate) mod remarks;
pub(crate) mod shape;
mod unknown_key;
