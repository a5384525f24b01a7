//! The vehicles of a straight road by lanes, from rear to front, so that the vehicle ahead is found however far away it is.
//!
//! A road is cut lengthwise into bands, and each band lists the vehicles whose bodies reach into it by their arc length. A look into a lane
//! is a binary search in each of its bands, and a walk that ends at the first vehicle that is at least partly in the lane.

use crate::Agent;

/// Bands per width of a 1/10 scale car's lane, so that a car is in two or three.
const BAND_M: f64 = 0.18;
/// Bands of a road are at most as many, so that a vehicle far away from it costs no memory.
const MOST_BANDS: usize = 256;

/// A vehicle on a straight road.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct OnRoad {
    /// Its row.
    pub row: usize,
    /// Arc length of its mass centre \[m\].
    pub along_m: f64,
    /// Lateral coordinate \[m\].
    pub across_m: f64,
    /// Front and rear of its body, from its mass centre \[m\].
    pub ends_m: [f64; 2],
    /// Width of its body \[m\].
    pub width_m: f64,
    /// Its speed \[m/s\].
    pub speed_mps: f64,
    /// Its last acceleration \[m/s²\].
    pub acceleration_mps2: f64,
}

/// The vehicles of one straight road.
#[derive(Clone, Debug, Default, PartialEq)]
struct Road {
    /// From rear to front.
    vehicles: Vec<OnRoad>,
    /// Lateral coordinate at which the first band begins, and the width of each \[m\].
    first_m: f64,
    band_m: f64,
    /// Numbers of `vehicles`, in their order.
    bands: Vec<Vec<u32>>,
    longest_m: f64,
}

/// All vehicles of one straight road by lanes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaneOrder {
    road: Road,
    /// The place of each row in the order.
    places: Vec<Option<u32>>,
}

/// A strip of a road that is looked at: a lane, or the way of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strip {
    /// Lateral coordinate of its middle \[m\].
    pub centre_m: f64,
    /// Its width \[m\].
    pub width_m: f64,
}

impl LaneOrder {
    /// Whether vehicles are all on one straight road.
    pub(crate) fn has_all<'a>(agents: impl Iterator<Item = &'a Agent>) -> bool {
        let mut headings_rad = agents.map(|agent| agent.route.straight().map(|corridor| corridor.heading_rad));
        let Some(Some(first_rad)) = headings_rad.next() else { return false };
        headings_rad.all(|heading_rad| heading_rad == Some(first_rad))
    }

    /// Sorts vehicles of one straight road anew, by their rows; none are not on the road. Memory is kept from the last time.
    pub(crate) fn sort<'a>(&mut self, agents: impl Iterator<Item = Option<&'a Agent>>) {
        self.places.clear();
        self.road.clear();
        for (row, agent) in agents.enumerate() {
            self.places.push(None);
            self.road.vehicles.extend(agent.map(|agent| OnRoad::of(row, agent)));
        }
        self.road.sort();
        for (place, vehicle) in self.road.vehicles.iter().enumerate() {
            self.places[vehicle.row] = Some(place as u32);
        }
    }

    /// The vehicle of a row on its road; none of a vehicle that is not sorted.
    pub(crate) fn of(&self, row: usize) -> Option<OnStraightRoad<'_>> {
        let place = (*self.places.get(row)?)?;
        Some(OnStraightRoad { road: &self.road, own: &self.road.vehicles[place as usize] })
    }
}

impl OnRoad {
    fn of(row: usize, agent: &Agent) -> OnRoad {
        let at = agent.place();
        OnRoad {
            row,
            along_m: at.along_m,
            across_m: at.across_m,
            ends_m: [agent.body.front_m, agent.body.rear_m],
            width_m: agent.body.width_m,
            speed_mps: agent.state.speed_mps,
            acceleration_mps2: agent.previous_input.acceleration_mps2,
        }
    }
}

impl Road {
    fn clear(&mut self) {
        self.vehicles.clear();
        self.bands.iter_mut().for_each(Vec::clear);
    }

    fn sort(&mut self) {
        self.vehicles.sort_by(|one, other| one.along_m.total_cmp(&other.along_m).then(one.row.cmp(&other.row)));
        self.longest_m = self.vehicles.iter().map(|one| one.ends_m[1]).fold(0.0, f64::max);
        let low_m = self.vehicles.iter().map(|one| one.across_m - 0.5 * one.width_m).fold(f64::INFINITY, f64::min);
        let high_m = self.vehicles.iter().map(|one| one.across_m + 0.5 * one.width_m).fold(low_m, f64::max);
        let widest_m = self.vehicles.iter().map(|one| one.width_m).fold(BAND_M, f64::max);
        self.band_m = widest_m.max((high_m - low_m) / (MOST_BANDS - 1) as f64);
        self.first_m = low_m;
        let count = ((high_m - low_m) / self.band_m).floor() as usize + 1;
        self.bands.resize(self.bands.len().max(count), Vec::new());
        for number in 0..self.vehicles.len() {
            let OnRoad { across_m, width_m, .. } = self.vehicles[number];
            for band in self.bands_of(Strip { centre_m: across_m, width_m }) {
                self.bands[band].push(number as u32);
            }
        }
    }

    /// The bands that a strip reaches into.
    fn bands_of(&self, strip: Strip) -> std::ops::RangeInclusive<usize> {
        let band = |lateral_m: f64| ((lateral_m - self.first_m) / self.band_m).floor().max(0.0) as usize;
        let last = self.bands.len().saturating_sub(1);
        band(strip.centre_m - 0.5 * strip.width_m).min(last)..=band(strip.centre_m + 0.5 * strip.width_m).min(last)
    }
}

/// A vehicle on its straight road, among the others there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnStraightRoad<'a> {
    road: &'a Road,
    pub own: &'a OnRoad,
}

impl<'a> OnStraightRoad<'a> {
    /// The vehicle with the smallest gap ahead of its own front that is at least partly in a strip, and that gap between bumpers \[m\].
    pub fn ahead(&self, strip: Strip) -> Option<(&'a OnRoad, f64)> {
        let (road, own) = (self.road, self.own);
        let mut best: Option<(&OnRoad, f64)> = None;
        for band in road.bands_of(strip) {
            let numbers = road.bands.get(band).map_or(&[][..], Vec::as_slice);
            let from = numbers.partition_point(|number| road.vehicles[*number as usize].along_m <= own.along_m);
            for number in &numbers[from..] {
                let other = &road.vehicles[*number as usize];
                let ahead_m = other.along_m - own.along_m;
                if best.is_some_and(|(_, gap_m)| ahead_m - road.longest_m - own.ends_m[0] > gap_m) {
                    break;
                }
                let gap_m = ahead_m - other.ends_m[1] - own.ends_m[0];
                if is_in(strip, other) && best.is_none_or(|(_, least_m)| gap_m < least_m) {
                    best = Some((other, gap_m));
                }
            }
        }
        best
    }

    /// The nearest vehicle behind or beside it that is at least partly in a strip, among those that count.
    pub fn behind(&self, strip: Strip, counts: impl Fn(&OnRoad) -> bool) -> Option<&'a OnRoad> {
        let (road, own) = (self.road, self.own);
        let mut best: Option<&OnRoad> = None;
        for band in road.bands_of(strip) {
            let numbers = road.bands.get(band).map_or(&[][..], Vec::as_slice);
            let to = numbers.partition_point(|number| road.vehicles[*number as usize].along_m <= own.along_m);
            let behind = numbers[..to].iter().rev().map(|number| &road.vehicles[*number as usize]);
            let found = behind.filter(|other| other.row != own.row).find(|other| is_in(strip, other) && counts(other));
            if let Some(found) = found.filter(|found| best.is_none_or(|best| found.along_m > best.along_m)) {
                best = Some(found);
            }
        }
        best
    }
}

fn is_in(strip: Strip, other: &OnRoad) -> bool {
    (other.across_m - strip.centre_m).abs() < 0.5 * (strip.width_m + other.width_m)
}
