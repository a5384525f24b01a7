//! ZIP archives with uncompressed files (APPNOTE 6.3, sections 4.3.7, 4.3.12 and 4.3.16).
//!
//! The date of all files is the first of January 1980, so that the same files give the same archive.

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
