//! The extent that the camera shows: the ego, its partners, and vehicles nearby.

use interplay_planners::State;
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::{Frame, VehicleFrame};

use crate::body::scale;
use crate::rectangle::extent;

/// Length of a car of 1/10 scale \[m\].
const CAR_M: f64 = 0.4;
/// Space between the vehicles and the edge of the view, in lengths of a car.
const MARGIN_CARS: f64 = 1.3;
/// The same in a close view of two vehicles.
const CLOSE_MARGIN_CARS: f64 = 0.4;
/// How far ahead of each vehicle the view reaches, as driving time at 1/10 scale \[s\].
const LOOK_AHEAD_S: f64 = 0.35;
/// The camera does not follow vehicles further away than this many widths of the largest view.
const NEAR_WIDTHS: f64 = 2.5;
/// Share of the largest view that is shown around an ego without other vehicles nearby.
const ALONE_RATIO: f64 = 0.7;
/// Least space between a vehicle that must be in view and the edge, in lengths of a car.
pub const LEAST_MARGIN_CARS: f64 = 0.35;

/// Least and greatest coordinates \[m\].
pub type Extent = [[f64; 2]; 2];

/// The input of the camera for one view.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraFrame {
    /// Every vehicle, in the scenario's order.
    pub states: Vec<State>,
    /// Indices of the vehicles with which the ego interacts: first those with a request, then those with an open passing order.
    pub partners: Vec<usize>,
    /// Two vehicles of a close view, which shows them alone.
    pub close_up: Option<[usize; 2]>,
}

/// The largest extents that are shown \[m\].
pub struct Largest {
    /// Largest extent for vehicles nearby.
    pub usual_m: [f64; 2],
    /// Largest extent for a mentioned vehicle.
    pub spoken_of_m: [f64; 2],
}

/// Length of a car of the scenario's scale \[m\].
pub fn car_m(scenario: &Scenario) -> f64 {
    CAR_M * scenario.ego().map_or(1.0, |ego| scale(&ego.body))
}

/// Indices of the vehicles with which a vehicle interacts: first those with a request, then those with an open passing order.
pub fn partners(scenario: &Scenario, vehicle: &VehicleFrame) -> Vec<usize> {
    let asked = vehicle.plan.proposals.iter().map(|proposal| &proposal.to);
    let mut partners = Vec::new();
    for name in asked.chain(vehicle.plan.homotopy_class.iter().map(|order| &order.of)) {
        if let Some(index) = scenario.index_of(name).filter(|index| !partners.contains(index)) {
            partners.push(index);
        }
    }
    partners
}

/// The frames, each with the additional partners of the frames less than `reach` away from it.
pub fn keeping_partners(moments: &[CameraFrame], reach: f64) -> Vec<CameraFrame> {
    let reach = reach as usize;
    let kept = |(index, moment): (usize, &CameraFrame)| {
        let mut kept = moment.clone();
        let near = &moments[index.saturating_sub(reach)..(index + reach + 1).min(moments.len())];
        for partner in near.iter().flat_map(|moment| &moment.partners) {
            if !kept.partners.contains(partner) {
                kept.partners.push(*partner);
            }
        }
        kept
    };
    moments.iter().enumerate().map(kept).collect()
}

/// Least and greatest coordinates of some vehicles and of their near future, with a margin in lengths of a car \[m\].
fn extent_of(
    scenario: &Scenario,
    states: &[State],
    indices: &[usize],
    (margin_cars, look_ahead_s): (f64, f64),
) -> Extent {
    let of = |index: &usize| {
        let (vehicle, state) = (&scenario.vehicles[*index], &states[*index]);
        let ahead_m = look_ahead_s * vehicle.body.time_ratio() * state.speed_mps;
        let (sin, cos) = libm::sincos(state.heading_rad);
        let soon = [state.x_m + ahead_m * cos, state.y_m + ahead_m * sin];
        vehicle.body.corners(state).into_iter().chain([soon])
    };
    let margin_m = margin_cars * car_m(scenario);
    let [low, high] = extent(indices.iter().flat_map(of));
    [low.map(|part| part - margin_m), high.map(|part| part + margin_m)]
}

fn fits([low, high]: &Extent, largest_m: [f64; 2]) -> bool {
    (0..2).all(|axis| high[axis] - low[axis] <= largest_m[axis])
}

/// Least and greatest coordinates of the ego and of vehicles near it, with a margin, within the largest extent \[m\].
pub fn shown_extent(scenario: &Scenario, moment: &CameraFrame, largest: &Largest) -> Extent {
    let CameraFrame { states, partners, close_up } = moment;
    if let Some(pair) = close_up {
        return extent_of(scenario, states, pair, (CLOSE_MARGIN_CARS, LOOK_AHEAD_S));
    }
    let ego = scenario.ego_index();
    let usual = |kept: &[usize]| extent_of(scenario, states, kept, (MARGIN_CARS, LOOK_AHEAD_S));
    let (mut kept, mut shown) = (vec![ego], usual(&[ego]));
    for partner in partners {
        kept.push(*partner);
        let narrow = || extent_of(scenario, states, &kept, (LEAST_MARGIN_CARS, 0.0));
        match [usual(&kept), narrow()].into_iter().find(|extent| fits(extent, largest.spoken_of_m)) {
            Some(extent) => shown = extent,
            None => drop(kept.pop()),
        }
    }
    let away_m = |index: usize| distance_m(&states[index], &states[ego]);
    let mut others: Vec<usize> = (0..states.len()).filter(|index| !kept.contains(index)).collect();
    let rank = |index: &usize| partners.iter().position(|partner| partner == index).unwrap_or(partners.len());
    others.sort_by(|a, b| rank(a).cmp(&rank(b)).then(away_m(*a).total_cmp(&away_m(*b))));
    let next = others.first().copied();
    // Vehicles that are not mentioned are included only if the scale stays the same.
    let most_m = [0, 1].map(|axis| largest.usual_m[axis].max(shown[1][axis] - shown[0][axis]));
    for other in others {
        kept.push(other);
        match Some(usual(&kept)).filter(|extent| fits(extent, most_m)) {
            Some(extent) => shown = extent,
            None => drop(kept.pop()),
        }
    }
    if kept.len() > 1 {
        return shown;
    }
    // If no further vehicle fits, the extent grows as far as possible toward the next one.
    let largest_m = if partners.is_empty() { largest.usual_m } else { largest.spoken_of_m };
    let is_coming = |next: usize| {
        let is_near = away_m(next) < NEAR_WIDTHS * largest_m[0];
        partners.contains(&next) || is_near && are_closing([&states[ego], &states[next]])
    };
    if let Some(next) = next.filter(|next| is_coming(*next)) {
        shown = toward(shown, states[next].position(), largest_m);
    }
    with_space(shown, largest.usual_m.map(|most_m| ALONE_RATIO * most_m))
}

/// Extends an extent toward a place as far as the largest extent allows.
fn toward([mut low, mut high]: Extent, place_m: [f64; 2], largest_m: [f64; 2]) -> Extent {
    for axis in 0..2 {
        if place_m[axis] < low[axis] {
            low[axis] = place_m[axis].max(high[axis] - largest_m[axis]);
        } else {
            high[axis] = high[axis].max(place_m[axis].min(low[axis] + largest_m[axis]));
        }
    }
    [low, high]
}

/// The extent widened to a least size around its middle.
fn with_space([low, high]: Extent, least_m: [f64; 2]) -> Extent {
    let half_m = [0, 1].map(|axis| 0.5 * (least_m[axis] - (high[axis] - low[axis])).max(0.0));
    [[0, 1].map(|axis| low[axis] - half_m[axis]), [0, 1].map(|axis| high[axis] + half_m[axis])]
}

fn distance_m(one: &State, other: &State) -> f64 {
    libm::hypot(one.x_m - other.x_m, one.y_m - other.y_m)
}

/// Whether two vehicles come closer to each other.
fn are_closing([one, other]: [&State; 2]) -> bool {
    let velocity = |state: &State| {
        let (sin, cos) = libm::sincos(state.heading_rad);
        [state.speed_mps * cos, state.speed_mps * sin]
    };
    let (one_mps, other_mps) = (velocity(one), velocity(other));
    let [x, y] = [other.x_m - one.x_m, other.y_m - one.y_m];
    x * (other_mps[0] - one_mps[0]) + y * (other_mps[1] - one_mps[1]) < 0.0
}

/// Indices of the vehicles on the road that have a driver, without the ego, sorted by distance from the ego.
pub fn nearest_vehicles(scenario: &Scenario, frame: &Frame) -> Vec<usize> {
    let ego = scenario.ego_index();
    let Some(own) = frame.vehicles.get(ego).map(|vehicle| vehicle.state) else { return Vec::new() };
    let away_m = |index: &usize| {
        let state = &frame.vehicles[*index].state;
        libm::hypot(state.x_m - own.x_m, state.y_m - own.y_m)
    };
    let is_driven = |index: &usize| {
        *index != ego && scenario.vehicles[*index].obstacle.is_none() && !frame.vehicles[*index].is_absent
    };
    let mut near: Vec<usize> = (0..frame.vehicles.len()).filter(is_driven).collect();
    near.sort_by(|one, other| away_m(one).total_cmp(&away_m(other)));
    near
}

/// Most vehicles with a label and a safety ellipse besides the ego: more would cover the road.
const MAX_LABELLED: usize = 8;

/// Vehicles of a crowd are described within this distance from the ego, in lengths of their bodies.
const NEAR_LENGTHS: f64 = 30.0;

/// For each vehicle, whether a recording contains its plans, numbers and words at a tick: always, except that in a
/// crowd only vehicles near the ego have them.
pub fn described(scenario: &Scenario, frame: &Frame) -> Vec<bool> {
    let ego = frame.vehicles.get(scenario.ego_index());
    let is_near = |(vehicle, stated): (&VehicleFrame, &Vehicle)| {
        let Some(ego) = ego.filter(|ego| !ego.is_absent) else { return false };
        let reach_m = NEAR_LENGTHS * (stated.body.front_m + stated.body.rear_m);
        let (own, other) = (&ego.state, &vehicle.state);
        libm::hypot(other.x_m - own.x_m, other.y_m - own.y_m) <= reach_m
    };
    if !scenario.is_crowd() {
        return vec![true; frame.vehicles.len()];
    }
    frame.vehicles.iter().zip(&scenario.vehicles).map(is_near).collect()
}

/// For each vehicle, whether it has a label: the ego and the vehicles nearest to it have one.
pub fn labelled(scenario: &Scenario, frame: &Frame) -> Vec<bool> {
    let mut near = nearest_vehicles(scenario, frame);
    near.truncate(MAX_LABELLED);
    (0..frame.vehicles.len()).map(|index| index == scenario.ego_index() || near.contains(&index)).collect()
}
