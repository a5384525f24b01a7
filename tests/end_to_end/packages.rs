//! Contents of a package: licences and bill of materials. `packaging/try_wheel.sh` and `packaging/try_archive.sh` try
//! the packages themselves.

#![allow(clippy::print_stderr, reason = "a test that skips says so")]

use std::process::Command;

use crate::architecture::root;

/// What a script of `packaging/` prints; nothing without Python.
fn printed(script: &str) -> Option<String> {
    let mut command = Command::new("python3");
    command.arg(root().join("packaging").join(script)).env("CARGO_NET_OFFLINE", "true");
    let Ok(output) = command.output() else {
        eprintln!("skipped: no python3 here");
        return None;
    };
    assert!(output.status.success(), "{script}: {}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).expect("UTF-8 text"))
}

#[test]
fn licences_and_bill_of_materials_name_the_same_crates() {
    let (Some(licences), Some(bill)) = (printed("third_party.py"), printed("sbom.py")) else { return };
    assert_eq!(printed("sbom.py").as_ref(), Some(&bill), "equal trees, equal bytes");
    let bill: serde_json::Value = serde_json::from_str(&bill).expect("JSON");
    let components = bill["components"].as_array().expect("a list");
    // What has an address in a registry is not ours.
    let named: Vec<String> = components
        .iter()
        .filter(|component| component["purl"].is_string())
        .map(|component| {
            assert!(component["licenses"].is_array() && component["hashes"].is_array(), "{component}");
            let word = |key: &str| component[key].as_str().expect("a text").to_owned();
            format!("| {} | {} |", word("name"), word("version"))
        })
        .collect();
    assert!(named.len() > 100, "{}", named.len());
    assert!(licences.contains(&format!("\n{} crates, ", named.len())), "{}", &licences[..200]);
    for crate_row in &named {
        assert!(licences.contains(crate_row), "{crate_row} has no licence in THIRD-PARTY.md");
    }
    assert!(licences.contains("Bitstream Vera"), "the licence of the font");
}
