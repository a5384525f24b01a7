//! How this program is called.

use std::env;

/// The name by which a shell finds this program again: `interplay` if that is on the path, otherwise what it was called by.
pub(crate) fn this_program() -> String {
    const NAME: &str = "interplay";
    let called = env::args().next().unwrap_or_else(|| NAME.to_owned());
    let mut folders = env::var_os("PATH").into_iter().flat_map(|path| env::split_paths(&path).collect::<Vec<_>>());
    let is_on_path = folders.any(|folder| folder.join(NAME).is_file());
    if is_on_path { NAME.to_owned() } else { called }
}
