//! The versions of the standard that an FMU can be written for.

/// A version of FMI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FmiVersion {
    /// FMI 2.0.
    #[default]
    Two,
    /// FMI 3.0.
    Three,
}

impl FmiVersion {
    /// The folder of binaries and their extension for a system, by the names of [`std::env::consts`]. For some systems FMI 2.0 defines
    /// no folder; these have the names that tools agree on.
    pub(crate) fn binary(self, system: &str, processor: &str) -> Option<(&'static str, &'static str)> {
        let (two, three, extension) = match (system, processor) {
            ("linux", "x86_64") => ("linux64", "x86_64-linux", "so"),
            ("linux", "aarch64") => ("aarch64-linux", "aarch64-linux", "so"),
            ("windows", "x86_64") => ("win64", "x86_64-windows", "dll"),
            ("macos", "x86_64") => ("darwin64", "x86_64-darwin", "dylib"),
            ("macos", "aarch64") => ("aarch64-darwin", "aarch64-darwin", "dylib"),
            _ => return None,
        };
        Some((if self == Self::Two { two } else { three }, extension))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folder_names_in_an_fmu_depend_on_the_fmi_version() {
        let folders = |system, processor| {
            [FmiVersion::Two, FmiVersion::Three]
                .map(|version| version.binary(system, processor).map(|(folder, _)| folder))
        };
        assert_eq!(folders("linux", "x86_64"), [Some("linux64"), Some("x86_64-linux")]);
        assert_eq!(folders("windows", "x86_64"), [Some("win64"), Some("x86_64-windows")]);
        assert_eq!(FmiVersion::Three.binary("windows", "x86_64"), Some(("x86_64-windows", "dll")));
        assert_eq!(folders("linux", "riscv64"), [None, None]);
    }
}
