//! Checks of zones and walls, and what the shape of the graph implies.

use super::{AMBIENT, Network, NetworkError, Part, Remark, Wall, Zone};
use crate::setting::{SettingError, check_not_negative, check_within};

/// A zone that settles faster than this is remarked upon \[s\].
const FAST_S: f64 = 600.0;
/// A zone that settles more slowly than this is remarked upon \[s\].
const SLOW_S: f64 = 90.0 * 86_400.0;

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

impl Network {
    /// What is allowed and may not have been meant: separate groups, heat that cannot leave, implausible time constants.
    pub fn remarks(&self) -> Vec<Remark> {
        let groups = self.groups();
        let named = |group: &[usize]| {
            group.iter().filter(|&&node| node < self.zone_count).map(|&node| self.names[node].clone()).collect()
        };
        let mut remarks = Vec::new();
        if groups.len() > 1 {
            remarks.push(Remark::Apart { groups: groups.iter().map(|group| named(group)).collect() });
        }
        let closed = groups.iter().filter(|group| group.iter().all(|&node| self.ambient_kw_per_k[node] == 0.0));
        let closed: Vec<String> = closed.flat_map(|group| -> Vec<String> { named(group) }).collect();
        if !closed.is_empty() {
            remarks.push(Remark::NoWayOut { zones: closed });
        }
        let time_constants = self.node_time_constants_s();
        for (zone, &time_constant_s) in self.names[..self.zone_count].iter().zip(&time_constants) {
            let zone = zone.clone();
            if time_constant_s < FAST_S {
                remarks.push(Remark::Fast { zone, time_constant_s });
            } else if time_constant_s > SLOW_S && time_constant_s.is_finite() {
                remarks.push(Remark::Slow { zone, time_constant_s });
            }
        }
        remarks
    }

    /// Capacity over total conductance of each node \[s\]; infinite for one that exchanges heat with nobody.
    pub fn node_time_constants_s(&self) -> Vec<f64> {
        let mut conductance_kw_per_k = self.ambient_kw_per_k.clone();
        for link in &self.links {
            conductance_kw_per_k[link.from] += link.conductance_kw_per_k;
            conductance_kw_per_k[link.to] += link.conductance_kw_per_k;
        }
        self.capacities_kj_per_k.iter().zip(&conductance_kw_per_k).map(|(c, k)| c / k).collect()
    }

    /// Nodes that exchange heat with one another, directly or not; groups and nodes in the order of the network.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut leader: Vec<usize> = (0..self.node_count()).collect();
        fn find(leader: &mut [usize], mut node: usize) -> usize {
            while leader[node] != node {
                leader[node] = leader[leader[node]];
                node = leader[node];
            }
            node
        }
        for link in &self.links {
            let (one, other) = (find(&mut leader, link.from), find(&mut leader, link.to));
            leader[one.max(other)] = one.min(other);
        }
        let mut groups: Vec<Vec<usize>> = vec![Vec::new(); self.node_count()];
        for node in 0..self.node_count() {
            let first = find(&mut leader, node);
            groups[first].push(node);
        }
        groups.retain(|group| !group.is_empty());
        groups
    }
}
