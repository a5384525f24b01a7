//! The checks of a file: its shape against the schema, and what it means. Remarks say what is allowed and may not have been meant.

pub(crate) mod consistency;
pub(crate) mod remarks;
pub(crate) mod shape;
mod unknown_key;
