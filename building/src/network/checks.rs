//! Checks of described zones and walls.

use interplay_common::setting;
use interplay_common::spelling::suggestion;

use super::error::{NetworkError, Part};
use super::settings::{AMBIENT, Wall, Zone};

pub(super) fn check_zones(zones: &[Zone]) -> Result<(), NetworkError> {
    if zones.is_empty() {
        return Err(NetworkError::NoZones);
    }
    for (index, zone) in zones.iter().enumerate() {
        let name = zone.name.clone();
        if name.trim().is_empty() || name == AMBIENT {
            return Err(NetworkError::BadName { zone: index, name });
        }
    }
    setting::check_each(zones).map_err(|(index, error)| {
        let called = format!("zone `{}`", zones[index].name);
        NetworkError::Setting { part: Part::Zone(index), called, error }
    })?;
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
        let [one, other] = &wall.between;
        if one == other {
            return Err(NetworkError::SamePlace { wall: index, called: wall_name(index, wall), name: one.clone() });
        }
        ends.push([find(index, one)?, find(index, other)?]);
    }
    setting::check_each(walls).map_err(|(index, error)| {
        let called = wall_name(index, &walls[index]);
        NetworkError::Setting { part: Part::Wall(index), called, error }
    })?;
    let has_sun = |wall: &Wall| wall.solar_aperture_m2 > 0.0 || !wall.windows.is_empty();
    match walls.iter().position(|wall| has_sun(wall) && wall.capacity_kj_per_k.is_none()) {
        Some(wall) => {
            let key = if walls[wall].windows.is_empty() { "solar_aperture_m2" } else { "window" };
            Err(NetworkError::SunWithoutMass { wall, called: wall_name(wall, &walls[wall]), key })
        }
        None => Ok(ends),
    }
}

/// A wall in words, by its position from zero.
pub(super) fn wall_name(index: usize, wall: &Wall) -> String {
    format!("wall {} (`{}` - `{}`)", index + 1, wall.between[0], wall.between[1])
}

fn unknown(zones: &[Zone], (index, wall): (usize, &Wall), name: &str) -> NetworkError {
    let names: Vec<&str> = zones.iter().map(|zone| zone.name.as_str()).collect();
    NetworkError::UnknownZone {
        wall: index,
        called: wall_name(index, wall),
        name: name.to_owned(),
        suggestion: suggestion(name, "the zones are", &names),
    }
}

/// The largest heating and cooling power of each zone.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerLimits {
    /// Largest heating power of each zone, at least 0 \[kW\].
    pub heating_kw: Vec<f64>,
    /// Largest cooling power of each zone, at least 0 \[kW\].
    pub cooling_kw: Vec<f64>,
}

impl PowerLimits {
    /// Limits of equipment that cools as strongly as it heats; one number per zone \[kW\].
    pub fn symmetric(limits_kw: &[f64]) -> Self {
        Self { heating_kw: limits_kw.to_vec(), cooling_kw: limits_kw.to_vec() }
    }

    /// Number of zones.
    pub fn zones(&self) -> usize {
        self.heating_kw.len()
    }

    /// The heat that a zone gets if `heat_kw` is requested; negative is cooling \[kW\].
    ///
    /// # Panics
    /// When `zone` is out of range.
    pub fn limited(&self, zone: usize, heat_kw: f64) -> f64 {
        heat_kw.clamp(-self.cooling_kw[zone], self.heating_kw[zone])
    }

    /// The heat that every zone gets if `heat_kw` is requested, one number per zone \[kW\].
    pub(crate) fn limited_all(&self, heat_kw: &[f64]) -> Vec<f64> {
        heat_kw.iter().enumerate().map(|(zone, kw)| self.limited(zone, *kw)).collect()
    }

    /// The limit on the side of `heat_kw`: that of cooling where it is negative \[kW\].
    ///
    /// # Panics
    /// When `zone` is out of range.
    pub(crate) fn towards_kw(&self, zone: usize, heat_kw: f64) -> f64 {
        if heat_kw < 0.0 { self.cooling_kw[zone] } else { self.heating_kw[zone] }
    }

    /// Amount by which a request exceeds its limit; negative within it \[kW\].
    pub fn excess_kw(&self, zone: usize, heat_kw: f64) -> f64 {
        heat_kw.abs() - self.towards_kw(zone, heat_kw)
    }
}
