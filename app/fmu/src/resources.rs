//! The file `plant.txt`, which the shared library reads (format in `library/plant.rs`).
//!
//! ZIP archives with uncompressed files (APPNOTE 6.3, sections 4.3.7, 4.3.12 and 4.3.16).
//!
//! The date of all files is the first of January 1980, so that the same files give the same archive.

use std::fmt::{Display, Write};

use interplay_building::day::Surroundings;
use interplay_building::discretise::Model;

/// Weather and heat gains over a run, stacked over all steps.
#[derive(Clone, Debug)]
pub(crate) struct OutsideSeries {
    /// Outdoor temperature T₀ of each step \[°C\].
    pub ambient_c: Vec<f64>,
    /// Heat w of people, sun and machines, one number per step and heated node \[kW\].
    pub gains_kw: Vec<f64>,
}

impl OutsideSeries {
    /// Collects the actual values of all days.
    pub(crate) fn collect(surroundings: &Surroundings, model: &Model, steps_per_day: usize, days: usize) -> Self {
        let actual = (0..days).map(|day| surroundings.actual(model, steps_per_day, day));
        let mut all = Self { ambient_c: Vec::new(), gains_kw: Vec::new() };
        for day in actual {
            all.ambient_c.extend(day.ambient_c);
            all.gains_kw.extend(day.gains_kw);
        }
        all
    }
}

/// The content of the file without its GUID.
pub(crate) fn plant_text(model: &Model, initial_c: f64, outside: &OutsideSeries) -> String {
    let network = model.network();
    let (nodes, zones) = (network.node_count(), network.zone_count());
    let (state, gain) = (model.state_matrix(), model.disturbance_matrix());
    let mut text = String::new();
    row(&mut text, "step_s", [model.step_s()]);
    row(&mut text, "nodes", [nodes]);
    row(&mut text, "zones", [zones]);
    row(&mut text, "gained", [network.gain_count()]);
    row(&mut text, "steps", [outside.ambient_c.len()]);
    row(&mut text, "initial_c", vec![initial_c; nodes]);
    row(&mut text, "state", state.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<f64>>()));
    row(&mut text, "gain", gain.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<f64>>()));
    row(&mut text, "outdoor", model.gain_product(network.ambient_kw_per_k()));
    row(&mut text, "ambient_c", &outside.ambient_c);
    row(&mut text, "gains_kw", &outside.gains_kw);
    text
}

/// Writes a line of a word and numbers, which round-trip exactly.
fn row<T: Display>(text: &mut String, word: &str, numbers: impl IntoIterator<Item = T>) {
    text.push_str(word);
    for number in numbers {
        // Writing to a text cannot fail.
        let _ = write!(text, " {number}");
    }
    text.push('\n');
}

/// 1980-01-01.
const DATE: u16 = (1 << 5) | 1;
/// The version that is needed to extract: 2.0, for folders.
const VERSION: u16 = 20;
/// Unix, with permissions: a file that may be read and executed by all.
const MADE_BY: u16 = (3 << 8) | VERSION;
const PERMISSIONS: u32 = 0o100_755 << 16;
/// Names are UTF-8.
const FLAGS: u16 = 1 << 11;

/// Stores files in an archive. All sizes must be below 4 GiB.
pub(crate) fn archive(files: &[(String, &[u8])]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let start = bytes.len() as u32;
        bytes.extend(0x0403_4b50_u32.to_le_bytes());
        let entry = entry(name, content);
        bytes.extend(&entry);
        bytes.extend(name.as_bytes());
        bytes.extend(*content);
        directory.extend(0x0201_4b50_u32.to_le_bytes());
        directory.extend(MADE_BY.to_le_bytes());
        directory.extend(&entry);
        // The fields for the comment, the disk number and the internal attributes.
        directory.extend([0; 6]);
        directory.extend(PERMISSIONS.to_le_bytes());
        directory.extend(start.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (count, start, size) = (files.len() as u16, bytes.len() as u32, directory.len() as u32);
    bytes.extend(directory);
    bytes.extend(0x0605_4b50_u32.to_le_bytes());
    // The number of this disk, and of the disk with the directory.
    bytes.extend([0; 4]);
    bytes.extend(count.to_le_bytes());
    bytes.extend(count.to_le_bytes());
    bytes.extend(size.to_le_bytes());
    bytes.extend(start.to_le_bytes());
    // The length of the comment.
    bytes.extend([0; 2]);
    bytes
}

/// The common part of both headers of a file: version, flags, method, time, date, checksum, sizes, lengths.
fn entry(name: &str, content: &[u8]) -> Vec<u8> {
    let size = content.len() as u32;
    let mut bytes = Vec::with_capacity(26);
    for word in [VERSION, FLAGS, 0, 0, DATE] {
        bytes.extend(word.to_le_bytes());
    }
    for word in [crc32fast::hash(content), size, size] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend((name.len() as u16).to_le_bytes());
    bytes.extend([0; 2]);
    bytes
}
