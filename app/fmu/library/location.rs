//! The folder that the importer names as a URI.

use std::path::PathBuf;

/// The path of a `file:` URI, or of a plain path.
pub fn folder(uri: &str) -> PathBuf {
    let Some(rest) = uri.strip_prefix("file:") else { return PathBuf::from(uri) };
    let path = match rest.strip_prefix("//") {
        // After the two slashes comes a host, mostly none, and then the path.
        Some(with_host) => with_host.find('/').map_or("", |start| &with_host[start..]),
        None => rest,
    };
    let path = decoded(path);
    // A drive of Windows: `/C:/fmu`.
    let bytes = path.as_bytes();
    let has_drive = bytes.len() > 2 && bytes[0] == b'/' && bytes[1].is_ascii_alphabetic() && bytes[2] == b':';
    PathBuf::from(if has_drive { &path[1..] } else { &path })
}

/// Replaces `%20` and the like.
fn decoded(text: &str) -> String {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).and_then(|byte| char::from(*byte).to_digit(16));
    let (mut plain, mut at) = (Vec::with_capacity(bytes.len()), 0);
    while at < bytes.len() {
        match (bytes[at], digit(at + 1), digit(at + 2)) {
            (b'%', Some(high), Some(low)) => {
                plain.push((16 * high + low) as u8);
                at += 3;
            }
            (byte, ..) => {
                plain.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&plain).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_uris_are_converted_to_folder_paths() {
        for (uri, path) in [
            ("file:///tmp/a%20b/resources", "/tmp/a b/resources"),
            ("file:/tmp/resources/", "/tmp/resources/"),
            ("file://localhost/tmp/resources", "/tmp/resources"),
            ("file:///C:/fmu/resources", "C:/fmu/resources"),
            ("/tmp/resources", "/tmp/resources"),
            ("file:///tmp/100%", "/tmp/100%"),
            ("file://", ""),
        ] {
            assert_eq!(folder(uri), PathBuf::from(path), "{uri}");
        }
    }
}
