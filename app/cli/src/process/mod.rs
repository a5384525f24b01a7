//! The process of a command: threads, memory, limits of the system, and running again when a file is saved.

pub(crate) mod limits;
pub(crate) mod out_of_memory;
pub(crate) mod watch;
