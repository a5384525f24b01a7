//! Drawings that several entries share, each of the first run.

use super::entry::{Entry, FigureContent};
use super::error::FigureError;
use super::recorded_run::RecordedRun;
use super::{climate, driving};

/// Footprints.
pub(super) fn footprints(entry: &Entry, recorded_runs: &[&RecordedRun]) -> Result<FigureContent, FigureError> {
    Ok(driving::footprints(entry.title, recorded_runs[0]).drawing().into())
}

/// Footprints, and below them what the ego's planner computed.
pub(super) fn footprints_and_planner_panels(
    entry: &Entry,
    recorded_runs: &[&RecordedRun],
) -> Result<FigureContent, FigureError> {
    let mut content = footprints(entry, recorded_runs)?;
    let planner_panels = driving::reasons(
        "What the ego's planner believes and intends",
        recorded_runs[0],
        recorded_runs[0].scenario.ego_index(),
    );
    content.pictures.extend(planner_panels.map(|panels| panels.drawing()));
    Ok(content)
}

/// Speeds.
pub(super) fn speeds(entry: &Entry, recorded_runs: &[&RecordedRun]) -> Result<FigureContent, FigureError> {
    Ok(driving::speeds(entry.title, recorded_runs[0]).drawing().into())
}

/// Temperatures of the first four zones.
pub(super) fn temperatures(entry: &Entry, recorded_runs: &[&RecordedRun]) -> Result<FigureContent, FigureError> {
    Ok(climate::temperatures(entry.title, recorded_runs[0], &climate::first_zones(recorded_runs[0])).drawing().into())
}

/// Inputs of the first four zones.
pub(super) fn inputs(entry: &Entry, recorded_runs: &[&RecordedRun]) -> Result<FigureContent, FigureError> {
    Ok(climate::inputs(entry.title, recorded_runs[0], &climate::first_zones(recorded_runs[0])).drawing().into())
}
