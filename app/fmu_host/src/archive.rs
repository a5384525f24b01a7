//! Reads ZIP archives (APPNOTE 6.3, sections 4.3.7, 4.3.12 and 4.3.16) whose files are stored or deflated.

use std::ops::Range;

use miniz_oxide::inflate::decompress_to_vec_with_limit;

const END_OF_DIRECTORY: u32 = 0x0605_4b50;
const DIRECTORY_ENTRY: u32 = 0x0201_4b50;
const FILE_HEADER: u32 = 0x0403_4b50;
/// Length of the end-of-directory record without its comment, and of the longest comment \[bytes\].
const END_BYTES: usize = 22;
const MAX_COMMENT_BYTES: usize = 65_535;
/// Length of a directory entry and of a file header, both without names \[bytes\].
const ENTRY_BYTES: usize = 46;
const HEADER_BYTES: usize = 30;
/// The largest file that is unpacked \[bytes\].
const MAX_FILE_BYTES: usize = 1 << 30;
const STORED: u16 = 0;
const DEFLATED: u16 = 8;

#[derive(Clone, Debug, PartialEq)]
pub struct Packed {
    /// Its path within the archive.
    pub name: String,
    method: u16,
    content: Range<usize>,
    size: usize,
}

/// The files of an archive.
///
/// # Errors
/// What is wrong, in words.
pub fn files(archive: &[u8]) -> Result<Vec<Packed>, String> {
    let first = archive.len().saturating_sub(END_BYTES + MAX_COMMENT_BYTES);
    let last = archive.len().checked_sub(END_BYTES).ok_or("it is too short for an archive")?;
    let end = (first..=last).rev().find(|at| long(archive, *at) == Some(END_OF_DIRECTORY));
    let end = end.ok_or("it has no directory of an archive at its end")?;
    let broken = || "its directory is broken".to_owned();
    let count = short(archive, end + 10).ok_or_else(broken)?;
    let mut at = long(archive, end + 16).ok_or_else(broken)? as usize;
    let mut files = Vec::new();
    for _ in 0..count {
        if long(archive, at) != Some(DIRECTORY_ENTRY) {
            return Err(broken());
        }
        let part = |offset: usize| short(archive, at + offset).map(usize::from).ok_or_else(broken);
        let number = |offset: usize| long(archive, at + offset).map(|number| number as usize).ok_or_else(broken);
        let name_bytes = part(28)?;
        let name = archive.get(at + ENTRY_BYTES..at + ENTRY_BYTES + name_bytes).ok_or_else(broken)?;
        let name = String::from_utf8_lossy(name).into_owned();
        let (method, packed, size, header) = (part(10)? as u16, number(20)?, number(24)?, number(42)?);
        if long(archive, header) != Some(FILE_HEADER) {
            return Err(format!("its file `{name}` is broken"));
        }
        let header_part = |offset: usize| short(archive, header + offset).map(usize::from).ok_or_else(broken);
        let start = header + HEADER_BYTES + header_part(26)? + header_part(28)?;
        if start + packed > archive.len() || size > MAX_FILE_BYTES {
            return Err(format!("its file `{name}` is cut off or too large"));
        }
        if !name.ends_with('/') {
            files.push(Packed { name, method, content: start..start + packed, size });
        }
        at += ENTRY_BYTES + name_bytes + part(30)? + part(32)?;
    }
    Ok(files)
}

impl Packed {
    /// The content of the file in its archive.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn unpacked(&self, archive: &[u8]) -> Result<Vec<u8>, String> {
        let content = archive.get(self.content.clone()).unwrap_or_default();
        match self.method {
            STORED => Ok(content.to_vec()),
            DEFLATED => decompress_to_vec_with_limit(content, self.size)
                .map_err(|error| format!("its file `{}` is broken: {error}", self.name)),
            other => Err(format!("its file `{}` is packed by method {other}; known are 0 and 8", self.name)),
        }
    }
}

fn short(bytes: &[u8], at: usize) -> Option<u16> {
    let bytes = bytes.get(at..at.checked_add(2)?)?;
    Some(u16::from_le_bytes([bytes[0], bytes[1]]))
}

fn long(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from(short(bytes, at)?) | u32::from(short(bytes, at.checked_add(2)?)?) << 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_an_archive_is_refused() {
        for bytes in [
            &b""[..],
            b"PK",
            &[0; 100],
            b"PK\x05\x06\x00\x00\x00\x00\x01\x00\x01\x00\x00\x00\x00\x00\xff\xff\xff\xff\x00\x00",
        ] {
            assert!(files(bytes).is_err(), "{bytes:?}");
        }
        assert_eq!(
            files(b"PK\x05\x06\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00"),
            Ok(vec![])
        );
    }
}
