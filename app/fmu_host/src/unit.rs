//! A unit on disk: unpacked, with its description.

use std::fs;
use std::path::{Component, Path, PathBuf};

use tempfile::TempDir;

use crate::archive::{self, Packed};
use crate::description::Description;
use crate::error::HostError;

/// The folder of the libraries for this system.
const SYSTEM: &str = "binaries/linux64";
/// The extension of a library on this system.
const ENDING: &str = "so";

/// A unit whose files lie in a temporary folder until it is dropped.
#[derive(Debug)]
pub struct Unit {
    folder: TempDir,
    description: Description,
}

impl Unit {
    /// Unpacks an FMU of FMI 2.0, for co-simulation or model exchange.
    ///
    /// # Errors
    /// [`HostError`] if the file is unreadable or another kind of unit, has no library for this system, or if this is not Linux on x86-64.
    pub fn open(path: &Path) -> Result<Self, HostError> {
        let described = |reason: String| HostError::Description { path: path.to_owned(), reason };
        let broken = |reason: String| HostError::Archive { path: path.to_owned(), reason };
        if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            return Err(described(
                "FMUs are run on Linux with x86-64 only; serve it elsewhere, and state `url`".to_owned(),
            ));
        }
        let bytes = fs::read(path).map_err(|reason| HostError::Read { path: path.to_owned(), reason })?;
        let files = archive::files(&bytes).map_err(broken)?;
        let named = |name: &str| files.iter().find(|file| file.name == name);
        let text =
            named("modelDescription.xml").ok_or_else(|| broken("it has no `modelDescription.xml`".to_owned()))?;
        let text = String::from_utf8(text.unpacked(&bytes).map_err(broken)?)
            .map_err(|_| described("its description is not UTF-8".to_owned()))?;
        let description = Description::parse(&text).map_err(described)?;
        let library = format!("{SYSTEM}/{}.{ENDING}", description.library);
        if named(&library).is_none() {
            let folders = files.iter().filter_map(|file| file.name.strip_prefix("binaries/")?.split('/').next());
            let mut folders: Vec<&str> = folders.collect();
            folders.sort_unstable();
            folders.dedup();
            return Err(described(format!("it has no `{library}`; its libraries are for: {}", folders.join(", "))));
        }
        let folder = tempfile::Builder::new().prefix("interplay-fmu-").tempdir();
        let folder = folder.map_err(|reason| HostError::Unpack { reason })?;
        for file in &files {
            unpack(file, &bytes, folder.path()).map_err(|failure| match failure {
                Failure::Archive(reason) => broken(reason),
                Failure::System(reason) => HostError::Unpack { reason },
            })?;
        }
        Ok(Self { folder, description })
    }

    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The path of the unit's library.
    pub fn library(&self) -> PathBuf {
        self.folder.path().join(SYSTEM).join(format!("{}.{ENDING}", self.description.library))
    }

    /// The folder of its resources, which may be empty or missing.
    pub fn resources(&self) -> PathBuf {
        self.folder.path().join("resources")
    }
}

enum Failure {
    Archive(String),
    System(std::io::Error),
}

fn unpack(file: &Packed, archive: &[u8], folder: &Path) -> Result<(), Failure> {
    let name = Path::new(&file.name);
    if !name.components().all(|part| matches!(part, Component::Normal(_))) {
        return Err(Failure::Archive(format!("its file `{}` would lie elsewhere", file.name)));
    }
    let path = folder.join(name);
    if let Some(parent) = path.parent() {
        fs::create_dir_all(parent).map_err(Failure::System)?;
    }
    fs::write(path, file.unpacked(archive).map_err(Failure::Archive)?).map_err(Failure::System)
}
