//! The true distances between footprints during a tick: of the ego to the others, and of any two vehicles.

use std::sync::Arc;

use interplay_planners::State;
use interplay_scenarios::{Scenario, Vehicle};

use super::footprint::{Footprint, distance_m, separation_m};
use super::near_pairs::{near_pairs, some_distance_m};

#[derive(Clone, Debug)]
pub(super) struct FootprintGaps {
    ego: usize,
    footprints: Arc<[Footprint]>,
    /// Whether each vehicle is not on the road in this tick.
    absent: Vec<bool>,
    /// Whether a measurement needs the distances; else there are none.
    pub is_measured: bool,
    smallest_m: Option<f64>,
    closest: Option<Closest>,
}

/// The two vehicles that came closest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Closest {
    /// The distance \[m\].
    pub m: f64,
    /// Their indices, ascending.
    pub pair: [usize; 2],
    /// Share of the tick that has passed by then.
    pub share: f64,
}

impl FootprintGaps {
    /// Measures before the first tick.
    pub fn new(scenario: &Scenario) -> Self {
        let footprint = |vehicle: &Vehicle| Footprint::new(&vehicle.body, vehicle.outline());
        let footprints: Arc<[Footprint]> = scenario.vehicles.iter().map(footprint).collect();
        let absent = vec![false; footprints.len()];
        FootprintGaps {
            ego: scenario.ego_index(),
            footprints,
            absent,
            is_measured: true,
            smallest_m: None,
            closest: None,
        }
    }

    /// The footprint of each vehicle.
    pub fn footprints(&self) -> Arc<[Footprint]> {
        Arc::clone(&self.footprints)
    }

    /// Begins a tick in which some vehicles are not on the road; returns the ego's distance at its start \[m\], `None` without others.
    pub fn begin(&mut self, states: &[State], absent: Vec<bool>) -> Option<f64> {
        self.absent = absent;
        (self.smallest_m, self.closest) = (None, None);
        self.observe(states, 0.0);
        self.smallest_m
    }

    /// Updates the distances at a time within the tick, given as the elapsed share of the tick.
    pub fn observe(&mut self, states: &[State], share: f64) {
        if !self.is_measured {
            return;
        }
        let (Some(footprint), Some(state)) = (self.footprints.get(self.ego), states.get(self.ego)) else { return };
        let present = || {
            let all = self.footprints.iter().zip(states).enumerate();
            all.filter(|(index, _)| !self.absent[*index])
        };
        let others = present().filter(|(index, _)| *index != self.ego && !self.absent[self.ego]);
        for (_, other) in others {
            let so_far_m = self.smallest_m.unwrap_or(f64::INFINITY);
            if least_gap_m((footprint, state), other) < so_far_m {
                let m = distance_m((footprint, state), other);
                self.smallest_m = Some(m.min(so_far_m));
            }
        }
        let circles: Vec<_> = (0..states.len())
            .map(|index| (!self.absent[index]).then(|| (states[index].position(), self.footprints[index].radius_m)))
            .collect();
        let closest_m = self.closest.map_or(f64::INFINITY, |closest| closest.m);
        for [index, other] in near_pairs(&circles, closest_m.min(some_distance_m(&circles))) {
            let [a, b] = [index, other].map(|index| (&self.footprints[index], &states[index]));
            let smallest_m = self.closest.map_or(f64::INFINITY, |closest| closest.m);
            if smallest_m > 0.0 && least_gap_m(a, b) < smallest_m {
                let m = distance_m(a, b);
                if m < smallest_m {
                    self.closest = Some(Closest { m, pair: [index, other], share });
                }
            }
        }
    }

    /// Records that two vehicles begin to touch at a share of the tick.
    pub fn touch(&mut self, pair: [usize; 2], share: f64) {
        if pair.contains(&self.ego) {
            self.smallest_m = Some(0.0);
        }
        if self.closest.is_none_or(|closest| closest.m > 0.0) {
            self.closest = Some(Closest { m: 0.0, pair, share });
        }
    }

    /// The smallest distance of the ego in the tick \[m\]; `None` without other vehicles.
    pub fn smallest_m(&self) -> Option<f64> {
        self.smallest_m
    }

    /// The two vehicles that came closest to each other in the tick; `None` if there is only one.
    pub fn closest(&self) -> Option<Closest> {
        self.closest
    }
}

/// A lower bound of the distance between two footprints, from the circles around them \[m\].
pub(super) fn least_gap_m((footprint, state): (&Footprint, &State), (around, other): (&Footprint, &State)) -> f64 {
    let apart_m = libm::hypot(state.x_m - other.x_m, state.y_m - other.y_m);
    apart_m - footprint.radius_m - around.radius_m
}

/// The shortest step between two checks, in ticks: the resolution of contact times.
pub(super) const MIN_STEP_TICKS: f64 = 1e-3;

/// The longest step between two checks, in ticks, at any distance of the vehicles.
const MAX_STEP_TICKS: f64 = 0.25;

/// Vehicles that come no nearer than this share of the largest radius do not touch, for all that single precision changes.
const MARGIN_RADII: f64 = 0.02;

/// The motion of one vehicle during a tick.
#[derive(Clone, Copy)]
pub(super) struct Path<'a> {
    pub footprint: &'a Footprint,
    /// Whether it is not on the road.
    pub is_absent: bool,
    /// State at the beginning of the tick.
    pub from: State,
    /// State at the end of the tick.
    pub to: State,
}

impl Path<'_> {
    /// The state when a share of the tick has passed.
    pub fn at(&self, share: f64) -> State {
        self.from.towards(&self.to, share)
    }

    /// The circle around it in a state; none if it is not on the road.
    fn circle(&self, state: &State) -> Option<([f64; 2], f64)> {
        (!self.is_absent).then(|| (state.position(), self.footprint.radius_m))
    }

    /// Upper bound of the displacement of its points during the tick \[m\].
    fn moved_m(&self) -> f64 {
        let moved_m = libm::hypot(self.to.x_m - self.from.x_m, self.to.y_m - self.from.y_m);
        moved_m + (self.to.heading_rad - self.from.heading_rad).abs() * self.footprint.radius_m
    }

    /// Upper bound of the decrease of the gap to another vehicle during the tick \[m\].
    fn approach_m(&self, other: &Path<'_>) -> f64 {
        let moved = |path: &Path<'_>| [path.to.x_m - path.from.x_m, path.to.y_m - path.from.y_m];
        let swept = |path: &Path<'_>| (path.to.heading_rad - path.from.heading_rad).abs() * path.footprint.radius_m;
        let ([ax, ay], [bx, by]) = (moved(self), moved(other));
        ((ax - bx) * (ax - bx) + (ay - by) * (ay - by)).sqrt() + swept(self) + swept(other)
    }
}

/// Extents of vehicles along an axis, whose memory is kept from tick to tick.
#[derive(Clone, Debug, Default)]
pub(super) struct Sweep(Vec<(f64, f64, usize)>);

impl Sweep {
    /// Whether any two of some vehicles may touch during the tick: those that are no further apart at its start than they approach each
    /// other, and a margin for the single precision of the physics engine. The motion that all have in common brings none nearer.
    pub fn may_touch<'a>(&mut self, count: usize, path: impl Fn(usize) -> Path<'a>) -> bool {
        let present = || (0..count).map(|row| (row, path(row))).filter(|(_, path)| !path.is_absent);
        let mut common_m = [0.0, 0.0];
        let moved_m = |path: &Path<'_>| [path.to.x_m - path.from.x_m, path.to.y_m - path.from.y_m];
        for (_, path) in present() {
            let moved_m = moved_m(&path);
            common_m = [0, 1].map(|axis| common_m[axis] + moved_m[axis] / count as f64);
        }
        if !common_m.iter().all(|m| m.is_finite()) {
            common_m = [0.0, 0.0];
        }
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let (mut fastest_m, mut widest_m) = (0.0_f64, 0.0_f64);
        for (_, path) in present() {
            let [x_m, y_m] = moved_m(&path);
            let turned_m = (path.to.heading_rad - path.from.heading_rad).abs() * path.footprint.radius_m;
            let [x_m, y_m] = [x_m - common_m[0], y_m - common_m[1]];
            fastest_m = fastest_m.max((x_m * x_m + y_m * y_m).sqrt() + turned_m);
            widest_m = widest_m.max(path.footprint.radius_m);
            for (bound, m) in bounds.iter_mut().zip(path.from.position()) {
                *bound = [bound[0].min(m), bound[1].max(m)];
            }
        }
        let axis = usize::from(bounds[1][1] - bounds[1][0] > bounds[0][1] - bounds[0][0]);
        let margin_m = MARGIN_RADII * widest_m;
        self.0.clear();
        self.0.extend(present().map(|(row, path)| {
            let (m, radius_m) = (path.from.position()[axis], path.footprint.radius_m);
            // A state that is not a number may touch all.
            if m.is_finite() { (m - radius_m, m + radius_m, row) } else { (f64::NEG_INFINITY, f64::INFINITY, row) }
        }));
        self.0.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.2.cmp(&other.2)));
        let window_m = 2.0 * fastest_m + margin_m;
        let near = self.0.iter().enumerate().flat_map(|(place, (_, high_m, one))| {
            let others = self.0[place + 1..].iter().take_while(move |(low_m, ..)| low_m - high_m <= window_m);
            others.map(move |(.., other)| [*one, *other])
        });
        { near }.any(|pair| {
            let [a, b] = pair.map(&path);
            let apart_m = separation_m((a.footprint, &a.from), (b.footprint, &b.from));
            (apart_m - margin_m).partial_cmp(&a.approach_m(&b)).is_none_or(std::cmp::Ordering::is_le)
        })
    }
}

/// The share of the tick at the next check, after one at `share`.
pub(super) fn next_look(paths: &[Path<'_>], share: f64) -> f64 {
    let states: Vec<State> = paths.iter().map(|path| path.at(share)).collect();
    let mut step = MAX_STEP_TICKS;
    let circles: Vec<_> = paths.iter().zip(&states).map(|(path, state)| path.circle(state)).collect();
    // Vehicles too far apart to meet in the longest step do not shorten it.
    let fastest_m = paths.iter().map(Path::moved_m).fold(0.0, f64::max);
    for [one, other] in near_pairs(&circles, 2.0 * MAX_STEP_TICKS * fastest_m) {
        let (a, b) = (&paths[one], &paths[other]);
        let (a_now, b_now) = ((a.footprint, &states[one]), (b.footprint, &states[other]));
        let approach = a.approach_m(b);
        if least_gap_m(a_now, b_now) >= step * approach {
            continue;
        }
        let gap = distance_m(a_now, b_now);
        // Vehicles that touch already cannot begin to touch.
        if approach > 0.0 && gap > 0.0 {
            step = step.min(gap / approach);
        }
    }
    (share + step.max(MIN_STEP_TICKS)).min(1.0)
}

#[cfg(test)]
mod tests {
    use interplay_planners::Body;

    use super::*;

    /// Footprints that may not touch are apart at every time of the tick, and most that are far apart may not.
    #[test]
    fn vehicles_that_may_not_touch_do_not() {
        let footprint = Footprint::new(&Body::default(), None);
        let mut spared = 0;
        for case in 0..2000 {
            let share = |prime: usize| (case * prime % 1999) as f64 / 1999.0;
            let from = |primes: [usize; 3]| State {
                x_m: share(primes[0]),
                y_m: 0.6 * share(primes[1]),
                heading_rad: 6.3 * share(primes[2]),
                speed_mps: 1.0,
            };
            let path = |from: State, primes: [usize; 3]| Path {
                footprint: &footprint,
                is_absent: false,
                from,
                to: State {
                    x_m: from.x_m + 0.3 * share(primes[0]) - 0.15,
                    y_m: from.y_m + 0.3 * share(primes[1]) - 0.15,
                    heading_rad: from.heading_rad + 0.2 * share(primes[2]) - 0.1,
                    ..from
                },
            };
            let paths = [path(from([13, 29, 41]), [53, 67, 71]), path(from([83, 97, 101]), [113, 127, 131])];
            if Sweep::default().may_touch(2, |row| paths[row]) {
                continue;
            }
            spared += 1;
            for part in 0..=100 {
                let [a, b] = [0, 1].map(|index| paths[index].at(0.01 * f64::from(part)));
                assert!(distance_m((&footprint, &a), (&footprint, &b)) > 1e-3, "{a:?} {b:?}");
            }
        }
        assert!((200..1900).contains(&spared), "{spared}");
    }
}
