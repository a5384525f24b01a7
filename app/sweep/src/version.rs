//! The version of the program as far as it determines results.

/// The version of the package and a digest of the sources that compute a run.
pub fn program_version() -> String {
    format!("{}+{}", env!("CARGO_PKG_VERSION"), env!("INTERPLAY_SOURCES"))
}
