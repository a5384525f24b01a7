//! Reads a scenario into a tree of keys and values with their places: its file, the files that it extends, and changes by flags.

pub(crate) mod degrees;
pub(crate) mod embedded;
pub(crate) mod merge;
pub(crate) mod overrides;
mod planner_flag;
pub(crate) mod regular_file;
pub(crate) mod source;
pub(crate) mod stated_path;
pub(crate) mod text_line;
pub(crate) mod tree;
