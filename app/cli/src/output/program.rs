//! The name by which a shell finds this program.

use std::env;

use interplay_presentation::shell::is_on_path;

/// The name by which a shell finds this program again: `interplay` if that is on the path, otherwise what it was called by.
pub(crate) fn this_program() -> String {
    const NAME: &str = "interplay";
    env::args().next().filter(|_| !is_on_path(NAME)).unwrap_or_else(|| NAME.to_owned())
}
