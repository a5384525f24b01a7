//! Checks of described zones and walls.

use super::error::{NetworkError, Part};
use super::settings::{AMBIENT, Wall, Zone};
use crate::setting::{SettingError, check_not_negative, check_within};

pub(super) fn check_zones(zones: &[Zone]) -> Result<(), NetworkError> {
    if zones.is_empty() {
        return Err(NetworkError::NoZones);
    }
    for (index, zone) in zones.iter().enumerate() {
        let name = zone.name.clone();
        if name.trim().is_empty() || name == AMBIENT {
            return Err(NetworkError::BadName { zone: index, name });
        }
        let settings = positive("capacity_kj_per_k", zone.capacity_kj_per_k).and_then(|()| {
            check_not_negative(&[("limit_kw", zone.limit_kw), ("solar_aperture_m2", zone.solar_aperture_m2)])
        });
        let called = || format!("zone `{name}`");
        settings.map_err(|error| NetworkError::Setting { part: Part::Zone(index), called: called(), error })?;
    }
    let mut names: Vec<(&str, usize)> = zones.iter().enumerate().map(|(i, zone)| (zone.name.as_str(), i)).collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        Some(pair) => Err(NetworkError::DuplicateZone { zone: pair[1].1, name: pair[1].0.to_owned() }),
        None => Ok(()),
    }
}

/// The nodes at the two ends of each wall; `None` is the air outside.
pub(super) fn check_walls(zones: &[Zone], walls: &[Wall]) -> Result<Vec<[Option<usize>; 2]>, NetworkError> {
    let mut places: Vec<(&str, usize)> = zones.iter().enumerate().map(|(i, zone)| (zone.name.as_str(), i)).collect();
    places.sort_unstable();
    let find = |wall: usize, name: &str| {
        if name == AMBIENT {
            return Ok(None);
        }
        match places.binary_search_by_key(&name, |&(known, _)| known) {
            Ok(position) => Ok(Some(places[position].1)),
            Err(_) => Err(unknown(zones, (wall, &walls[wall]), name)),
        }
    };
    let mut ends = Vec::with_capacity(walls.len());
    for (index, wall) in walls.iter().enumerate() {
        let called = || wall_name(index, wall);
        let [one, other] = &wall.between;
        if one == other {
            return Err(NetworkError::SamePlace { wall: index, called: called(), name: one.clone() });
        }
        ends.push([find(index, one)?, find(index, other)?]);
        let capacity = || wall.capacity_kj_per_k.map_or(Ok(()), |capacity| positive("capacity_kj_per_k", capacity));
        positive("resistance_k_per_kw", wall.resistance_k_per_kw)
            .and_then(|()| capacity())
            .map_err(|error| NetworkError::Setting { part: Part::Wall(index), called: called(), error })?;
    }
    Ok(ends)
}

/// A wall in words, by its position from zero.
pub(super) fn wall_name(index: usize, wall: &Wall) -> String {
    format!("wall {} (`{}` - `{}`)", index + 1, wall.between[0], wall.between[1])
}

fn unknown(zones: &[Zone], (index, wall): (usize, &Wall), name: &str) -> NetworkError {
    let nearest = zones.iter().min_by_key(|zone| strsim::damerau_levenshtein(&zone.name, name));
    NetworkError::UnknownZone {
        wall: index,
        called: wall_name(index, wall),
        name: name.to_owned(),
        nearest: nearest.map_or_else(String::new, |zone| zone.name.clone()),
    }
}

/// Refuses what is not a positive number, or so small or large that its inverse is of no use.
fn positive(key: &str, value: f64) -> Result<(), SettingError> {
    check_within(key, value, 1e-9..=1e12, "between 1e-9 and 1e12 (leave a wall out that lets no heat through)")
}
