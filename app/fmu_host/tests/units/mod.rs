//! Units that tests make.

use std::fs;
use std::path::Path;

use interplay_fmu_host::{HostError, Unit};

/// An archive whose files are stored as they are.
fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    let long = |number: usize| (number as u32).to_le_bytes();
    let short = |number: usize| (number as u16).to_le_bytes();
    for (name, content) in files {
        let start = bytes.len();
        let sizes = [long(content.len()), long(content.len())].concat();
        bytes.extend(b"PK\x03\x04");
        bytes.extend([0; 14]);
        bytes.extend([&sizes[..], &short(name.len()), &[0; 2], name.as_bytes(), content].concat());
        directory.extend(b"PK\x01\x02");
        directory.extend([0; 16]);
        directory.extend([&sizes[..], &short(name.len()), &[0; 12], &long(start), name.as_bytes()].concat());
    }
    let start = bytes.len();
    let count = short(files.len());
    bytes.extend([&directory[..], b"PK\x05\x06", &[0; 4], &count, &count].concat());
    bytes.extend([&long(directory.len())[..], &long(start), &[0; 2]].concat());
    bytes
}

pub fn unit(folder: &Path, files: &[(&str, &[u8])]) -> Result<Unit, HostError> {
    let path = folder.join("case.fmu");
    fs::write(&path, archive(files)).expect("written");
    Unit::open(&path)
}
