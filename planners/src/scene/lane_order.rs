//! The vehicles of a straight road by lanes, from rear to front, so that the vehicle ahead is found however far away it is.
//!
//! A road is cut lengthwise into bands, and each band lists the vehicles whose bodies reach into it by their arc length. Each vehicle knows
//! how many of each band are behind it or beside it, so that a look into a lane is a walk in each of its bands, from the middle one on, which
//! ends at the first vehicle that is at least partly in the lane.

use crate::Agent;

/// Width of the narrowest body that counts \[m\].
const LEAST_WIDTH_M: f64 = 0.18;
/// Width of a band, as a share of that of the widest body: the body in the middle of a lane is in no band of the lane beside.
const BAND_SHARE: f64 = 0.4;
/// Bands of a road are at most as many, so that a vehicle far away from it costs no memory.
const MOST_BANDS: usize = 48;

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

/// The row of a vehicle that has left the road.
const GONE: usize = usize::MAX;

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
    /// For each vehicle in turn, how many of each band are not ahead of it.
    behind: Vec<u32>,
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

    /// Sorts vehicles of one straight road anew, each with its row and, if it is on the road, its agent. Order and memory are kept from the
    /// last time.
    pub(crate) fn sort<'a>(&mut self, agents: impl ExactSizeIterator<Item = Option<&'a Agent>>) {
        if self.places.len() != agents.len() {
            self.places.clear();
            self.places.resize(agents.len(), None);
            self.road.vehicles.clear();
        }
        for (row, agent) in agents.enumerate() {
            let vehicle = agent.map(|agent| OnRoad::of(row, agent));
            match (self.places[row], vehicle) {
                (Some(place), Some(vehicle)) => self.road.vehicles[place as usize] = vehicle,
                (Some(place), None) => self.road.vehicles[place as usize].row = GONE,
                (None, vehicle) => self.road.vehicles.extend(vehicle),
            }
        }
        self.road.vehicles.retain(|vehicle| vehicle.row != GONE);
        self.road.sort();
        self.places.fill(None);
        for (place, vehicle) in self.road.vehicles.iter().enumerate() {
            self.places[vehicle.row] = Some(place as u32);
        }
    }

    /// The vehicle of a row on its road; none of a vehicle that is not sorted.
    pub(crate) fn of(&self, row: usize) -> Option<OnStraightRoad<'_>> {
        let place = (*self.places.get(row)?)?;
        let (place, bands) = (place as usize, self.road.bands.len());
        let behind = &self.road.behind[place * bands..(place + 1) * bands];
        Some(OnStraightRoad { road: &self.road, own: &self.road.vehicles[place], behind })
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
    fn sort(&mut self) {
        sort_again(&mut self.vehicles, |one, other| {
            one.along_m.total_cmp(&other.along_m).then(one.row.cmp(&other.row))
        });
        let all = || self.vehicles.iter();
        self.longest_m = all().map(|one| one.ends_m[1]).fold(0.0, f64::max);
        let low_m = all().map(|one| one.across_m - 0.5 * one.width_m).fold(f64::INFINITY, f64::min);
        let high_m = all().map(|one| one.across_m + 0.5 * one.width_m).fold(low_m, f64::max);
        let widest_m = all().map(|one| one.width_m).fold(LEAST_WIDTH_M, f64::max);
        self.band_m = (BAND_SHARE * widest_m).max((high_m - low_m) / (MOST_BANDS - 1) as f64);
        self.first_m = low_m;
        let count = (((high_m - low_m) / self.band_m) as usize + 1).min(MOST_BANDS);
        self.bands.resize(self.bands.len().max(count), Vec::new());
        self.bands.iter_mut().for_each(Vec::clear);
        self.behind.clear();
        let mut from = 0;
        while let Some(OnRoad { along_m, .. }) = self.vehicles.get(from).copied() {
            let beside =
                self.vehicles[from..].iter().take_while(|other| other.along_m.total_cmp(&along_m).is_eq()).count();
            for number in from..from + beside {
                let OnRoad { across_m, width_m, .. } = self.vehicles[number];
                let [first, last] = self.bands_of(Strip { centre_m: across_m, width_m });
                self.bands[first..=last].iter_mut().for_each(|band| band.push(number as u32));
            }
            for _ in 0..beside {
                self.behind.extend(self.bands.iter().map(|band| band.len() as u32));
            }
            from += beside;
        }
    }

    /// The first and the last band that a strip reaches into.
    fn bands_of(&self, strip: Strip) -> [usize; 2] {
        let last = self.bands.len().saturating_sub(1);
        [-0.5, 0.5]
            .map(|side| (((strip.centre_m + side * strip.width_m - self.first_m) / self.band_m) as usize).min(last))
    }

    /// The same bands, each once, from the middle one outwards.
    fn bands_from_middle(&self, strip: Strip) -> impl Iterator<Item = usize> {
        let [first, last] = self.bands_of(strip);
        let middle = (first + last) / 2;
        (middle..=last).chain((first..middle).rev())
    }
}

/// Sorts what was in order and has changed little since, without memory.
pub(crate) fn sort_again<T: Copy>(sorted: &mut [T], order: impl Fn(&T, &T) -> std::cmp::Ordering) {
    let most_moves = 8 * sorted.len();
    let mut moves = 0;
    for next in 1..sorted.len() {
        let (one, mut place) = (sorted[next], next);
        while place > 0 && order(&sorted[place - 1], &one).is_gt() {
            sorted[place] = sorted[place - 1];
            place -= 1;
        }
        sorted[place] = one;
        moves += next - place;
        if moves > most_moves {
            return sorted.sort_unstable_by(order);
        }
    }
}

/// A vehicle on its straight road, among the others there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnStraightRoad<'a> {
    road: &'a Road,
    pub own: &'a OnRoad,
    /// How many of each band are not ahead of it.
    behind: &'a [u32],
}

impl<'a> OnStraightRoad<'a> {
    /// The vehicle with the smallest gap ahead of its own front that is at least partly in a strip, and that gap between bumpers \[m\].
    pub fn ahead(&self, strip: Strip) -> Option<(&'a OnRoad, f64)> {
        let (road, own) = (self.road, self.own);
        let mut best: Option<(f64, u32)> = None;
        for band in road.bands_from_middle(strip) {
            for number in &road.bands[band][self.behind[band] as usize..] {
                let other = &road.vehicles[*number as usize];
                let ahead_m = other.along_m - own.along_m;
                if best.is_some_and(|(gap_m, _)| ahead_m - road.longest_m - own.ends_m[0] > gap_m) {
                    break;
                }
                let found = (ahead_m - other.ends_m[1] - own.ends_m[0], *number);
                if is_in(strip, other) && best.is_none_or(|best| found < best) {
                    best = Some(found);
                }
            }
        }
        best.map(|(gap_m, number)| (&road.vehicles[number as usize], gap_m))
    }

    /// The nearest vehicle behind or beside it that is at least partly in a strip, among those that count.
    pub fn behind(&self, strip: Strip, counts: impl Fn(&OnRoad) -> bool) -> Option<&'a OnRoad> {
        let (road, own) = (self.road, self.own);
        let mut best: Option<u32> = None;
        for band in road.bands_from_middle(strip) {
            let numbers = road.bands[band][..self.behind[band] as usize].iter().copied().rev();
            let nearer = numbers.take_while(|number| best.is_none_or(|best| *number > best));
            let is_found = |number: &u32| {
                let other = &road.vehicles[*number as usize];
                other.row != own.row && is_in(strip, other) && counts(other)
            };
            best = { nearer }.find(is_found).or(best);
        }
        best.map(|number| &road.vehicles[number as usize])
    }
}

fn is_in(strip: Strip, other: &OnRoad) -> bool {
    (other.across_m - strip.centre_m).abs() < 0.5 * (strip.width_m + other.width_m)
}
