//! What is seen of the vehicles at any moment of a run: between two ticks, states are interpolated.

use interplay_planners::road::network::RouteLeg;
use interplay_planners::{Route, State};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Frame, Origin, VehicleFrame};

use crate::figures::RecordedRun;
use crate::palette::{Colour, VERMILLION, vehicle_colours};

/// A vehicle brakes visibly if its acceleration is below this \[m/s²\].
pub const BRAKING_MPS2: f64 = -0.1;
/// A plan that leads further sideways than this is a change of lane, in lane widths.
const LANE_CHANGE_LANES: f64 = 0.5;
/// How much a way turns away from the lane before it, where there is a choice, to be indicated \[rad\].
const TURN_RAD: f64 = 0.6;
/// How far ahead a turn is indicated, in lane widths.
const TURN_AHEAD_LANES: f64 = 5.0;
/// How long an indicator is lit and dark \[s\], in the picture's time.
const BLINK_S: f64 = 0.32;

/// The side to which a vehicle is going to move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// To the left.
    Left,
    /// To the right.
    Right,
}

/// A vehicle at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenVehicle {
    /// Where it is.
    pub state: State,
    /// Angle of its front wheels \[rad\].
    pub steering_rad: f64,
    /// Whether its brake lights are on.
    pub brakes: bool,
    /// Which indicator is on; it may be dark at the moment.
    pub turn: Option<Turn>,
    /// Whether the lit indicator shines at the moment.
    pub blinks: bool,
    /// The planned positions from now on \[m\].
    pub plan: Vec<[f64; 2]>,
    /// The colour of the plan: its own, or that of a failure if the plan is a fallback.
    pub plan_colour: Colour,
    /// What it may do instead, of plans that branch \[m\].
    pub branches: Vec<Vec<[f64; 2]>>,
    /// The motion that it asks another vehicle for \[m\].
    pub proposal: Vec<[f64; 2]>,
}

/// All ticks of a run with vehicles.
pub struct DrivingRun<'a> {
    /// What was run.
    pub scenario: &'a Scenario,
    /// One colour a vehicle.
    pub colours: Vec<Colour>,
    /// Its ticks with vehicles.
    pub frames: Vec<&'a Frame>,
    /// Where every vehicle ended, and when \[s\].
    end: (f64, Vec<State>),
}

impl<'a> DrivingRun<'a> {
    /// The vehicles of a run; none of a run without them.
    pub fn of(recorded: &'a RecordedRun) -> Option<DrivingRun<'a>> {
        let frames: Vec<&Frame> = recorded.frames.iter().filter(|frame| !frame.vehicles.is_empty()).collect();
        let last = frames.last()?;
        let scenario = &recorded.scenario;
        let colours = vehicle_colours(scenario).into_iter().map(|colour| colour.rgb).collect();
        let end = recorded.report.vehicles.iter().map(|vehicle| vehicle.last).collect();
        let end = (last.time_s + scenario.step_s, end);
        Some(DrivingRun { scenario, colours, frames, end })
    }

    /// When it ends \[s\].
    pub fn end_s(&self) -> f64 {
        self.end.0
    }

    /// The last tick that began at a time or before it.
    pub fn frame(&self, time_s: f64) -> &'a Frame {
        self.frames[self.tick(time_s)]
    }

    /// The index of that tick.
    fn tick(&self, time_s: f64) -> usize {
        self.frames.partition_point(|frame| frame.time_s <= time_s + 1e-9).saturating_sub(1)
    }

    /// Every vehicle at a time, in the scenario's order; `shown_s` is the time in the picture, by which indicators blink.
    pub fn seen(&self, time_s: f64, shown_s: f64) -> Vec<SeenVehicle> {
        let tick = self.tick(time_s);
        let frame = self.frames[tick];
        let next_s = self.frames.get(tick + 1).map_or(self.end.0, |frame| frame.time_s);
        let share = ((time_s - frame.time_s) / (next_s - frame.time_s).max(1e-9)).clamp(0.0, 1.0);
        let blinks = ((shown_s / BLINK_S) as usize).is_multiple_of(2);
        let seen =
            |(index, vehicle): (usize, &VehicleFrame)| {
                let state = self.state(index, tick, share);
                let turn = turn(self.scenario, &self.scenario.vehicles[index].route, vehicle);
                let failed = vehicle.origin != Origin::Planned;
                SeenVehicle {
                    state,
                    steering_rad: vehicle.input.steering_rad,
                    brakes: is_braking(vehicle.input.acceleration_mps2) && state.speed_mps > 1e-3,
                    turn,
                    blinks,
                    plan: rest(&vehicle.plan.trajectory.states, &state),
                    plan_colour: if failed { VERMILLION.rgb } else { self.colours[index] },
                    branches: {
                        let branches = vehicle.plan.branches.iter();
                        branches.map(|branch| rest(&branch.trajectory.states, &state)).collect()
                    },
                    proposal: vehicle.plan.proposal.as_ref().map_or_else(Vec::new, |proposal| {
                        proposal.trajectory.states.iter().map(State::position).collect()
                    }),
                }
            };
        frame.vehicles.iter().enumerate().map(seen).collect()
    }

    /// The state of a vehicle when a share of a tick has passed.
    fn state(&self, index: usize, tick: usize, share: f64) -> State {
        let at = |tick: usize| match self.frames.get(tick) {
            Some(frame) => frame.vehicles[index].state,
            None => self.end.1[index],
        };
        let [before, from, to, after] = [tick.saturating_sub(1), tick, tick + 1, tick + 2].map(at);
        let between = |values: [f64; 4]| spline(values, share);
        let turned = |state: State| from.heading_rad + wrapped(state.heading_rad - from.heading_rad);
        State {
            x_m: between([before.x_m, from.x_m, to.x_m, after.x_m]),
            y_m: between([before.y_m, from.y_m, to.y_m, after.y_m]),
            heading_rad: from.heading_rad + share * (turned(to) - from.heading_rad),
            speed_mps: from.speed_mps + share * (to.speed_mps - from.speed_mps),
        }
    }
}

/// Whether an acceleration lights the brake lights.
pub fn is_braking(acceleration_mps2: f64) -> bool {
    acceleration_mps2 < BRAKING_MPS2
}

/// The value between the second and the third of four values at equal distances: the cubic of Catmull and Rom.
fn spline([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let (slope, end_slope) = (0.5 * (c - a), 0.5 * (d - b));
    let (squared, cubed) = (t * t, t * t * t);
    (2.0 * cubed - 3.0 * squared + 1.0) * b
        + (cubed - 2.0 * squared + t) * slope
        + (3.0 * squared - 2.0 * cubed) * c
        + (cubed - squared) * end_slope
}

/// An angle between −π and π \[rad\].
fn wrapped(angle_rad: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle_rad + PI).rem_euclid(TAU) - PI
}

/// The positions of a plan ahead of a state, which is the first of them.
fn rest(states: &[State], now: &State) -> Vec<[f64; 2]> {
    let later = states.iter().skip(1).map(State::position);
    let mut points = vec![now.position()];
    let (sin, cos) = libm::sincos(now.heading_rad);
    points.extend(later.filter(|[x, y]| cos * (x - now.x_m) + sin * (y - now.y_m) > 0.0));
    points
}

/// To which side a plan leads: into another lane, or on a network around a corner.
fn turn(scenario: &Scenario, route: &Route, vehicle: &VehicleFrame) -> Option<Turn> {
    let states = &vehicle.plan.trajectory.states;
    let (first, last) = (&vehicle.state, states.last()?);
    let side = |amount: f64| if amount > 0.0 { Turn::Left } else { Turn::Right };
    let across = |state: &State| route.locate(state.position(), None).across_m;
    let sideways_m = across(last) - across(first);
    if sideways_m.abs() > LANE_CHANGE_LANES * scenario.road.lane_width_m() {
        return Some(side(sideways_m));
    }
    turned_rad(scenario, route, route.along(first.position())).map(side)
}

/// How much the way of a vehicle turns at the next lane from which several lead on, if that is near \[rad\].
///
/// From a lane that is itself bent at its end, as on a ring, a lane that is bent as much leads straight on.
fn turned_rad(scenario: &Scenario, route: &Route, along_m: f64) -> Option<f64> {
    let network = scenario.network.as_ref()?;
    let ahead_m = TURN_AHEAD_LANES * scenario.road.lane_width_m();
    let pairs = route.legs.windows(2).filter(|legs| {
        let is_choice = network.lane(&legs[0].lane).is_some_and(|lane| lane.successors.len() > 1);
        is_choice && legs[0].to_m - ahead_m < along_m && along_m < legs[1].to_m
    });
    let direction = |at_m: f64| {
        let [from, to] = [at_m - 0.01 * ahead_m, at_m].map(|at_m| route.centre.position(at_m, 0.0));
        libm::atan2(to[1] - from[1], to[0] - from[0])
    };
    let turned = |legs: &[RouteLeg]| {
        let (here_m, length_m) = (legs[0].to_m, legs[1].to_m - legs[1].from_m);
        let own_m = length_m.min(legs[0].to_m - legs[0].from_m).max(1e-3 * ahead_m);
        let own_rad = wrapped(direction(here_m) - direction(here_m - own_m));
        wrapped(direction(legs[1].to_m) - direction(here_m) - own_rad * length_m / own_m)
    };
    pairs.map(turned).find(|turned_rad| turned_rad.abs() > TURN_RAD)
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    fn recorded(name: &str) -> RecordedRun {
        let scenario = load(name, &[]).expect("embedded");
        RecordedRun::of(name, scenario, Vec::new(), "").expect("a run")
    }

    #[test]
    fn states_at_ticks_are_those_of_the_run_and_motion_between_is_smooth() {
        let recorded = recorded("lane-change/front-nice");
        let run = DrivingRun::of(&recorded).expect("vehicles");
        for frame in &run.frames {
            let seen = run.seen(frame.time_s, 0.0);
            for (seen, vehicle) in seen.iter().zip(&frame.vehicles) {
                assert!((seen.state.x_m - vehicle.state.x_m).abs() < 1e-9);
            }
        }
        let step_s = recorded.scenario.step_s;
        for index in 0..recorded.scenario.vehicles.len() {
            let places: Vec<f64> =
                (0..=60).map(|part| run.seen(0.1 * step_s * f64::from(part), 0.0)[index].state.x_m).collect();
            let steps: Vec<f64> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert!(steps.iter().all(|step| *step > 0.0), "{steps:?}");
        }
        let (end, last) = (run.seen(1e3, 0.0)[0].state, recorded.report.vehicles[0].last);
        let off = end.to_array().iter().zip(last.to_array()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "{end:?} {last:?}");
    }

    #[test]
    fn brake_lights_shine_exactly_while_braking() {
        let recorded = recorded("roundabout/nice");
        let run = DrivingRun::of(&recorded).expect("vehicles");
        let (mut lit, mut dark) = (0, 0);
        for frame in &run.frames {
            for (seen, vehicle) in run.seen(frame.time_s, 0.0).iter().zip(&frame.vehicles) {
                let brakes = vehicle.input.acceleration_mps2 < -0.1 && vehicle.state.speed_mps > 1e-3;
                assert_eq!(seen.brakes, brakes, "{} at {} s", vehicle.name, frame.time_s);
                if brakes { lit += 1 } else { dark += 1 }
            }
        }
        assert!(lit > 10 && dark > 10, "{lit} {dark}");
    }

    /// On the ring nobody indicates before the exit, there to the right; a left turn at a crossing is indicated to the left.
    #[test]
    fn turns_are_indicated_where_there_is_a_choice() {
        let turns = |name: &str| {
            let recorded = recorded(name);
            let run = DrivingRun::of(&recorded).expect("vehicles");
            let ego = recorded.scenario.ego_index();
            let mut turns: Vec<Turn> =
                run.frames.iter().filter_map(|frame| run.seen(frame.time_s, 0.0)[ego].turn).collect();
            turns.dedup();
            turns
        };
        assert_eq!(turns("roundabout/nice"), [Turn::Right]);
        assert_eq!(turns("left-turn/nice"), [Turn::Left]);
    }

    /// The ego of this scenario changes to the lane on its left, and indicates before it is there.
    #[test]
    fn an_indicator_is_on_before_a_lane_change() {
        let recorded = recorded("lane-change/front-nice");
        let run = DrivingRun::of(&recorded).expect("vehicles");
        let ego = recorded.scenario.ego_index();
        let first = run.seen(0.0, 0.0)[ego].state.y_m;
        let last = recorded.report.vehicles[ego].last.y_m;
        let to = if last > first { Turn::Left } else { Turn::Right };
        let middle = 0.5 * (first + last);
        let crossing =
            run.frames.iter().position(|frame| (frame.vehicles[ego].state.y_m - middle) * (last - middle) > 0.0);
        let crossing_s = run.frames[crossing.expect("it changes lanes")].time_s;
        let before = run.frames.iter().filter(|frame| frame.time_s < crossing_s);
        let indicated = before.filter(|frame| run.seen(frame.time_s, 0.0)[ego].turn == Some(to)).count();
        assert!(indicated > 3, "{indicated} ticks before {crossing_s} s");
        assert!(run.seen(run.end_s() - 0.01, 0.0)[ego].turn.is_none(), "nothing to indicate in its lane");
    }
}
