//! Compiles the shared library that an FMU contains, so that the exporter has it within itself.
//!
//! A crate cannot depend on a shared library of another package, and one beside the binary would be missing after `cargo run`
//! and `cargo install`. The library names nothing but the standard library, so the compiler alone makes it.

use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=library");
    println!("cargo::rerun-if-changed=build.rs");
    let variable = |name: &str| env::var(name).unwrap_or_default();
    let path = PathBuf::from(variable("OUT_DIR")).join("library.bin");
    let mut compiler = Command::new(variable("RUSTC"));
    compiler.args(["library/lib.rs", "--crate-name=interplay_fmu_library", "--crate-type=cdylib", "--edition=2024"]);
    compiler.args(["-Copt-level=3", "-Cstrip=symbols", "-Cpanic=unwind"]);
    compiler.arg(format!("--target={}", variable("TARGET"))).arg("-o").arg(&path);
    if let Ok(linker) = env::var("RUSTC_LINKER") {
        compiler.arg(format!("-Clinker={linker}"));
    }
    let why = match compiler.output() {
        Ok(output) if output.status.success() && path.exists() => return,
        Ok(output) => String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or_default().to_owned(),
        Err(error) => error.to_string(),
    };
    // Some targets have no shared libraries. Everything else works without it; `export-fmu` says that it is missing.
    println!("cargo::warning=no FMUs can be exported by this build: {why}");
    if let Err(error) = fs::write(&path, []) {
        println!("cargo::error=cannot write {}: {error}", path.display());
    }
}
