//! The version that identifies the sources on which results depend.

/// The version of the package and a digest of the sources that compute a run.
pub fn program_version() -> String {
    format!("{}+{}", env!("CARGO_PKG_VERSION"), env!("INTERPLAY_SOURCES"))
}
