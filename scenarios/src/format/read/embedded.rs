//! The authored scenarios, embedded in the binary: every file below `files`.

use std::sync::LazyLock;

use include_dir::{Dir, DirEntry, include_dir};

/// One authored scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Embedded {
    /// Its name: the path below `files`, without the extension.
    pub name: &'static str,
    /// The file as written.
    pub text: &'static str,
}

static FILES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/files");

static SCENARIOS: LazyLock<Vec<Embedded>> = LazyLock::new(|| {
    let mut found = Vec::new();
    collect(&FILES, &mut found);
    found.sort_unstable_by_key(|file| file.name);
    found
});

/// Adds the scenarios of a folder and of its subfolders.
fn collect(folder: &'static Dir<'static>, found: &mut Vec<Embedded>) {
    for entry in folder.entries() {
        match entry {
            DirEntry::Dir(below) => collect(below, found),
            DirEntry::File(file) => {
                let name = file.path().to_str().and_then(|path| path.strip_suffix(".toml"));
                found.extend(name.zip(file.contents_utf8()).map(|(name, text)| Embedded { name, text }));
            }
        }
    }
}

/// Every authored scenario, sorted by name.
pub fn embedded() -> &'static [Embedded] {
    &SCENARIOS
}

/// The authored scenario of that name.
pub(crate) fn find(name: &str) -> Option<&'static Embedded> {
    SCENARIOS.iter().find(|file| file.name == name)
}
