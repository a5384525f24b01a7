//! The source of a scenario: a file, or an authored one in the binary.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use interplay_common::spelling::nearest;

use crate::encounters::Encounter;
use crate::format::read::embedded::{self, Embedded};
use crate::format::read::regular_file::read_regular;
use crate::streets::Street;
use crate::text::error::{Document, Fault, LoadError, Place, quoted};

/// The largest file that is read; a scenario takes a few kilobytes.
const MAX_FILE_BYTES: u64 = 1 << 20;
/// The largest file of another format that is read: maps of towns take some megabytes.
pub(crate) const MAX_IMPORTED_BYTES: u64 = 1 << 26;

/// The source of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// An authored scenario, embedded in the binary.
    Embedded(&'static Embedded),
    /// A street that is drawn from its name.
    Street(Street),
    /// A start of the benchmark.
    Encounter(Encounter),
    /// A file.
    File(PathBuf),
}

impl Source {
    /// The authored scenario with this name, otherwise the file at this path. Whether the file is readable is only found when it is read.
    ///
    /// # Errors
    ///
    /// If neither a scenario nor a file has this name.
    pub fn find(name_or_path: &str) -> Result<Source, LoadError> {
        Source::resolve(name_or_path).map_err(|fault| LoadError::new(name_or_path, vec![fault]))
    }

    fn resolve(name_or_path: &str) -> Result<Source, Fault> {
        if let Some(file) = embedded::find(name_or_path) {
            return Ok(Source::Embedded(file));
        }
        if let Some(street) = Street::named(name_or_path) {
            return Ok(Source::Street(street));
        }
        if let Some(start) = Encounter::named(name_or_path) {
            return Ok(Source::Encounter(start));
        }
        let path = PathBuf::from(name_or_path);
        if name_or_path.is_empty() || matches!(fs::exists(&path), Ok(false)) {
            let message = format!("there is no scenario and no file {}", quoted(name_or_path));
            return Err(Fault::new(message).help(other_names(name_or_path)));
        }
        Ok(Source::File(path))
    }

    /// The source that `extends` in this one refers to: an authored scenario, or a file relative to this one.
    pub(crate) fn parent(&self, extends: &str) -> Result<Source, Fault> {
        let folder = match self {
            Source::Embedded(file) => Path::new(file.name).parent(),
            Source::Street(_) | Source::Encounter(_) => None,
            Source::File(path) => path.parent(),
        };
        let beside = folder.unwrap_or(Path::new("")).join(extends);
        match self {
            Source::Embedded(_) => {
                let beside_name = beside.with_extension("");
                let found = beside_name.to_str().and_then(embedded::find).or_else(|| embedded::find(extends));
                let missing = || Fault::new(format!("there is no scenario {}", quoted(extends)));
                found.map(Source::Embedded).ok_or_else(|| missing().help(other_names(extends)))
            }
            Source::Street(_) | Source::Encounter(_) | Source::File(_) => {
                match (embedded::find(extends), Street::named(extends)) {
                    (Some(file), _) => Ok(Source::Embedded(file)),
                    (None, Some(street)) => Ok(Source::Street(street)),
                    (None, None) => Source::resolve(&beside.to_string_lossy()),
                }
            }
        }
    }

    /// A short name for titles and recordings: that of the authored scenario, or the file's without its extension.
    pub fn name(&self) -> String {
        match self {
            Source::Embedded(file) => file.name.to_owned(),
            Source::Street(street) => street.name(),
            Source::Encounter(start) => start.to_string(),
            Source::File(path) => path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }

    pub(crate) fn title(&self) -> String {
        match self {
            Source::Embedded(file) => format!("{}.toml", file.name),
            Source::Street(street) => format!("{}.toml", street.name()),
            Source::Encounter(start) => format!("{start}.toml"),
            Source::File(path) => path.display().to_string(),
        }
    }

    /// Two sources with the same identity are the same text.
    pub(crate) fn identity(&self) -> PathBuf {
        match self {
            Source::Embedded(file) => PathBuf::from(file.name),
            Source::Street(street) => PathBuf::from(street.name()),
            Source::Encounter(start) => PathBuf::from(start.to_string()),
            Source::File(path) => fs::canonicalize(path).unwrap_or_else(|_| path.clone()),
        }
    }

    /// The text, and the document that errors point into.
    pub(crate) fn read(&self, rank: usize) -> Result<(Arc<Document>, String), Fault> {
        let text = match self {
            Source::Embedded(file) => file.text.to_owned(),
            Source::Street(street) => street.text(),
            Source::Encounter(start) => start.text(),
            Source::File(path) => decoded(&self.title(), &read_bytes(path, MAX_FILE_BYTES)?, rank)?,
        };
        if text.trim().is_empty() {
            return Err(Fault::new(format!("{} is empty", quoted(&self.title()))).help(
                "a scenario needs at least `title`, `shows` and a `[[vehicle]]`; or start with `extends = \"lane-change/front-nice\"`",
            ));
        }
        Ok((Document::new(self.title(), &text, rank), text))
    }
}

/// The text of a file of another format, for import.
pub(crate) fn imported_text(path: &Path) -> Result<String, Fault> {
    decoded(&path.display().to_string(), &read_bytes(path, MAX_IMPORTED_BYTES)?, 1)
}

/// Suggestions for a name that does not exist.
fn other_names(missing: &str) -> String {
    let word = missing.strip_suffix(".toml").unwrap_or(missing);
    let names = || embedded::embedded().iter().map(|file| file.name);
    let last_part = |name: &'static str| name.rsplit('/').next().unwrap_or(name);
    let near = nearest(word, names()).or_else(|| {
        let near = nearest(word.rsplit(['/', '\\']).next()?, names().map(last_part))?;
        names().find(|name| last_part(name) == near)
    });
    let is_path = word.len() < missing.len();
    match near {
        Some(name) if is_path => format!(
            "is it in another folder? `{name}` is the name of an embedded scenario; `interplay list` shows all of them"
        ),
        Some(name) => format!("did you mean the embedded scenario `{name}`? `interplay list` shows all of them"),
        None => {
            "give the path of a TOML file, or the name of an embedded scenario: `interplay list` shows them".to_owned()
        }
    }
}

fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, Fault> {
    let name = quoted(&path.display().to_string());
    let bytes = read_regular(path, limit).map_err(|error| match error.kind() {
        ErrorKind::IsADirectory => {
            Fault::new(format!("{name} is a directory")).help("give the path of a TOML file in it")
        }
        _ => Fault::new(format!("cannot read {name}: {error}")),
    })?;
    bytes.ok_or_else(|| {
        let help = "a scenario takes a few kilobytes: is this the file that you meant?";
        Fault::new(format!("{name} is larger than {} MiB", limit >> 20)).help(help)
    })
}

/// The bytes as text; the error points at the first byte that is not UTF-8.
fn decoded(title: &str, bytes: &[u8], rank: usize) -> Result<String, Fault> {
    let error = match str::from_utf8(bytes) {
        Ok(text) => return Ok(text.strip_prefix('\u{feff}').unwrap_or(text).to_owned()),
        Err(error) => error,
    };
    let valid = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
    let offset = valid.len();
    let document = Document::new(title, &format!("{valid}\u{fffd}"), rank);
    let place = Place::new(&document, offset..offset + '\u{fffd}'.len_utf8());
    let message = format!("{} is not UTF-8 text", quoted(title));
    Err(Fault::at(&place, "here the text ends", message).help("a scenario is a TOML file, encoded as UTF-8"))
}
