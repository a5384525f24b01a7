//! The files of the page, which are part of the binary; pictures of families, and animations of played runs.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use axum::extract::Path;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use interplay_presentation::animation::{AnimationFormat, encoded};
use interplay_presentation::figures::RecordedRun;
use interplay_scenarios::{Scenario, embedded, load};
use interplay_simulation::Simulation;

/// Lists files of the page with their content.
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

/// The picture of a family shows its first scenario after this share of its duration.
const PICTURE_TIME_SHARE: f64 = 0.25;

/// Cache of drawn pictures.
static DRAWN: LazyLock<Mutex<BTreeMap<&'static str, Vec<u8>>>> = LazyLock::new(Mutex::default);

pub(super) async fn family_picture(Path(file): Path<String>) -> Response {
    let family = file.split('.').next().unwrap_or_default().to_owned();
    let drawn = tokio::task::spawn_blocking(move || of_family(&family)).await;
    drawn.ok().flatten().map_or_else(|| StatusCode::NOT_FOUND.into_response(), image)
}

fn of_family(family: &str) -> Option<Vec<u8>> {
    let name = embedded().iter().map(|file| file.name).find(|name| name.split('/').next() == Some(family))?;
    let known = DRAWN.lock().unwrap_or_else(PoisonError::into_inner).get(name).cloned();
    known.or_else(|| {
        let picture = drawn(name)?;
        DRAWN.lock().unwrap_or_else(PoisonError::into_inner).insert(name, picture.clone());
        Some(picture)
    })
}

fn drawn(name: &str) -> Option<Vec<u8>> {
    let scenario = load(name, &[]).ok()?;
    let mut world = Simulation::new(&scenario).ok()?;
    while world.time_s() < PICTURE_TIME_SHARE * scenario.duration_s && world.step().ok()?.is_some() {}
    let frame = world.frame()?.clone();
    let now = RecordedRun::to_draw(scenario, vec![frame], world.report());
    encoded(&now, AnimationFormat::Filmstrip).ok()
}

/// The animation of a run, which is repeated for it. The scenarios are the written and the played one.
pub(super) fn animation([written, played]: [Scenario; 2]) -> Option<Vec<u8>> {
    let again = RecordedRun::record("played", played, Vec::new(), "").ok()?;
    encoded(&RecordedRun::to_draw(written, again.frames, again.report), AnimationFormat::WebP).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every file of the folder is served, and every imported file exists.
    #[test]
    fn every_file_of_the_play_page_is_served_and_every_import_exists() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/page");
        let there = std::fs::read_dir(folder).expect("the folder of the page");
        let mut there: Vec<String> =
            there.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into()).collect();
        let mut known: Vec<String> = FILES.iter().map(|(name, _)| (*name).to_owned()).collect();
        // For Node only.
        there.retain(|name| name != "package.json");
        there.sort();
        known.sort();
        assert_eq!(known, there);
        for (name, text) in FILES {
            for asked in text.split("from \"./").skip(1).filter_map(|rest| rest.split('"').next()) {
                assert!(FILES.iter().any(|(known, _)| *known == asked), "{name} imports {asked}");
            }
            assert!(!text.contains("https://") || *name == "icon.svg", "{name} uses an external address");
        }
    }
}
