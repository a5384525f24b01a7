//! Drawings that several entries share, each of the first take.

use super::entry::{Entry, Exhibit};
use super::take::Take;
use super::{climate, driving};

/// Footprints.
pub(super) fn film(entry: &Entry, takes: &[&Take]) -> Result<Exhibit, String> {
    Ok(driving::film(entry.title, takes[0]).sketch().into())
}

/// Footprints, and below them what the ego had in mind.
pub(super) fn film_and_mind(entry: &Entry, takes: &[&Take]) -> Result<Exhibit, String> {
    let mut exhibit = film(entry, takes)?;
    let mind = driving::reasons("What the ego has in mind", takes[0], takes[0].scenario.ego_index());
    exhibit.pictures.extend(mind.map(|panels| panels.sketch()));
    Ok(exhibit)
}

/// Speeds.
pub(super) fn speeds(entry: &Entry, takes: &[&Take]) -> Result<Exhibit, String> {
    Ok(driving::speeds(entry.title, takes[0]).sketch().into())
}

/// Temperatures of the first four zones.
pub(super) fn temperatures(entry: &Entry, takes: &[&Take]) -> Result<Exhibit, String> {
    Ok(climate::temperatures(entry.title, takes[0], &climate::first_zones(takes[0])).sketch().into())
}

/// Inputs of the first four zones.
pub(super) fn inputs(entry: &Entry, takes: &[&Take]) -> Result<Exhibit, String> {
    Ok(climate::inputs(entry.title, takes[0], &climate::first_zones(takes[0])).sketch().into())
}
