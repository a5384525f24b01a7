//! The version of the program as far as it decides results.

/// The version of the package and a digest of the sources that a run is computed by.
pub fn program_version() -> String {
    format!("{}+{}", env!("CARGO_PKG_VERSION"), env!("INTERPLAY_SOURCES"))
}
