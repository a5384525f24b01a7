//! Checks of zones and walls, and what the shape of the graph implies.

use super::{AMBIENT, Network, NetworkError, Remark, Wall, Zone};

/// A zone that settles faster than this is remarked upon \[s\].
const FAST_S: f64 = 600.0;
/// A zone that settles more slowly than this is remarked upon \[s\].
const SLOW_S: f64 = 90.0 * 86_400.0;

pub(super) fn check_zones(zones: &[Zone]) -> Result<(), NetworkError> {
    if zones.is_empty() {
        return Err(NetworkError::NoZones);
    }
    let mut names: Vec<&str> = Vec::with_capacity(zones.len());
    for (index, zone) in zones.iter().enumerate() {
        let name = zone.name.clone();
        if name.trim().is_empty() || name == AMBIENT {
            return Err(NetworkError::BadName { number: index + 1, name });
        }
        let place = format!("zone `{name}`");
        positive(&place, "capacity_kj_per_k", zone.capacity_kj_per_k)?;
        not_negative(&place, "limit_kw", zone.limit_kw)?;
        not_negative(&place, "solar_aperture_m2", zone.solar_aperture_m2)?;
        names.push(&zone.name);
    }
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(NetworkError::DuplicateZone { name: pair[0].to_owned() }),
        None => Ok(()),
    }
}

/// The nodes at the two ends of each wall; `None` is the air outside.
pub(super) fn check_walls(zones: &[Zone], walls: &[Wall]) -> Result<Vec<[Option<usize>; 2]>, NetworkError> {
    let mut places: Vec<(&str, usize)> = zones.iter().enumerate().map(|(i, zone)| (zone.name.as_str(), i)).collect();
    places.sort_unstable();
    let find = |wall: &str, name: &str| {
        if name == AMBIENT {
            return Ok(None);
        }
        match places.binary_search_by_key(&name, |&(known, _)| known) {
            Ok(position) => Ok(Some(places[position].1)),
            Err(_) => Err(unknown(zones, wall, name)),
        }
    };
    let mut ends = Vec::with_capacity(walls.len());
    for (number, wall) in walls.iter().enumerate() {
        let called = wall_name(number, wall);
        let [one, other] = &wall.between;
        if one == other {
            return Err(NetworkError::SamePlace { wall: called, name: one.clone() });
        }
        ends.push([find(&called, one)?, find(&called, other)?]);
        positive(&called, "resistance_k_per_kw", wall.resistance_k_per_kw)?;
        if let Some(capacity_kj_per_k) = wall.capacity_kj_per_k {
            positive(&called, "capacity_kj_per_k", capacity_kj_per_k)?;
        }
    }
    Ok(ends)
}

pub(super) fn wall_name(number: usize, wall: &Wall) -> String {
    format!("wall {} (`{}` - `{}`)", number + 1, wall.between[0], wall.between[1])
}

fn unknown(zones: &[Zone], wall: &str, name: &str) -> NetworkError {
    let nearest = zones.iter().min_by_key(|zone| strsim::damerau_levenshtein(&zone.name, name));
    NetworkError::UnknownZone {
        wall: wall.to_owned(),
        name: name.to_owned(),
        nearest: nearest.map_or_else(String::new, |zone| zone.name.clone()),
    }
}

/// Refuses what is not a positive number, or so small or large that its inverse is of no use.
fn positive(place: &str, quantity: &'static str, value: f64) -> Result<(), NetworkError> {
    if (1e-9..=1e12).contains(&value) {
        return Ok(());
    }
    let wanted = "between 1e-9 and 1e12 (leave a wall out that lets no heat through)";
    Err(NetworkError::OutOfRange { place: place.to_owned(), quantity, value, wanted })
}

fn not_negative(place: &str, quantity: &'static str, value: f64) -> Result<(), NetworkError> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(NetworkError::OutOfRange { place: place.to_owned(), quantity, value, wanted: "a number, at least 0" })
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
