//! Rebuilds the crate when an authored scenario is added or removed, which the compiler does not detect.

fn main() {
    println!("cargo::rerun-if-changed=files");
}
