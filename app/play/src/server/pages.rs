//! The files of the page, which are in the binary.

use axum::extract::Path;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};

/// A file of the page by its name.
macro_rules! files {
    ($($name:literal),* $(,)?) => {
        const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../page/", $name)))),*];
    };
}

files![
    "bicycle.js",
    "camera.js",
    "cards.js",
    "dom.js",
    "hud.js",
    "icon.svg",
    "index.html",
    "keys.js",
    "marks.js",
    "menu.js",
    "motion.js",
    "overlays.css",
    "pad.js",
    "page.css",
    "page.js",
    "roads.js",
    "score.js",
    "study.js",
    "touch.js",
    "vehicles.js",
    "world.js",
];

pub(super) async fn index() -> Response {
    named("index.html")
}

pub(super) async fn file(Path(file): Path<String>) -> Response {
    named(&file)
}

fn named(name: &str) -> Response {
    let kind = match name.rsplit_once('.').map(|(_, ending)| ending) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("svg") => "image/svg+xml",
        _ => "application/octet-stream",
    };
    match FILES.iter().find(|(known, _)| *known == name) {
        Some((_, text)) => ([(header::CONTENT_TYPE, kind)], *text).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

/// An image, by its first bytes.
pub(super) fn image(bytes: Vec<u8>) -> Response {
    let kind = if bytes.starts_with(b"\x89PNG") { "image/png" } else { "image/webp" };
    ([(header::CONTENT_TYPE, kind)], bytes).into_response()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every file of the folder is served, and what it asks for is there.
    #[test]
    fn the_page_is_whole() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/page");
        let there = std::fs::read_dir(folder).expect("the folder of the page");
        let mut there: Vec<String> =
            there.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into()).collect();
        let mut known: Vec<String> = FILES.iter().map(|(name, _)| (*name).to_owned()).collect();
        // It tells Node what the files are, and no browser.
        there.retain(|name| name != "package.json");
        there.sort();
        known.sort();
        assert_eq!(known, there);
        for (name, text) in FILES {
            for asked in text.split("from \"./").skip(1).filter_map(|rest| rest.split('"').next()) {
                assert!(FILES.iter().any(|(known, _)| *known == asked), "{name} asks for {asked}");
            }
            assert!(!text.contains("https://") || *name == "icon.svg", "{name} fetches something from elsewhere");
        }
    }
}
