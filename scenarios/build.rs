//! Embeds the authored scenarios anew when one is added or taken away, which the compiler alone does not notice.

fn main() {
    println!("cargo::rerun-if-changed=files");
}
