//! Pictures: of each family for the menu, and of what was played.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use axum::extract::Path;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use interplay_presentation::animation::{AnimationFormat, encoded};
use interplay_presentation::figures::RecordedRun;
use interplay_scenarios::{Scenario, embedded, load};
use interplay_simulation::Simulation;

use super::pages::image;

/// The picture of a family is its first scenario after this share of its time.
const SHARE: f64 = 0.25;

/// Pictures that were drawn before.
static DRAWN: LazyLock<Mutex<BTreeMap<&'static str, Vec<u8>>>> = LazyLock::new(Mutex::default);

pub(super) async fn picture(Path(file): Path<String>) -> Response {
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
    while world.time_s() < SHARE * scenario.duration_s && world.step().ok()?.is_some() {}
    let frame = world.frame()?.clone();
    let now = RecordedRun::to_draw(scenario, vec![frame], world.report());
    encoded(&now, AnimationFormat::Filmstrip).ok()
}

/// The moving picture of a run, which is repeated for it: of a scenario as it is written, and as it was played.
pub(super) fn animation([written, played]: [Scenario; 2]) -> Option<Vec<u8>> {
    let again = RecordedRun::record("played", played, Vec::new(), "").ok()?;
    encoded(&RecordedRun::to_draw(written, again.frames, again.report), AnimationFormat::WebP).ok()
}
