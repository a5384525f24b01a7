//! The version of the program as far as it determines results: a digest of the sources that compute a run and its row.
//!
//! A row of an older version must not be taken for one of this version, and the package's version number changes too
//! seldom to tell them apart. The digest depends only on contents, so it is the same on every machine that builds the same sources.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// The sources that determine results, relative to the root of the repository.
const SOURCES: [&str; 10] = [
    "Cargo.lock",
    "common/src",
    "convex/src",
    "planners/src",
    "building/src",
    "scenarios/src",
    "app/fmu_host/src",
    "app/simulation/src",
    "app/sweep/src/measure",
    "app/sweep/src/row.rs",
];
/// Length of the digest that is kept \[bytes\].
const DIGEST_BYTES: usize = 8;

fn main() -> io::Result<()> {
    // Read when it runs, since this build script may have been compiled for another folder.
    let package = std::env::var("CARGO_MANIFEST_DIR").map_err(io::Error::other)?;
    let root = Path::new(&package).join("../..");
    let mut digest = Sha256::new();
    for source in SOURCES {
        println!("cargo::rerun-if-changed={}", root.join(source).display());
        let files = files(&root.join(source))?;
        if files.is_empty() {
            return Err(io::Error::other(format!("there is no `{source}` in {}", root.display())));
        }
        for file in files {
            let name = file.strip_prefix(&root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
            let content = fs::read(&file)?;
            digest.update(format!("{name}\n{}\n", content.len()));
            digest.update(content);
        }
    }
    let digest: String = digest.finalize().iter().take(DIGEST_BYTES).map(|byte| format!("{byte:02x}")).collect();
    println!("cargo::rustc-env=INTERPLAY_SOURCES={digest}");
    Ok(())
}

/// A file itself, or all files below a folder, sorted; empty if the path does not exist.
fn files(path: &Path) -> io::Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(if path.is_file() { vec![path.to_owned()] } else { Vec::new() });
    }
    let mut entries: Vec<PathBuf> = fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    entries.sort();
    let mut found = Vec::new();
    for entry in entries {
        found.extend(files(&entry)?);
    }
    Ok(found)
}
