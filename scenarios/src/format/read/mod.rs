//! From a name to a tree of keys and values with their places: files, what they extend, and changes by flags.

pub(crate) mod degrees;
pub(crate) mod embedded;
pub(crate) mod merge;
pub(crate) mod overrides;
pub(crate) mod regular_file;
pub(crate) mod source;
pub(crate) mod stated_path;
pub(crate) mod text_line;
pub(crate) mod tree;
